"""No sample may cost 5% more instructions than counts.json says, unless that file is changed with it."""

from __future__ import annotations

import pytest

from . import instructions

GROWTH = 1.05


@pytest.mark.slow
@pytest.mark.parametrize("scene", instructions.SCENES)
def test_a_sample_costs_no_more_than_it_did(scene: str) -> None:
    obstacle = instructions.obstacle()
    if obstacle:
        pytest.skip(obstacle)
    known, now = instructions.known()[scene], instructions.per_sample(scene)
    assert now <= GROWTH * known, (
        f"{scene}: {now:.0f} instructions a sample, {known:.0f} in counts.json; "
        "where they are worth it: python -m tests.performance.instructions"
    )

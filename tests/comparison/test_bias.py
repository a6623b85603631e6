"""The verdict: right estimators pass at its level, wrong ones do not, and it knows when it cannot tell."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from etendue.comparison import bias, metrics
from etendue.comparison.estimators import Estimator
from etendue.comparison.reference import Reference
from etendue.comparison.tally import Point, Repeat, Tally
from etendue.film import Film

HEIGHT, WIDTH, REPEATS, SPP = 48, 64, 8, 4
Draw = NDArray[np.float64]


def film(samples: Draw) -> Film:
    """Of samples (spp, height, width), grey."""
    count = len(samples)
    made = Film.empty(samples.shape[2], samples.shape[1])
    made.sum[:] = samples.sum(0)[..., None]
    made.sum_squares[:] = (samples**2).sum(0)[..., None]
    made.sample_count[:] = count
    made.image = (made.sum / count).astype(np.float32)
    return made


def tally(random: np.random.Generator, draw: object, truth: Draw) -> Tally:
    found = Tally(Estimator("test"))
    for seed in range(REPEATS):
        samples = np.stack([draw(random, truth) for _ in range(SPP)])  # type: ignore[operator]
        found.add(Repeat(film(samples), [Point(SPP, 1, 1, 1, {})]), seed)
    return found


def exact(truth: Draw) -> Reference:
    image = np.repeat(truth[..., None], 3, axis=2).astype(np.float32)
    return Reference(image, np.zeros_like(image, np.float64), None, "exact", "exact")


def noise(random: np.random.Generator, truth: Draw) -> Draw:
    """Unbiased, of a standard deviation of 1."""
    return truth * random.gamma(1, 1, truth.shape)


def lightning(random: np.random.Generator, truth: Draw) -> Draw:
    """Unbiased, with all light in one sample of 20,000."""
    return truth * (random.random(truth.shape) < 1 / 20000) * 20000


@pytest.fixture(scope="module")
def truth() -> Draw:
    return np.random.default_rng(0).random((HEIGHT, WIDTH)) + 0.5


def test_right_estimators_are_not_called_biased(truth: Draw) -> None:
    """200 verdicts at 0.1%: two or more false ones have a chance of 2%; and p-values of tiles are uniform."""
    random = np.random.default_rng(1)
    verdicts = [bias.judge(tally(random, noise, truth), exact(truth)) for _ in range(200)]
    assert sum(bool(verdict.is_biased) for verdict in verdicts) <= 1
    p = np.concatenate([verdict.p_values.ravel() for verdict in verdicts])
    assert abs(np.mean(p < 0.05) - 0.05) < 0.01
    assert verdicts[0].p_values.shape == (6, 8)
    assert "no bias detectable at 0.1%" in verdicts[0].words
    covered = np.mean([verdict.ratio.low < 1 < verdict.ratio.high for verdict in verdicts])
    assert 0.9 < covered < 0.99


def test_a_shift_of_all_is_found(truth: Draw) -> None:
    """2% where the mean is known to 0.3%: 98,304 samples of standard deviation 1."""
    random = np.random.default_rng(2)
    verdict = bias.judge(tally(random, lambda r, t: noise(r, t * 1.02), truth), exact(truth))
    assert verdict.is_biased
    assert verdict.words.startswith("biased: +")
    assert verdict.ratio.low < 1.02 < verdict.ratio.high


def test_a_shift_of_one_tile_is_found_there(truth: Draw) -> None:
    random = np.random.default_rng(3)

    def draw(r: np.random.Generator, t: Draw) -> Draw:
        wrong = t.copy()
        wrong[8:16, 16:24] *= 1.3
        return noise(r, wrong)

    verdict = bias.judge(tally(random, draw, truth), exact(truth))
    assert verdict.is_biased
    assert np.argwhere(verdict.rejected).tolist() == [[1, 2]]
    assert verdict.relative[1, 2] == pytest.approx(0.3, abs=0.1)


def test_shifts_that_cancel_are_found(truth: Draw) -> None:
    random = np.random.default_rng(4)
    board = np.where(np.indices((6, 8)).sum(0) % 2, 1.05, 0.95).repeat(8, 0).repeat(8, 1)
    verdict = bias.judge(tally(random, lambda r, t: noise(r, t * board), truth), exact(truth))
    assert verdict.p_mean > 0.001
    assert verdict.is_biased


def test_light_of_few_samples_is_not_judged(truth: Draw) -> None:
    """An estimator that is right and has hardly seen the light yet is too dark, but not biased."""
    random = np.random.default_rng(5)
    verdict = bias.judge(tally(random, lightning, truth), exact(truth))
    assert verdict.is_biased is None
    assert "cannot tell" in verdict.words


def test_rare_light_on_top_of_ordinary_light_is_not_judged(truth: Draw) -> None:
    """Half of the light is smooth, half in one sample of 2,000: tiles without any seem to be certain, and too dark."""
    random = np.random.default_rng(6)

    def draw(r: np.random.Generator, t: Draw) -> Draw:
        return t * (0.5 + 0.1 * r.random(t.shape) - 0.05 + 1000 * (r.random(t.shape) < 1 / 2000))

    verdicts = [bias.judge(tally(random, draw, truth), exact(truth)) for _ in range(20)]
    assert not any(verdict.is_biased for verdict in verdicts)


def test_a_little_rare_light_that_has_not_come_is_no_evidence(truth: Draw) -> None:
    """2% of the light in one sample of 1,000: a tile has two such on average, and many have none."""
    random = np.random.default_rng(10)

    def draw(r: np.random.Generator, t: Draw) -> Draw:
        return t * (0.98 + 0.02 * (r.random(t.shape) - 0.5) + 20 * (r.random(t.shape) < 1 / 1000))

    verdicts = [bias.judge(tally(random, draw, truth), exact(truth)) for _ in range(20)]
    assert min(verdict.p_values.min() for verdict in verdicts) < 1e-8
    assert not any(verdict.is_biased for verdict in verdicts)
    # What such light cannot explain is evidence all the same.
    assert bias.judge(tally(random, lambda r, t: draw(r, 0.9 * t), truth), exact(truth)).is_biased


def test_tiles_grow_with_rarity(truth: Draw) -> None:
    random = np.random.default_rng(9)

    def draw(r: np.random.Generator, t: Draw) -> Draw:
        return t * (r.random(t.shape) < 0.02) / 0.02

    verdict = bias.judge(tally(random, draw, truth), exact(truth))
    assert verdict.is_biased is False
    assert verdict.tile > bias.judge(tally(random, noise, truth), exact(truth)).tile


def test_black_is_black(truth: Draw) -> None:
    nothing = np.zeros_like(truth)
    random = np.random.default_rng(7)
    assert bias.judge(tally(random, noise, nothing), exact(nothing)).is_biased is False


def test_the_references_noise_counts(truth: Draw) -> None:
    """A reference with a standard error of 10% a pixel: its errors are not taken for the estimator's."""
    random = np.random.default_rng(8)
    false_alarms = 0
    for _ in range(40):
        shown = truth + random.normal(0, 0.1, truth.shape)
        image = np.repeat(shown[..., None], 3, axis=2).astype(np.float32)
        noisy = Reference(image, np.full((*truth.shape, 3), 0.01), None, "noisy", "noisy")
        precise = tally(random, lambda r, t: t + r.normal(0, 0.01, t.shape), truth)
        false_alarms += bool(bias.judge(precise, noisy).is_biased)
    assert false_alarms == 0


def test_tiles_at_the_edges_are_smaller() -> None:
    sums = metrics.sums(np.ones((10, 13)), 8)
    assert sums.tolist() == [[64, 40], [16, 10]]

"""Patches over the materials that meshes bring."""

from __future__ import annotations

from collections.abc import Iterable

from .sections import MaterialPatch

PATCHED = ("type", "ior", "roughness", "absorb", "albedo_col", "emissive_strength", "coated")


def merged(patches: Iterable[MaterialPatch]) -> dict[str, MaterialPatch]:
    """One patch for each name; where several set a key, the last one counts."""
    by_name: dict[str, MaterialPatch] = {}
    for patch in patches:
        earlier = by_name.get(patch.name)
        if earlier is not None:
            kept = {key: getattr(earlier, key) for key in PATCHED if getattr(patch, key) is None}
            patch = patch.model_copy(update=kept)
        by_name[patch.name] = patch
    return by_name

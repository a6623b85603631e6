"""The film file, merging, and the arithmetic of sums."""

from __future__ import annotations

import dataclasses
import errno
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import etendue
from etendue import EtendueError, Film, Scene
from etendue.film import file as film_file
from etendue.film import mean_of, sample_ranges
from etendue.film import replacing as film_replacing

ARRAYS = ("image", "sum", "sum_squares", "half_sum", "sample_count", "invalid_per_pixel", "half_count")


@pytest.fixture
def scene(lit_scene: Callable[..., None]) -> Scene:
    return etendue.load("lit.json")


def assert_same(film: Film, other: Film) -> None:
    for name in ARRAYS:
        mine, its = getattr(film, name), getattr(other, name)
        assert mine.dtype == its.dtype
        np.testing.assert_array_equal(mine, its, err_msg=name)
    assert (film.ranges, film.partial, film.goal) == (other.ranges, other.partial, other.goal)


def refusal(action: Callable[[], Any]) -> str:
    with pytest.raises(EtendueError) as caught:
        action()
    return str(caught.value)


def test_a_film_comes_back_as_it_was(scene: Scene) -> None:
    film = scene.render(spp=5, seed=2**32 - 1)
    film.write("a.film.exr")
    back = etendue.read_film("a.film.exr")
    assert_same(film, back)
    for field in dataclasses.fields(Film):
        if field.name not in ARRAYS:
            assert getattr(film, field.name) == getattr(back, field.name), field.name
    back.write("b.film.exr")
    assert_same(film, etendue.read_film("b.film.exr"))


def test_sums_keep_every_bit(scene: Scene) -> None:
    film = scene.render(spp=1)
    random = np.random.default_rng(1)
    shape = film.sum.shape
    for name in ("sum", "sum_squares", "half_sum"):
        bits = random.integers(0, 0x7FF0 << 48, shape, np.uint64)
        setattr(film, name, bits.view(np.float64))
    film.sum[0, 0] = 0.0, 5e-324, 1.7976931348623157e308
    film.sample_count = random.integers(0, 2**64 - 1, shape[:2], np.uint64, endpoint=True)
    film.invalid_per_pixel = random.integers(0, 2**64 - 1, shape[:2], np.uint64, endpoint=True)
    film.image = random.random(shape, np.float32)
    for compressed in (True, False):
        film_file.write(film, Path("a.exr"), compressed)
        assert_same(film, etendue.read_film("a.exr"))


def test_other_programs_see_an_image(scene: Scene) -> None:
    film = scene.render()
    film.write("a.film.exr")
    source = oiio.ImageInput.open("a.film.exr")
    spec = source.spec()
    assert spec.channelnames[:3] == ("R", "G", "B")
    kinds = dict(zip(spec.channelnames, map(str, spec.channelformats), strict=True))
    assert kinds["R"] == kinds["G"] == kinds["B"] == "float"
    assert kinds["sum.high.R"] == kinds["sample_count.low"] == "uint"
    np.testing.assert_array_equal(source.read_image(0, 0, 0, 3, oiio.FLOAT), film.image)
    position = spec.channelnames.index("sample_count.low")
    counts = source.read_image(0, 0, position, position + 1, oiio.UINT)
    assert (counts == 4).all()
    assert spec.getattribute("etendue:algorithm") == "Pathtracer"
    assert spec.getattribute("etendue:ranges") == "[[0, 4]]"
    assert spec.getattribute("etendue:scene_hash") == film.origin.scene_hash


def test_the_half_is_that_of_the_first_halves_of_octaves(scene: Scene) -> None:
    film = scene.render(samples=(3, 70))
    half = etendue.merge([scene.render(samples=part) for part in ((3, 8), (16, 24), (32, 48), (64, 70))])
    np.testing.assert_allclose(film.half_sum, half.sum, rtol=1e-12)
    np.testing.assert_array_equal(film.half_count, half.sample_count)
    assert (film.half_count == 5 + 8 + 16 + 6).all()


def test_what_is_no_film_is_refused(scene: Scene) -> None:
    film = scene.render()
    film.save("image.exr")
    assert refusal(lambda: etendue.read_film("image.exr")) == (
        "image.exr: an image, but no film; films are written with --film"
    )
    assert refusal(lambda: etendue.read_film("none.exr")) == (
        "none.exr: cannot be read: No such file or directory"
    )
    Path("text.exr").write_text("no image at all")
    assert refusal(lambda: etendue.read_film("text.exr")).startswith("text.exr: cannot be read: ")
    assert refusal(lambda: film.write("film.png")) == (
        'film.png: a film file is an EXR image; its name must end with ".exr"'
    )
    zero = np.zeros((2, 2, 3))
    strange = Film(zero.astype(np.float32), np.zeros((2, 2), np.uint64), zero, zero)
    assert "no render gave" in refusal(lambda: strange.write("film.exr"))


@pytest.mark.parametrize("compressed", [True, False])
def test_damage_is_noticed(scene: Scene, compressed: bool) -> None:
    film_file.write(scene.render(size=(64, 48)), Path("a.exr"), compressed)
    whole = Path("a.exr").read_bytes()
    for length in (*range(0, len(whole), len(whole) // 12), len(whole) - 1):
        Path("b.exr").write_bytes(whole[:length])
        assert refusal(lambda: etendue.read_film("b.exr")).startswith("b.exr: ")
    random = np.random.default_rng(2)
    for position in random.integers(len(whole) // 2, len(whole), 10):
        broken = bytearray(whole)
        broken[position] ^= 0x10
        Path("b.exr").write_bytes(broken)
        assert refusal(lambda: etendue.read_film("b.exr")).startswith("b.exr: ")


def test_a_full_disk_leaves_the_old_film(
    scene: Scene, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    film = scene.render()
    film.write("a.film.exr")
    before, old = Path("a.film.exr").read_bytes(), sorted(tmp_path.iterdir())

    def full(source: Any, target: Any, *_: Any) -> None:
        target.write(source.read(100))
        target.flush()
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(shutil, "copyfileobj", full)
    assert refusal(lambda: scene.render(spp=8).write("a.film.exr")) == (
        "a.film.exr: cannot be written: No space left on device"
    )
    assert Path("a.film.exr").read_bytes() == before
    assert sorted(tmp_path.iterdir()) == old


def test_what_killed_writers_left_is_swept_but_nothing_of_the_living(scene: Scene) -> None:
    Path(".a.film-dead.part").write_text("half a film")
    Path(".b.film-other.part").write_text("of another film")
    living, file = film_replacing._locked(Path("a.film.exr").resolve())
    with file:
        scene.render().write("a.film.exr")
        assert living.exists()
    assert not Path(".a.film-dead.part").exists()
    assert Path(".b.film-other.part").exists()


def test_a_link_stays_a_link(scene: Scene) -> None:
    Path("there").mkdir()
    Path("a.exr").symlink_to("there/real.exr")
    scene.render().write("a.exr")
    assert Path("a.exr").is_symlink()
    assert etendue.read_film("there/real.exr").spp == 4


def test_merged_parts_are_the_whole(scene: Scene) -> None:
    whole = scene.render(spp=11)
    parts = [scene.render(samples=range(3, 11)), scene.render(samples=(0, 3))]
    parts[0].write("b.exr")
    merged = etendue.merge(["b.exr", parts[1]])
    np.testing.assert_array_max_ulp(merged.image, whole.image, maxulp=1)
    assert (merged.ranges, merged.goal, merged.complete) == ([(0, 11)], (0, 11), True)
    assert merged.rays == whole.rays
    assert merged.spp == 11
    assert merged.origin is not None
    assert merged.origin.config["framebuffer"]["sppx"] == 11
    assert_same(merged, etendue.merge([parts[1], "b.exr"]))
    # What went in stays as it was.
    assert parts[1].spp == 3


def test_overlaps_and_strangers_are_refused(scene: Scene) -> None:
    scene.render(samples=(0, 6)).write("a.exr")
    scene.render(samples=(4, 8)).write("b.exr")
    scene.render(samples=(8, 9), seed=1, rr_threshold=0.5).write("c.exr")
    assert refusal(lambda: etendue.merge(["a.exr", "b.exr"])) == "b.exr: the samples 4:6 are in a.exr, too"
    assert refusal(lambda: etendue.merge(["a.exr", "c.exr"])) == (
        "c.exr: not of the same scene and settings as a.exr:\n"
        "  rr_threshold: 0.5 in c.exr, 0.25 in a.exr\n"
        "  seed: 1 in c.exr, 0 in a.exr"
    )
    assert refusal(lambda: etendue.merge([])) == "merge: at least one film is needed"
    film = etendue.read_film("a.exr")
    assert film.origin is not None
    film.origin = dataclasses.replace(film.origin, version="9.9")
    assert "version: 9.9 in film 2, " in refusal(lambda: etendue.merge(["b.exr", film]))


@pytest.fixture(scope="module")
def shared_scene(tmp_path_factory: pytest.TempPathFactory) -> Scene:
    folder = tmp_path_factory.mktemp("shared")
    (folder / "lit.obj").write_text("v -9 -9 0\nv 9 -9 0\nv 0 9 0\nusemtl floor\nf 1 2 3\n")
    data = {
        "camera": {"pos": [0, 0, 1], "dir": [0, 0.2, -1]},
        "framebuffer": {"res_w": 5, "res_h": 4},
        "scene": {"mesh_files": [str(folder / "lit.obj")], "sky": {}},
    }
    return etendue.load(data)


@settings(max_examples=40)
@given(st.data())
def test_any_split_in_any_order_is_the_single_render(shared_scene: Scene, data: st.DataObject) -> None:
    spp = data.draw(st.integers(1, 40))
    cuts = data.draw(st.lists(st.integers(0, spp), max_size=5))
    edges = sorted({0, *cuts, spp})
    parts = []
    for first, end in zip(edges, edges[1:], strict=False):
        threads = data.draw(st.integers(1, 2))
        half = data.draw(st.integers(first + 1, end))
        part = shared_scene.render(samples=(first, half), threads=threads)
        parts.append(shared_scene.render(resume=part, spp=end - first))
    films = data.draw(st.permutations(parts))
    while len(films) > 1:
        some = data.draw(st.integers(2, len(films)))
        films = [*films[some:], etendue.merge(films[:some])]
    whole = shared_scene.render(spp=spp)
    np.testing.assert_array_max_ulp(films[0].image, whole.image, maxulp=1)
    np.testing.assert_array_equal(films[0].sample_count, whole.sample_count)
    assert (films[0].ranges, films[0].complete) == (whole.ranges, True)


@settings(max_examples=15)
@given(st.lists(st.floats(0, 1), min_size=1, max_size=4))
def test_interruptions_anywhere_lose_nothing(shared_scene: Scene, moments: list[float]) -> None:
    spp = 3000
    whole = shared_scene.render(spp=spp)
    film = None
    for moment in moments:

        def stop(fraction: float, _: float, moment: float = moment) -> None:
            if fraction >= moment:
                raise KeyboardInterrupt

        try:
            film = shared_scene.render(spp=spp, resume=film, progress=stop)
        except KeyboardInterrupt:
            continue
    film = shared_scene.render(spp=spp, resume=film)
    for name in ("sum", "sum_squares", "half_sum", "sample_count", "image"):
        np.testing.assert_array_equal(getattr(film, name), getattr(whole, name))
    assert (film.rays, film.complete, film.partial) == (whole.rays, True, None)


def unfinished(film: Film) -> Film:
    """`film` as if it had been interrupted in its last sample, with half the pixels done."""
    done = np.arange(film.sample_count.size).reshape(film.sample_count.shape) % 2 == 0
    (first, end) = film.ranges[-1]
    return dataclasses.replace(
        film,
        sample_count=np.where(done, film.sample_count, film.sample_count - np.uint64(1)),
        ranges=sample_ranges.union([*film.ranges[:-1], (first, end - 1)]),
        partial=(end - 1, end),
    )


def test_an_unfinished_part_is_merged_and_finished(scene: Scene) -> None:
    part = unfinished(scene.render(samples=(4, 7)))
    other = scene.render(samples=(0, 2))
    merged = etendue.merge([part, other])
    assert (merged.ranges, merged.partial, merged.complete) == ([(0, 2), (4, 6)], (6, 7), False)
    merged.write("m.exr")
    merged = etendue.read_film("m.exr")
    assert (merged.partial, merged.missing) == ((6, 7), 3)
    film = scene.render(resume=merged, spp=9)
    assert (film.ranges, film.partial, film.complete) == ([(0, 9)], None, True)
    assert (film.sample_count == 9).all()
    assert "with samples that only some pixels have" in refusal(
        lambda: etendue.merge([part, unfinished(scene.render(samples=(0, 2)))])
    )
    none_whole = unfinished(scene.render(samples=(4, 5)))
    film = scene.render(resume=etendue.merge([none_whole, other]))
    assert (film.ranges, film.partial, film.complete) == ([(0, 5)], None, True)


def test_sums_of_a_million_samples_are_exact(lit_scene: Callable[..., None]) -> None:
    scene = etendue.load({"scene": {"sky": {"intensity": 0.7}}})
    one = scene.render(spp=1, size=(1, 1))
    film = scene.render(spp=1_000_000, size=(1, 1))
    value = np.float64(one.sum[0, 0, 0])
    assert value == np.float32(0.7)
    # 24 bits of the value and 20 of the count: every one of the million sums is a double without rounding.
    assert (film.sum == 1e6 * value).all()
    # The octave of 2^19 is complete, and of that of 2^20 nothing is in it.
    half = 2**18 + min(10**6 - 2**19, 2**18)
    assert (film.half_count == half).all()
    assert (film.half_sum == half * value).all()
    np.testing.assert_allclose(film.sum_squares, 1e6 * value * value, rtol=1e-10)
    assert (film.image == np.float32(0.7)).all()


def test_one_sample_counts_after_a_million(shared_scene: Scene) -> None:
    film = shared_scene.render(samples=(0, 1))
    many = 1_000_000
    total = film.sum * many + np.pi
    before = dataclasses.replace(
        film,
        sum=total,
        sample_count=film.sample_count * np.uint64(many),
        ranges=[(0, many)],
        goal=(0, many),
    )
    after = shared_scene.render(resume=before, spp=many + 1)
    sample = shared_scene.render(samples=(many, many + 1))
    np.testing.assert_array_equal(after.sum, total + sample.sum)
    assert (after.sum > total)[sample.sum > 0].all()
    assert (after.sample_count == many + 1).all()


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="needs Linux")
@pytest.mark.parametrize("beauty", [False, True])
def test_long_renders_take_no_more_memory_than_short_ones(
    shared_scene: Scene, tmp_path: Path, beauty: bool
) -> None:
    used: list[int] = []

    def checkpoint(film: Film) -> None:
        film.write(tmp_path / "a.exr")
        used.append(int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE"))
        if len(used) == 120:
            raise KeyboardInterrupt

    kind: dict[str, Any] = {"beauty_render": True, "error_eps": 1e-9} if beauty else {"spp": 10**9}
    film = shared_scene.render(
        size=(32, 32),
        checkpoint=checkpoint,
        checkpoint_seconds=0.01,
        threads=2,
        **kind,
    )
    assert film.interrupted
    # Every other checkpoint's 200 kB would be 8 MB.
    assert max(used[100:]) - max(used[20:40]) < 3e6


def test_counts_and_indices_beyond_32_bits(shared_scene: Scene, tmp_path: Path) -> None:
    edge = 2**32
    across = shared_scene.render(samples=(edge - 2, edge + 3))
    parts = [shared_scene.render(samples=samples) for samples in ((edge, edge + 3), (edge - 2, edge))]
    np.testing.assert_array_max_ulp(etendue.merge(parts).image, across.image, maxulp=1)
    assert not np.array_equal(parts[0].image, shared_scene.render(samples=(0, 3)).image)
    path = tmp_path / "a.exr"
    across.write(path)
    assert etendue.read_film(path).ranges == [(edge - 2, edge + 3)]

    film = shared_scene.render(samples=(0, 1))
    many = 3 * edge
    film = dataclasses.replace(
        film, ranges=[(0, many)], goal=(0, many), sample_count=film.sample_count * many
    )
    film.sum *= many
    film.image = mean_of(film.sum, film.sample_count, film.invalid_per_pixel)
    film = shared_scene.render(resume=film, spp=many + 2)
    film.write(path)
    film = etendue.read_film(path)
    assert (film.sample_count == many + 2).all()
    assert (film.ranges, film.spp) == ([(0, many + 2)], many + 2)


@pytest.mark.parametrize(
    ("samples", "message"),
    [
        ((4, 4), "samples: the first sample must be 0 or more and below the end"),
        ((-1, 4), "samples: the first sample must be 0 or more and below the end"),
        ((0, 2**63), "and the end at most 2^63 - 1"),
        ((0, 2**31), "samples: 2147483648 samples are too many for one film"),
    ],
)
def test_ranges_that_cannot_be(shared_scene: Scene, samples: tuple[int, int], message: str) -> None:
    assert message in refusal(lambda: shared_scene.render(samples=samples))
    assert "exclude each other" in refusal(lambda: shared_scene.render(samples=samples, spp=3))


ranges = st.lists(st.tuples(st.integers(0, 30), st.integers(0, 30)).map(sorted).map(tuple), max_size=5)


@given(ranges, ranges)
def test_ranges_are_sets_of_indices(some: list[Any], others: list[Any]) -> None:
    def indices(of: list[Any]) -> set[int]:
        return {index for first, end in of for index in range(first, end)}

    joined = sample_ranges.union(some)
    assert indices(joined) == indices(some)
    assert sample_ranges.count(joined) == len(indices(some))
    assert all(a[1] < b[0] for a, b in zip(joined, joined[1:], strict=False))
    assert indices(sample_ranges.gaps((5, 20), some)) == set(range(5, 20)) - indices(some)
    shared = sample_ranges.overlap(some, others)
    both = indices(some) & indices(others)
    assert (shared is None) == (not both)
    assert shared is None or set(range(*shared)) <= both

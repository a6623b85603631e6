"""The report in a real browser: it opens offline, flips, zooms, reads pixels and switches metrics."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import etendue
from etendue.comparison import Comparison, metrics

from .conftest import write_lit

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("browser")]

BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
HOSTILE = "<img src=x onerror=document.title='hacked'>"
WIDTH, HEIGHT = 48, 36


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("report")


@pytest.fixture(scope="module")
def comparison(folder: Path) -> Comparison:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ETENDUE_CACHE", str(folder / "cache"))
        estimators = {"naive": {"algorithm": "NaivePathtracer"}, "mis": {}, HOSTILE: {"mis": "none"}}
        return etendue.compare(
            write_lit(folder),
            estimators,
            spp=4,
            repeats=2,
            size=(WIDTH, HEIGHT),
            reference_spp=64,
            output=folder / "out",
        )


@pytest.fixture(scope="module")
def page(folder: Path, comparison: Comparison) -> Iterator[Any]:
    playwright = pytest.importorskip(
        "playwright.sync_api", reason="playwright is missing; ./test --slow installs it"
    )
    program = next(filter(None, map(shutil.which, BROWSERS)), None)
    if program is None:
        pytest.skip(f"no browser here (one of {', '.join(BROWSERS)})")
    with playwright.sync_playwright() as driver:
        # As root, Chromium has no sandbox; without a graphics card, it draws WebGL in software.
        options = ["--no-sandbox", "--enable-unsafe-swiftshader"]
        browser = driver.chromium.launch(executable_path=program, args=options)
        context = browser.new_context(viewport={"width": 1400, "height": 1000}, offline=True)
        opened = context.new_page()
        opened.problems = []
        opened.on("pageerror", lambda error: opened.problems.append(str(error)))
        opened.on("console", lambda m: opened.problems.append(m.text) if m.type == "error" else None)
        opened.on(
            "request",
            lambda request: opened.problems.append(request.url) if is_foreign(request.url) else None,
        )
        opened.goto((folder / "out" / "index.html").as_uri())
        opened.wait_for_selector("body[data-ready]", timeout=120_000)
        yield opened
        browser.close()


def is_foreign(url: str) -> bool:
    return not url.startswith(("file:", "data:", "blob:"))


def canvas(page: Any, book: str) -> Any:
    """The image that a flip book shows."""
    return page.locator(f"#{book} canvas:visible").first


def colours(page: Any, book: str) -> Any:
    """Its pixels, uint8 (height, width, 3), once they are drawn."""
    page.wait_for_timeout(600)
    shown = canvas(page, book).evaluate(
        "c => [c.width, c.height, Array.from(c.getContext('2d').getImageData(0, 0, c.width, c.height).data)]"
    )
    width, height, values = shown
    return np.array(values, np.uint8).reshape(height, width, 4)[..., :3]


def flip(page: Any, book: str, name: str) -> None:
    page.locator(f"#{book} button", has_text=name).first.click()


def test_nothing_is_wrong_and_nothing_is_loaded(page: Any) -> None:
    assert page.problems == []
    assert page.title().startswith("lit: ")


def test_names_are_texts(page: Any) -> None:
    assert page.locator("th", has_text=HOSTILE).count() >= 2
    assert page.locator("#book-beauty button", has_text=HOSTILE).count() == 1
    assert page.locator("img[src=x]").count() == 0


def test_it_shows_the_images_and_flips(page: Any, comparison: Comparison) -> None:
    for tally, name in zip(comparison.tallies, ("naive", "mis"), strict=False):
        flip(page, "book-beauty", name)
        expected = etendue.tonemap(tally.film.image).astype(int)
        assert np.abs(colours(page, "book-beauty").astype(int) - expected).max() <= 2
    flip(page, "book-beauty", "reference")
    expected = etendue.tonemap(comparison.reference.image).astype(int)
    assert np.abs(colours(page, "book-beauty").astype(int) - expected).max() <= 2


def test_both_books_flip_together(page: Any) -> None:
    page.get_by_role("button", name="Error", exact=True).click()
    flip(page, "book-beauty", "naive")
    first = colours(page, "book-error")
    page.locator("#book-beauty").press("2")
    assert not np.array_equal(colours(page, "book-error"), first)


def test_metrics_are_switched(page: Any) -> None:
    flip(page, "book-beauty", "naive")
    seen = {}
    for label, metric in (
        ("Error", "error"), ("Signed error", "signed"), ("Variance", "variance"),
        ("Samples", "samples"), ("FLIP", "flip"),
    ):  # fmt: skip
        button = page.get_by_role("button", name=label, exact=True)
        button.click()
        assert button.get_attribute("aria-pressed") == "true"
        assert page.locator(".metrics [aria-pressed=true]").count() == 1
        visible = [
            each
            for each in ("error", "signed", "variance", "samples", "flip")
            if page.locator(f"#book-{each}").evaluate("e => getComputedStyle(e).visibility") == "visible"
        ]
        assert visible == [metric]
        seen[metric] = colours(page, f"book-{metric}"), page.locator("#legend").inner_text()
    assert len({legend for _, legend in seen.values()}) == 5
    # Every pixel has the same number of samples; too bright is red, too dark blue.
    assert np.ptp(seen["samples"][0].reshape(-1, 3), axis=0).max() == 0
    red, blue = seen["signed"][0][..., 0].astype(int), seen["signed"][0][..., 2].astype(int)
    assert (red > blue + 50).any()
    assert (blue > red + 50).any()


def test_the_signed_error_has_the_sign_of_the_error(page: Any, comparison: Comparison) -> None:
    flip(page, "book-beauty", "naive")
    page.get_by_role("button", name="Signed error", exact=True).click()
    shown = colours(page, "book-signed").astype(int)
    difference = (comparison.tallies[0].film.image - comparison.reference.image).mean(axis=2)
    weight = np.sqrt(comparison.reference.image**2 + metrics.EPSILON).mean(axis=2)
    clear = np.abs(difference) > 0.3 * weight
    assert clear.sum() > 100
    assert (np.sign(shown[..., 0] - shown[..., 2]) == np.sign(difference))[clear].mean() > 0.98


def test_it_zooms_both_images(page: Any) -> None:
    page.get_by_role("button", name="Error", exact=True).click()
    before = [canvas(page, book).bounding_box()["width"] for book in ("book-beauty", "book-error")]
    canvas(page, "book-beauty").hover(position={"x": before[0] / 2, "y": before[0] / 3})
    page.keyboard.down("Control")
    page.mouse.wheel(0, -100)
    page.keyboard.up("Control")
    after = before
    for _ in range(100):
        page.wait_for_timeout(300)
        last = after
        after = [canvas(page, book).bounding_box()["width"] for book in ("book-beauty", "book-error")]
        if min(after) > 1.2 * before[0] and after == last:
            break
    assert after[0] > 1.2 * before[0]
    assert after[0] / before[0] == pytest.approx(after[1] / before[1], rel=0.01)
    page.keyboard.down("Control")
    page.mouse.wheel(0, 100)
    page.keyboard.up("Control")


def test_it_reads_pixels(page: Any, comparison: Comparison) -> None:
    flip(page, "book-beauty", "mis")
    box = canvas(page, "book-beauty").bounding_box()
    x, y = 20, 30
    canvas(page, "book-beauty").hover(
        position={"x": (x + 0.5) * box["width"] / WIDTH, "y": (y + 0.5) * box["height"] / HEIGHT}
    )
    page.wait_for_function("document.getElementById('pixel').textContent.includes('pixel ')")
    text = page.locator("#pixel").inner_text()
    assert f"pixel {x}, {y}" in text
    shown = re.search(r"mis: ([\d.e-]+) ([\d.e-]+) ([\d.e-]+) \(error ([\d.e+-]+)\)", text)
    assert shown is not None, text
    image = comparison.tallies[1].film.image
    error = metrics.relative_squared_error(image, comparison.reference.image)[y, x]
    assert [float(shown[i]) for i in (1, 2, 3)] == pytest.approx(list(image[y, x]), rel=0.005)
    assert float(shown[4]) == pytest.approx(error, rel=0.1, abs=1e-4)
    # The viewer's own magnifier, with the right button.
    page.mouse.down(button="right")
    page.mouse.move(
        box["x"] + (x + 0.6) * box["width"] / WIDTH, box["y"] + (y + 0.5) * box["height"] / HEIGHT
    )
    page.locator("#book-beauty").get_by_text(f"{x}, {y}").first.wait_for()
    page.mouse.up(button="right")


def test_exposure_changes_the_image_and_not_the_metric(page: Any) -> None:
    page.get_by_role("button", name="Error", exact=True).click()
    flip(page, "book-beauty", "mis")
    image, error = colours(page, "book-beauty"), colours(page, "book-error")
    page.locator("#book-beauty").press("e")
    brighter = colours(page, "book-beauty")
    assert brighter.mean() > image.mean() + 2
    assert np.array_equal(colours(page, "book-error"), error)
    page.locator("#book-beauty").press("E")


@pytest.mark.parametrize(("width", "scheme"), [(380, "light"), (760, "dark"), (1400, "light")])
def test_it_fits_every_screen(page: Any, folder: Path, width: int, scheme: str) -> None:
    page.set_viewport_size({"width": width, "height": 900})
    page.emulate_media(color_scheme=scheme)
    page.wait_for_timeout(300)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    ink, ground = page.evaluate(
        "[getComputedStyle(document.body).color, getComputedStyle(document.body).backgroundColor]"
    )
    light, dark = (sum(map(int, re.findall(r"\d+", colour)[:3])) / 765 for colour in (ground, ink))
    assert (light > 0.9 and dark < 0.2) if scheme == "light" else (light < 0.15 and dark > 0.8)
    page.screenshot(path=folder / f"{width}-{scheme}.png", full_page=True)
    assert page.problems == []


def test_jupyter_shows_it(page: Any, comparison: Comparison) -> None:
    notebook = page.context.new_page()
    notebook.set_content(f"<p>a cell</p>{comparison._repr_html_()}")
    frame = notebook.frame_locator("iframe")
    frame.locator("body[data-ready]").wait_for(timeout=120_000)
    assert frame.locator("h1").inner_text() == "lit"
    notebook.close()

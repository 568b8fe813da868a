"""The live page in Chromium, with real input: its numbers are those of the command."""

from __future__ import annotations

import json
import os
import random
import shutil
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

sync_api = pytest.importorskip("playwright.sync_api")

ROOT = Path(__file__).parents[2]
PROGRAM = os.environ.get("IMPACTCHECK_PROGRAM", str(ROOT / "target/release/impactcheck"))
PLATE = "scaled-plate-r10"
SCENES = [PLATE, "scenes/validation/friction.toml", "scenes/examples/wet-valve-plate.toml"]
FLIGHT = "scenes/examples/rocker-flight.toml"
AXE = next(
    ROOT.glob("target/python-tools/lib/*/site-packages/axe_playwright_python/axe.min.js"), None
)
# Relative difference of the same model of the same scene. Model C solves an eigenvalue problem
# of a mesh, whose rounding depends on the instructions of the processor.
EQUAL = {"A": 1e-9, "B": 1e-9, "C": 1e-7}
# a loaded machine is slow
PATIENCE = 120_000

Open = Callable[..., Any]


def program(*arguments: str) -> str:
    done = subprocess.run(
        [PROGRAM, *arguments], capture_output=True, text=True, cwd=ROOT, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def live(tmp_path_factory: pytest.TempPathFactory) -> Path:
    page = tmp_path_factory.mktemp("live") / "live.html"
    done = subprocess.run(
        [PROGRAM, "live", *SCENES, FLIGHT, "-o", str(page)],
        capture_output=True,
        text=True,
        cwd=ROOT,
        check=False,
    )
    if "no models for live pages" in done.stderr:
        pytest.skip("the program has no models for pages: `make live-page`")
    assert done.returncode == 0, done.stderr
    return page


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    names = ["chromium", "chromium-browser", "google-chrome"]
    path = os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, names)), None)
    if path is None:
        pytest.skip("no Chromium")
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture
def opened(live: Path, chromium: Any) -> Iterator[Open]:
    """Opens the page; whatever it logs is a fault."""
    faults: list[str] = []
    pages = []

    def opening(fragment: str = "", **view: Any) -> Any:
        context = chromium.new_context(viewport={"width": 1280, "height": 950}, **view)
        page = context.new_page()
        page.set_default_timeout(PATIENCE)
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.on("console", lambda line: faults.append(line.text))
        page.goto(f"file://{live}{fragment}")
        pages.append(context)
        rest(page)
        return page

    yield opening
    for context in pages:
        context.close()
    assert not faults


def rest(page: Any) -> None:
    """Waits until all models have answered for the present numbers, with their estimates."""
    page.wait_for_function(
        """() => { const live = window.impactcheck; if (!live?.state.models.length) return false;
        const now = JSON.stringify(live.changed());
        return live.state.models.every((model) => {
            const one = live.state.estimated[model];
            return one && (one.error || one.of === now); }); }"""
    )
    # what was answered stands in the table one frame later
    page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def shown(page: Any) -> dict[str, dict[str, float | None]]:
    """Numbers in the table, SI: by model and quantity."""
    cells = page.eval_on_selector_all(
        "#results td[data-model]",
        "all => all.map((cell) => [cell.dataset.model, cell.dataset.quantity, cell.dataset.si])",
    )
    found: dict[str, dict[str, float | None]] = {}
    for model, quantity, value in cells:
        found.setdefault(model, {})[quantity] = float(value) if value else None
    return found


def require_those_of_the_command(page: Any, folder: Path) -> int:
    """Holds the table against ``reduced`` of the scene that the page copies; number of values."""
    text = page.evaluate(
        """() => new Promise((done) => { const to = navigator.clipboard;
        Object.defineProperty(navigator, "clipboard", { configurable: true,
            value: { writeText: async (text) => done(text) } });
        document.getElementById("toml").click(); })"""
    )
    scene = folder / "scene.toml"
    scene.write_text(text)
    count = 0
    for model, values in shown(page).items():
        expected = json.loads(program("reduced", str(scene), "--model", model, "--json"))
        for name, value in values.items():
            assert value == pytest.approx(expected[name], rel=EQUAL[model]), (model, name, text)
            count += value is not None
    return count


def test_typed_and_dragged_numbers_give_those_of_the_command(opened: Open, tmp_path: Path) -> None:
    page = opened()
    first = shown(page)
    assert require_those_of_the_command(page, tmp_path) == 30
    box = page.get_by_label("thickness", exact=True)
    box.fill("1500 um")
    box.press("Enter")
    page.wait_for_function("impactcheck.changed()['plate.thickness'] === 0.0015")
    rest(page)
    assert shown(page) != first
    require_those_of_the_command(page, tmp_path)
    # a bare number is in the unit that stands there
    box.fill("1.7")
    box.press("Enter")
    page.wait_for_function("impactcheck.changed()['plate.thickness'] === 0.0017")
    slider = page.get_by_label("outer.speed, slider").bounding_box()
    y = slider["y"] + slider["height"] / 2
    page.mouse.move(slider["x"] + slider["width"] / 2, y)
    page.mouse.down()
    page.mouse.move(slider["x"] + 0.8 * slider["width"], y, steps=12)
    page.mouse.up()
    rest(page)
    speed = page.evaluate("impactcheck.changed()['outer.speed']")
    assert speed == pytest.approx(0.55 * 4**0.6, rel=0.2)
    require_those_of_the_command(page, tmp_path)


def test_numbers_out_of_bounds_are_refused_and_nothing_moves(opened: Open) -> None:
    page = opened()
    before = shown(page)
    box = page.get_by_label("thickness", exact=True)
    for text, part in [
        ("-2", "must be greater than 0 m"),
        ("3 kg", "is not the unit"),
        ("x", "not a number"),
    ]:
        box.fill(text)
        box.press("Enter")
        page.wait_for_function(
            f"document.querySelector('.why:not([hidden])')?.textContent.includes({part!r})"
        )
    assert shown(page) == before
    assert page.evaluate("Object.keys(impactcheck.changed()).length") == 0


def test_keyboard_locks_reset_and_the_address(opened: Open) -> None:
    page = opened()
    original = shown(page)
    for name in ["plate.radius", "plate.thickness"]:
        page.get_by_label(f"lock {name}").press("Space")
    page.get_by_label("plate.radius, slider").press("ArrowRight")
    rest(page)
    changed = page.evaluate("impactcheck.changed()")
    assert set(changed) == {"plate.radius", "plate.thickness"}
    assert changed["plate.radius"] / 0.033 == pytest.approx(changed["plate.thickness"] / 0.002)
    # the address takes another page there
    page.wait_for_function("location.hash.includes('plate.radius')")
    there = opened(page.evaluate("location.hash"))
    assert shown(there) == shown(page)
    page.get_by_role("button", name="Reset").click()
    page.wait_for_function("Object.keys(impactcheck.changed()).length === 0")
    rest(page)
    assert shown(page) == original


def test_prediction_map_and_downloads(opened: Open, tmp_path: Path) -> None:
    page = opened()
    text = page.inner_text("#prediction")
    assert "solved scenes of the group" in text
    low, high = page.evaluate(
        "(({low, high}) => [low, high])(impactcheck.state.estimated.C.prediction.efficiency)"
    )
    assert low < shown(page)["C"]["efficiency"] < high
    page.wait_for_function("document.getElementById('map-text').textContent.includes('576 of 576')")
    # the cell in the middle is near the scene's own numbers
    middle = page.evaluate("impactcheck.state.map.values[12][12]")
    assert middle == pytest.approx(shown(page)["B"]["efficiency"], rel=0.1)
    with page.expect_download() as download:
        page.get_by_label("Download the curves of model B").click()
    download.value.save_as(tmp_path / "curves.csv")
    expected = tmp_path / "expected.csv"
    program("reduced", PLATE, "--model", "B", "--history", str(expected))
    ours, theirs = (
        (tmp_path / name).read_text().splitlines() for name in ["curves.csv", "expected.csv"]
    )
    assert ours[0] == theirs[0]
    assert len(ours) == len(theirs)
    for one, other in zip(ours[1:], theirs[1:], strict=True):
        pairs = zip(one.split(","), other.split(","), strict=True)
        assert all(float(a) == pytest.approx(float(b), rel=1e-6, abs=1e-9) for a, b in pairs)


def test_flights_are_drawn_and_are_those_of_the_command(opened: Open) -> None:
    page = opened("#scene=rocker-flight")
    drawn = page.eval_on_selector_all(
        "#flight polyline", "all => all.map((one) => one.dataset.model)"
    )
    models = page.evaluate("impactcheck.state.models")
    assert drawn == models
    for model in models:
        found, last, seats = page.evaluate(
            f"""(({{summary, flight}}) => [summary.flight, flight.path.at(-1), flight.seats])(
            impactcheck.state.estimated[{model!r}])"""
        )
        flight = json.loads(program("reduced", FLIGHT, "--model", model, "--json"))["flight"]
        assert found["seat"] == flight["seat"]
        assert found["time"] == pytest.approx(flight["time"], rel=1e-6)
        # the path ends on the side of the seat that is reached
        nearest = min(range(2), key=lambda k: abs(last[0] - seats[k][0]))
        assert flight["seat"] in ("none", ["same", "other"][nearest])


@pytest.mark.parametrize(
    "view",
    [
        {},
        {"color_scheme": "dark"},
        {"is_mobile": True, "device_scale_factor": 2, "has_touch": True},
    ],
    ids=["light", "dark", "phone"],
)
def test_the_page_is_accessible(opened: Open, view: dict[str, Any]) -> None:
    page = opened(**view)
    if view.get("is_mobile"):
        page.set_viewport_size({"width": 400, "height": 850})
        page.wait_for_timeout(300)
        width = page.evaluate("document.documentElement.scrollWidth")
        assert width <= 400, "nothing is wider than the phone"
    if AXE is None:
        pytest.skip("no axe-core: `make setup`")
    page.add_script_tag(path=str(AXE))
    found = page.evaluate("axe.run().then((result) => result.violations)")
    serious = [one for one in found if one["impact"] in ("serious", "critical")]
    assert not serious, json.dumps([(one["id"], one["nodes"][0]["html"]) for one in serious])


def random_settings(
    count: int, fields: list[dict[str, Any]], seed: int
) -> Iterator[dict[str, float]]:
    draw = random.Random(seed)
    for _ in range(count):
        some = draw.sample(fields, draw.randint(1, len(fields)))
        yield {
            field["path"]: min(
                max(field["value"] * 2 ** draw.uniform(-1, 1), field["low"]), field["high"]
            )
            for field in some
            if field["value"] > 0 and not field["count"]
        }


@pytest.mark.parametrize(
    "count", [3, pytest.param(200, marks=pytest.mark.evidence)], ids=["some", "many"]
)
def test_random_settings_give_the_numbers_of_the_command(
    opened: Open, tmp_path: Path, count: int
) -> None:
    refused = compared = 0
    for number, scene in enumerate(SCENES):
        name = Path(scene).stem
        page = opened(f"#scene={name}")
        fields = page.evaluate(
            """impactcheck.state.fields.map(({path, value, low, high, count}) =>
            ({path, value, low, high, count}))"""
        )
        share = count // len(SCENES)
        for settings in random_settings(share, fields, seed=100 + number):
            parts = "&".join(f"{path}={value!r}" for path, value in settings.items())
            page.evaluate(f"location.hash = {f'#scene={name}&{parts}'!r}")
            for path, value in settings.items():
                page.wait_for_function(f"impactcheck.state.numbers[{path!r}] === {value!r}")
            rest(page)
            failed = page.evaluate(
                "Object.values(impactcheck.state.estimated).some((one) => one.error)"
            )
            refused += failed
            if not failed:
                compared += require_those_of_the_command(page, tmp_path)
    assert compared > 10 * count
    assert refused < count / 5

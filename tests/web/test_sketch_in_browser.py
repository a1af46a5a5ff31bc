"""Drawing an answer in Chromium: by mouse, by keys; the text underneath is what is sent."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

pytestmark = pytest.mark.browser

SKETCH = "recognise-and-sketch-distortion"


@pytest.fixture
def field(opened, served):
    """The part to draw in, and what its text says is wanted."""
    page = opened()
    token = page.locator("[name=token]").first.input_value()
    sent = {"token": token, "template": SKETCH}
    page.goto(page.request.post(served.address + "/practice", form=sent).url)
    part = page.locator("section.part").nth(1)
    inward = "barrel" in part.locator("strong").first.inner_text()
    return page, part, -0.15 if inward else 0.15


def wanted(k: float) -> list[list[tuple[float, float]]]:
    """Edges and middle lines, points moved by ``1 + k r²``."""
    ways = [[(t / 5, s) for t in range(-5, 6)] for s in (1, -1)]
    lines = [
        *ways,
        *([(y, x) for x, y in way] for way in ways),
        [(-1, 0), (1, 0)],
        [(0, -1), (0, 1)],
    ]
    return [
        [(x * (1 + k * (x * x + y * y)), y * (1 + k * (x * x + y * y))) for x, y in line]
        for line in lines
    ]


def test_a_grid_is_drawn_by_mouse(field):
    page, part, k = field
    svg = part.locator("svg.strokes")
    svg.scroll_into_view_if_needed()
    box = svg.bounding_box()
    wide, tall = map(float, svg.get_attribute("viewBox").split()[2:])
    x0, y0, w, h = map(float, part.locator(".board").get_attribute("data-frame").split())
    scale = box["width"] / wide

    def place(x: float, y: float) -> tuple[float, float]:
        at = x0 + (x + 1.4) / 2.8 * w, y0 + (1.4 - y) / 2.8 * h
        return box["x"] + at[0] * scale, box["y"] + at[1] * scale

    assert box["height"] / tall == pytest.approx(scale, rel=0.02)
    for count, line in enumerate(wanted(k), 1):
        page.mouse.move(*place(*line[0]))
        page.mouse.down()
        for point in line[1:]:
            page.mouse.move(*place(*point), steps=3)
        page.mouse.up()
        expect(svg.locator("polyline")).to_have_count(count)
    part.get_by_role("button", name="Undo").click()
    expect(svg.locator("polyline")).to_have_count(5)
    part.get_by_role("button", name="Ruler").click()
    page.mouse.move(*place(*line[0]))
    page.mouse.down()
    page.mouse.move(*place(0.4, 0.1), steps=3)
    page.mouse.move(*place(*line[-1]), steps=3)
    page.mouse.up()
    expect(svg.locator("polyline")).to_have_count(6)
    part.get_by_role("button", name="Check").click()
    expect(part.locator(".verdict.correct")).to_be_visible()
    solved = part.locator(".board").last
    expect(solved.locator("polyline")).to_have_count(6)
    expect(solved.locator("[data-part=wanted]")).to_have_count(1)


def test_lines_are_drawn_by_keys_and_what_is_typed_is_drawn(field):
    page, part, _ = field
    svg, area = part.locator("svg.strokes"), part.locator("textarea")
    svg.focus()
    for key in (
        "ArrowLeft",
        "ArrowUp",
        "Enter",
        "Shift+ArrowRight",
        "ArrowRight",
        "Enter",
        "Escape",
    ):
        page.keyboard.press(key)
    expect(area).to_have_value("-0.1,0.1 0.5,0.1")
    expect(page.locator("#said")).to_have_text("Line ended.")
    for key in ("Enter", "ArrowDown", "Enter", "Backspace", "ArrowDown", "Enter", "Escape"):
        page.keyboard.press(key)
    expect(area).to_have_value("-0.1,0.1 0.5,0.1; 0.5,0.1 0.5,-0.1")
    page.keyboard.press("Backspace")
    expect(area).to_have_value("-0.1,0.1 0.5,0.1")
    area.fill("\u22121,\u22121 1,1; 0,1")
    expect(svg.locator("polyline")).to_have_count(2)
    part.get_by_role("button", name="Clear").click()
    expect(area).to_have_value("")

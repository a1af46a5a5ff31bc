"""Drawing an answer in Chromium: by mouse, by keys; the text underneath is what is sent."""

from __future__ import annotations

import pytest
from fingers import Screen
from playwright.sync_api import expect

pytestmark = pytest.mark.browser

SKETCH = "recognise-and-sketch-distortion"


@pytest.fixture
def field(opened, served):
    """The part to draw in, and what its text says is wanted."""
    page = opened(has_touch=True)
    token = page.locator("[name=token]").first.input_value()
    sent = {"token": token, "template": SKETCH}
    page.goto(page.request.post(served.address + "/practice", form=sent).url)
    page.locator(".parts a").nth(1).click()
    part = page.locator("section.part")
    expect(part.locator(".board[data-ready]")).to_be_visible()
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


def placed(part):
    """Says where on the screen a point of the field is."""
    svg = part.locator("svg.strokes").first
    svg.scroll_into_view_if_needed()
    box = svg.bounding_box()
    wide, tall = map(float, svg.get_attribute("viewBox").split()[2:])
    board = part.locator(".board").first
    x0, y0, w, h = map(float, board.get_attribute("data-frame").split())
    left, right, low, high = map(float, board.get_attribute("data-view").split())
    scale = box["width"] / wide
    assert box["height"] / tall == pytest.approx(scale, rel=0.02)

    def place(x: float, y: float) -> tuple[float, float]:
        at = x0 + (x - left) / (right - left) * w, y0 + (high - y) / (high - low) * h
        return box["x"] + at[0] * scale, box["y"] + at[1] * scale

    return place


def drawer(page, part):
    """What draws a line by mouse, from point to point of the field."""
    place = placed(part)

    def draw(line) -> None:
        page.mouse.move(*place(*line[0]))
        page.mouse.down()
        for point in line[1:]:
            page.mouse.move(*place(*point), steps=3)
        page.mouse.up()

    return draw


def test_a_grid_is_drawn_by_mouse(field):
    page, part, k = field
    svg, draw = part.locator("svg.strokes"), drawer(page, part)
    for count, line in enumerate(wanted(k), 1):
        draw(line)
        expect(svg.locator("polyline")).to_have_count(count)
    part.get_by_role("button", name="Undo").click()
    expect(svg.locator("polyline")).to_have_count(5)
    part.get_by_role("button", name="Ruler").click()
    draw([line[0], (0.4, 0.1), line[-1]])
    expect(svg.locator("polyline")).to_have_count(6)
    part.get_by_role("button", name="Check").click()
    expect(part.locator(".verdict.correct")).to_be_visible()
    solved = part.locator(".board").last
    expect(solved.locator("polyline")).to_have_count(6)
    expect(solved.locator("[data-part=wanted]")).to_have_count(1)


def test_a_line_by_a_finger_is_the_same_with_another_finger_on_the_field(field):
    page, part, k = field
    place, area, line = placed(part), part.locator("textarea"), wanted(k)[0]
    Screen(page).finger([place(*point) for point in line], beside=place(1.2, -1.2))
    expect(part.locator("svg.strokes polyline")).to_have_count(1)
    drawn = [tuple(map(float, point.split(","))) for point in area.input_value().split()]
    assert drawn[0] == pytest.approx(line[0], abs=0.03)
    assert drawn[-1] == pytest.approx(line[-1], abs=0.03)
    assert min(y for _, y in drawn) > 0.5


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
    part.get_by_text("Type points instead").click()
    area.fill("\u22121,\u22121 1,1; 0,1")
    expect(svg.locator("polyline")).to_have_count(2)
    part.get_by_role("button", name="Clear").click()
    expect(area).to_have_value("")


def test_in_an_exam_what_was_drawn_stays_and_stands_over_the_solution(opened, served):
    page = opened()
    page.goto(served.address + "/exam")
    page.get_by_label("Paper", exact=True).select_option("trial")
    page.get_by_role("button", name="Begin the exam").click()
    part = page.locator("#exam .part").filter(has=page.locator("svg.strokes"))
    lines, svg = wanted(0.15), part.locator("svg.strokes")
    part.evaluate("part => { location.hash = part.id; }")
    draw = drawer(page, part)
    for line in lines[:3]:
        draw(line)
    expect(page.locator("#kept")).to_have_text("All answers are saved.")
    page.reload()
    expect(svg.locator("polyline")).to_have_count(3)
    svg.focus()  # the cross begins in the middle: an upright line by keys
    for key in (*["ArrowDown"] * 9, "Enter", *["ArrowUp"] * 6, "Enter", "Escape"):
        page.keyboard.press(key)
    expect(svg.locator("polyline")).to_have_count(4)
    expect(page.locator("#kept")).to_have_text("All answers are saved.")
    for _ in range(2):
        page.get_by_role("button", name="Hand in").click()
    solved = page.locator(".board").filter(has=page.locator("[data-part=wanted]"))
    expect(solved.locator("polyline")).to_have_count(4)

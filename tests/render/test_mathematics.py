"""Formulas as they stand on a page: measured in Chromium, and as pictures in Firefox, too."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import cv2
import numpy as np
import pytest

from quizgen import typeset
from quizgen.maths.notation import parse_formula
from quizgen.question.html import inlines_to_html
from quizgen.render import fonts
from quizgen.render.html import _build_paper_css
from quizgen.typeset.prose import PlainText, TypesetMaths

pytestmark = pytest.mark.browser

SIZE = 40
"""Pixels of one em: large enough that a hundredth shows."""

LOOK = (Path(fonts.__file__).parent / "look" / "look.css").read_text("utf-8")
FAMILY = re.search(r"--font-math: [^;]+;", LOOK)[0]

TALLEST = {  # ems from the highest to the lowest ink: no family stands out of its line
    "x": 0.6,
    "x'": 1.0,
    "p'_y": 1.4,
    "p'_y^2": 1.7,
    "x'^2": 1.2,
    "k_1": 1.0,
    "I_max": 1.1,
    "G_hat": 1.15,
    "x_bar": 0.9,
    "sigma_tilde": 0.95,
    "f = 6": 1.1,
    "p'_x = f*X/Z": 1.5,
    "e^(-x^2/2)": 1.2,
    "log2(q)": 1.3,
    "sqrt(x^2 + y^2)": 1.5,
}


def formula(text):
    return typeset.to_mathml(typeset.lay_out(parse_formula(text), inline=True))


def sheet(body):
    font = f'@font-face {{ font-family: "QuizMaths"; src: url("{fonts.maths_uri()}"); }}'
    plain = f":root {{ {FAMILY} }} html {{ font-size: {SIZE / 1.06}px }} body {{ margin: 0; padding: 0; }}"
    return f'<!DOCTYPE html><meta charset="utf-8"><style>{font}{_build_paper_css()}{plain}</style>{body}'


def rows(bodies):
    """Each formula in a row of 200 px of its own, in black on white."""
    style = f"position:absolute;left:{SIZE}px;background:#fff;color:#000"
    placed = [f'<div style="{style};top:{200 * i}px">{b}</div>' for i, b in enumerate(bodies)]
    return sheet("".join(placed))


def in_chromium(browser, page, folder, height):
    file = folder / "page.html"
    file.write_text(page, "utf-8")
    tab = browser.new_page(viewport={"width": 800, "height": height})
    tab.goto(file.as_uri())
    tab.evaluate("document.fonts.ready")
    picture = tab.screenshot()
    tab.close()
    return cv2.imdecode(np.frombuffer(picture, np.uint8), cv2.IMREAD_GRAYSCALE)


def in_firefox(firefox, page, folder, height):
    file, picture, profile = folder / "page.html", folder / "page.png", folder / "profile"
    file.write_text(page, "utf-8")
    profile.mkdir()
    command = [firefox, "--headless", "--profile", profile, f"--window-size=800,{height}"]
    subprocess.run([*command, "--screenshot", picture, file.as_uri()], check=True, timeout=120,
                   capture_output=True)  # fmt: skip
    return cv2.imread(str(picture), cv2.IMREAD_GRAYSCALE)


@pytest.fixture(scope="module", params=["chromium", "firefox"])
def camera(request, tmp_path_factory):
    """Photograph a page in one of the browsers."""

    def shoot(page, height):
        folder = tmp_path_factory.mktemp("mathematics")
        if request.param == "chromium":
            return in_chromium(request.getfixturevalue("browser"), page, folder, height)
        return in_firefox(request.getfixturevalue("firefox"), page, folder, height)

    return shoot


@pytest.fixture(scope="module")
def inked(camera):
    """Where the ink of each formula is, its row cut out."""
    picture = camera(rows(map(formula, TALLEST)), 200 * len(TALLEST))
    cut = {text: picture[200 * i : 200 * (i + 1)] < 128 for i, text in enumerate(TALLEST)}
    assert all(ink.any() for ink in cut.values())
    return cut


def extent(ink):
    """First and last inked row, in ems, below the top of the box."""
    lines = np.flatnonzero(ink.any(axis=1))
    return lines[0] / SIZE, (lines[-1] + 1) / SIZE


def pieces(ink):
    """Connected marks from left to right: (left, top, width, height) in ems."""
    found = cv2.connectedComponentsWithStats(ink.astype(np.uint8))[2][1:]
    return sorted(tuple(float(side) / SIZE for side in row[:4]) for row in found if row[4] > 3)


@pytest.mark.parametrize("text", TALLEST)
def test_no_formula_stands_out_of_its_line(inked, text):
    top, bottom = extent(inked[text])
    assert bottom - top <= TALLEST[text]


def test_primes_are_close_to_their_letter(inked):
    """The prime overlaps the letter's height and stands at most a sixth of an em to its right."""
    letter, prime = pieces(inked["x'"])
    assert prime[1] + prime[3] > letter[1], "floats above"
    assert letter[1] - prime[1] < 0.5
    assert -0.05 < prime[0] - (letter[0] + letter[2]) < 0.17


def test_a_subscript_stands_below_the_prime(inked):
    letter, *others = pieces(inked["p'_y"])
    prime, sub = sorted(others, key=lambda piece: piece[1])
    assert prime[0] < sub[0] + sub[2]
    assert abs(prime[0] - sub[0]) < 0.2, "one above the other"
    assert sub[1] + sub[3] - (letter[1] + letter[3]) < 0.4, "hangs far below"
    assert prime[1] + prime[3] < sub[1]


@pytest.mark.parametrize("text", ["G_hat", "x_bar", "sigma_tilde"])
def test_accents_neither_hover_nor_touch(inked, text):
    mark, letter = sorted(pieces(inked[text]), key=lambda piece: piece[1])
    gap = letter[1] - (mark[1] + mark[3])
    assert 0 < gap < 0.14
    middle = letter[0] + letter[2] / 2 - (mark[0] + mark[2] / 2)
    assert abs(middle) < 0.2


def test_a_short_formula_and_its_value_stay_on_one_line(camera):
    """A column that ends at each place in turn: nothing of ``f = 6 mm,`` begins a line."""
    maths = TypesetMaths(typeset.lay_out(parse_formula("f")), "f")
    said = inlines_to_html((maths, PlainText(" = "), PlainText("6\u00a0mm"), PlainText(",")), "en")
    whole = typeset.to_mathml(typeset.lay_out(parse_formula("f = 6"), inline=True))
    widths = range(60, 400, 20)
    style = "position:absolute;background:#fff;color:#000;font-size:20px;line-height:40px"
    page = "".join(
        f'<div style="{style};left:{400 * k}px;top:{200 * i}px;width:{width}px">'
        f'<span style="color:#fff">mmmm mm</span> {text}</div>'
        for i, width in enumerate(widths)
        for k, text in enumerate((said, whole))
    )
    ink = camera(sheet(page), 200 * len(widths)) < 128
    for i in range(len(widths)):
        for k in range(2):
            cell = ink[200 * i : 200 * (i + 1), 400 * k : 400 * (k + 1)]
            lines = [cell[40 * n : 40 * (n + 1)].any() for n in range(5)]
            assert lines.count(True) == 1, (widths[i], k)


def test_the_style_is_the_one_of_papers():
    assert re.search(r"math \{[^}]*var\(--font-math\)", _build_paper_css())
    assert FAMILY.startswith('--font-math: "QuizMaths"')

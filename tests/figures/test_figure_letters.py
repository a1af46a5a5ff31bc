"""The letters of labels, beside FreeType with the fonts that they were taken from."""

from __future__ import annotations

import itertools
import subprocess
import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from figure_cases import REFERENCE
from matplotlib.ft2font import FT2Font, LoadFlags

from quizgen.figures import _letters

FONTS = Path(mpl.get_data_path()) / "fonts" / "ttf"
LABELLED = "ABXYZabcxyz0189+−=≈≤()?%′αβσμλνπΔθ°×…≠ "


FAR = 0.002
"""How far a letter may be from its font: 0.02 pt at 10 pt."""


def contours(points, codes):
    """Points along each line of an outline, close together."""
    times = np.linspace(0, 1, 33)[:, None]
    found = []
    for point, code in zip(points, codes, strict=True):
        if code == 1:
            found.append([[point]])
            waiting = []
        if code in {2, 3, 4}:
            waiting.append(point)
        if len(waiting) == {2: 1, 3: 2, 4: 3}.get(code):
            ends = [found[-1][-1][-1], *waiting]
            while len(ends) > 1:  # de Casteljau
                pairs = itertools.pairwise(ends)
                ends = [one + times * (other - one) for one, other in pairs]
            found[-1].append(ends[0])
            waiting = []
    return [np.concatenate(contour) for contour in found]


def apart(ours, theirs):
    """How far any point of one line is from the nearest of another."""
    steps = np.diff(theirs, axis=0)
    squared = np.maximum((steps**2).sum(axis=1), 1e-18)
    ways = ours[:, None] - theirs[:-1]
    along = np.clip((ways * steps).sum(axis=2) / squared, 0, 1)
    return np.linalg.norm(ways - along[..., None] * steps, axis=2).min(axis=1).max()


@pytest.mark.parametrize(
    ("italic", "name"), [(False, "STIXGeneral.ttf"), (True, "STIXGeneralItalic.ttf")]
)
def test_every_letter_is_the_one_of_the_font(italic, name):
    font = FT2Font(str(FONTS / name))
    font.set_size(100, 72)
    letters = _letters._packed()[italic]
    assert len(letters) > 400
    fewer = 0
    for character in letters:
        shape = font.load_char(ord(character), flags=LoadFlags.NO_HINTING)
        points, codes = font.get_path()
        ours = _letters.glyph(character, italic=italic)
        drawn = contours(np.array(ours.points), ours.codes)
        wanted = contours(points / 100, codes)
        assert len(drawn) == len(wanted)
        for one, other in zip(drawn, wanted, strict=True):
            assert max(apart(one, other), apart(other, one)) < FAR, character
        fewer += (codes == 3).sum() // 2 - ours.codes.count(4) // 3
        assert ours.width == shape.linearHoriAdvance / 65536 / 100
    assert fewer > 3000


def test_what_figures_print_is_there():
    for character in LABELLED:
        assert _letters.glyph(character, italic=character.isalpha()).width > 0


def test_a_letter_that_is_not_there_is_named():
    with pytest.raises(LookupError, match="ক"):
        _letters.runs("ক")


LOADED = """
import sys
sys.path.insert(0, sys.argv[1])
from figure_cases import REFERENCE, render
for name in sys.argv[2:]:
    figure = render(name, REFERENCE[name], quiz=False, lang="en")
    figure.svg, figure.light
print(*sys.modules)
"""


def loaded(*names):
    """Modules of a process that drew these figures."""
    done = subprocess.run(
        [sys.executable, "-c", LOADED, str(Path(__file__).parent), *names],
        check=True, capture_output=True, text=True,
    )  # fmt: skip
    return set(done.stdout.split())


def test_no_figure_loads_matplotlib():
    assert not {"matplotlib", "PIL", "pyparsing", "sympy"} & loaded(*REFERENCE)


def test_lines_and_letters_load_no_numpy():
    lines = ["bayer", "blur_curve", "blur_disc", "gaussian", "pinhole", "staircase", "thin_lens"]
    assert "numpy" not in loaded(*lines)

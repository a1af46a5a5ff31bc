"""The letters of labels, beside FreeType with the fonts that they were taken from."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import matplotlib as mpl
import pytest
from figure_cases import REFERENCE
from matplotlib.ft2font import FT2Font, LoadFlags

from quizgen.figures import _letters

FONTS = Path(mpl.get_data_path()) / "fonts" / "ttf"
LABELLED = "ABXYZabcxyz0189+−=≈≤()?%′αβσμλνπΔθ°×…≠ "


@pytest.mark.parametrize(
    ("italic", "name"), [(False, "STIXGeneral.ttf"), (True, "STIXGeneralItalic.ttf")]
)
def test_every_letter_is_the_one_of_the_font(italic, name):
    font = FT2Font(str(FONTS / name))
    font.set_size(100, 72)
    letters = _letters._packed()[italic]
    assert len(letters) > 400
    for character in letters:
        shape = font.load_char(ord(character), flags=LoadFlags.NO_HINTING)
        points, codes = font.get_path()
        ours = _letters.glyph(character, italic=italic)
        assert [*map(list, ours.points)] == (points / 100).tolist()
        assert [*ours.codes] == codes.tolist()
        assert ours.width == shape.linearHoriAdvance / 65536 / 100


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

"""Figures that only cards use: the quiz hides the answer, the numbers are right, the bytes are fixed."""

from __future__ import annotations

import re
import statistics
from xml.etree import ElementTree as ET

import pytest

from quizgen.cards.content import entries
from quizgen.cards.drawings import DRAWINGS, draw, noisy
from quizgen.cards.pictures import draw as any_figure
from quizgen.errors import BankError

ANSWERS = {
    "noise_histograms": ["20", "8 %"],
    "focus_pair": ["f/16", "f/1.8"],
    "luminosity": ["555", "507"],
    "clamped_histogram": ["176"],
}


def words_of(figure):
    return " ".join(ET.fromstring(figure.svg).itertext())


@pytest.mark.parametrize("name", list(DRAWINGS))
@pytest.mark.parametrize("lang", ["en", "bn"])
def test_the_quiz_hides_what_the_answer_shows(name, lang):
    quiz, full = (draw(name, quiz=quiz, lang=lang) for quiz in (True, False))
    for answer in ANSWERS[name]:
        assert answer not in words_of(quiz)
        assert answer not in quiz.alt
        assert answer in words_of(full)
        assert answer in full.alt


@pytest.mark.parametrize("name", list(DRAWINGS))
def test_drawings_hold_no_words(name):
    """Letters and units only, so that one file serves every language."""
    for quiz in (True, False):
        for word in re.findall(r"[^\W\d_]{3,}", words_of(draw(name, quiz=quiz, lang="en"))):
            assert word == "max"


@pytest.mark.parametrize("name", list(DRAWINGS))
def test_languages_differ_in_the_alt_text_alone(name):
    one, other = (draw(name, quiz=True, lang=lang) for lang in ("en", "bn"))
    assert one.svg == other.svg
    assert one.alt != other.alt


def test_the_noise_is_what_it_is_called():
    clean, gauss, impulse = map(noisy, ("clean", "gauss", "impulse"))
    shifts = [b - a for a, b in zip(clean, gauss, strict=True)]
    assert statistics.stdev(shifts) == pytest.approx(20, rel=0.15)
    assert abs(statistics.mean(shifts)) < 4
    changed = [b for a, b in zip(clean, impulse, strict=True) if a != b]
    assert set(changed) == {0, 255}
    assert 0.04 < len(changed) / len(clean) < 0.12


def test_the_eye_is_most_sensitive_where_the_standards_say():
    """CIE 1924: V at 555 nm. CIE 1951: V' at 507 nm. The curves' tops stand above those places."""
    lines = re.findall(
        r'<polyline points="([^"]+)"[^>]*>', draw("luminosity", quiz=True, lang="en").svg.decode()
    )
    curves = [
        [tuple(map(float, p.split(","))) for p in line.split()]
        for line in lines
        if line.count(" ") > 20
    ]
    tops = [min(curve, key=lambda point: point[1])[0] for curve in curves]
    wavelengths = [400 + 300 * (x - 30) / 285 for x in tops]
    assert wavelengths == [pytest.approx(555, abs=3), pytest.approx(507, abs=4)]


def test_every_figure_card_has_a_figure():
    for entry in entries("figures"):
        for quiz in (True, False):
            assert any_figure(entry.figure, entry.values, quiz=quiz, lang="en").svg
    with pytest.raises(BankError, match="unknown figure"):
        any_figure("nothing", {}, quiz=True, lang="en")

"""German, as it is said at a German university; the expected words are typed by hand."""

from __future__ import annotations

import pytest

from quizgen.cards.deck import build_deck
from quizgen.core.errors import BankError
from quizgen.locale import load_words, translate
from quizgen.maths.notation import parse_formula
from quizgen.typeset import lay_out, quantity, to_speech


@pytest.mark.parametrize(("formula", "said"), [
    ("f/(z - f)", "Bruch f durch z minus f, Ende Bruch"),
    ("sqrt(x^2 + y^2)", "Wurzel aus x Quadrat plus y Quadrat, Ende Wurzel"),
    ("-a^3", "minus a hoch drei"),
    ("x_1 <= 4", "x Index 1 kleiner oder gleich 4"),
    ("sin(x)", "Sinus von x"),
])  # fmt: skip
def test_formulas_are_read_aloud(formula, said):
    assert to_speech(lay_out(parse_formula(formula)), "de") == said


@pytest.mark.parametrize(("unit", "said"), [
    ("mm", "5 Millimeter"), ("mm^2", "5 Quadratmillimeter"), ("m/s", "5 Meter pro Sekunde"),
    ("um/px", "5 Mikrometer pro Pixel"),
])  # fmt: skip
def test_units_are_nouns_that_prefixes_continue(unit, said):
    assert to_speech(quantity("5", unit), "de") == said


def test_learners_are_addressed_formally():
    texts = [str(value) for name in ("interface", "messages", "web", "cards")
             for section in load_words("de", name).values()
             for value in (section.values() if isinstance(section, dict) else [section])]  # fmt: skip
    words = {token.strip(".,;:!?()") for text in texts for token in text.split()}
    assert not words & {"du", "Du", "dein", "deine", "Deine", "dir", "dich", "euch"}
    assert "Sie" in words


def test_a_bank_without_german_says_so(bank):
    assert translate("de", "paper.exam") == "Probeklausur"
    with pytest.raises(
        BankError, match=r"nothing in 'Image Acquisition' .* 'de' \(only in en, bn\)"
    ):
        build_deck("de", bank=bank)

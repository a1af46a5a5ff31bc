"""German, as it is said at a German university; the expected words are typed by hand."""

from __future__ import annotations

from fractions import Fraction

import msgspec
import pytest

from quizgen.cards.deck import build_deck
from quizgen.core.errors import BankError
from quizgen.grading.feedback import feedback_sentence, format_read_back, name_truth
from quizgen.grading.verdict import Verdict
from quizgen.kinds.grade import grade_answer
from quizgen.locale import load_words, translate
from quizgen.maths.notation import parse_formula
from quizgen.paper.grade_report import result_rows
from quizgen.paper.grading import PaperResult, PartResult
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


STATEMENT = {"kind": "tf", "correct": [1]}


@pytest.mark.parametrize(("lang", "said"), [("de", "richtig"), ("en", "true"), ("bn", "সত্য")])
def test_a_statement_is_read_back_in_the_words_it_is_asked_in(lang, said):
    read = grade_answer(STATEMENT, "wahr").read_as
    assert format_read_back("tf", read, lang) == said
    assert format_read_back("gap", read, lang) == "true"  # a word that stands in a gap
    assert name_truth("tf", "true", lang) == said  # as the field of a page holds it
    assert name_truth("tf", "wahr", lang) == "wahr"  # as it was typed


@pytest.mark.parametrize(("lang", "said"), [("de", "„6 nm“"), ("en", "“6 nm”")])
def test_what_was_typed_stands_in_the_quotation_marks_of_the_language(lang, said):
    found = feedback_sentence(lang, "unknown-name", {"found": "6 nm", "allowed": ("x",)})
    assert said in found, found


def test_how_to_round_is_said_once_on_a_paper():
    words = load_words("de")
    assert "kaufmännisch" in words["paper"]["on_paper"]
    assert "kaufmännisch" in words["paper"]["rules"]
    for name in ("decimals", "decimals_1", "decimals_0", "sigfigs"):
        assert "(" not in words["ask"][name]


def test_full_points_for_an_error_carried_forward_are_not_partly_right():
    carried = Verdict("partial", Fraction(1), note="carried-forward")
    part = PartResult("1b", "1", "t", "97,7", Fraction(2), carried, Fraction(2), "number")
    for lang, sentences in SENTENCES.items():
        words = [load_words(lang, "messages")[table] for table in ("words", "practice")]
        words += [load_words(lang, "web")[table] for table in ("verdict", "results")]
        assert [table[part.word] for table in words] == sentences
    ((_, cells),) = result_rows(PaperResult("c", (part,)), "de")
    assert cells[1:3] == ["Folgefehler", "2 / 2"]
    half = msgspec.structs.replace(carried, credit=Fraction(1, 2))
    assert half.word == "partial"


SENTENCES = {
    "en": ["carried on", *["Error carried forward."] * 3],
    "de": ["Folgefehler", *["Folgefehler berücksichtigt."] * 3],
    "bn": ["পদ্ধতি ঠিক", *["আগের ভুল ধরে ঠিক।"] * 3],
}

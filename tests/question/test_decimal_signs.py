"""Numbers of a question, as its language writes them: 1/11 = 0.09091, 1/24 = 0.04167."""

from __future__ import annotations

import re
import shutil
from fractions import Fraction
from pathlib import Path

import pytest
from sweep import together

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.bank.variant import draw_variant
from quizgen.figures import FieldPicture, draw_figure
from quizgen.figures.alt_text import strip_mathtext
from quizgen.kinds.contract import DrawingField
from quizgen.kinds.grade import grade_answer
from quizgen.locale import format_amount, format_marks, get_language, localise_numbers
from quizgen.paper.answer_key import make_answer_key
from quizgen.paper.grade_report import format_table
from quizgen.paper.grading import grade_paper
from quizgen.paper.paper import single_question_paper
from quizgen.question.compose import compose_question
from quizgen.question.localise import localise
from quizgen.render import render_paper
from quizgen.render.text import blocks_to_plain_text, inlines_to_plain_text
from quizgen.typeset import fence, lay_out_name, number, to_latex, to_mathml, to_speech, to_typst
from quizgen.typeset.nodes import Func, Word
from quizgen.typeset.prose import InlineCode, Paragraph, PlainText, TypesetMaths

FILTERING = Bank(Path(__file__).parents[2] / "examples" / "filtering", trusted=True)


def spectrum(lang):
    return compose_question(FILTERING.template("spectrum-of-a-mean"), 0, lang)


def test_only_german_has_a_comma():
    assert [get_language(lang).decimal for lang in ("en", "bn", "de")] == [".", ".", ","]


@pytest.mark.parametrize(
    ("lang", "line", "answer"),
    [
        ("en", "f₀ = 1/n = 1/(11 px) = 1/11 cycle/px ≈ 0.09091 cycle/px", "0.689"),
        ("de", "f₀ = 1/n = 1/(11 px) = 1/11 cycle/px ≈ 0,09091 cycle/px", "0,689"),
    ],
)
def test_solutions_have_the_sign_of_their_language(lang, line, answer):
    question, key = spectrum(lang)
    first, second = key.solution.parts
    assert inlines_to_plain_text(first.lines[0].maths).replace("\u00a0", " ") == line
    assert second.answer == answer
    assert key.solution.parts[1].mistakes[0].value == answer.replace("689", "991")
    hints = " ".join(inlines_to_plain_text(part.field.hint) for part in question.parts).replace(
        "\u00a0", " "
    )
    assert ("0,5 %" in hints, "0.5 %" in hints) == (lang == "de", lang == "en")
    check = " ".join(blocks_to_plain_text(key.solution.check))
    assert ("0,6886" in check, "0.6886" in check) == (lang == "de", lang == "en")


@pytest.mark.parametrize("typed", ["0,689", "0.689", "0,965", "0.965"])
def test_either_sign_is_read(typed):
    """0.965 is what comes of forgetting pi; the message has a comma, too."""
    spec = spectrum("de")[1].specs[1]
    verdict = grade_answer(spec, typed, lang="de")
    assert verdict.verdict == ("correct" if "689" in typed else "wrong")
    assert verdict.note == ("" if "689" in typed else "trap:pi-forgotten")


def test_formulas_have_it_in_every_medium():
    shown = number("57.25")
    assert [write(shown, "de") for write in (to_latex, to_mathml, to_typst, to_speech)] == [
        "57{,}25",
        to_mathml(shown, "en").replace("57.25", "57,25"),
        '"57,25"',
        "57,25",
    ]
    assert [write(shown, "en") for write in (to_latex, to_typst)] == ["57.25", "57.25"]


def test_programs_and_sentences_of_other_languages_stay():
    said = (Paragraph((PlainText("2.5 mm, 2. Teil, "), InlineCode("x = 2.5"))),)
    assert localise("bn", said) is said
    assert localise("de", said) == (
        Paragraph((PlainText("2,5 mm, 2. Teil, "), InlineCode("x = 2.5"))),
    )


def test_figures_have_it_in_labels_and_in_words():
    drawn = {lang: draw_figure(builtin_bank().figure("thin_lens"), {"f": 52.5, "z": 200}, quiz=False, lang=lang)
             for lang in ("en", "de")}  # fmt: skip
    for lang, sign in (("en", "."), ("de", ",")):
        labels = " ".join(strip_mathtext(label.text) for label in drawn[lang].labels)
        assert f"52{sign}5" in labels
        assert f"52{sign}5" in drawn[lang].alt
    assert draw_variant(FILTERING.template("spectrum-of-a-mean"), 0).shown["n"] == 11


def test_points_have_it_too():
    assert [format_marks(Fraction(1, 2), lang) for lang in ("en", "de")] == [
        "0.5 points",
        "0,5 Punkte",
    ]
    assert [format_amount(1.75, lang) for lang in ("en", "bn", "de")] == ["1.75", "1.75", "1,75"]


def test_points_of_a_paper_and_of_its_report_have_it(tmp_path):
    shutil.copytree(FILTERING.root, tmp_path / "own")
    rules = tmp_path / "own/templates/edges/sharpen-with-laplacian/template.toml"
    rules.write_text(rules.read_text("utf-8").replace("points = 1\n", 'points = "0.5"\n'), "utf-8")
    own = Bank(tmp_path / "own", trusted=True).template("sharpen-with-laplacian")
    for lang, half in (("de", "0,5 Punkte"), ("en", "0.5 points")):
        paper = single_question_paper(own, 3, lang, figures=False)
        page = render_paper(paper, "exam", "html").decode()
        assert half in page.replace("\u00a0", " ")
        assert f"<td>2{half[1]}5</td>" in page
        result = grade_paper(make_answer_key(paper), {}, lang)
        assert list(format_table(result, lang, 80, paint=False))[-1].endswith(f"0 / 2{half[1]}5")


@together(
    ("written", "german"),
    [
        ("27.25 mm, -0.5; (1.5; 2.25).", "27,25 mm, -0,5; (1,5; 2,25)."),
        ("(1.5,2.5) and 1.5e-3 and 3.14-3.15", "(1,5,2,5) and 1,5e-3 and 3,14-3,15"),
        ("12.5.2024, 1.2.3, 1.000.000", "12.5.2024, 1.2.3, 1.000.000"),
        ("1.000,50 and 12.345.678,9", "1.000,50 and 12.345.678,9"),
        ("1.125 and 10.125, then 2", "1,125 and 10,125, then 2"),
        ("sections 3 and 4. 5 follow", "sections 3 and 4. 5 follow"),
    ],
)
def test_what_is_no_number_with_a_point_stays(written, german):
    assert localise_numbers("de", written) == german
    assert localise_numbers("en", written) == written


def test_hints_in_plain_text_have_it():
    template = FILTERING.template("two-gaussians-in-a-row")
    for lang, sign, other in (("de", ",", "."), ("en", ".", ",")):
        keys = (compose_question(template, seed, lang)[1] for seed in range(6))
        lines = [line for key in keys for part in key.solution.parts for line in part.lines]
        said = " ".join(inlines_to_plain_text(rung.shown) for line in lines for rung in line.hints)
        assert f"4{sign}5" in said
        assert f"4{other}5" not in said


@pytest.mark.parametrize(
    ("coordinates", "german", "english"),
    [
        (["3/2", "2"], "(1,5; 2)", "(1.5, 2)"),
        (["-5/2", "7/4"], "(−2,5; 1,75)", "(−2.5, 1.75)"),
        (["1", "2"], "(1, 2)", "(1, 2)"),
    ],
)
def test_a_comma_does_not_stand_between_numbers_with_commas(coordinates, german, english):
    texts = [f"{float(Fraction(one)):g}" for one in coordinates]
    pair = fence([number(text) for text in texts])
    listed = f"({', '.join(texts)})".replace("-", "−")
    for lang, wanted in (("de", german), ("en", english)):
        assert TypesetMaths(pair, listed, lang).text == wanted
        assert to_latex(pair, lang).replace(" ", "") == wanted.replace(" ", "").replace(
            "−", "-"
        ).replace(",", "{,}" if lang == "de" and ";" in wanted else ",")
        text = re.sub(r"<[^>]*>", "", to_mathml(pair, lang))
        assert text == wanted.replace(" ", "")
        spec = {"kind": "point", "values": coordinates, "exact": True}
        assert grade_answer(spec, wanted, lang="de").verdict == "correct"


def test_arguments_of_functions_are_separated_alike():
    most = Func(Word("max"), (number("0.5"), lay_out_name("x")))
    assert [to_latex(most, lang) for lang in ("de", "en")] == [r"\max(0{,}5; x)", r"\max(0.5, x)"]
    assert to_typst(most, "de") == r'max ("0,5" \; x)'


def test_the_axes_of_a_field_have_it_and_its_words():
    field = DrawingField((-1.0, 1.0, 0.0, 1.0), (0.5, 0.25), given=(((0.5, 0.25), (1.0, 0.75)),))
    for lang, sign in (("de", ","), ("en", ".")):
        drawn = FieldPicture(field, lang)
        labels = {label.text for label in drawn.figure.labels}
        assert {f"−0{sign}5", f"0{sign}25"} <= labels
        assert f"(0{sign}5; 0{sign}25), (1; 0{sign}75)" in drawn.alt

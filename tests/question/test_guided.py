"""Calculations step by step: values worked out by hand, mistakes where they happen, full marks."""

from __future__ import annotations

from fractions import Fraction

import pytest
from sweep import spread

from quizgen.bank.bank import builtin_bank
from quizgen.bank.variant import draw_variant, reference_variant
from quizgen.core.shares import share_points
from quizgen.grading.options import GradingOptions
from quizgen.paper.answer_key import make_key_question
from quizgen.paper.grading import QuestionGrader
from quizgen.paper.paper import PaperItem
from quizgen.question.compose import compose_variant
from quizgen.question.levels.guided import guided_stages
from quizgen.typeset.prose import Emphasis, Paragraph

CALCULATING = [
    name for name in builtin_bank().template_paths
    if builtin_bank().rules(name).solver and "guided" in builtin_bank().rules(name).levels
]  # fmt: skip
SEEDS = [1, pytest.param(0, marks=pytest.mark.slow)]


@pytest.fixture(scope="module", params=spread(CALCULATING, 12, slow=12))
def template(request):
    return builtin_bank().template(request.param)


@pytest.fixture(scope="module", params=SEEDS)
def drawn(request, template):
    """Drawn once, used by all tests of a template."""
    return draw_variant(template, request.param)


def guided(drawn, lang="en"):
    return compose_variant(drawn, lang, level="guided", figures=False)


def marker_of(question, key):
    keyed = make_key_question(PaperItem("1", (question,), (key,)))
    return QuestionGrader(keyed, GradingOptions(question.lang)), {
        part.id: part for part in keyed.parts
    }


def lens():
    """f = 50 mm, z = 550 mm in the notes."""
    return reference_variant(builtin_bank().template("thin-lens-image-distance"))


def test_the_steps_of_a_lens_come_in_their_order_with_the_values_of_the_notes():
    drawn = lens()
    question, key = guided(drawn)
    f, z = Fraction(str(drawn.shown["f"])), Fraction(str(drawn.shown["z"]))
    image = 1 / (1 / f - 1 / z)
    labels = [part.label for part in question.parts]
    assert labels == ["a1", "a2", "a3", "b1", "b2", "c"]
    values = [Fraction(str(spec.value)) for spec in key.specs if hasattr(spec, "value")]
    assert values == [1 / image, image, image / z, image - f]


def test_a_mistake_is_named_at_the_step_where_it_happens_and_only_there():
    drawn = draw_variant(
        builtin_bank().template("blur-disc-diameter"), 0
    )  # f = 50 mm, N_1 = 8, image at 50 mm
    marker, parts = marker_of(*guided(drawn))
    assert (
        marker.grade_part(parts["1a1"], "12.5 mm").verdict.verdict == "wrong"
    )  # twice the diameter
    carried = marker.grade_part(parts["1a3"], "500 um").verdict
    assert (carried.note, carried.credit) == ("carried-forward", 1)


def test_a_known_mistake_of_an_intermediate_step_is_told_with_its_sentence():
    drawn = reference_variant(builtin_bank().template("rgb-to-hsv"))
    question, key = guided(drawn)
    marker, parts = marker_of(question, key)
    red, green, blue = (Fraction(str(drawn.shown[name])) for name in "RGB")
    place = next(i for i, spec in enumerate(key.specs) if spec.of == ["V"])
    first = question.parts[place].field.id
    verdict = marker.grade_part(parts[first], str((red + green + blue) / 3)).verdict
    assert verdict.note == "trap:mean-as-value"
    assert "mean of the three channels" in verdict.message
    assert "mean-as-value" in [mistake.name for mistake in key.solution.parts[place].mistakes]


def test_a_wrong_formula_is_answered_with_the_sentence_of_its_mistake():
    drawn = lens()
    question, key = guided(drawn)
    place = next(i for i, part in enumerate(question.parts) if part.field.options)
    marker, parts = marker_of(*guided(drawn))
    for reason in key.solution.parts[place].reasons:
        verdict = marker.grade_part(parts[question.parts[place].field.id], reason.value).verdict
        told = (
            builtin_bank()
            .template("thin-lens-image-distance")
            .texts["en"]
            .sentence("traps", reason.name)
        )
        assert verdict.verdict == "wrong"
        assert told[0].text.split("$")[0][:20] in verdict.message


@pytest.mark.parametrize("lang", ["en", "bn"])
def test_what_the_solution_prints_gets_the_marks_of_the_exam(drawn, lang):
    question, key = guided(drawn, lang)
    marker, parts = marker_of(question, key)
    marks = Fraction(0)
    for part, solved in zip(question.parts, key.solution.parts, strict=True):
        result = marker.grade_part(parts[part.field.id], solved.answer)
        marks += part.points if result.marks is None else result.marks  # a person marks sentences
    exam, _ = compose_variant(drawn, lang, figures=False)
    assert marks == question.points == exam.points


def test_both_languages_are_marked_alike(drawn):
    (_, english), (_, bangla) = guided(drawn), guided(drawn, "bn")
    assert english.specs == bangla.specs
    assert english.identity == bangla.identity


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("depth-of-field-limits", {"H", "z_n", "z_f"}),
        ("hyperfocal-distance", {"H"}),
        ("photon-energy-and-band", {"E"}),
    ],
)
def test_a_formula_that_the_text_gives_is_no_question(name, told):
    for seed in range(5):
        asked = {stage.formula.name for stage in guided_stages(draw_variant(builtin_bank().template(name), seed)) if stage.formula}  # fmt: skip
        assert asked
        assert not asked & told


def bold(blocks):
    """Questions in bold."""
    shown = (part for block in blocks if isinstance(block, Paragraph) for part in block.children)
    return [part for part in shown if isinstance(part, Emphasis) and part.style == "strong"]


def test_one_question_is_asked_at_a_time(drawn):
    question, _ = guided(drawn)
    authored = {part.label: part for part in compose_variant(drawn, "en", figures=False)[0].parts}
    for part in question.parts:
        usual = authored.get(part.label)
        assert len(bold(part.body)) <= 1 or (usual and bold(part.body) == bold(usual.body))
    if all(part.label not in authored for part in question.parts):
        assert bold(question.stem) == [] or len(authored) > 1


@pytest.mark.parametrize("level", ["guided", "transfer"])
def test_letters_of_parts_are_not_those_of_the_fields_of_a_table(drawn, level):
    question, key = compose_variant(drawn, "en", level=level, figures=False)
    cells = {
        cell for spec in key.specs for cell in getattr(spec, "values", {}) if spec.kind == "table"
    }
    authored = drawn.template.labels if len(drawn.template.labels) > 1 else ()
    assert cells.isdisjoint({part.label for part in question.parts}.difference(authored))


def test_a_time_that_the_text_gives_is_no_step():
    """The exposure time was 1/250 s."""
    for name in ("blur-and-light-factors", "best-pinhole-diameter", "exposure-equivalence"):
        _, key = guided(draw_variant(builtin_bank().template(name), 1))
        assert ["t_1"] not in [spec.of for spec in key.specs]
        assert ["t_2"] in [spec.of for spec in key.specs]


def test_a_sum_has_no_brackets_within():
    steps = {"Y_601": "(R + G + B)/3", "V": "(R + G + B)/3"}
    found = set()
    for name in ("luma-before-and-after-turn", "rgb-to-hsv"):
        for seed in range(8):
            _, key = guided(draw_variant(builtin_bank().template(name), seed))
            found |= {option for spec in key.specs if spec.kind == "choice" for option in spec.options}  # fmt: skip
    assert {f"{name} = {text}" for name, text in steps.items()} <= found
    assert not any("(R + G)" in text for text in found)


@pytest.mark.parametrize(
    ("total", "weights", "shares"),
    [
        ("3", ["1", "1", "1"], ["1", "1", "1"]),
        ("1", ["1", "1", "1"], ["1/2", "1/4", "1/4"]),
        ("2", ["1/2", "1/2", "1"], ["1/2", "1/2", "1"]),
        ("1/2", ["1", "1", "1"], ["1/4", "1/4", "1/4"]),
        ("6", ["1", "1", "1", "1", "1", "1", "1"], ["1", "1", "1", "3/4", "3/4", "3/4", "3/4"]),
    ],
)
def test_marks_are_shared_out_in_quarters(total, weights, shares):
    found = share_points(Fraction(total), [Fraction(weight) for weight in weights])
    assert found == tuple(map(Fraction, shares))

"""What is suggested of sentences, beside what an examiner gave them: five tables of sentences.

``given.toml`` was written by somebody who did not write the mark schemes, ``own_a.toml``,
``own_b.toml`` and ``own_d.toml`` after they stood, ``own_c.toml`` before they did. A row is a
sentence and its points, criterion by criterion.
"""

from __future__ import annotations

import tomllib
from fractions import Fraction
from functools import cache
from pathlib import Path

import pytest

from quizgen.bank.bank import builtin_bank
from quizgen.bank.variant import draw_variant
from quizgen.grading.judging.statements import Statement, read_subject, split_tokens
from quizgen.maths.numbers import parse_written_number
from quizgen.question.part_context import ask_part

TABLES = sorted((Path(__file__).parent / "rubric").glob("*.toml"))
SCHEMES = {
    "aperture-two-effects": ("aperture-two-effects", 0, {"opened": 1}, ["dof", "light"]),
    "stopping-down-from-geometry": (
        "stopping-down-from-geometry", 0, {"closing": 1, "q": 8}, ["cone", "threshold", "area"]),
    "two-compensations-and-their-price": (
        "two-compensations-and-their-price", 0, {}, ["time", "motion", "gain", "noise"]),
    "why-twice-as-many-green": ("why-bayer-green-and-demosaicing", 0, {}, ["eye", "detail"]),
    "why-demosaicing-is-needed": (
        "why-bayer-green-and-demosaicing", 1, {}, ["one-colour", "interpolated"]),
    "three-reasons-for-floats": (
        "three-reasons-for-floats", 0, {}, ["precision", "wrap", "range", "between"]),
    "ccd-streak-and-blooming": ("ccd-and-cmos-artefacts", 0, {}, ["shift", "full-well", "bright"]),
    "rolling-shutter-explained": (
        "ccd-and-cmos-artefacts", 1, {}, ["rows", "movement", "scenes"]),
    "additive-and-subtractive": (
        "additive-and-subtractive", 0, {}, ["adds additive", "absorbs subtractive"]),
    "shot-noise-dark-and-normal": (
        "photon-snr-formula-and-model", 1, {}, ["limit", "relative", "variance"]),
    "averaging-encoded-values": (
        "averaging-encoded-values", 0, {"i": 0}, ["nonlinear", "darker", "pipeline"]),
    "isotropic-or-anisotropic": (
        "isotropic-or-anisotropic", 0, {"s_1": 3, "s_2": 1}, ["iso", "aniso", "scene"]),
    "why-clamping-loses": ("why-clamping-loses", 0, {"value": 300}, ["collapse", "range"]),
    "metamerism-explained": ("metamerism-explained", 0, {}, ["integral", "same", "lamp"]),
    "gaussian-or-impulse-noise": (
        "gaussian-or-impulse-noise", 0, {}, ["gauss", "impulse", "mean-filter median"]),
    "why-the-pinhole-model": (
        "why-pinhole-model", 0, {}, ["collinear simple homogeneous basis"]),
    "bare-sensor-and-pinhole": (
        "bare-sensor-and-pinhole", 0, {"narrower": 0}, ["mixed", "one-ray", "price"]),
    "three-primaries-and-night": (
        "three-primaries-and-night", 0, {}, ["cones", "mixture", "rods"]),
    "density-above-one": (
        "density-above-one", 0, {"halved": 0}, ["density", "area", "trade"]),
    "two-quantisations": (
        "two-quantisations", 0, {}, ["spatial", "levels", "cure"]),
    "compare-two-lens-defects": (
        "compare-two-lens-defects", 0, {}, ["fringes", "corners", "cure"]),
    "flat-field-in-words": (
        "flat-field-in-words", 0, {}, ["white", "divide", "dark"]),
    "why-the-red-car-is-blue": (
        "why-the-red-car-is-blue", 0, {}, ["order", "grey", "mend"]),
    "hue-of-grey": (
        "hue-of-grey", 0, {}, ["undefined", "saturation", "unsteady"]),
    "why-compare-in-lab": (
        "why-compare-in-lab", 0, {}, ["distance", "rgb", "lightness"]),
    "over-and-underexposed": (
        "over-and-underexposed", 0, {}, ["full", "few", "scaled"]),
    "equal-power-unequal-brightness": (
        "equal-power-unequal-brightness", 0, {}, ["weight", "night"]),
    "zoom-or-step-closer": (
        "zoom-or-step-closer", 0, {}, ["depth", "zoom", "step"]),
}  # fmt: skip
"""Template, part and drawn values of each question; criteria, those marked together in one name."""


@cache
def scheme(question):
    template, part, wanted, names = SCHEMES[question]
    for seed in range(500):
        drawn = draw_variant(builtin_bank().template(template), seed)
        if all(drawn.shown_values[name] == value for name, value in wanted.items()):
            return ask_part(drawn, part).spec, names
    raise LookupError(question)


@cache
def judged(table, question=""):
    """Each sentence (to a question) with what is suggested, criterion by criterion, and what the examiner gave."""
    found = []
    for asked in tomllib.loads(table.read_text("utf-8"))["question"]:
        if question not in {"", asked["id"]}:
            continue
        spec, names = scheme(asked["id"])
        for sentence, *points in asked["rows"]:
            made = spec.suggest(sentence)
            earned = {finding.name: finding.points for finding in made.findings}
            got = [float(sum(earned[one] for one in name.split())) for name in names]
            wanted = [sum(points[:2])] if len(names) == 1 else points  # two reasons of four
            found.append((sentence, got, wanted, made))
    return found


def test_there_are_four_hundred_sentences():
    tables = [tomllib.loads(table.read_text("utf-8"))["question"] for table in TABLES]
    assert sum(len(asked["rows"]) for table in tables for asked in table) >= 400


@pytest.mark.slow
@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.stem)
def test_the_suggestion_is_what_the_examiner_gave(table):
    pairs = [pair for _, got, points, _ in judged(table) for pair in zip(got, points, strict=True)]
    assert sum(got == wanted for got, wanted in pairs) >= 0.85 * len(pairs)


@pytest.mark.slow
def test_blind_sentences_get_about_the_points_of_the_examiner():
    """Of questions alone, marks were given without the scheme: a point is one idea of several."""
    rows = tomllib.loads((Path(__file__).parent / "blind_sentences.toml").read_text("utf-8"))
    away, possible = 0.0, 0.0
    for template, points, sentence in rows["rows"]:
        drawn = draw_variant(builtin_bank().template(template), 1)
        asked = (ask_part(drawn, n).spec for n in range(len(drawn.template.rules.part)))
        spec = next(one for one in asked if one.kind == "rubric")
        made = spec.suggest(sentence)
        away += abs(float(made.points) - points)
        possible += float(parse_written_number(spec.full))
        assert made.touched or not points
    assert away <= 0.1 * possible


@pytest.mark.parametrize("question", SCHEMES)
@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.stem)
def test_what_is_denied_is_never_found_and_what_is_right_is_never_overlooked(table, question):
    found = judged(table, question)
    assert not [
        (sentence, got, points)
        for sentence, got, points, _ in found
        if any(clause.denials or clause.ahead for clause in Statement(sentence).clauses)
        and any(mine > wanted for mine, wanted in zip(got, points, strict=True))
    ]
    assert not [said for said, _, points, made in found if sum(points) >= 1 and not made.touched]


def draw_part(template, part):
    """Return the specification of a part, with the values that its sentences are about."""
    known = (
        values for name, index, values, _ in SCHEMES.values() if (name, index) == (template, part)
    )
    wanted = next(known, {})
    for seed in range(1, 500):
        drawn = draw_variant(builtin_bank().template(template), seed)
        if all(drawn.shown_values[name] == value for name, value in wanted.items()):
            return ask_part(drawn, part).spec
    raise LookupError(template)


@pytest.mark.slow
def test_a_contradiction_is_never_counted():
    rows = tomllib.loads((Path(__file__).parent / "contradictions.toml").read_text("utf-8"))["rows"]
    specs = {place: draw_part(*place) for place in {tuple(row[:2]) for row in rows}}
    counted = []
    for template, part, names, sentence in rows:
        points = {one.name: one.points for one in specs[template, part].suggest(sentence).findings}
        counted += [(sentence, name) for name in names.split() if points[name]]
    assert not counted


@pytest.mark.slow
def test_an_examiner_finds_the_same_criteria():
    """What is right is never overlooked whole, and nothing is found where all is wrong."""
    rows = tomllib.loads((Path(__file__).parent / "blind_criteria.toml").read_text("utf-8"))["rows"]
    variants = {(name, seed) for name, seed, *_ in rows}
    drawn = {place: draw_variant(builtin_bank().template(place[0]), place[1]) for place in variants}
    specs, equal, asked = {}, 0, 0
    for name, seed, part, found, sentence in rows:
        place = (name, seed, part)
        if place not in specs:
            labels = [label or "a" for label in drawn[place[:2]].template.labels]
            specs[place] = ask_part(drawn[place[:2]], labels.index(part)).spec
        made = specs[place].suggest(sentence)
        wanted = found.split()
        equal += sum(bool(one.points) == (one.name in wanted) for one in made.findings)
        asked += len(made.findings)
        assert wanted or not made.points, sentence
        assert len(wanted) < len(made.findings) or made.touched, sentence
    assert equal >= 0.95 * asked


COMPARED = {
    "kind": "rubric", "full": "2", "synonyms": [],
    "criteria": {
        "ccd": {"points": "1", "accept": ["streaks", "higher price"], "about": ["CCD"]},
        "cmos": {"points": "1", "accept": ["leaning poles"], "about": ["CMOS"]},
    },
}  # fmt: skip


@pytest.mark.parametrize(("sentence", "ccd", "cmos"), [
    ("Streaks; leaning poles.", "found", "found"),
    ("CCD: streaks. CMOS: leaning poles.", "found", "found"),
    ("CMOS: streaks. CCD: leaning poles.", "open", "open"),
    ("Streaks are typical of CMOS chips and leaning poles of a CCD.", "open", "open"),
    ("CMOS, as one sees, has streaks", "open", "missing"),
    ("The CCD has a higher price than CMOS", "found", "missing"),
    ("Unlike CMOS it has streaks", "open", "missing"),
    ("CCDs are free of streaks", "open", "missing"),
])  # fmt: skip
def test_what_is_said_of_another_thing_is_left_to_a_person(sentence, ccd, cmos):
    from quizgen.kinds.grade import load_spec

    made = load_spec(COMPARED).suggest(sentence)
    assert [finding.status for finding in made.findings] == [ccd, cmos]


@pytest.mark.parametrize(("sentence", "status"), [
    ("The near one grows more than the far one.", "found"),
    ("The far one grows more than the near one.", "open"),
    ("Das Nahe wächst stärker als das Ferne.", "found"),
    ("Das Ferne wächst stärker als das Nahe.", "open"),
])  # fmt: skip
def test_both_sides_of_a_comparison_stand_on_their_side(sentence, status):
    from quizgen.kinds.grade import load_spec

    accept = ["near one grows more than the far one", "das Nahe wächst stärker als das Ferne"]
    spec = {"kind": "rubric", "full": "1", "criteria": {"a": {"points": "1", "accept": accept}}}
    assert load_spec(spec).suggest(sentence).findings[0].status == status


SPEC = {
    "kind": "rubric", "full": "2", "synonyms": [["dof", "depth of field", "Schärfentiefe"]],
    "criteria": {
        "dof": {"points": "1", "accept": ["less depth of field", "background gets blurry"],
                "refuse": ["the whole image gets blurred"]},
        "light": {"points": "1", "accept": ["the image gets brighter", "more light"],
                  "half": ["the exposure changes"], "follows": "dof"},
    },
}  # fmt: skip


@pytest.mark.parametrize(("sentence", "dof", "light"), [
    ("The depth of field is reduced.", "found", "missing"),
    ("The depth of field is not reduced.", "refused", "missing"),
    ("The depth of field does not get larger.", "open", "missing"),  # nor need it get smaller
    ("It is not true that the depth of field shrinks.", "open", "missing"),
    ("Not only does the DoF shrink, the image gets brighter, too.", "found", "found"),
    ("The image gets brighter, and so darker.", "missing", "refused"),
    ("The image gets darker, no: brighter.", "missing", "found"),
    ("The whole image gets blurred.", "refused", "missing"),
    ("Not the whole image gets blurred.", "missing", "missing"),
    ("The DoF grows and the image gets darker.", "refused", "follows"),
    ("The DoF shrinks and the image gets darker.", "found", "refused"),
    ("The exposure changes.", "missing", "half"),
    ("Die Schärfentiefe nimmt nicht zu, sondern ab.", "open", "missing"),
    ("Die Schärfentiefe nimmt stark ab.", "found", "missing"),
    ("dof কমে না", "refused", "missing"),
    ("dof kome, chobi ujjol", "found", "missing"),
    ("depht of feild decreses", "found", "missing"),
    ("without more light", "missing", "refused"),
    ("Nobody would say that the depth of field shrinks.", "open", "missing"),
    ("One might think that the DoF shrinks, but that is not so.", "open", "missing"),
    ("The DoF shrinks and the image gets brighter. This is wrong.", "open", "open"),
    ("There is no doubt that the depth of field shrinks.", "found", "missing"),
    ("The mistake is that the depth of field shrinks.", "found", "missing"),
    ("Many forget the light. That is wrong: the image gets brighter.", "missing", "found"),
    ("Es ist ein Irrtum, dass die Schärfentiefe abnimmt.", "open", "missing"),
    ("Die Schärfentiefe nimmt ab, das stimmt aber nicht.", "open", "missing"),
    ("dof কমে, এমন না", "open", "missing"),
    ("onekei bhabe dof kome, kintu ashole ta na", "open", "missing"),
    ("The shot has a depth of field.", "missing", "missing"),  # no short one
    ("", "missing", "missing"),
    ("(((( ^^ -> ] 1/0 √ |", "missing", "missing"),
])  # fmt: skip
def test_the_sign_of_a_statement(sentence, dof, light):
    from quizgen.kinds.grade import load_spec

    made = load_spec(SPEC).suggest(sentence)
    assert [finding.status for finding in made.findings] == [dof, light]


def test_a_root_is_one_with_what_stands_under_it():
    from quizgen.kinds.grade import load_spec

    spec = load_spec({"kind": "rubric", "full": "1", "criteria": {
        "root": {"points": "1", "accept": ["SNR = √N"]}}})  # fmt: skip
    said = {"SNR is sqrt N": "found", "SNR = √(2N)": "missing", "√M is the SNR of N": "missing"}
    assert {one: spec.suggest(one).findings[0].status for one in said} == said


def test_the_clause_that_is_gone_by_is_quoted():
    from quizgen.kinds.grade import load_spec

    made = load_spec(SPEC).suggest("I think the DoF shrinks, and the image gets brighter.")
    assert [finding.quote for finding in made.findings] == [
        "I think the DoF shrinks", "the image gets brighter",
    ]  # fmt: skip
    assert made.points == parse_written_number("2")


@pytest.mark.parametrize(("worth", "said"), [(None, "1 of 2"), (Fraction(3), "1.5 of 3")])
def test_what_is_recognised_is_counted_in_the_points_of_the_part(worth, said):
    from quizgen.grading.judge import explain_verdict, judge_answer
    from quizgen.grading.options import GradingOptions
    from quizgen.kinds.grade import load_spec

    spec = load_spec(SPEC)
    verdict = judge_answer(spec, "The depth of field shrinks.", GradingOptions(points=worth))
    assert said in explain_verdict(spec, verdict, "en").message


@pytest.mark.parametrize("word", ["পড়তে", "reading", "sensing", "lighted"])
def test_a_word_of_two_groups_is_of_the_one_that_has_it(word):
    others = {"পড়তে": "পড়া", "reading": "reads", "sensing": "sense", "lighted": "lights"}
    mine, other = (word,), (others[word],)
    for groups in ((mine, other), (other, mine)):
        assert read_subject(groups).find(split_tokens(word), 0) == (((word,),), 1)

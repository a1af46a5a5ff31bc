"""Tasks turned round: every key is worked out again from the solver's model, by SymPy alone."""

from __future__ import annotations

import re
from fractions import Fraction

import pytest
import sympy
from models import DIGITS, model, near, solved, symbols
from sweep import spread, together

from quizgen.bank.bank import builtin_bank
from quizgen.bank.variant import draw_variant
from quizgen.kinds.grade import grade_answer
from quizgen.kinds.rubric import suggest_marks
from quizgen.maths.constants import parse_exact
from quizgen.maths.limits import find_limit
from quizgen.maths.notation import parse_formula
from quizgen.maths.numbers import format_for_key
from quizgen.maths.scaling import scaling_exponent
from quizgen.maths.units import unit_factor
from quizgen.question.compose import compose_variant
from quizgen.question.interpolation import inlines_to_text
from quizgen.question.levels import load_level
from quizgen.question.levels.comparison import choose_comparison
from quizgen.question.levels.consequence import choose_consequence, choose_way_back
from quizgen.question.levels.error_spotting import choose_faulty_solution
from quizgen.question.levels.limit import choose_limit
from quizgen.question.levels.perturbations import Perturbations, askable_results
from quizgen.typeset.prose import ListBlock, Paragraph

CALCULATING = [
    name for name in builtin_bank().template_paths
    if builtin_bank().rules(name).solver and "transfer" in builtin_bank().rules(name).levels
]  # fmt: skip
SEEDS = [range(2), pytest.param(range(2, 4), marks=pytest.mark.slow)]


@pytest.fixture(scope="module", params=spread(CALCULATING, 12, slow=12))
def template(request):
    return builtin_bank().template(request.param)


@pytest.fixture(scope="module", params=SEEDS)
def draws(request, template):
    """Drawn once, used by all tests of a template."""
    return [draw_variant(template, seed) for seed in request.param]


def moved(change):
    """A result before and after a change."""
    before = solved(change.drawn)[change.target]
    return before, solved(change.drawn, **{change.given: change.scale})[change.target]


def test_the_effect_of_a_change_is_that_of_the_model(draws):
    for drawn in draws:
        asked = choose_consequence(Perturbations(drawn))
        if asked is None:
            continue
        spec, (before, after) = asked("en").spec, moved(asked.change)
        if asked.way == "factor":
            assert near(after / before, sympy.Rational(str(spec.value)))
        else:
            size = unit_factor(
                getattr(spec, "unit", "") or drawn.template.units[asked.change.target]
            )
            assert near(after, sympy.Rational(format_for_key(parse_exact(spec.value) * size)))


def test_the_way_back_brings_about_what_is_wanted_in_the_model(draws):
    for drawn in draws:
        changes = Perturbations(drawn)
        back = choose_way_back(changes, choose_consequence(changes))
        if back is not None:
            given, target = back.change.given, back.change.target
            found = sympy.Rational(str(back("en").spec.value))
            after = solved(drawn, **{given: found})[target]
            wanted = sympy.Rational(str(back.change.factor))
            assert near(after / solved(drawn)[target], wanted)


def test_a_limit_is_what_the_model_comes_to_far_away(draws):
    """A result that a quantity 10^30 times as large, or as small, does not move any more."""
    for drawn in draws:
        changes = Perturbations(drawn)
        asked = choose_limit(changes, choose_consequence(changes))
        if asked is None:
            continue
        far = sympy.Integer(10) ** (30 if asked.grows else -30)
        before, after = (solved(drawn, **how)[asked.target] for how in ({}, {asked.given: far}))
        spec = asked("en").spec
        size = unit_factor(getattr(spec, "unit", ""))
        key = sympy.Rational(format_for_key(parse_exact(spec.value) * size))
        assert abs(after - key) < sympy.Float("1e-12") * abs(before - key)
        for lang in ("en", "bn"):
            assert all(mistake.shown for mistake in asked(lang).solved.mistakes)


def test_some_limits_by_hand():
    """Far away a thing is as small as nothing, and behind the lens at the focus."""
    lens = draw_variant(builtin_bank().template("thin-lens-image-distance"), 3)
    steps = {step.name: step.expr for step in lens.template.chain.steps}
    focus = find_limit("z'", "z", steps, lens.values, grows=True)
    assert focus == lens.values["f"]
    assert find_limit("m", "z", steps, lens.values, grows=True) == 0
    assert find_limit("z'", "z", steps, lens.values, grows=False) == 0  # 1/q, q without bound
    assert find_limit("q", "z", steps, lens.values, grows=False) is None


@together(
    ("formula", "grows", "limit"),
    [
        ("x/(x + 3)", True, "1"), ("x/(x + 3)", False, "0"), ("(2*x^2 - 1)/(x^2 + x)", True, "2"),
        ("(x + 1)^3/x^3", True, "1"), ("x^-2 + 5", True, "5"), ("x^2/x", False, "0"),
        ("1/x", False, None), ("x + 1", True, None), ("sqrt(x)/x", True, None),
        ("abs(x)/x", True, None), ("3/(x - x)", True, None), ("(x^2 - x^2)/x", False, "0"),
    ],
)  # fmt: skip
def test_a_limit_is_that_of_the_leading_terms(formula, grows, limit):
    found = find_limit("y", "x", {"y": parse_formula(formula)}, {}, grows=grows)
    assert found == (None if limit is None else parse_exact(limit))


def test_a_wrong_step_is_named_and_mended_in_words():
    """Whoever copies the scheme's sentences meets both criteria; another step is not found."""
    for seed in range(6):
        drawn = draw_variant(builtin_bank().template("weak-perspective-scale-error"), seed)
        part = choose_faulty_solution(drawn, written=True)("en")
        idea = {line.name: inlines_to_text(line.idea) for line in part.solved.scheme}
        step = re.search(r"\d", idea["step"])[0]
        assert {
            one.status for one in suggest_marks(part.spec, " ".join(idea.values())).findings
        } == {"found"}
        other = suggest_marks(part.spec, f"Step {int(step) % 4 + 1} is wrong.").findings
        assert [one.status for one in other] == ["missing", "missing"]


def test_of_two_changes_the_model_moves_the_same_one_further(draws):
    for drawn in draws:
        changes = Perturbations(drawn)
        pair = choose_comparison(changes, choose_consequence(changes))
        if pair is None:
            continue
        moves = [abs(after - before) for before, after in map(moved, (pair.first, pair.second))]
        place = 3 if near(*moves) else 1 if moves[0] > moves[1] else 2
        assert pair("en").spec.correct == [place]
        if place != 3:
            assert max(moves) > 1.2 * min(moves)


def test_the_first_wrong_step_is_the_first_that_the_model_does_not_take(draws):
    for drawn in draws:
        found = choose_faulty_solution(drawn)
        if found is None:
            continue
        own = model(drawn.template)
        traps = own.traps[found.trap] if found.trap else ()
        env = solved(drawn, traps if isinstance(traps, tuple) else (traps,))
        known = symbols(drawn, env)
        right = {
            step.symbol.name: sympy.N(sympy.S(step.expr).xreplace(known), DIGITS)
            for step in own.steps
        }
        odd = [
            place
            for place, step in enumerate(found.steps)
            if not near(env[step.name], right[step.name])
        ]
        expected = odd[0] + 1 if odd else len(found.steps) + 1
        assert found("en").spec.correct == [expected]


@pytest.mark.parametrize("lang", ["en", "bn"])
def test_every_option_is_answered_and_every_mistake_named(draws, lang):
    for drawn in draws:
        if not load_level("transfer").is_applicable(drawn):
            continue
        question, key = compose_variant(drawn, lang, level="transfer", figures=False)
        for part, solution, spec in zip(question.parts, key.solution.parts, key.specs, strict=True):
            if solution.scheme:
                assert sum(line.points for line in solution.scheme) == part.points
                continue
            assert grade_answer(spec, solution.answer, lang=lang, decimal="point").credit == 1
            for letter, _ in part.field.options:
                verdict = grade_answer(spec, letter, lang=lang)
                assert verdict.credit or spec.why[lang][letter] in verdict.message
            for mistake in solution.mistakes:
                verdict = grade_answer(spec, mistake.value, lang=lang, decimal="point")
                assert verdict.note == f"trap:{mistake.name}"


@pytest.mark.parametrize("lang", ["en", "bn"])
def test_a_worked_solution_and_two_changes_are_introduced(lang):
    drawn = draw_variant(builtin_bank().template("diameter-stops-and-exposure-time"), 3)
    for part in (
        choose_faulty_solution(drawn)(lang),
        choose_comparison(Perturbations(drawn), None)(lang),
    ):
        assert [type(block) for block in part.body] == [Paragraph, ListBlock, Paragraph]
        assert inlines_to_text(part.body[0].children).endswith(":")
        assert all(len(inlines_to_text(text)) < 40 for _, text in part.options)


def test_no_step_with_a_wrong_formula_is_called_right():
    """Rounding gives the same as cutting off in about half of the four numbers."""
    places = set()
    for seed in range(40):
        drawn = draw_variant(builtin_bank().template("flat-field-correction-output"), seed)
        found = choose_faulty_solution(drawn)
        if found is None or not found.trap:
            continue
        wrong = {step.name for step in drawn.template.chain.traps[found.trap]}
        odd = [place for place, step in enumerate(found.steps) if step.name in wrong]
        why = found("en").spec.why["en"]
        assert found.place == odd[0]
        assert not any(
            why["ABCDEF"[place]].startswith(f"Step {place + 1} is right") for place in odd
        )
        places.add(found.trap)
    assert "rounded" in str(places)


def test_a_mistake_whose_value_cannot_be_written_is_left_out():
    """1 - (1/sqrt(a))^2*a is nought, but no number of digits shows it."""
    for seed in (18, 23, 34):
        drawn = draw_variant(builtin_bank().template("fold-over-radius"), seed)
        assert choose_faulty_solution(drawn)("en").spec.correct
        assert choose_faulty_solution(drawn).trap != "factor-zero"


POWERS = [
    ("x", "f*X/Z", {}, {"f": "1", "X": "1", "Z": "-1"}),
    ("c", "D*abs(s - z)/z", {"D": "f/N"}, {"f": "1", "N": "-1", "s": None, "z": None}),
    ("e", "q^2", {"q": "a/b", "a": "f/N", "b": "f/M"}, {"f": "0", "N": "-2", "M": "2"}),
    ("S", "N/s", {"s": "sqrt(N)"}, {"N": "1/2"}),
    ("y", "a + b", {"a": "2*x", "b": "x/3"}, {"x": "1"}),
    ("y", "0 + m", {"m": "x"}, {"x": "1"}),
    ("y", "log2(x)", {}, {"x": None}),
    ("y", "log2(x/z)", {"z": "3*x"}, {"x": "0"}),
    ("y", "2^x", {}, {"x": None}),
    ("y", "max(x, 2*x)", {}, {"x": "1"}),
    ("y", "floor(x)", {}, {"x": None}),
    ("y", "x + 1", {}, {"x": None}),
]


@together(("target", "formula", "before", "expected"), POWERS)
def test_a_power_is_what_the_formulas_prove(target, formula, before, expected):
    steps = {name: parse_formula(text) for name, text in {**before, target: formula}.items()}
    for quantity, power in expected.items():
        wanted = None if power is None else Fraction(power)
        assert scaling_exponent(target, quantity, steps) == wanted


def test_what_nobody_can_change_stays():
    """The wavelength of a laser fixes the height of the curve; nobody doubles that alone."""
    drawn = draw_variant(builtin_bank().template("two-lasers-flux-ratio"), 0)
    changed = {change.given for change in Perturbations(drawn).of(0, "r")}
    assert changed == {"P_1", "P_2"}


@pytest.mark.parametrize("name", ["opencv-stored-hue", "opencv-hue-shift", "uint8-sum"])
def test_a_program_prints_a_whole_number_after_a_change_too(name):
    for seed in range(12):
        changes = Perturbations(draw_variant(builtin_bank().template(name), seed))
        after = [change.after for change in changes.of(0, "c")]
        assert all(value.q == 1 for value in after)


def test_every_letter_that_a_question_names_has_a_name(template):
    drawn = draw_variant(template, 0)
    known = drawn.template.quantities
    changed = {
        change.given
        for _, target in askable_results(drawn)
        for change in Perturbations(drawn).of(0, target)
    }
    steps = {
        step.name
        for place in range(len(drawn.template.labels))
        for step in drawn.steps_of_part(place)
    }
    assert not [
        one for one in changed | steps for lang in ("en", "bn") if not known.name(one, lang)
    ]


def test_what_follows_from_a_quantity_cannot_stay_when_it_changes():
    """In the turned pixel red is the old blue: nobody can change only one of them."""
    drawn = draw_variant(builtin_bank().template("luma-before-and-after-turn"), 0)
    assert {change.given for change in Perturbations(drawn).of(1, "Y_t")} == set()
    assert {change.given for change in Perturbations(drawn).of(0, "Y_601")} <= {"R", "G", "B"}


def test_the_largest_of_two_depths_stays_the_largest():
    template = builtin_bank().template("weak-perspective-scale-error")
    for seed in range(20):
        for change in Perturbations(draw_variant(template, seed)).of(0, "s_2"):
            assert change.changed.shown["z_1"] < change.changed.shown["z_2"]


def test_answers_vary_over_the_seeds():
    template = builtin_bank().template("diameter-stops-and-exposure-time")
    drawn = [draw_variant(template, seed) for seed in range(40)]
    places = [choose_faulty_solution(one)("en").spec.correct[0] for one in drawn]
    factors = {str(choose_consequence(Perturbations(one)).change.factor) for one in drawn}
    pairs = {choose_comparison(Perturbations(one), None).answer for one in drawn}
    assert len(set(places)) >= 3
    assert len(factors) >= 3
    assert len(pairs) >= 2

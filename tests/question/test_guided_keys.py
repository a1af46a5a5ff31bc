"""Steps asked one by one: every key, mistake and formula worked out again by SymPy alone."""

from __future__ import annotations

import pytest
import sympy
from models import mistaken, near, solved
from sweep import draws, spread

from quizgen.bank.bank import builtin_bank
from quizgen.bank.variant import draw_variant
from quizgen.maths.constants import parse_exact
from quizgen.maths.numbers import format_for_key
from quizgen.maths.units import unit_factor
from quizgen.question.compose import compose_variant
from quizgen.question.levels import load_level
from quizgen.question.levels.guided import guided_stages
from quizgen.question.levels.steps import wrong_options
from quizgen.tradeoff.solving import draws_list

CALCULATING = [
    name for name in builtin_bank().template_paths
    if builtin_bank().rules(name).solver and "guided" in builtin_bank().rules(name).levels
]  # fmt: skip
SEEDS = [1, *(pytest.param(n, marks=pytest.mark.slow) for n in range(2, draws(2, full=8) + 1))]
UNITS_ALONE = [1, 180 / sympy.pi]
"""Between two values of one formula in different units; powers of ten also come by chance."""


@pytest.fixture(scope="module", params=spread(CALCULATING, 12, slow=20))
def template(request):
    return builtin_bank().template(request.param)


@pytest.fixture(scope="module", params=SEEDS)
def drawn(request, template):
    """One of a template that promises steps to ask for, and so has some in every draw."""
    found = draw_variant(template, request.param)
    if draws_list(found):
        pytest.skip("SymPy's model has no lists; tests/independent works these out with NumPy")
    assert load_level("guided").is_applicable(found)
    return found


def size(spec, label):
    """A unit of an answer in base units."""
    if spec.kind == "angle":
        return 1
    units = getattr(spec, "units", {})
    unit = units.get(label, "") if units else getattr(spec, "unit", "")
    return sympy.Rational(format_for_key(unit_factor(unit)))


def asked_values(spec):
    """Quantity, and value in base units, of whatever numbers a part asks for."""
    if hasattr(spec, "value"):
        yield spec.of[0], exactly(spec.value), size(spec, "")
    elif spec.kind == "point":
        yield from ((of, exactly(value), size(spec, of)) for of, value in zip(spec.of, spec.values, strict=True))  # fmt: skip
    elif spec.kind == "table":
        yield from ((spec.of[cell], exactly(value), size(spec, cell)) for cell, value in spec.values.items())  # fmt: skip


def exactly(text):
    return sympy.Rational(format_for_key(parse_exact(text)))


def test_every_number_that_is_asked_is_that_of_the_model(drawn):
    values = solved(drawn)
    _, key = compose_variant(drawn, "en", level="guided", figures=False)
    for spec in key.specs:
        for of, value, unit in asked_values(spec):
            assert near(value * unit, values[of]), (spec.kind, of)


def test_a_mistake_of_a_step_gives_what_the_model_makes_of_it(drawn):
    values = solved(drawn)
    before = {step.name for stage in guided_stages(drawn) for step in stage.before}
    _, key = compose_variant(drawn, "en", level="guided", figures=False)
    for spec in key.specs:
        if not hasattr(spec, "value") or spec.of[0] not in before:
            continue
        for trap, told in spec.traps.items():
            value = exactly(told) * size(spec, "")
            assert near(value, mistaken(drawn, values, trap, spec.of[0])), (spec.of, trap)


def test_a_wrong_formula_is_wrong_in_every_unit(drawn):
    """2·atan(W/(2·f)) is an angle; that it is one in radians makes it no wrong formula."""
    values = solved(drawn)
    for stage in guided_stages(drawn):
        if stage.formula is None:
            continue
        right = values[stage.formula.name]
        for way in wrong_options(drawn, stage.formula, stage.known):
            value = mistaken(drawn, values, way.trap, stage.formula.name)
            alike = [
                unit
                for unit in UNITS_ALONE
                if near(value * unit, right) or near(value, right * unit)
            ]
            assert not alike, (way.shown.typed_text, stage.formula.name)

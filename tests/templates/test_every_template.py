"""What must hold for each template: one parametrised proof over seeds, languages and mistakes."""

from __future__ import annotations

import itertools
import math

import mpmath
from sweep import IS_FULL, draws, spread, together

from quizgen.bank.bank import builtin_bank
from quizgen.bank.pools import count_pool_variants
from quizgen.bank.sampler import list_candidates, sampler_for, solve_candidate
from quizgen.bank.variant import Variant, draw_variant
from quizgen.lint.template_checks import lint_template
from quizgen.maths.numbers import to_float
from quizgen.maths.tree import Call, Expr, Num, Sym
from quizgen.question.part_context import ask_part
from quizgen.tradeoff.solving import draws_list

NAMES = list(builtin_bank().template_paths)
SEEDS = draws(2, full=1000)
DRAWS = 300
QUICKLY_COUNTED, MOST_COUNTED = 200, 60_000
"""Largest number of candidates that the default tests, and any tests, walk through for a pool."""


@together("name", spread(NAMES, 8))
def test_lint_finds_nothing(bank, name):
    template = bank.template(name)
    runs = any(part.answer["kind"] == "program" for part in template.rules.part)
    seeds = 1 if runs and not IS_FULL else SEEDS  # each draw runs a dozen programs
    report = lint_template(template, seeds, bank.languages)
    assert report.problems == []
    assert report.seeds == seeds


def test_every_template_is_written_in_every_language_of_the_bank(bank):
    for name in NAMES:
        assert set(bank.languages) <= set(bank.template(name).languages), name


MPMATH = {
    "add": lambda *a: mpmath.fsum(a), "mul": lambda *a: mpmath.fprod(a), "sub": lambda a, b: a - b,
    "neg": lambda a: -a, "div": lambda a, b: a / b, "pow": mpmath.power, "sqrt": mpmath.sqrt,
    "exp": mpmath.exp, "ln": mpmath.log, "log2": lambda a: mpmath.log(a, 2), "log10": mpmath.log10,
    "sin": mpmath.sin, "cos": mpmath.cos, "tan": mpmath.tan, "asin": mpmath.asin,
    "acos": mpmath.acos, "atan": mpmath.atan, "atan2": mpmath.atan2, "erf": mpmath.erf,
    "erfc": mpmath.erfc, "abs": abs, "sign": mpmath.sign, "floor": mpmath.floor,
    "ceil": mpmath.ceil, "mod": lambda a, b: a - b * mpmath.floor(a / b), "min": min, "max": max,
    "round": lambda a: mpmath.sign(a) * mpmath.floor(abs(a) + mpmath.mpf(1) / 2),
    "pi": lambda: +mpmath.pi, "eq": lambda a, b: a == b, "ne": lambda a, b: a != b,
    "lt": lambda a, b: a < b, "le": lambda a, b: a <= b, "gt": lambda a, b: a > b,
    "ge": lambda a, b: a >= b, "and": lambda *a: all(a), "or": lambda *a: any(a),
    "not": lambda a: not a,
}  # fmt: skip


def by_mpmath(expr: Expr, env):
    """An evaluator of our trees that shares nothing with ours: mpmath at 60 digits."""
    if isinstance(expr, Num):
        return mpmath.mpf(expr.value.numerator) / expr.value.denominator
    if isinstance(expr, Sym):
        return env[expr.name]
    if expr.op == "piecewise":
        for value, condition in zip(expr.args[:-1:2], expr.args[1::2], strict=True):
            if by_mpmath(condition, env):
                return by_mpmath(value, env)
        return by_mpmath(expr.args[-1], env)
    assert isinstance(expr, Call)
    return MPMATH[expr.op](*(by_mpmath(arg, env) for arg in expr.args))


@together("name", spread([n for n in NAMES if builtin_bank().rules(n).solver], 20))
def test_values_agree_with_mpmath_at_sixty_digits(bank, name):
    template = bank.template(name)
    with mpmath.workdps(60):
        for seed in range(15):
            one = draw_variant(template, seed)
            if draws_list(one):  # worked out by NumPy in tests/independent
                break
            env = {}
            for given in template.chain.given:
                value = one.values[given]
                env[given] = mpmath.mpf(int(value.p)) / int(value.q)
            for step in template.chain.steps:
                env[step.name] = by_mpmath(step.expr, env)
                ours = to_float(one.values[step.name])
                assert math.isclose(ours, float(env[step.name]), rel_tol=1e-14, abs_tol=1e-300)


def tried(name):
    """How many candidates a template has before any condition."""
    drawn = builtin_bank().rules(name).draw.values()
    return math.prod(
        max(len(list_candidates(r.pick, r.range, r.skip)), len(r.words), 1) for r in drawn
    )


COUNTED = [
    name for name in NAMES if builtin_bank().rules(name).pool and tried(name) <= MOST_COUNTED
]
QUICKLY = [name for name in COUNTED if tried(name) <= QUICKLY_COUNTED]
LONG = spread((name for name in COUNTED if name not in QUICKLY), 0, slow=12)


@together("name", [*QUICKLY, *LONG])
def test_the_pool_is_as_large_as_stated(bank, name):
    template = bank.template(name)
    plan = sampler_for(template)
    free = [v for v in plan.variables if v.choices]
    count = 0
    for values in itertools.product(*(v.choices for v in free)):
        shown, words = dict(zip((v.name for v in free), values, strict=True)), {}
        for variable in plan.variables:
            if variable.formula is not None:
                variable.derive(shown, words)
        kept = solve_candidate(plan, shown)
        if not isinstance(kept, str):
            count += count_pool_variants(Variant(template, "0", "0", 1, shown, words, *kept))
    assert count == template.rules.pool


@together("name", spread([n for n in NAMES if 1 < builtin_bank().rules(n).pool < DRAWS], 6))
def test_no_more_draws_differ_than_the_pool_holds(bank, name):
    template = bank.template(name)
    seen = {draw_variant(template, seed).identity for seed in range(DRAWS)}
    assert len(seen) <= bank.rules(name).pool


def choices():
    for name in NAMES:
        for index, part in enumerate(builtin_bank().rules(name).part):
            if part.answer["kind"] == "choice" and not part.answer.get("in_order"):
                yield name, index


@together(("name", "index"), spread(choices(), 8, slow=12))
def test_the_right_choice_stands_anywhere(bank, name, index):
    """Position of the right option over seeds: no place more than five deviations off its share."""
    template = bank.template(name)
    seen = [
        ask_part(draw_variant(template, seed, "place"), index).spec.correct[0]
        for seed in range(DRAWS)
    ]
    answer = template.rules.part[index].answer
    places = answer.get("take") or len(answer["options"])
    share = DRAWS / places
    deviation = math.sqrt(share * (1 - 1 / places))
    for place in range(1, places + 1):
        assert abs(seen.count(place) - share) < 5 * deviation

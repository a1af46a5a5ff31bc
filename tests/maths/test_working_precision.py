"""Certified values do not depend on the process: neither on threads nor on FLINT's own precision."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor

import mpmath
import pytest
from flint import arb, ctx, fmpq

from quizgen.maths.chain import Chain, ChainStep
from quizgen.maths.notation import parse_formula
from quizgen.maths.number_systems import compile_expr, evaluate, exact_system
from quizgen.maths.numbers import decimal_exponent, format_for_key, format_rounded, round_to
from quizgen.maths.precision import PRECISION, working_precision

CHAIN = Chain(
    given={"x": "", "y": ""},
    steps=(
        ChainStep("r", parse_formula("sqrt(x^2 + y^2)")),
        ChainStep("a", parse_formula("atan2(y, -x) + exp(-r)")),
        ChainStep("d", parse_formula("abs(-r - a)/ln(2 + r)")),
        ChainStep("side", parse_formula("piecewise(sin(d), d > 3/7, cos(d))")),
    ),
    traps={"slip": (ChainStep("r", parse_formula("sqrt(x + y)")),)},
)


def by_mpmath(x: int, y: int, *, slip: bool = False) -> dict[str, str]:
    """The same chain at 60 digits by another library."""
    with mpmath.workdps(60):
        r = mpmath.sqrt(x + y) if slip else mpmath.sqrt(x * x + y * y)
        a = mpmath.atan2(y, -x) + mpmath.exp(-r)
        d = (r + a) / mpmath.log(2 + r)
        side = mpmath.sin(d) if d > mpmath.mpf(3) / 7 else mpmath.cos(d)
        return {n: mpmath.nstr(v, 38) for n, v in {"r": r, "a": a, "d": d, "side": side}.items()}


def agrees(text: str, expected: str) -> bool:
    return abs(mpmath.mpf(text) - mpmath.mpf(expected)) < mpmath.mpf(10) ** -35


def texts(x: int, y: int) -> dict[str, str]:
    solved = CHAIN.solve({"x": fmpq(x), "y": fmpq(y)})
    return {name: format_for_key(value) for name, value in solved.items()}


@pytest.fixture(params=[20, 53, 1000])
def disturbed(request):
    before = ctx.prec
    ctx.prec = request.param
    yield request.param
    assert ctx.prec == request.param
    ctx.prec = before


def test_a_chain_is_solved_to_forty_digits(disturbed):
    expected = by_mpmath(3, 7)
    found = texts(3, 7)
    with mpmath.workdps(60):
        assert all(agrees(found[name], text) for name, text in expected.items())


def test_so_is_a_trap(disturbed):
    solved = CHAIN.solve({"x": fmpq(3), "y": fmpq(7)})
    trapped = CHAIN.solve_with_misconception("slip", solved)
    with mpmath.workdps(60):
        for name, text in by_mpmath(3, 7, slip=True).items():
            assert agrees(format_for_key(trapped[name]), text)


def test_rounding_reads_no_outer_precision(disturbed):
    root = evaluate(parse_formula("sqrt(2)*10^9"), {})
    assert format_rounded(root, decimals=20) == "1414213562.37309504880168872421"
    negative = evaluate(parse_formula("-sqrt(2)*10^9"), {})
    assert format_rounded(negative, figures=12) == "−1414213562.37"
    assert round_to(root, 25).q == 10**25
    assert (
        format_rounded(evaluate(parse_formula("sqrt(2)*10^-20"), {}), figures=12)
        == "1.41421356237e-20"
    )


def test_size_is_certified_beside_a_power_of_ten(disturbed):
    with working_precision():
        root = arb(2).sqrt()
        above, below = 1000 + root * fmpq(1, 10**30), 1000 - root * fmpq(1, 10**30)
    assert decimal_exponent(above) == 3
    assert decimal_exponent(below) == 2


def test_a_compiled_formula_states_its_precision(disturbed):
    third = compile_expr(parse_formula("-abs(-sqrt(2)/3)"), exact_system())({})
    assert third.rel_accuracy_bits() > PRECISION - 8


def test_a_compiled_formula_keeps_the_precision_around_it():
    with working_precision(600):
        assert compile_expr(parse_formula("sqrt(2)"), exact_system())({}).rel_accuracy_bits() > 590


def test_precision_nests_and_returns_after_an_error():
    before = ctx.prec
    with working_precision(100):
        with pytest.raises(ZeroDivisionError), working_precision(300):
            1 / (ctx.prec - 300)
        assert ctx.prec == 100
    assert ctx.prec == before


def test_six_threads_find_what_one_finds():
    pairs = [(x, y) for x in range(1, 21) for y in range(1, 11)]
    alone = [texts(x, y) for x, y in pairs]
    before = ctx.prec

    def disturbing(pair: tuple[int, int]) -> dict[str, str]:
        with working_precision(24 + 40 * pair[1]):
            arb(pair[0]).sqrt()
        return texts(*pair)

    with ThreadPoolExecutor(6) as pool:
        assert list(pool.map(disturbing, pairs * 3)) == alone * 3
    assert ctx.prec == before


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_forked_child_can_work_while_a_thread_of_its_parent_holds_the_precision():
    import multiprocessing
    import threading
    import time

    stop = threading.Event()

    def busy() -> None:
        while not stop.is_set():
            texts(3, 7)

    thread = threading.Thread(target=busy)
    thread.start()
    try:
        context = multiprocessing.get_context("fork")
        for _ in range(10):
            child = context.Process(target=texts, args=(3, 7))
            child.start()
            child.join(20)
            assert child.exitcode == 0
            time.sleep(0.001)
    finally:
        stop.set()
        thread.join()

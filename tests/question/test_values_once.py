"""Values are computed once per draw, under one precision: whatever the process does with FLINT."""

from __future__ import annotations

import json
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import cache, cached_property

import flint
import mpmath
import pytest
from sweep import together

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.bank.variant import draw_variant
from quizgen.grading.options import QuestionContext
from quizgen.maths.precision import working_precision
from quizgen.paper.answer_key import parse_answer_key, write_answer_key
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.grading import grade_paper
from quizgen.paper.paper import build_paper, single_question_paper

SEEDS = range(3)
BANK = builtin_bank()


@cache
def irrational():
    """Templates with values that no fraction is."""
    found = [
        name
        for name in BANK.template_paths
        if any(
            isinstance(v, flint.arb) for v in draw_variant(BANK.template(name), 0).values.values()
        )
    ]
    assert len(found) >= 5
    return found


@contextmanager
def disturbed(bits):
    """The process's own precision, as another library might leave it."""
    before = flint.ctx.prec
    flint.ctx.prec = bits
    try:
        yield
    finally:
        flint.ctx.prec = before


def key(name, seed):
    return write_answer_key(single_question_paper(BANK.template(name), seed, "en", figures=False))


@pytest.fixture(scope="module")
def expected():
    """Keys of every template with irrational values."""
    with disturbed(53):
        return {(name, seed): key(name, seed) for name in irrational() for seed in SEEDS}


@pytest.mark.parametrize("bits", [2, 20, 1000])
def test_a_key_is_the_same_at_any_precision_of_the_process(expected, bits):
    with disturbed(bits):
        found = {one: key(*one) for one in expected}
    assert [one for one in expected if found[one] != expected[one]] == []


@pytest.mark.parametrize("threads", [2, 6])
def test_keys_are_the_same_from_any_number_of_threads(expected, threads):
    asked = list(expected) * 3
    with ThreadPoolExecutor(threads) as pool:
        found = list(pool.map(lambda one: key(*one), asked))
    for one, got in zip(asked, found, strict=True):
        assert got == expected[one], one


def test_a_paper_is_the_same_at_any_precision_and_in_threads():
    def paper(bits):
        with disturbed(bits):
            return write_answer_key(
                build_paper(BANK, load_blueprint("mock"), 11, "en", figures=False)
            )

    found = paper(53)
    assert paper(20) == found
    assert paper(1000) == found
    with ThreadPoolExecutor(3) as pool:
        assert set(pool.map(lambda _: write_answer_key(
            build_paper(BANK, load_blueprint("mock"), 11, "en", figures=False)), range(3))) == {found}  # fmt: skip


@together("seed", range(6))
def test_decibels_hold_forty_certified_digits(seed):
    """N photons have a ratio of sqrt N to one, 20 log10 of which is in decibels."""
    one = draw_variant(BANK.template("photon-snr-and-decibels"), seed)
    made = single_question_paper(
        BANK.template("photon-snr-and-decibels"), seed, "en", figures=False
    )
    with mpmath.workdps(60):
        level = 20 * mpmath.log10(mpmath.sqrt(int(one.shown["N_2"].p)))
        digits(made.items[0].keys[0].specs[1].value, level)


@together("seed", range(6))
def test_tails_hold_forty_certified_digits(seed):
    """Outside k standard deviations lies erfc(k / sqrt 2); megapixels times it is a count."""
    template = BANK.template("gaussian-peak-and-tail-shares")
    one, made = (
        draw_variant(template, seed),
        single_question_paper(template, seed, "en", figures=False),
    )
    _, share, count = made.items[0].keys[0].specs
    with mpmath.workdps(60):
        shown = {name: mpmath.mpf(int(v.p)) / int(v.q) for name, v in one.shown.items()}
        digits(share.value, mpmath.erfc(shown["a"] / mpmath.sqrt(2)))
        digits(count.value, shown["M"] * 10**6 * mpmath.erfc(shown["b"] / mpmath.sqrt(2)))


def digits(text, value):
    """A key's text is the value, exactly or to within one unit of its fortieth digit."""
    assert len(text.replace(".", "").lstrip("0")) == 40 or mpmath.mpf(text) == value, text
    assert abs(mpmath.mpf(text) / value - 1) < mpmath.mpf(10) ** -39


def test_a_shown_value_is_computed_once(monkeypatch):
    one = draw_variant(BANK.template("gaussian-peak-and-tail-shares"), 0)
    first = one.shown_values
    monkeypatch.setattr(type(one.sampler), "in_shown_units", None)
    assert one.shown_values is first
    text = one.format_value("N")
    monkeypatch.setitem(first, "N", None)
    assert one.format_value("N") == text


def test_no_cached_property_states_a_precision(monkeypatch):
    """A cached property has a lock of its own for all instances (up to Python 3.11): whoever waits
    in it for the precision, while the one who holds that waits for the property, waits for ever."""
    fill = cached_property.__get__.__code__
    entered, faults = working_precision.__enter__, set()

    def watched(self):
        frame, below = sys._getframe(1), ""
        while frame is not None:
            if frame.f_code is fill:
                faults.add(below)
            frame, below = frame.f_back, frame.f_code.co_qualname
        return entered(self)

    monkeypatch.setattr(working_precision, "__enter__", watched)
    bank = Bank(BANK.root, trusted=True)
    for name in irrational():
        key = parse_answer_key(
            json.loads(
                write_answer_key(single_question_paper(bank.template(name), 7, "en", figures=False))
            )
        )
        grade_paper(key, {part.id: "1.25" for q in key.questions for part in q.parts})
    assert not faults


def test_every_number_of_a_question_is_solved_once(monkeypatch):
    template = BANK.template("gaussian-peak-and-tail-shares")
    context = QuestionContext(template.chain, dict(draw_variant(template, 0).shown))
    first = context.solved_values
    monkeypatch.setattr(type(template.chain), "solve", None)
    assert context.solved_values is first

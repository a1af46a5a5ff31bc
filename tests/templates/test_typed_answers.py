"""Every template of the bank: what is printed counts, what lies beyond the tolerance does not."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from functools import cache

import pytest
from msgspec import to_builtins
from sweep import draws, together

from quizgen.bank.bank import builtin_bank
from quizgen.kinds.grade import grade_answer, load_spec, show_key
from quizgen.question.compose import draw_instance
from quizgen.question.part_context import ask_part

EVERY_WAY = 6
"""Draws whose answers are typed in every way; those of the others in one way in turn."""
SEEDS = [2, pytest.param(draws(5, full=500), marks=pytest.mark.slow)]
BANGLA = str.maketrans("0123456789", "০১২৩৪৫৬৭৮৯")
IN_PROCESSES = {"program"}  # test_programs_run.py
NOT_TYPED_BACK = {"rubric", "witness"}  # no single printed answer
TEMPLATES = list(builtin_bank().template_paths)


@cache
def draw_parts(name, seeds):
    """Specs of every part, one list per seed: drawn once, used by all tests of a template."""
    template = builtin_bank().template(name)
    return [
        [to_builtins(ask_part(drawn, index).spec) for index in range(len(template.rules.part))]
        for drawn in (draw_instance(template, seed) for seed in range(seeds))
    ]


def tables(parts, most=None):
    for drawn in parts[:most]:
        yield from drawn


@together("seeds", SEEDS)
@together("name", TEMPLATES)
def test_printed_answer_typed_back_is_correct(name, seeds):
    for seed, drawn in enumerate(draw_parts(name, seeds)):
        for table in drawn:
            if table["kind"] in NOT_TYPED_BACK | IN_PROCESSES:
                continue
            spec = load_spec(table)
            ways = ways_to_type(table["kind"], show_key(spec))
            for decimal, text in ways if seed < EVERY_WAY else [ways[seed % len(ways)]]:
                verdict = grade_answer(spec, text, decimal=decimal)
                assert verdict.verdict == "correct", (table, text, verdict)


def ways_to_type(kind, printed):
    """The printed answer with either decimal sign and either digits."""
    styles = [("auto", printed), ("point", printed), ("comma", printed.replace(".", ","))]
    if kind in {"code", "sketch"}:
        styles.pop()  # a program prints a point wherever it runs, a comma parts x from y
    return styles + [(decimal, text.translate(BANGLA)) for decimal, text in styles]


def shaped(table, value):
    """The key's own notation for a wrong answer."""
    if table["kind"] == "derivation":
        value = {"wrong": {"forms": value}}
    name = next(one for one in ("value", "lines", "values") if one in table)
    plain = {k: v for k, v in table.items() if k not in {"traps", "notes", "accept"}}
    return show_key({**plain, name: value})


@together("seeds", SEEDS)
@together("name", TEMPLATES)
def test_typed_traps_are_named_and_never_misnamed(name, seeds):
    named: Counter[str] = Counter()
    for table in tables(draw_parts(name, seeds)):
        spec = load_spec(table)
        for trap, value in table.get("traps", {}).items():
            named_by_answer = {"choice", "multi", "match", "order", "code", "expression", "witness"}
            if table["kind"] in named_by_answer | IN_PROCESSES:
                continue
            verdict = grade_answer(spec, shaped(table, value))
            assert verdict.verdict != "correct"
            hit = verdict.note == f"trap:{trap}"
            assert hit or not verdict.note.startswith("trap:"), (table, trap, verdict)
            named["yes" if hit else "no"] += 1
    assert named["yes"] >= 0.95 * named.total()


def width(table, key):
    """The documented tolerance, worked out here on its own; None for the default."""
    if "decimals" in table:
        return Fraction(str(table.get("within", 1))) / 10 ** table["decimals"]
    if "rel" in table:
        return Fraction(str(table["rel"])) * abs(key)
    if "abs" in table:
        return Fraction(str(table["abs"]))
    return Fraction(0) if table.get("exact") else None


def printed(table, key):
    """The key as it is printed: rounded half away from zero where decimals are asked."""
    if "decimals" not in table:
        return key
    scale = 10 ** table["decimals"]
    return Fraction(int(abs(key) * scale + Fraction(1, 2)), scale) * (1 if key >= 0 else -1)


def typed(value, table):
    unit = table["unit"] if table["kind"] == "quantity" else ""
    percent = "%" if table.get("percent") else ""
    return f"{value.numerator}/{value.denominator} {unit}{percent}".strip()


@together("seeds", SEEDS)
@together("name", TEMPLATES)
def test_the_bound_counts_and_beyond_it_does_not(name, seeds):
    for table in tables(draw_parts(name, seeds), 40):
        if table["kind"] not in {"number", "quantity"} or "accept" in table:
            continue
        key = Fraction(table["value"]) * (100 if table.get("percent") else 1)
        reach = width(table, key)
        if reach is None or len(table["value"]) > 30:
            continue
        step = max(reach, abs(key), Fraction(1)) / 10**9
        for sign in (1, -1):
            # what is printed is right within the same bound, too
            centre = max((key, printed(table, key)), key=lambda value: sign * value)
            on, beyond = key + sign * reach, centre + sign * (reach + step)
            assert grade_answer(table, typed(on, table)).verdict == "correct", (table, on)
            assert grade_answer(table, typed(beyond, table)).verdict != "correct", (table, beyond)

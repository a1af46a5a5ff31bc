"""What stands on the printed page is enough, and right: solvers that share no code find the key.

A page is rendered, read back as text (``printed_page``), worked out from the formulas of the notes
(``hand_*``) and compared with ``key.json`` within what the page itself allows (``printed_key``).
"""

from __future__ import annotations

import ast
import json
import tomllib
from collections.abc import Iterator
from fractions import Fraction
from functools import lru_cache
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from by_hand import SOLVERS, WITH_FIGURE
from printed_key import OWED, agrees
from printed_numbers import APERTURE, numbers
from printed_page import Page, pages
from sweep import draws, together

from quizgen.bank.bank import Bank
from quizgen.paper.answer_key import write_answer_key
from quizgen.paper.blueprint import Blueprint, SlotRule
from quizgen.paper.paper import build_paper
from quizgen.render import render_paper

LANGS = ("en", "bn")
QUICK = (1,)
SEEDS = [pytest.param(n, marks=pytest.mark.slow) for n in range(1, draws(1, full=50) + 1)]
HERE = Path(__file__).parent
for module in sorted(HERE.glob("hand_*.py")):
    import_module(module.stem)  # each enters its solvers in the table

REASONS = tomllib.loads((HERE / "not_computed.toml").read_text(encoding="utf-8"))
"""Templates in which no answer follows from numbers on the page, by the reason."""
LISTED = [name for names in REASONS.values() for name in names]

SPELLED = {"twice as much": 2, "three by three": 3, "array of tens": 10}
"""Numbers that one language writes as a word."""


Printed = list[tuple[str, Page, dict[str, Any]]]


def printed(bank: Bank, names: list[str], seed: int, lang: str, *, figures: bool) -> Printed:
    """The questions of some templates as they stand on the page, with what the key has of them."""
    slots = tuple(SlotRule(templates=(name,)) for name in names)
    blueprint = Blueprint({"en": "Everything"}, slots, name="everything", source="everything")
    paper = build_paper(bank, blueprint, seed, lang, figures=figures)
    keys = json.loads(write_answer_key(paper))["questions"]
    assert [key["template"] for key in keys] == names
    return list(zip(names, pages(render_paper(paper, "exam", "html")), keys, strict=True))


@lru_cache(len(LANGS))
def every_page(bank: Bank, seed: int, lang: str) -> Printed:
    """Each template; pictures are drawn only where a solver looks at them, for they take time."""
    names = [name for name in bank.template_paths if name in SOLVERS or seed in QUICK]
    groups = (
        ([name for name in names if (name in WITH_FIGURE) == figures], figures)
        for figures in (False, True)
    )
    return [one for group, figures in groups
            for one in printed(bank, group, seed, lang, figures=figures)]  # fmt: skip


def worked_out(name: str, page: Page, key: dict[str, Any]) -> Iterator[tuple[str, Any, Any, str]]:
    """The parts that were worked out: all that a number answers, and choices that follow."""
    mine = SOLVERS[name](page)
    specs = {part["id"].lstrip("0123456789") or "a": part["spec"] for part in key["parts"]}
    owed = {part for part, spec in specs.items() if spec["kind"] in OWED}
    assert owed <= set(mine) <= set(specs), f"{name}: {owed - set(mine)} is not worked out"
    for part, answer in mine.items():
        yield part, answer, specs[part], page.parts[part].hint


def disagreeing(page: Page, name: str, key: dict[str, Any]) -> list[tuple[str, str, Any]]:
    """The parts of a page whose answer is not the key's."""
    if name not in SOLVERS:
        return []
    found = worked_out(name, page, key)
    return [(name, part, mine) for part, mine, spec, hint in found if not agrees(mine, spec, hint)]


@pytest.mark.parametrize("seed", SEEDS)
def test_the_page_leads_to_the_key_in_both_languages(bank, seed):
    both = [every_page(bank, seed, lang) for lang in LANGS]
    assert not [
        wrong for one in both for name, page, key in one for wrong in disagreeing(page, name, key)
    ]
    assert not differing(*both)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [51])
def test_the_words_of_figures_agree_with_the_page(bank, seed):
    """With all figures: a value that a figure names otherwise than the text is found."""
    both = [printed(bank, list(bank.template_paths), seed, lang, figures=True) for lang in LANGS]
    assert not [
        wrong for one in both for name, page, key in one for wrong in disagreeing(page, name, key)
    ]
    assert not differing(*both)


def differing(one: Printed, other: Printed) -> list[tuple[str, set[Fraction]]]:
    """The templates whose pages show different numbers, with these numbers."""
    both = [(a[0], met(a[1]) ^ met(b[1])) for a, b in zip(one, other, strict=True)]
    return [(name, numbers) for name, numbers in both if numbers]


def met(page: Page) -> set[Fraction]:
    """All numbers a reader meets on a page, those behind ``f/`` among them."""
    text = "\n".join([page.everything, *(part.hint for part in page.parts.values())])
    spelled = {Fraction(value) for word, value in SPELLED.items() if word in text}
    return {*numbers(text), *map(Fraction, APERTURE.findall(text)), *spelled}


@pytest.mark.slow
def test_a_wrong_key_would_be_found(bank):
    believed = [
        (name, part)
        for name, page, key in every_page(bank, 1, "en")
        if name in SOLVERS
        for part, answer, spec, hint in worked_out(name, page, key)
        if agrees(answer, spoiled(spec), hint)
    ]
    assert not believed


def spoiled(spec: dict[str, Any]) -> dict[str, Any]:
    """A specification that asks for another answer."""
    return {**spec, **(_other_lines(spec) or _other_number(spec) or _other_words(spec))}


def _other_lines(spec: dict[str, Any]) -> dict[str, Any]:
    """What a known mistake draws, derives or writes, where that is asked."""
    field = next((name for name in ("lines", "solution") if name in spec), "")
    if not field or not spec.get("traps"):
        return {}
    wrong = next(iter(spec["traps"].values()))
    if spec["kind"] == "derivation":
        return {"lines": {"wrong": {"forms": wrong}}, "traps": {}}
    return {field: wrong}


def _other_number(spec: dict[str, Any]) -> dict[str, Any]:
    match spec:
        case {"value": str(formula), "symbols": _}:
            return {"value": f"1.001*({formula})"}
        case {"value": value}:
            beyond = Fraction((spec.get("accept") or [0, value])[1]) * 2
            return {"value": _other(value), "accept": [str(beyond), str(beyond * 2)]}
        case {"values": dict(values)}:
            return {"values": {name: _other(value) for name, value in values.items()}}
        case {"values": [first, *rest]}:
            return {"values": [_other(first), *rest]}
    return {}


def _other_words(spec: dict[str, Any]) -> dict[str, Any]:
    match spec:
        case {"correct": correct}:
            return {"correct": [place + 1 for place in correct]}
        case {"pairs": pairs}:
            return {"pairs": dict(zip(pairs, reversed(list(pairs.values())), strict=True))}
        case {"output": output}:
            return {"output": f"{output}0"}
        case {"steps": steps}:
            return {"steps": steps[::-1], "before": []}
        case {"accept": [_, *rest]}:
            return {"accept": [["neither"], *rest]}
        case {"symbols": _}:
            return {"where": ["1 = 2"]}
    raise AssertionError(f"no other answer is known for {spec['kind']}")


def _other(value: str) -> str:
    return str(Fraction(value) * Fraction("1.61") + 1)


def test_every_template_is_worked_out_or_listed_with_its_reason(bank):
    """Add a function to ``hand_*.py``, or the name to ``not_computed.toml``."""
    for name in bank.template_paths:
        assert (name in SOLVERS) + LISTED.count(name) == 1, name
        kinds = {part.answer["kind"] for part in bank.rules(name).part}
        assert name in SOLVERS or not kinds & OWED, name


def test_no_solver_is_left_over(bank):
    assert {*SOLVERS, *LISTED} <= set(bank.template_paths)


@together("path", sorted(HERE.glob("[bhp]*.py")))
def test_solvers_and_readers_share_no_code_with_the_product(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    named = {node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    named |= {
        one.name for node in ast.walk(tree) if isinstance(node, ast.Import) for one in node.names
    }
    assert not {name.partition(".")[0] for name in named} & {"quizgen", "solvers"}

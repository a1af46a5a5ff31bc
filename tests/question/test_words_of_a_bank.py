"""Words of a subject come from its bank through the key; the engine knows none."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from sweep import together

import quizgen.grading
from quizgen.bank.language_file import parse_language_file
from quizgen.bank.metadata import BankMetadata
from quizgen.bank.rules import PartRule, Rules
from quizgen.bank.template import Template
from quizgen.bank.variant import draw_variant
from quizgen.core.errors import BankError
from quizgen.maths.chain import Chain, ChainStep
from quizgen.maths.notation import parse_formula
from quizgen.question.part_context import ask_part

ABOUT = BankMetadata(terms=("proton", "phonon", "zebra"), counted={"sheep": ("sheep", "ভেড়া")})
TEXT = "# Words\nFill in.\n\n## gaps\n- light: photon\n"


def template(answer: dict[str, object]) -> Template:
    rules = Rules(topic="t", tier="A", part=(PartRule(answer=answer),))
    chain = Chain(
        {}, (ChainStep("n", parse_formula("3*4"), ""), ChainStep("p", parse_formula("2*4"), "px"))
    )
    texts = {"en": parse_language_file(TEXT)}
    return Template(f"words-{answer}", rules, chain, texts, f"{answer}", Path("bank"), ABOUT)


def spec(answer: dict[str, object]):
    return ask_part(draw_variant(template(answer), 1), 0).spec


def test_a_gap_takes_the_terms_that_could_be_its_own_misspelt():
    assert spec({"kind": "gap", "gaps": ["light"]}).terms == ["proton", "phonon"]


@together(
    ("answer", "counts"),
    [
        ({"kind": "number", "of": "n", "counts": "sheep"}, ["sheep", "ভেড়া"]),
        ({"kind": "number", "of": "n", "counts": ["px", "sheep"]}, ["px", "sheep", "ভেড়া"]),
        ({"kind": "number", "of": "n"}, []),
        ({"kind": "number", "of": "p"}, ["px"]),
        ({"kind": "number", "of": "p", "counts": "sheep"}, ["sheep", "ভেড়া"]),
        ({"kind": "point", "of": ["n", "n"], "counts": "sheep"}, ["sheep", "ভেড়া"]),
        ({"kind": "table", "of": ["n", "p"], "counts": {"n": "sheep"}}, {"n": ["sheep", "ভেড়া"]}),
    ],
)
def test_what_is_counted_is_named_by_the_bank(answer, counts):
    assert spec(answer).counts == counts


@pytest.mark.parametrize("counts", ["cows", ["sheep", "cows"]])
def test_what_nobody_knows_is_refused(counts):
    with pytest.raises(BankError, match=r"cows.*neither a unit nor in bank\.toml"):
        spec({"kind": "number", "of": "n", "counts": counts})


GENERAL = {
    "constant", "electron", "interval", "inverse", "negative", "photon", "positive", "solution",
}  # fmt: skip
"""Terms that are also notes, kinds, domains or units of the engine."""


def test_the_engine_holds_no_term_of_the_bank(bank):
    terms = {*bank.metadata.terms} - GENERAL
    assert len(terms) > 90
    for file in Path(quizgen.grading.__path__[0]).rglob("*.py"):
        nodes = ast.walk(ast.parse(file.read_text("utf-8")))
        texts = {node.value for node in nodes if isinstance(node, ast.Constant)}
        assert not texts & terms, file

"""``key.json``: everything that marking needs, written and read by the same structs."""

from __future__ import annotations

import json
from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
from flint import fmpq

from quizgen.core.decoding import convert
from quizgen.core.errors import FormulaError, KeyFileError
from quizgen.core.files import read_table
from quizgen.grading.options import QuestionContext
from quizgen.grading.spec import AnySpec
from quizgen.kinds.contract import MOST_POINTS
from quizgen.kinds.grade import load_spec
from quizgen.locale import register_languages
from quizgen.maths.chain import Chain, ChainStep
from quizgen.maths.constants import parse_exact
from quizgen.maths.numbers import parse_written_number
from quizgen.maths.precision import working_precision
from quizgen.maths.recipes import decode_form, decode_recipe
from quizgen.maths.tree import Expr
from quizgen.maths.units import UnitRegistry, build_unit_registry
from quizgen.maths.values import map_numbers
from quizgen.paper.code import content_digest
from quizgen.paper.provenance import BankRecord

if TYPE_CHECKING:
    from quizgen.paper.paper import Paper, PaperItem

FORMAT = "quizgen-key/2"
UNORDERED = frozenset({"notes", "traps"})
"""Mappings of a specification whose entries are only ever looked up by name."""


class KeyGiven(msgspec.Struct):
    """A drawn number, or a list of them, in base units, and the unit it is shown in."""

    value: str | list[str]
    unit: str = ""

    def parse_value(self) -> Any:
        """Return the number, or the list as a tuple, exactly.

        Raises
        ------
        FormulaError
            If it cannot be read.
        """
        value = self.value if isinstance(self.value, str) else tuple(self.value)
        return map_numbers(parse_exact, value)


class KeyChain(msgspec.Struct, omit_defaults=True):
    """The chain of a question as plain formulas.

    ``define`` holds units of the bank's own. ``checked`` are steps whose values were computed
    twice and compared, but are not proved. ``alternatives`` are other right formulas of steps.
    ``forms`` are formulas over ``free`` names, matrices and the like; ``recipes`` say how steps and
    forms follow from other forms.
    """

    given: dict[str, KeyGiven]
    steps: list[tuple[str, str, str]]
    define: list[str] = []
    checked: list[str] = []
    alternatives: list[tuple[str, str]] = []
    forms: dict[str, Any] = {}
    recipes: dict[str, list[Any]] = {}
    free: list[str] = []

    def units(self) -> dict[str, str]:
        """Return the shown unit of each quantity, by name."""
        given = {name: given.unit for name, given in self.given.items()}
        return given | {name: unit for name, _, unit in self.steps}

    def context(
        self, earlier: Mapping[str, fmpq], forms: Mapping[str, Expr] | None = None
    ) -> QuestionContext:
        """Return the question around a part, with the student's earlier values and forms.

        Raises
        ------
        FormulaError
            If a formula cannot be read.
        ValueError
            If a form or a recipe is none.
        """
        units = tuple((name, given.unit) for name, given in self.given.items())
        others = tuple((name, formula, "") for name, formula in self.alternatives)
        chain = _build_chain(units, tuple(map(tuple, self.steps)), others)
        values = {name: given.parse_value() for name, given in self.given.items()}
        if self.forms:
            chain = self._add_forms(chain)
        return QuestionContext(chain, values, earlier, forms or {})

    def _add_forms(self, chain: Chain) -> Chain:
        """Return the chain with its forms, and with the recipes of its steps."""
        recipes = {name: decode_recipe(written) for name, written in self.recipes.items()}
        if {use.of for recipe in recipes.values() for use in recipe.uses} - self.forms.keys():
            raise ValueError("a recipe uses a form that there is not")
        forms = [
            ChainStep(name, decode_form(written), recipe=recipes.get(name))
            for name, written in self.forms.items()
        ]
        steps = [
            msgspec.structs.replace(step, recipe=recipes.get(step.name)) for step in chain.steps
        ]
        return msgspec.structs.replace(
            chain, steps=tuple(steps), forms=tuple(forms), free=tuple(self.free)
        )


@lru_cache(maxsize=512)
def _build_chain(
    units: tuple[tuple[str, str], ...],
    steps: tuple[tuple[str, str, str], ...],
    alternatives: tuple[tuple[str, str, str], ...],
) -> Chain:
    """Return a chain, built once for all students of a paper."""
    from quizgen.maths.notation import parse_formula

    right, others = (
        tuple(ChainStep(name, parse_formula(formula), unit) for name, formula, unit in rows)
        for rows in (steps, alternatives)
    )
    return Chain(dict(units), right, alternatives=others)


@lru_cache(maxsize=256)
def _parse_points(text: str) -> Fraction:
    """Return points as an exact number, cached: a class has few different ones."""
    return parse_written_number(text)


class KeyPart(msgspec.Struct, dict=True):
    """One answer field; not to be changed once its specification has been parsed.

    Objects of JSON have no order, but cells of a table are asked and typed in one: ``order`` holds
    the names of every mapping of ``spec`` as a list.
    """

    id: str
    points: str
    spec: dict[str, Any]
    order: dict[str, list[str]] = {}

    def points_exact(self) -> Fraction:
        """Return the points as an exact number."""
        return _parse_points(self.points)

    def parse_spec(self, *, proven: bool = False) -> AnySpec:
        """Return the specification that answers are judged by, parsed once for all who answer.

        Parameters
        ----------
        proven : bool
            Whether the key is known to be as it was written.

        Raises
        ------
        KeyFileError
            Naming the field that is wrong.
        """
        # Not a cached property: its lock would be held while the precision is waited for.
        spec: AnySpec | None = self.__dict__.get("_parsed")
        if spec is None:
            spec = self.__dict__["_parsed"] = load_spec(self._ordered_spec(), proven=proven)
        return spec

    def _ordered_spec(self) -> dict[str, Any]:
        """Return the specification with its mappings in their order.

        Raises
        ------
        KeyFileError
            If the order is not one of the names there are.
        """
        for field, names in self.order.items():
            mapping = self.spec.get(field)
            if not isinstance(mapping, dict) or sorted(mapping) != sorted(names):
                raise KeyFileError(f"order.{field} does not hold the names of spec.{field}")
        sorted_out = {
            field: {name: self.spec[field][name] for name in names}
            for field, names in self.order.items()
        }
        return {**self.spec, **sorted_out}


class KeyQuestion(msgspec.Struct):
    """One question of the key."""

    number: str
    parts: list[KeyPart]
    points: str = ""
    template: str = ""
    identity: str = ""
    topic: str = ""
    tier: str = ""
    title: dict[str, str] = {}
    chain: KeyChain | None = None

    def known_units(self) -> UnitRegistry:
        """Return the units of its chain: those listed, and those that its bank defines."""
        return build_unit_registry(tuple(self.chain.define) if self.chain else ())


class AnswerKey(msgspec.Struct):
    """Everything that grading a paper needs, as ``key.json`` holds it."""

    format: str
    questions: list[KeyQuestion]
    code: str = ""
    paper: str = ""
    title: dict[str, str] = {}
    langs: tuple[str, ...] = ("en",)
    banks: tuple[BankRecord, ...] = ()


def make_answer_key(paper: Paper) -> AnswerKey:
    """Return the answer key of a paper."""
    title = {lang: paper.title(lang) for lang in paper.langs}
    questions = [make_key_question(item) for item in paper.items]
    return AnswerKey(FORMAT, questions, paper.code, paper.digest, title, paper.langs, paper.banks)


def answer_key_digest(key: AnswerKey, code: str = "") -> str:
    """Return the digest of the paper that a key is of, equal to ``Paper.digest``.

    Parameters
    ----------
    key : AnswerKey
    code : str
        That which the paper had before it got a secret one.
    """
    asked = [
        (q.number, q.template, q.identity, [(part.id, part.points) for part in q.parts])
        for q in key.questions
    ]
    return content_digest(code or key.code, asked)


def make_key_question(item: PaperItem) -> KeyQuestion:
    """Return the key of one question."""
    question, key = item.questions[0], item.keys[0]
    parts = [
        _key_part(part.field.id, str(part.points), msgspec.to_builtins(spec))
        for part, spec in zip(question.parts, key.specs, strict=True)
    ]
    return KeyQuestion(
        number=item.number,
        parts=parts,
        points=str(question.points),
        template=key.template,
        identity=key.identity,
        topic=question.topic,
        tier=question.tier,
        title={q.lang: q.title for q in item.questions},
        chain=None if key.chain is None else convert(key.chain, KeyChain),
    )


def _key_part(name: str, points: str, spec: dict[str, Any]) -> KeyPart:
    """Return one part of a key, with the order of the mappings that it matters for.

    Objects of JSON have no order, but cells of a table are asked and typed in one.
    """
    order = {
        field: list(value)
        for field, value in spec.items()
        if isinstance(value, dict) and field not in UNORDERED and len(value) > 1
    }
    return KeyPart(name, points, spec, order)


def write_answer_key(paper: Paper) -> bytes:
    """Return the bytes of ``key.json``; writes no file."""
    table = msgspec.to_builtins(make_answer_key(paper))
    text = json.dumps(table, ensure_ascii=False, indent=1)
    return (text + "\n").encode()


def parse_answer_key(table: Mapping[str, Any], place: str = "key") -> AnswerKey:
    """Return a key's table as an answer key, checked.

    Raises
    ------
    KeyFileError
        Naming file and field.
    """
    if table.get("format") == "quizgen-key/1":
        raise KeyFileError(
            f"{place}: from an earlier version, which did not keep the order of the cells of a "
            "table; make the paper again, or mark it with that version"
        )
    if table.get("format") != FORMAT:
        form = " (this is a form; the key comes first)" if "answers" in table else ""
        found = f"format is {table.get('format')!r}, not {FORMAT!r}"
        raise KeyFileError(f"{place}: {found}{form}")
    try:
        key = convert(table, AnswerKey)
    except msgspec.ValidationError as error:
        raise KeyFileError(f"{place}: {error}") from None
    seen: set[str] = set()
    for part in (part for question in key.questions for part in question.parts):
        if part.id in seen:
            raise KeyFileError(f"{place}: part {part.id!r} stands twice")
        seen.add(part.id)
        _check_points(part, place)
        _check_spec(part, place)
    for question in key.questions:
        _check_chain(question, place)
    register_languages(key.langs)
    return key


def _check_points(part: KeyPart, place: str) -> None:
    """Raise ``KeyFileError`` if a part's points are no number, not above 0, or far too many."""
    try:
        worth = part.points_exact()
    except ValueError as error:
        raise KeyFileError(f"{place}: part {part.id!r}: points: {error}") from None
    if not 0 < worth <= MOST_POINTS:
        raise KeyFileError(
            f"{place}: part {part.id!r}: points {part.points[:40]!r} (allowed: more than 0, "
            f"at most {MOST_POINTS})"
        )


def _check_spec(part: KeyPart, place: str) -> None:
    """Raise ``KeyFileError`` if a part cannot be graded: wrong specification or units."""
    try:
        spec = part.parse_spec()
        for unit in spec.value_units():
            spec.known_units().factor(unit)
    except (KeyFileError, FormulaError) as error:
        raise KeyFileError(f"{place}: part {part.id!r}: {error}") from None


@working_precision()
def _check_chain(question: KeyQuestion, place: str) -> None:
    """Raise ``KeyFileError`` if a question's chain cannot be evaluated; None is no chain."""
    if question.chain is None:
        return
    try:
        question.chain.context({})
        for unit in question.chain.units().values():
            question.known_units().factor(unit)
    except (FormulaError, ValueError, TypeError) as error:
        raise KeyFileError(f"{place}: question {question.number!r}: chain: {error}") from None


def read_answer_key(path: Path) -> AnswerKey:
    """Return the answer key in a file, checked.

    Raises
    ------
    KeyFileError
        Naming file and field or line.
    """
    return parse_answer_key(read_table(path), str(path))


def read_key_code(path: Path) -> str:
    """Return the code of the paper that a key is of; empty for any other file, or none."""
    try:
        return str(read_table(path).get("code", ""))
    except KeyFileError:
        return ""

"""Kind ``derivation``: typed lines, each judged by what is true and by the lines before it.

A line is right if it holds; its points are those of the author's lines that follow from it, so any
road to the goal is right. After a wrong line, lines that follow from it keep their points: an error
costs once.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import chain
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import msgspec
from msgspec import Meta

from quizgen.core.decoding import convert, json_decoder
from quizgen.core.errors import FormulaError
from quizgen.grading.echo import safe_echo
from quizgen.grading.judge import read_error_verdict
from quizgen.grading.judging.derivation import (
    LONGEST_LINE,
    DerivationKey,
    DerivationMarker,
    MarkedDerivation,
    ScoredLine,
)
from quizgen.grading.judging.relations import Relation, World, build_world
from quizgen.grading.judging.sampled_equality import Domain
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.derivations import DerivationReader, DerivedLine, LineReadError
from quizgen.grading.reading.formulas import parse_authored
from quizgen.grading.reading.units import listed_unit
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import (
    FULL,
    Verdict,
    ambiguous,
    partial,
    verdict_by_share,
)
from quizgen.kinds.asking import make_spec, sentence_with_code
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    AuthoredAnswer,
    Condition,
    DerivedStep,
    FieldProblem,
    InputControl,
    PartContext,
    SymbolDomain,
)
from quizgen.kinds.equation import RELATIONS as SAME_SIGN
from quizgen.kinds.forms import typeset_key
from quizgen.kinds.rubric import Criterion, RubricSpec
from quizgen.kinds.work import count_listed
from quizgen.maths.constants import Scalar, parse_exact
from quizgen.maths.notation import FormulaReadError, format_tree, parse_formula, pretty
from quizgen.maths.numbers import format_for_key, to_fraction
from quizgen.maths.tidy import tidy_formula
from quizgen.maths.tree import Call, Expr, Num, Sym, names_in, substitute

if TYPE_CHECKING:
    from quizgen.typeset.prose import TextOrInlines

RELATIONS = (*SAME_SIGN, "ne")
"""Signs of a line."""
LONGEST_SHOWN = 200
"""Characters of all lines that are shown back."""
ROOM = 2
"""Lines that a learner may need besides those that earn points."""

Forms = str | tuple[str, ...]
"""A relation, or several that say the same."""


class DerivationLine(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A line that earns points: what it states, in one form or several."""

    forms: Forms = msgspec.field(name="is")
    points: Scalar = 1
    needed: bool = False
    when: Condition = True


Lines = Annotated[
    dict[str, DerivationLine], Meta(description="Lines that count, in order; the last is the goal.")
]
Let = Annotated[
    dict[str, str], Meta(description="What each derived name is, as a formula of the others.")
]
Where = Annotated[tuple[str, ...], Meta(description="Conditions on the names, such as z > f.")]
Given = Annotated[
    tuple[str, ...], Meta(description="What may be written down at the start, without points.")
]
Reasons = Annotated[
    dict[str, Scalar], Meta(description="Points of reasons in words, which a person judges.")
]


class AuthoredDerivation(AuthoredAnswer, kw_only=True, tag="derivation", frozen=True):
    """Lines to write, the last of which is the goal."""

    lines: Lines
    symbols: dict[str, SymbolDomain]
    let: Let = msgspec.field(default_factory=dict)
    where: Where = ()
    given: Given = ()
    traps: dict[str, Forms] = msgspec.field(default_factory=dict)
    reasons: Reasons = msgspec.field(default_factory=dict)
    unit: str = ""

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield what is wrong with the lines and names apart from their formulas."""
        if not self.lines:
            yield ("lines",), "QG110", "at least the goal is needed"
        for name in self.let.keys() - self.symbols.keys():
            yield ("let", name), "QG112", "is not among the symbols"


class KeyLine(msgspec.Struct, frozen=True, omit_defaults=True):
    """A line of a key: forms that say the same, its points, and whether it must be written."""

    forms: list[str]
    points: Scalar = 1
    needed: bool = False


class KeyReason(msgspec.Struct, frozen=True):
    """A reason that a person judges: its points, and words by which it is suggested."""

    points: Scalar
    words: list[str]


class DerivationSpec(WordSpec, kw_only=True, frozen=True):
    """Derivation: ``lines`` = {name: forms, points, needed}, the last one the goal.

    ``symbols`` = {name: "real", "positive" or [low, high]}; ``let`` says what each derived one is;
    ``where`` = conditions; ``given`` = what may be written down without points; ``reasons`` = words
    that a person judges. ``unit`` is what numbers stand in, if one may be typed behind them.
    """

    written_as: ClassVar[AnswerForm] = "verbatim"

    lines: dict[str, KeyLine]
    symbols: dict[str, Domain]
    let: dict[str, str] = msgspec.field(default_factory=dict)
    where: list[str] = msgspec.field(default_factory=list)
    given: list[str] = msgspec.field(default_factory=list)
    traps: dict[str, list[str]] = msgspec.field(default_factory=dict)
    reasons: dict[str, KeyReason] = msgspec.field(default_factory=dict)
    unit: str = ""

    def validate(self) -> None:
        """Check that every line is a relation in declared names, and earns something.

        Raises
        ------
        FormulaError
            If a formula cannot be read.
        ValueError
            If a line is no relation, there is none, or points are below 0.
        """
        if not self.lines or any(not line.forms for line in self.lines.values()):
            raise ValueError("lines: at least the goal is needed, each with a form")
        if any(points < 0 for points in self._list_points()) or not self.total:
            raise ValueError("points: none may be below 0, and not all 0")
        if self.unit:
            listed_unit(self.unit)
        for text in self.let.values():
            self._parse(text)
        for text in (*self.where, *self.given):
            self.relation(text)
        for forms in (*(line.forms for line in self.lines.values()), *self.traps.values()):
            for text in forms:
                self.relation(text)

    def _parse(self, text: str) -> Expr:
        """Return the tree of a formula of the key."""
        return parse_authored(text, tuple(self.symbols))

    def relation(self, text: str) -> Relation:
        """Return a relation of the key; ``FormulaError`` if it is none."""
        tree = self._parse(text)
        if not isinstance(tree, Call) or tree.op not in RELATIONS:
            raise FormulaError(f"{text!r} is no equation or inequality")
        left, right = tree.args
        return Relation(tree.op, left, right)

    @property
    def total(self) -> Fraction:
        """The points of all lines and reasons."""
        return sum(self._list_points(), Fraction(0))

    def _list_points(self) -> list[Fraction]:
        """Return the points of each line and reason."""
        lines = [_points(line) for line in self.lines.values()]
        return [*lines, *(_points(one) for one in self.reasons.values())]

    @property
    def goal(self) -> Relation:
        """What is to be derived."""
        return self.relation([*self.lines.values()][-1].forms[0])

    def right_world(self) -> World:
        """Return the world in which every true line holds."""
        domains = {name: tuple(of) if isinstance(of, list) else of
                   for name, of in self.symbols.items()}  # fmt: skip
        definitions = tuple((name, self._parse(text)) for name, text in self.let.items())
        return build_world(tuple(domains.items()), definitions, tuple(map(self._parse, self.where)))

    def marking_key(self) -> DerivationKey:
        """Return what the lines are marked by."""
        return DerivationKey(
            self.right_world(),
            {name: ScoredLine(self._relations(line.forms), _points(line), line.needed)
             for name, line in self.lines.items()},
            self._relations(self.given),
            {name: self._relations(texts) for name, texts in self.traps.items()},
            bool(self.reasons),
        )  # fmt: skip

    def _relations(self, texts: Iterable[str]) -> tuple[Relation, ...]:
        """Return several relations of the key."""
        return tuple(map(self.relation, texts))

    def reader(self, decimal: str) -> DerivationReader:
        """Return what reads typed lines, with a decimal sign."""
        return DerivationReader(self.symbols, decimal, self.goal.left, self.unit)

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return the verdict on typed lines: each of them a cell, the first fault as its note.

        Raises
        ------
        FormulaReadError
            If there are no lines, too many, or invisible characters.
        """
        key = _recall_key(msgspec.json.encode(self))
        try:
            lines = self.reader(options.decimal).read(typed)
        except LineReadError as error:
            found = read_error_verdict(error.why)
            fields = {**found.fields, "at_line": error.number}
            return msgspec.structs.replace(found, fields=fields)
        shown = safe_echo(
            "; ".join(line.display_text for line in lines if line.relations), LONGEST_SHOWN
        )
        marked = DerivationMarker(key).mark(lines)
        words = " ".join(line.words for line in lines if line.words)
        found = self._suggest(marked, words, shown) if self.reasons else self._sum_up(marked, shown)
        return msgspec.structs.replace(found, cells=marked.cells)

    def follow(self, typed: str, options: GradingOptions, *, judged: bool) -> tuple[Verdict, ...]:
        """Return how each line is read while lines are written; one that cannot be is left out.

        Parameters
        ----------
        typed : str
        options : GradingOptions
        judged : bool
            Whether it is said, too, which lines hold.
        """
        lines, unread = self._read_rows(typed, options)
        if judged:
            cells = DerivationMarker(self.marking_key()).follow(lines)
        else:
            texts = (safe_echo(line.display_text, LONGEST_LINE) for line in lines)
            cells = tuple(ambiguous("", text) for text in texts)
        rows = ((*unread[place], *cells[place : place + 1]) for place in range(len(cells) + 1))
        return tuple(chain.from_iterable(rows))

    def _read_rows(
        self, typed: str, options: GradingOptions
    ) -> tuple[list[DerivedLine], Mapping[int, list[Verdict]]]:
        """Return the lines that can be read, and verdicts on the others by how many are before."""
        rows: list[str] = []
        lines: list[DerivedLine] = []
        unread: defaultdict[int, list[Verdict]] = defaultdict(list)
        for row in typed.splitlines():
            reader = self.reader(options.decimal)
            try:
                lines = reader.read("\n".join([*rows, row]))
            except LineReadError as error:
                shown = safe_echo(row.strip(), LONGEST_LINE)
                why = msgspec.structs.replace(read_error_verdict(error.why), read_as=shown)
                unread[len(lines)].append(why)
            except FormulaReadError:  # there is nothing yet, or too much
                continue
            else:
                rows.append(row)
        return lines, unread

    def _sum_up(self, marked: MarkedDerivation, shown: str) -> Verdict:
        """Return the verdict on all lines by their points."""
        found = verdict_by_share(marked.points / self.total, shown, marked.note, **marked.fields)
        if marked.note == "line-undecided" and found.credit < 1:
            return ambiguous(marked.note, shown, **marked.fields)
        if found.credit == 1 and any(cell.note == "line-wrong" for cell in marked.cells):
            return partial(FULL, shown, marked.note, **marked.fields)
        return found

    def _suggest(self, marked: MarkedDerivation, words: str, shown: str) -> Verdict:
        """Return the points of the lines, and the reasons that seem to be there, for a person."""
        criteria = {
            name: Criterion(points=one.points, accept=one.words)
            for name, one in self.reasons.items()
        }
        looked = RubricSpec(kind="rubric", full=1, criteria=criteria)
        found = looked.judge(words, GradingOptions()).fields.get("found", ()) if words else ()
        names = found if isinstance(found, tuple) else ()
        share = marked.points + sum((_points(self.reasons[name]) for name in names), Fraction(0))
        fields = {**marked.fields, "found": names, "share": share / self.total}
        return ambiguous("self-mark-lines" if names else "self-mark-lines-none", shown, **fields)

    def show(self) -> str:
        """Return the lines as they can be typed back, the first form of each."""
        return "\n".join(pretty.format_formula(format_tree(self._parse(line.forms[0])))
                         for line in self.lines.values())  # fmt: skip

    def find_faults(self) -> Iterator[tuple[str, str]]:
        """Yield code and message of what an author has wrong: lines that do not hold, or do."""
        world = self.right_world()
        if len(world.points) < LEAST_POINTS:
            yield "QG243", f"where: {len(world.points)} of the points tried meet the conditions"
            return
        forms = [(name, text) for name, line in self.lines.items() for text in line.forms]
        for name, text in (*forms, *(("given", text) for text in self.given)):
            if world.holds(self.relation(text)) is not True:
                yield "QG240", f"{name}: {text} does not hold where the names are what let says"
        known = DerivationMarker(self.marking_key()).known
        for name, text in forms:
            form = self.relation(text)  # an inequality counts only where it is written
            if form.op == "eq" and known.holds(form) is True:
                yield "QG241", f"{name}: {text} holds before anything is written"


LEAST_POINTS = 8
"""Points that conditions must leave of those tried."""


@lru_cache(maxsize=128)
def _recall_key(spec: bytes) -> DerivationKey:
    """Return what lines are held against, for all learners whose specification, as JSON, is one."""
    return _decode(spec).marking_key()


_decode = json_decoder(DerivationSpec).decode


def _points(one: KeyLine | KeyReason) -> Fraction:
    """Return the points of a line or reason."""
    return to_fraction(parse_exact(one.points))


def ask(part: PartContext) -> AskedPart[DerivationSpec]:
    """Return the lines with the drawn numbers in place.

    Raises
    ------
    BankError
        If the authored answer is not complete.
    """
    answer = convert(_fill_phrases(part.answer, part.words), AuthoredDerivation)
    known = {
        name: Num(Fraction(format_for_key(value)), decimal=value.q != 1)
        for name, value in part.shown.items()
        if name not in answer.symbols
    }
    symbols = (*answer.symbols, *known)

    def fill(text: str) -> str:
        """Return a formula as text with the drawn numbers in place, tidied."""
        return format_tree(_fill_numbers(parse_formula(text, symbols=symbols), known))

    def fill_all(texts: Forms) -> list[str]:
        """Return one formula or several, likewise."""
        return [fill(text) for text in ([texts] if isinstance(texts, str) else texts)]

    lines = {name: line for name, line in answer.lines.items() if part.condition_holds(line.when)}
    spec = make_spec(
        DerivationSpec,
        part,
        lines={name: KeyLine(fill_all(line.forms), line.points, line.needed)
               for name, line in lines.items()},
        symbols=msgspec.to_builtins(answer.symbols),
        traps={name: fill_all(texts) for name, texts in answer.traps.items()},
        let={name: fill(text) for name, text in answer.let.items()},
        where=fill_all(answer.where),
        given=fill_all(answer.given),
        reasons={name: KeyReason(points, part.accepted_words(name))
                 for name, points in answer.reasons.items()},
        why=part.reasons([(name, name) for name in lines]),
        unit=answer.unit,
    )  # fmt: skip
    traps = {name: texts for name, texts in spec.traps.items() if _is_mistake(spec, texts)}
    notes = part.misconception_notes(traps) if traps else {}
    spec = msgspec.structs.replace(spec, traps=traps, notes=notes)
    steps = tuple(
        DerivedStep(name, spec.relation(line.forms[0]).tree, _points(line))
        for name, line in spec.lines.items()
    )
    mistakes = {
        name: msgspec.structs.replace(spec, traps={}, notes={}, lines={name: KeyLine(texts)})
        for name, texts in traps.items()
    }
    return AskedPart(
        spec,
        InputControl("lines", lines=len(lines) + ROOM, rows=True),
        right=tuple(("points", name) for name in answer.reasons),
        mistakes=mistakes,
        derived=steps,
    )


_BLANK = re.compile(r"\{\{ *([\w-]+) *\}\}")


def _fill_phrases(value: Any, words: Mapping[str, str]) -> Any:
    """Return an authored answer with the names of drawn phrases in its blanks.

    So the letters of a formula can be drawn: ``{{ axis }}`` is ``x`` if the phrase x was drawn.
    """
    if isinstance(value, str):
        return _BLANK.sub(lambda blank: words.get(blank[1], blank[0]), value)
    if isinstance(value, Mapping):
        return {_fill_phrases(name, words): _fill_phrases(of, words) for name, of in value.items()}
    if isinstance(value, list | tuple):
        return [_fill_phrases(one, words) for one in value]
    return value


def _is_mistake(spec: DerivationSpec, texts: Sequence[str]) -> bool:
    """Return whether none of the relations of a trap happens to hold with the drawn numbers."""
    world = spec.right_world()
    return all(world.holds(spec.relation(text)) is False for text in texts)


def _fill_numbers(tree: Expr, known: Mapping[str, Num]) -> Expr:
    """Return a formula with drawn numbers in place of their names, tidied where they stand.

    What holds none of them stays as the author wrote it. Fractions become decimals where decimals
    were drawn and they are short.
    """
    if isinstance(tree, Call) and tree.op in RELATIONS:
        return Call(tree.op, tuple(_fill_numbers(side, known) for side in tree.args))
    kept: dict[str, Expr] = {}

    def hide(node: Expr) -> Expr:
        """Return a formula with a name of its own for each part without drawn numbers."""
        if not isinstance(node, Call):
            return node
        if names_in(node).isdisjoint(known):
            name = f"kept{len(kept)}"
            kept[name] = node
            return Sym(name)
        return Call(node.op, tuple(map(hide, node.args)))

    hidden = hide(tree)
    drawn = [known[name] for name in names_in(tree) & known.keys()]
    filled = tidy_formula(substitute(hidden, known))
    if any(number.decimal for number in drawn):
        filled = _write_decimals(filled)
    return substitute(filled, kept)


def _write_decimals(tree: Expr) -> Expr:
    """Return a formula with its short fractions as decimals."""
    if isinstance(tree, Call):
        return Call(tree.op, tuple(map(_write_decimals, tree.args)))
    if isinstance(tree, Num) and tree.value * 10**LONGEST_DECIMALS % 1 == 0:
        return Num(tree.value, decimal=tree.value % 1 != 0)
    return tree


LONGEST_DECIMALS = 4
"""Decimals up to which a fraction is written as a decimal number."""


def input_hints(spec: DerivationSpec, lang: str) -> tuple[TextOrInlines, ...]:
    """Return how lines are typed, and the names that may stand in them."""
    names = ", ".join(spec.symbols)
    return (sentence_with_code(lang, "ask.derivation", names=names),)


def explain_key(spec: DerivationSpec, _lang: str) -> TextOrInlines:
    """Return the lines as they are written by hand, one after another."""
    from quizgen.typeset.prose import join_inlines, to_inlines

    shown = [to_inlines(typeset_key(spec.relation(line.forms[0]).tree))
             for line in spec.lines.values()]  # fmt: skip
    return join_inlines(shown, "; ")


KIND = AnswerKind(
    AuthoredDerivation,
    DerivationSpec,
    ask,
    input_hints,
    explain_key,
    verb="derive",
    work=count_listed("line derived", "lines"),
)

"""Kind ``derivation``: typed lines, each judged by what is true and by the lines before it.

A line is right if it holds; its points are those of the author's lines that follow from it, so any
road to the goal is right. After a wrong line, lines that follow from it keep their points: an error
costs once.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import msgspec
from msgspec import Meta

from quizgen.core.decoding import convert
from quizgen.core.errors import FormulaError
from quizgen.grading.echo import safe_echo
from quizgen.grading.judge import read_error_verdict
from quizgen.grading.judging.relations import (
    Relation,
    World,
    build_world,
    find_lost_solution,
    implies,
    solve_for,
)
from quizgen.grading.judging.sampled_equality import Domain, are_equal, compare_by_sampling
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.derivations import DerivationReader, DerivedLine, LineReadError
from quizgen.grading.reading.formulas import parse_authored
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import (
    FULL,
    HALF,
    Verdict,
    ambiguous,
    correct,
    partial,
    verdict_by_share,
    wrong,
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
from quizgen.kinds.equation import RELATIONS
from quizgen.kinds.forms import typeset_key
from quizgen.kinds.rubric import Criterion, RubricSpec
from quizgen.maths.constants import Scalar, parse_exact
from quizgen.maths.notation import format_tree, parse_formula, pretty
from quizgen.maths.numbers import format_for_key, to_fraction
from quizgen.maths.tidy import tidy_formula
from quizgen.maths.tree import Call, Expr, Num, Sym, names_in, substitute, walk_tree

if TYPE_CHECKING:
    from quizgen.question.inlines import TextOrInlines

MOST_ERRORS = 5
"""Wrong lines that are followed up; after them nobody can say what follows from what."""
ROOM = 3
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
    that a person judges.
    """

    written_as: ClassVar[AnswerForm] = "verbatim"

    lines: dict[str, KeyLine]
    symbols: dict[str, Domain]
    let: dict[str, str] = msgspec.field(default_factory=dict)
    where: list[str] = msgspec.field(default_factory=list)
    given: list[str] = msgspec.field(default_factory=list)
    traps: dict[str, list[str]] = msgspec.field(default_factory=dict)
    reasons: dict[str, KeyReason] = msgspec.field(default_factory=dict)

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
        return build_world(tuple(domains.items()), definitions, self.conditions())

    def conditions(self) -> tuple[Expr, ...]:
        """Return the conditions on the names."""
        return tuple(map(self._parse, self.where))

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return the verdict on typed lines: each of them a cell, the first fault as its note.

        Raises
        ------
        FormulaReadError
            If there are no lines, too many, or invisible characters.
        """
        reader = DerivationReader(self.symbols, options.decimal, self.goal.left)
        try:
            lines = reader.read(typed)
        except LineReadError as error:
            found = read_error_verdict(error.why)
            fields = {**found.fields, "at_line": error.number}
            return msgspec.structs.replace(found, fields=fields)
        return _Marking(self).mark(lines)

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
        known = _Marking(self).known
        for name, text in forms:
            if known.holds(self.relation(text)) is True:
                yield "QG241", f"{name}: {text} holds before anything is written"


LEAST_POINTS = 8
"""Points that conditions must leave of those tried."""


def _points(one: KeyLine | KeyReason) -> Fraction:
    """Return the points of a line or reason."""
    return to_fraction(parse_exact(one.points))


class _Marking:
    """Judges the lines of one derivation in order.

    ``right`` is the world of true lines, ``wrong`` that of the first errors, ``known`` what the
    true lines written so far say: in it the author's lines that follow from them hold. ``led`` is
    the same without lines that state the goal, which must not stand for what leads to it.
    """

    def __init__(self, spec: DerivationSpec) -> None:
        """Begin with nothing written."""
        self.spec, self.goal = spec, spec.goal
        self.conditions = spec.conditions()
        self.right = spec.right_world()
        self.wrong: World | None = None
        self.errors = 0
        self.derived = list(spec.let)
        self.given = [spec.relation(text) for text in spec.given]
        self.known = self.led = self._build_known_world()
        self.earned: dict[str, Fraction] = {}
        self.reached: dict[str, int] = {}
        self.spoilt: set[str] = set()
        self.before: tuple[Relation, ...] = ()
        self.goal_name = [*spec.lines][-1]
        self.forms = {name: [spec.relation(text) for text in line.forms]
                      for name, line in spec.lines.items()}  # fmt: skip

    def _build_known_world(self) -> World:
        """Return what is known before anything is written: what given names stand for."""
        named = {one.left.name: one.right for one in self.given
                 if isinstance(one.left, Sym) and one.left.name in self.derived}  # fmt: skip
        return World(self.spec.symbols, named, self.conditions)

    def mark(self, lines: Sequence[DerivedLine]) -> Verdict:
        """Return the verdict on all lines."""
        cells = tuple(self._mark_line(line) for line in lines)
        credit = sum(
            (share * _points(self.spec.lines[name]) for name, share in self.earned.items()),
            Fraction(0),
        )
        shown = safe_echo("; ".join(line.shown for line in lines if line.relations), 200)
        missing = tuple(name for name in self.spec.lines if self.earned.get(name, 0) < 1)
        fields: dict[str, object] = {
            "right": len(self.spec.lines) - len(missing),
            "of": len(self.spec.lines),
            "because": missing,
        }
        note, more = self._find_fault(lines, cells, missing)
        fields |= more
        if self.spec.reasons:
            return self._suggest(lines, cells, credit, shown, fields)
        found = verdict_by_share(credit / self.spec.total, shown, note, **fields)
        if note == "line-undecided" and found.credit < 1:
            found = ambiguous(note, shown, **fields)
        if found.credit == 1 and any(cell.note == "line-wrong" for cell in cells):
            found = partial(FULL, shown, note, **fields)
        return msgspec.structs.replace(found, cells=cells)

    def _suggest(
        self,
        lines: Sequence[DerivedLine],
        cells: tuple[Verdict, ...],
        credit: Fraction,
        shown: str,
        fields: dict[str, object],
    ) -> Verdict:
        """Return the points of the lines, and the reasons that seem to be there, for a person."""
        reasons = self.spec.reasons
        criteria = {
            name: Criterion(points=one.points, accept=one.words) for name, one in reasons.items()
        }
        words = RubricSpec(kind="rubric", full=0, criteria=criteria)
        text = " ".join(line.words for line in lines if line.words)
        found = words.judge(text, GradingOptions()).fields if text else {}
        there = found.get("found", ())
        names = there if isinstance(there, tuple) else ()
        share = credit + sum((_points(reasons[name]) for name in names), Fraction(0))
        fields |= {"found": names, "share": share / self.spec.total}
        note = "self-mark-lines" if names else "self-mark-lines-none"
        return msgspec.structs.replace(ambiguous(note, shown, **fields), cells=cells)

    def _find_fault(
        self, lines: Sequence[DerivedLine], cells: Sequence[Verdict], missing: Sequence[str]
    ) -> tuple[str, dict[str, object]]:
        """Return the note of the first fault with its fields; that of what is missing if none."""
        for line, cell in zip(lines, cells, strict=True):
            if cell.note in {"line-wrong", "line-undecided"}:
                fields = dict(cell.fields) if cell.note == "line-wrong" else {}
                note = str(fields.pop("why", cell.note))
                return note, {**fields, "at_line": line.number}
        for line, cell in zip(lines, cells, strict=True):
            if cell.note == "line-lost":
                return cell.note, {**cell.fields, "at_line": line.number}
        skipped = [name for name in missing if self.spec.lines[name].needed]
        later = [number for name, number in self.reached.items()
                 if skipped and self._is_behind(name, skipped[0])]  # fmt: skip
        if later:
            return "line-jump", {"at_line": min(later)}
        if [*missing] == [self.goal_name]:
            return "line-goal", {}
        return "lines-missing", {}

    def _is_behind(self, name: str, other: str) -> bool:
        """Return whether a line of the key comes after another one."""
        order = list(self.spec.lines)
        return order.index(name) > order.index(other)

    def _mark_line(self, line: DerivedLine) -> Verdict:
        """Return the verdict on one line, and remember what it says."""
        shown = safe_echo(line.shown, LONGEST_LINE)
        if not line.relations:
            return ambiguous("line-words", shown)
        if line.defines:
            self._define(line)
        relations = self._choose_reading(line)
        cells = [self._mark_relation(one, line.number, shown) for one in relations]
        worst = min(cells, key=lambda cell: _SEVERITY.index(cell.note))
        if line.both_ways and worst.note == "line-right" and self._is_one_way(relations):
            worst = correct(shown, "line-one-way")
        self.before = relations
        if line.defines and worst.note == "line-right" and len(relations) == 1:
            return correct(shown, "line-defines")
        return worst

    def _is_one_way(self, relations: Sequence[Relation]) -> bool:
        """Return whether a step that is called an equivalence gains a solution: squaring."""
        return any(
            find_lost_solution(relation, one, self.right.domains, self.conditions)
            for one in self.before
            for relation in relations
        )

    def _choose_reading(self, line: DerivedLine) -> tuple[Relation, ...]:
        """Return the relations of a line by that reading of its numbers that holds, if one does."""
        if not line.others or all(self.right.holds(one) for one in line.relations):
            return line.relations
        return line.others if all(self.right.holds(one) for one in line.others) else line.relations

    def _define(self, line: DerivedLine) -> None:
        """Add a name that the learner gives a meaning to every world."""
        meaning = line.relations[0].right
        worlds = [self.right, self.known, self.led, self.wrong]
        self.right, self.known, self.led, self.wrong = (  # type: ignore[assignment]
            world and (world.define(line.defines, meaning) or world) for world in worlds
        )
        self.derived.append(line.defines)

    def _mark_relation(self, relation: Relation, number: int, shown: str) -> Verdict:
        """Return the verdict on one relation, and remember what it says."""
        holds = self.right.holds(relation)
        if holds is None:
            return ambiguous("line-undecided", shown)
        if holds:
            return self._mark_true(relation, number, shown)
        if self.wrong is not None and self.wrong.holds(relation):
            self._credit_carried(relation, number)
            return partial(FULL, shown, "line-carried")
        return self._mark_wrong(relation, shown)

    def _mark_true(self, relation: Relation, number: int, shown: str) -> Verdict:
        """Return the verdict on what holds; credit the lines of the key that follow from it."""
        if any(self._says_the_same(relation, one) for one in self.given):
            return correct(shown, "line-given")
        lost = self._find_lost(relation)
        self.known = self._learn(self.known, relation)
        if not self._states_goal(relation):
            self.led = self._learn(self.led, relation)
        share = HALF if lost else FULL
        for name in self._iter_reached(relation):
            self.earned[name] = share
            self.reached.setdefault(name, number)
        if lost:
            return partial(HALF, shown, "line-lost", detail=lost)
        return correct(shown, "line-right")

    def _find_lost(self, relation: Relation) -> str:
        """Return what the step from the line before divides by, or loses; empty if it is safe."""
        domains = self.right.domains
        for one in self.before:
            if lost := find_lost_solution(one, relation, domains, self.conditions):
                return lost
        return ""

    def _iter_reached(self, relation: Relation) -> Iterator[str]:
        """Yield the lines of the key that are there now and were not before."""
        for name, forms in self.forms.items():
            if name in self.earned or name in self.spoilt:
                continue
            needed = self.spec.lines[name].needed
            if (
                self._states_goal(relation)
                if name == self.goal_name
                else any(self._follows(form, relation, needed=needed) for form in forms)
            ):
                yield name

    def _follows(self, form: Relation, relation: Relation, *, needed: bool) -> bool:
        """Return whether a form of the key follows from what is written, or says it in numbers."""
        if form.op != "eq":
            return self._is_in_numbers(relation, form) or implies(
                relation, form, self.right.domains, self.derived
            )
        if (self.led if needed else self.known).holds(form) is True:
            return True
        hidden = needed and self._states_goal(relation)
        return not hidden and implies(relation, form, self.right.domains, self.derived)

    def _states_goal(self, relation: Relation) -> bool:
        """Return whether a true relation is the goal: its left side alone, and nothing beyond it.

        What may stand on the other side are the names that the goal has there, in a formula that is
        about as short.
        """
        goal = self.goal
        if goal.op != "eq":
            return self._follows(goal, relation, needed=False)
        most = _size(goal.right)
        return any(
            own == goal.left
            and names_in(other) <= names_in(goal.right)
            and _size(other) <= most + max(1, most // 4)
            for own, other in _both_ways(relation)
        )

    def _is_in_numbers(self, relation: Relation, form: Relation) -> bool:
        """Return whether an inequality is one of the key with values put in on its sides."""
        sides = zip((relation.left, relation.right), (form.left, form.right), strict=True)
        return relation.op == form.op != "eq" and all(
            self.right.holds(Relation("eq", *pair)) for pair in sides
        )

    def _says_the_same(self, relation: Relation, given: Relation) -> bool:
        """Return whether a relation is a given one as it stands, its sides maybe exchanged."""
        if relation.op != given.op:
            return False
        domains = self.right.domains
        return any(
            are_equal(given.left, left, domains) and are_equal(given.right, right, domains)
            for left, right in _both_ways(relation)
        )

    def _learn(self, known: World, relation: Relation) -> World:
        """Return a world with what a true relation says of a name that was free in it.

        Where each of its names is known, it may say something of those that they are made of.
        """
        if self.right.holds(relation, rounded=False) and not [
            name for name in self._subjects(relation) if name not in known.definitions
        ]:
            left, right = (_unfold(one, known.definitions) for one in relation.tree.args)
            relation = Relation(relation.op, left, right)
        for name in self._subjects(relation):
            if name in known.definitions:
                continue
            exactly = self.right.holds(relation, rounded=False)
            formulas = solve_for(relation, name) if exactly else (self.right.definitions[name],)
            for formula in formulas:
                world = known.define(name, formula)
                is_true = exactly is not True or self.right.holds(
                    Relation("eq", Sym(name), formula)
                )
                if world is not None and is_true and world.holds(relation) is True:
                    return world
        return known

    def _subjects(self, relation: Relation) -> list[str]:
        """Return the derived names of a relation, first those that it may be about.

        A name that is a side by itself comes first, then the later ones before those they need.
        """
        alone = [side.name for side in (relation.left, relation.right)
                 if isinstance(side, Sym) and side.name in self.derived]  # fmt: skip
        own = [name for name in self.derived if name in self.spec.let]
        rest = [*own[::-1], *(name for name in self.derived if name not in own)]
        return list(dict.fromkeys([*alone, *(name for name in rest if name in relation.names)]))

    def _mark_wrong(self, relation: Relation, shown: str) -> Verdict:
        """Return why a relation does not hold, and what follows from it from now on."""
        self.errors += 1
        if self.errors > MOST_ERRORS:
            return wrong(shown, "line-wrong")
        why, fields = self._explain_wrong(relation) if self.errors == 1 else ("", {})
        subjects = self._subjects(relation)
        self._spoil(subjects)
        base = self.wrong or self.right
        for name in subjects:
            worlds = (base.define(name, formula) for formula in solve_for(relation, name)
                      if name not in names_in(formula))  # fmt: skip
            found = next((w for w in worlds if w is not None and w.holds(relation)), None)
            if found is not None:
                self.wrong = found
                break
        return wrong(shown, "line-wrong", why=why, **fields)

    def _spoil(self, subjects: Sequence[str]) -> None:
        """Give up the next line of the key about the same quantity: it is what went wrong.

        If all of them are there, the last one is given up: what is written last counts.
        """
        about = [
            name
            for name, forms in self.forms.items()
            if name not in self.spoilt and self._subjects(forms[0])[:1] == [*subjects[:1]]
        ]
        if about:
            name = next((name for name in about if name not in self.earned), about[-1])
            self.earned.pop(name, None)
            self.spoilt.add(name)

    def _credit_carried(self, relation: Relation, number: int) -> None:
        """Credit the next line of the key about what follows from an error."""
        about = self._subjects(relation)[:1]
        for name, forms in self.forms.items():
            if name in self.earned or name in self.spoilt or self._subjects(forms[0])[:1] != about:
                continue
            if name == self.goal_name and not self._is_solved_for_goal(relation):
                return
            self.earned[name] = FULL
            self.reached[name] = number
            return

    def _is_solved_for_goal(self, relation: Relation) -> bool:
        """Return whether a relation says what the left side of the goal is, by free names alone."""
        return any(
            own == self.goal.left and not names_in(other) & {*self.derived}
            for own, other in _both_ways(relation)
        )

    def _explain_wrong(  # noqa: PLR0911 - one for each cause
        self, relation: Relation
    ) -> tuple[str, dict[str, object]]:
        """Return the note of what is wrong with a relation, as far as it is certain."""
        domains = self.right.domains
        for name, texts in self.spec.traps.items():
            traps = map(self.spec.relation, texts)
            if any(
                implies(*pair, domains, self.derived)
                for trap in traps
                for pair in ((relation, trap), (trap, relation))
            ):
                return f"trap:{name}", {}
        left, right = relation.left, relation.right
        if relation.op != "eq":
            turned = {"lt": "gt", "le": "ge", "gt": "lt", "ge": "le"}[relation.op]
            held = self.right.holds(Relation(turned, left, right))
            return ("line-inequality" if held else "line-false"), {}
        if self.right.holds(Relation("eq", left, Call("neg", (right,)))):
            return "line-sign", {}
        if self.right.holds(Relation("eq", left, Call("div", (Num(Fraction(1)), right)))):
            return "line-upside-down", {}
        if names := self._assumed_positive(relation):
            return "line-assumes", {"names": names}
        if self._is_off_by_a_factor(relation):
            return "line-factor", {}
        return "line-false", {}

    def _assumed_positive(self, relation: Relation) -> tuple[str, ...]:
        """Return the names that must be positive for a relation to hold; none if that is not it."""
        real = [name for name in sorted(relation.names - {*self.derived})
                if self.right.domains[name] == "real"]  # fmt: skip
        if not real:
            return ()
        domains = {**self.right.domains, **dict.fromkeys(real, "positive")}
        world = World(domains, self.right.definitions, self.right.where)
        return tuple(real) if world.holds(relation) is True else ()

    def _is_off_by_a_factor(self, relation: Relation) -> bool:
        """Return whether one side is the other times a number, the same at all points."""
        free = {name: of for name, of in self.right.domains.items() if name not in self.derived}
        definitions = self.right.definitions
        left, right = (_unfold(side, definitions) for side in (relation.left, relation.right))
        if (
            not names_in(left) & names_in(right)
            or not names_in(left) | names_in(right) <= free.keys()
        ):
            return False
        return compare_by_sampling(left, right, free).ratio is not None


LONGEST_LINE = 120
"""Characters of a line that are shown back."""
_SEVERITY = (
    "line-wrong",
    "line-undecided",
    "line-lost",
    "line-carried",
    "line-right",
    "line-given",
)
"""Notes on the relations of one line, the worst first."""


def _both_ways(relation: Relation) -> tuple[tuple[Expr, Expr], tuple[Expr, Expr]]:
    """Return both sides in either order."""
    return (relation.left, relation.right), (relation.right, relation.left)


def _size(tree: Expr) -> int:
    """Return the number of names, numbers and operators of a formula."""
    return sum(1 for _ in walk_tree(tidy_formula(tree)))


def _unfold(tree: Expr, definitions: Mapping[str, Expr]) -> Expr:
    """Return a formula with defined names replaced by what they are; a few levels at most."""
    for _ in range(8):
        if not names_in(tree) & definitions.keys() or _size(tree) > MOST_UNFOLDED:
            break
        tree = substitute(tree, definitions)
    return tree


MOST_UNFOLDED = 200
"""Names, numbers and operators of a formula that is unfolded no further."""


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
    from quizgen.question.inlines import join_inlines, to_inlines

    shown = [to_inlines(typeset_key(spec.relation(line.forms[0]).tree))
             for line in spec.lines.values()]  # fmt: skip
    return join_inlines(shown, "; ")


KIND = AnswerKind(AuthoredDerivation, DerivationSpec, ask, input_hints, explain_key)

"""Marking a derivation: what holds, what follows from an error, which line is wrong first."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

import msgspec

from quizgen.grading.echo import safe_echo
from quizgen.grading.judging.relations import (
    Relation,
    World,
    find_lost_solution,
    implies,
    solve_for,
)
from quizgen.grading.judging.sampled_equality import are_equal, compare_by_sampling
from quizgen.grading.reading.derivations import DerivedLine
from quizgen.grading.verdict import FULL, HALF, Verdict, ambiguous, correct, partial, wrong
from quizgen.maths.tidy import tidy_formula
from quizgen.maths.tree import Call, Expr, Num, Sym, names_in, substitute, walk_tree

MOST_ERRORS = 5
"""Wrong lines that are followed up; after them nobody can say what follows from what."""


class ScoredLine(msgspec.Struct, frozen=True):
    """A line that earns points: relations that say the same, and whether it must be written."""

    forms: tuple[Relation, ...]
    points: Fraction
    needed: bool = False


class DerivationKey(msgspec.Struct, frozen=True):
    """What a derivation is marked by.

    Parameters
    ----------
    world : World
        In it every true line holds; its definitions are the derived quantities.
    lines : mapping of str to ScoredLine
        In order; the last one is the goal.
    given : tuple of Relation
        What may be written down and earns nothing.
    traps : mapping of str to tuple of Relation
        Known mistakes.
    has_reasons : bool
        Whether a person reads the words among the lines.
    """

    world: World
    lines: Mapping[str, ScoredLine]
    given: tuple[Relation, ...] = ()
    traps: Mapping[str, tuple[Relation, ...]] = msgspec.field(default_factory=dict)
    has_reasons: bool = False


class MarkedDerivation(msgspec.Struct, frozen=True):
    """What is said of all lines: a cell for each, the points, the first fault and its fields."""

    cells: tuple[Verdict, ...]
    points: Fraction
    note: str
    fields: dict[str, object]


class DerivationMarker:
    """Judges the lines of one derivation in order.

    ``right`` is the world of true lines, ``wrong`` that of the first errors, ``known`` what the
    true lines written so far say: in it the author's lines that follow from them hold. ``led`` is
    the same without lines that state the goal, which must not stand for what leads to it.
    """

    def __init__(self, key: DerivationKey) -> None:
        """Begin with nothing written."""
        self.key, self.right = key, key.world
        self.goal_name = [*key.lines][-1]
        self.goal = key.lines[self.goal_name].forms[0]
        self.wrong: World | None = None
        self.errors = 0
        self.derived = [*key.world.definitions]
        self.known = self.led = self._build_known_world()
        self.earned: dict[str, Fraction] = {}
        self.reached: dict[str, int] = {}
        self.spoilt: set[str] = set()
        self.before: tuple[Relation, ...] = ()
        self.forms = {name: line.forms for name, line in key.lines.items()}

    def _build_known_world(self) -> World:
        """Return what is known before anything is written: what given names stand for."""
        named = {one.left.name: one.right for one in self.key.given
                 if isinstance(one.left, Sym) and one.left.name in self.derived}  # fmt: skip
        return World(self.right.domains, named, self.right.where)

    def mark(self, lines: Sequence[DerivedLine]) -> MarkedDerivation:
        """Return what is said of all lines."""
        cells = tuple(self._mark_line(line) for line in lines)
        missing = tuple(name for name in self.key.lines if self.earned.get(name, 0) < 1)
        note, fields = self._find_fault(lines, cells, missing)
        points = (share * self.key.lines[name].points for name, share in self.earned.items())
        count = len(self.key.lines)
        fields |= {"right": count - len(missing), "of": count, "because": missing}
        return MarkedDerivation(cells, sum(points, Fraction(0)), note, fields)

    def follow(self, lines: Sequence[DerivedLine]) -> tuple[Verdict, ...]:
        """Return what is said of each line while others are still to come.

        Whether the goal is right is not said before what leads to it is there: nobody is to find it
        by trying.
        """
        found = []
        for line in lines:
            aims = any(self._may_be_goal(one) for one in line.relations)
            early = aims and not self._is_led_up_to()
            cell = self._mark_line(line)
            told = not early or cell.note == "line-carried"
            found.append(cell if told else ambiguous("line-early", cell.read_as))
        return tuple(found)

    def _may_be_goal(self, relation: Relation) -> bool:
        """Return whether a relation has the form of the goal, true or not."""
        return self._states_goal(relation) if self.goal.op == "eq" else relation.op != "eq"

    def _is_led_up_to(self) -> bool:
        """Return whether the lines are there that the goal needs, or any if none is needed."""
        needed = {name for name, line in self.key.lines.items() if line.needed} - {self.goal_name}
        there = self.earned.keys() - {self.goal_name}
        return needed <= there if needed else bool(there)

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
        skipped = [name for name in missing if self.key.lines[name].needed]
        later = [number for name, number in self.reached.items()
                 if skipped and self._is_behind(name, skipped[0])]  # fmt: skip
        if later:
            return "line-jump", {"at_line": min(later)}
        if [*missing] == [self.goal_name]:
            return "line-goal", {}
        return "lines-missing", {}

    def _is_behind(self, name: str, other: str) -> bool:
        """Return whether a line of the key comes after another one."""
        order = list(self.key.lines)
        return order.index(name) > order.index(other)

    def _mark_line(self, line: DerivedLine) -> Verdict:
        """Return the verdict on one line, and remember what it says."""
        shown = safe_echo(line.display_text, LONGEST_LINE)
        if not line.relations:
            return ambiguous("line-reason" if self.key.has_reasons else "line-words", shown)
        for name, place in line.defines:
            self._define(name, line.relations[place])
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
            find_lost_solution(relation, one, self.right.domains, self.right.where)
            for one in self.before
            for relation in relations
        )

    def _choose_reading(self, line: DerivedLine) -> tuple[Relation, ...]:
        """Return the relations of a line by that reading of its numbers that holds, if one does."""
        if not line.others or all(self.right.holds(one) for one in line.relations):
            return line.relations
        return line.others if all(self.right.holds(one) for one in line.others) else line.relations

    def _define(self, name: str, first: Relation) -> None:
        """Add a name that the learner gives a meaning to every world; one without is free there."""
        meaning = next(
            (one for one in solve_for(first, name)[::-1] if name not in names_in(one)), None
        )

        def admit(world: World) -> World:
            """Return a world that knows the name."""
            defined = world.define(name, meaning) if meaning is not None else None
            return defined or World({**world.domains, name: "real"}, world.definitions, world.where)

        self.right, self.known, self.led = map(admit, (self.right, self.known, self.led))
        self.wrong = admit(self.wrong) if self.wrong else None
        self.derived.append(name)

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
        if any(self._says_the_same(relation, one) for one in self.key.given):
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
            if lost := find_lost_solution(one, relation, domains, self.right.where):
                return lost
        return ""

    def _iter_reached(self, relation: Relation) -> Iterator[str]:
        """Yield the lines of the key that are there now and were not before."""
        for name, forms in self.forms.items():
            if name in self.earned or name in self.spoilt:
                continue
            needed = self.key.lines[name].needed
            later = needed and any(self._is_behind(other, name) for other in self.earned)
            if (
                self._states_goal(relation)
                if name == self.goal_name
                else any(
                    self._follows(form, relation, needed=needed, alone=later) for form in forms
                )
            ):
                yield name

    def _follows(
        self, form: Relation, relation: Relation, *, needed: bool = False, alone: bool = False
    ) -> bool:
        """Return whether a form of the key follows from what is written, or says it in numbers.

        With ``alone`` it must follow from the last line by itself: what comes later in the key is
        there already, and would imply it.
        """
        if form.op != "eq":
            return self._is_in_numbers(relation, form) or implies(
                relation, form, self.right.domains, self.derived
            )
        if not alone and (self.led if needed else self.known).holds(form) is True:
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
            return any(self._follows(form, relation) for form in self.forms[self.goal_name])
        most = _size(goal.right)
        return relation.op == "eq" and any(
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
        count = len(self.key.world.definitions)
        rest = [*self.derived[:count][::-1], *self.derived[count:]]
        return list(dict.fromkeys([*alone, *(name for name in rest if name in relation.names)]))

    def _mark_wrong(self, relation: Relation, shown: str) -> Verdict:
        """Return why a relation does not hold, and what follows from it from now on."""
        self.errors += 1
        if self.errors > MOST_ERRORS:
            return wrong(shown, "line-wrong")
        why, fields = self._explain_wrong(relation) if self.errors == 1 else ("", {})
        subjects = self._subjects(relation)
        self._spoil(subjects)
        base = self.wrong or self._without_expectations()
        for name in subjects:
            worlds = (base.define(name, formula) for formula in solve_for(relation, name)
                      if name not in names_in(formula))  # fmt: skip
            found = next((w for w in worlds if w is not None and w.holds(relation)), None)
            if found is not None:
                self.wrong = found
                break
        return wrong(shown, "line-wrong", why=why, **fields)

    def _without_expectations(self) -> World:
        """Return the right world, but derived quantities may have any sign and size.

        What follows from an error need not meet what is said of them.
        """
        domains = {**self.right.domains, **dict.fromkeys(self.derived, "real")}
        about_free = [one for one in self.right.where if names_in(one).isdisjoint(self.derived)]
        return World(domains, self.right.definitions, about_free)

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
        return relation.op == "eq" and any(
            own == self.goal.left and not names_in(other) & {*self.derived}
            for own, other in _both_ways(relation)
        )

    def _explain_wrong(  # noqa: PLR0911 - one for each cause
        self, relation: Relation
    ) -> tuple[str, dict[str, object]]:
        """Return the note of what is wrong with a relation, as far as it is certain."""
        domains, about = self.right.domains, self._subjects(relation)[:1]
        for name, traps in self.key.traps.items():
            unfolded = [(self._unfold_but(about, relation), self._unfold_but(about, trap))
                        for trap in traps]  # fmt: skip
            if any(
                implies(*pair, domains, self.derived)
                for one, other in (*((relation, trap) for trap in traps), *unfolded)
                for pair in ((one, other), (other, one))
            ):
                return f"trap:{name}", {}
        left, right = relation.left, relation.right
        if relation.op != "eq":
            turned = {"lt": "gt", "le": "ge", "gt": "lt", "ge": "le"}.get(relation.op, "eq")
            held = self.right.holds(Relation(turned, left, right))
            return ("line-inequality" if held and turned != "eq" else "line-false"), {}
        if self.right.holds(Relation("eq", left, Call("neg", (right,)))):
            return "line-sign", {}
        if self.right.holds(Relation("eq", left, Call("div", (Num(Fraction(1)), right)))):
            return "line-upside-down", {}
        if names := self._assumed_positive(relation):
            return "line-assumes", {"names": names}
        if self._is_off_by_a_factor(relation):
            return "line-factor", {}
        return "line-false", {}

    def _unfold_but(self, names: Sequence[str], relation: Relation) -> Relation:
        """Return a relation with all derived names replaced by what they are, but these."""
        known = {name: of for name, of in self.right.definitions.items() if name not in names}
        left, right = (_unfold(side, known) for side in (relation.left, relation.right))
        return Relation(relation.op, left, right, relation.near)

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

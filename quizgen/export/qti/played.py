"""What an ask becomes in an item: a response, where it is given, how it is marked, what is said.

Engines read ``null`` in comparisons in different ways, so all rules stand behind a test whether
anything was given (``item``); and not all know ``equal`` with a tolerance, so an interval is two
comparisons.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import singledispatch
from typing import NamedTuple

from markupsafe import Markup

from quizgen.bank.markdown import PlainText
from quizgen.export.asks import (
    Ask,
    Choose,
    Fill,
    Numeric,
    Order,
    Pairs,
    Said,
    Truth,
    Write,
    as_pairs,
)
from quizgen.export.qti.dialect import Attributes, written
from quizgen.export.qti.place import Place
from quizgen.export.ranges import Range
from quizgen.export.wording import beside, inline, marked
from quizgen.locale import translate

LENGTH = 20
"""Signs that a field for a number or a word has room for."""
TABULAR = "qti-match-tabular"
"""Pairs as a table to tick, by the vocabulary of QTI 3.0: it can be used without dragging."""


class Feedback(NamedTuple):
    """What is said when an outcome has this value."""

    outcome: str
    value: str
    said: Said


class Played(NamedTuple):
    """An ask as an engine plays it; ``rules`` are those for a response that was given.

    ``outcomes`` are those that ``feedback`` depends on.
    """

    response: Markup
    outcomes: Markup
    shown: Markup
    rules: Markup
    feedback: list[Feedback]


@singledispatch
def played(ask: Ask, _at: Place) -> Played:
    """The pieces of an item that an ask becomes."""
    raise TypeError(type(ask).__name__)


@played.register
def _number(ask: Numeric, at: Place) -> Played:
    right = [_within(one, at) for one in ask.ranges if one.right]
    wrong = [(_within(one, at), one.said) for one in ask.ranges if not one.right and one.said]
    declared = at.declared("single float", [written(ask.key.value)])
    return _compared(at, declared, beside(ask, _entry(at), at.lang, at.number), right, wrong)


def _within(one: Range, at: Place) -> Markup:
    low = at.tag("gte", {}, at.given(), at.value("float", one.low))
    return at.tag("and", {}, low, at.tag("lte", {}, at.given(), at.value("float", one.high)))


@played.register
def _words(ask: Fill, at: Place) -> Played:
    def same(typed: str) -> Markup:
        how = {"caseSensitive": str(ask.printed).lower()}
        return at.tag("stringMatch", how, at.given(), at.value("string", typed))

    wrong = [(same(typed), said) for typed, said in ask.wrong if said]
    declared = at.declared("single string", ask.right[:1])
    shown = Markup("<p>{}{}</p>").format(at.number, _entry(at))
    return _compared(at, declared, shown, [same(typed) for typed in ask.right], wrong)


def _entry(at: Place) -> Markup:
    return at.asked("textEntryInteraction", {"expectedLength": LENGTH})


def _compared(
    at: Place,
    declared: Markup,
    shown: Markup,
    right: list[Markup],
    wrong: Sequence[tuple[Markup, Said]],
) -> Played:
    """What is typed earns all marks, or is told what went wrong."""
    feedback = [Feedback(at.said, f"M{i}", said) for i, (_, said) in enumerate(wrong, 1)]
    rows = [(at.any_of(right), at.earns(at.worth))]
    rows += [
        (test, at.says(at.said, one.value)) for one, (test, _) in zip(feedback, wrong, strict=True)
    ]
    outcome = at.outcome(at.said) if feedback else Markup("")
    return Played(declared, outcome, shown, at.cases(rows), feedback)


@played.register
def _truth(ask: Truth, at: Place) -> Played:
    rows = {name: Markup.escape(translate(at.lang, f"ask.{name}")) for name in ("true", "false")}
    right = "true" if ask.true else "false"
    said = {name: ask.said for name in rows if name != right}
    return _chosen(at, rows, [right], said, many=False)


@played.register
def _options(ask: Choose, at: Place) -> Played:
    rows = {one.mark: marked(one.mark, one.words, at.lang) for one in ask.options}
    said = {one.mark: one.said for one in ask.options}
    return _chosen(at, rows, [one.mark for one in ask.right], said, many=ask.many)


def _chosen(
    at: Place,
    rows: Mapping[str, Markup],
    right: Sequence[str],
    said: Mapping[str, Said],
    *,
    many: bool,
) -> Played:
    """Options to choose from; the outcome of what is said is what was chosen."""
    cardinality = "multiple" if many else "single"
    share = at.worth / max(len(right), 1)
    shares = {at.choice(mark): share if mark in right else -share for mark in rows}
    mapping = [at.mapping(shares)] if many else []
    declared = at.declared(f"{cardinality} identifier", map(at.choice, right), *mapping)
    feedback = [Feedback(at.said, at.choice(mark), told) for mark, told in said.items() if told]
    outcome, rules = Markup(""), at.exactly(partly=many)
    if feedback:
        outcome = at.outcome(at.said, cardinality)
        rules += at.sets(at.said, at.given())
    choices = [at.tag("simpleChoice", {"identifier": at.choice(m)}, row) for m, row in rows.items()]
    how = {"shuffle": "false", "maxChoices": 0 if many else 1}
    shown = at.asked("choiceInteraction", how, *choices)
    return Played(declared, outcome, shown, rules, feedback)


@played.register
def _pairs(ask: Pairs, at: Place) -> Played:
    """A table to tick; each wrong pair is told apart."""
    shares = {at.pair(*pair): at.worth / len(ask.stems) for pair in ask.right.items()}
    declared = at.declared("multiple directedPair", shares, at.mapping(shares))
    outcomes, rules, feedback = Markup(""), at.exactly(partly=True), list[Feedback]()
    for stem, _ in ask.stems:
        outcome = f"{at.said}_{stem}"
        wrong = [(mark, ask.said.get((stem, mark), ())) for mark, _ in ask.targets]
        found = [Feedback(outcome, at.choice(mark), said) for mark, said in wrong if said]
        if found:
            outcomes += at.outcome(outcome)
            rules += at.cases(
                (_paired(stem, one, at), at.says(outcome, one.value)) for one in found
            )
        feedback += found
    sides = [_side(ask.stems, 1, at), _side(ask.targets, 0, at)]
    how: Attributes = {"class": TABULAR, "shuffle": "false", "maxAssociations": len(ask.stems)}
    shown = at.asked("matchInteraction", how, *sides)
    return Played(declared, outcomes, shown, rules, feedback)


def _paired(stem: str, one: Feedback, at: Place) -> Markup:
    pair = at.value("directedPair", f"{at.choice(stem)} {one.value}")
    return at.tag("member", {}, pair, at.given())


def _side(rows: Sequence[tuple[str, Said]], most: int, at: Place) -> Markup:
    """One side of a matching; each of it can be used so often, any number of times with 0."""
    choices = [
        at.tag(
            "simpleAssociableChoice",
            {"identifier": at.choice(mark), "matchMax": most},
            mark if words == (PlainText(mark),) else marked(mark, words, at.lang),
        )
        for mark, words in rows
    ]
    return at.tag("simpleMatchSet", {}, *choices)


@played.register
def _order(ask: Order, at: Place) -> Played:
    """Steps to sort; each in its place has its share, as in other systems."""
    if not ask.whole:
        return _pairs(as_pairs(ask, at.lang), at)
    right = [at.choice(mark) for mark in ask.right]
    partly = Markup("").join(
        at.cases([(_in_place(step, place, at), at.earns_more(at.worth / len(right)))])
        for place, step in enumerate(right, 1)
    )
    steps = [
        at.tag("simpleChoice", {"identifier": at.choice(mark)}, marked(mark, words, at.lang))
        for mark, words in ask.steps
    ]
    declared = at.declared("ordered identifier", right)
    shown = at.asked("orderInteraction", {"shuffle": "false"}, *steps)
    rules = at.cases([(at.correct(), at.earns(at.worth))], partly)
    return Played(declared, Markup(""), shown, rules, [])


def _in_place(step: str, place: int, at: Place) -> Markup:
    there = at.tag("index", {"n": place}, at.given())
    return at.tag("match", {}, there, at.value("identifier", step))


@played.register
def _written(ask: Write, at: Place) -> Played:
    """A person marks it by the key, which nobody else sees."""
    key = Markup("<p>{}</p>").format(inline(ask.key, at.lang))
    rubric = at.dialect.flow("rubricBlock", {"view": "scorer", "use": "scoring"}, key)
    shown = at.asked("extendedTextInteraction", {"expectedLines": ask.lines})
    declared = at.declared("single string", ())
    return Played(declared, Markup(""), shown + rubric, Markup(""), [])

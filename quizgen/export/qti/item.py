"""A question as an item."""

from __future__ import annotations

import re
from collections.abc import Iterator
from fractions import Fraction
from typing import NamedTuple

from markupsafe import Markup

from quizgen.bank.pictures import PictureFile
from quizgen.export import pictures
from quizgen.export.asks import Ask, Write
from quizgen.export.items import Item
from quizgen.export.kept import asked
from quizgen.export.qti.dialect import QTI21, Dialect, written
from quizgen.export.qti.place import Place
from quizgen.export.qti.played import Played, played
from quizgen.export.wording import body, inline, pictures_at, solution, stem
from quizgen.figures import Figure
from quizgen.locale import translate
from quizgen.responses.keys import Entry

SOLVED, WORKED = "SOLUTION", "worked"
"""Outcome and value that show the worked solution."""

_OTHER = re.compile(r"[^A-Za-z0-9_-]")
_MATHS = re.compile(r"<math(?=[ >])")


class Row(NamedTuple):
    """An ask, where it stands, and what it becomes."""

    ask: Ask
    at: Place
    played: Played


def name_of(item: Item) -> str:
    """What an item is called in a package: its id without points, which have a meaning there."""
    name = _OTHER.sub("_", item.id)
    return name if name[0].isalpha() else f"Q{name}"


def item_file(item: Item, dialect: Dialect) -> bytes:
    """A question as the file of an item."""
    with pictures_at(_source):
        return _item_file(item, dialect)


def _item_file(item: Item, dialect: Dialect) -> bytes:
    groups = [
        [Row(ask, at, played(ask, at)) for ask, at in group] for group in _asked(item, dialect)
    ]
    rows = [row for group in groups for row in group]
    named = {
        "identifier": name_of(item),
        "title": item.called(),
        "xml:lang": item.lang,
        "adaptive": "false",
        "timeDependent": "false",
        "toolName": "quizgen",
    }
    inside = [*_declared(item, rows, dialect), _body(item, groups, dialect)]
    inside += [_processing(item, groups, dialect), *_feedback(item, rows, dialect)]
    return dialect.file("assessmentItem", named, *map(_xml, inside))


def kept(item: Item) -> Iterator[Entry]:
    """How the variables of an item are read back; both versions name them alike."""
    groups = zip(item.parts, _asked(item, QTI21), strict=True)
    fields = [
        asked(ask, part, item.lang, at.response) for (part, _), group in groups for ask, at in group
    ]
    yield Entry(item.mark(), name_of(item), fields)


def _asked(item: Item, dialect: Dialect) -> Iterator[list[tuple[Ask, Place]]]:
    """What each part asks, with the places of it.

    Each of several values counts 1: marks such as 2/3 would not sum up where outcomes are rounded.
    """
    for part, asks in item.parts:
        label = f"_{part.label}" if part.label else ""
        points = float(part.points)
        yield [
            (ask, Place(dialect, f"{label}_{i}", 1.0, item.lang, f"{i}. "))
            if len(asks) > 1
            else (ask, Place(dialect, label, points, item.lang))
            for i, ask in enumerate(asks, 1)
        ]


def _declared(item: Item, rows: list[Row], dialect: Dialect) -> Iterator[Markup]:
    """Responses, then outcomes: the marks of each ask, of all of them, and what is shown."""
    total = float(item.question.points)
    yield from (row.played.response for row in rows)
    yield from (_marks(row.at.score, row.at.worth, row.ask, dialect) for row in rows)
    if not _alone(rows):
        yield _marks("SCORE", total, None, dialect)
    yield dialect.outcome("MAXSCORE", "single float", {}, _start(total, dialect))
    yield dialect.outcome(SOLVED, "single identifier", {})
    yield from (row.played.outcomes for row in rows)


def _alone(rows: list[Row]) -> bool:
    """Whether an item asks one thing, whose marks are those of the item."""
    return [row.at.score for row in rows] == ["SCORE"]


def _marks(name: str, most: float, ask: Ask | None, dialect: Dialect) -> Markup:
    """An outcome of marks; QTI 3.0 says if a person gives them."""
    by_hand = dialect.prefixed and isinstance(ask, Write)
    human = {"externalScored": "human"} if by_hand else {}
    return dialect.outcome(
        name, "single float", {"normalMaximum": most, **human}, _start(0, dialect)
    )


def _start(value: float, dialect: Dialect) -> Markup:
    return dialect.tag("defaultValue", {}, dialect.tag("value", {}, written(value)))


def _body(item: Item, groups: list[list[Row]], dialect: Dialect) -> Markup:
    shown = stem(item, _source)
    for (part, asks), group in zip(item.parts, groups, strict=True):
        shown += body(part, asks, item.lang, _source)
        shown += Markup("").join(row.played.shown for row in group)
    return dialect.tag("itemBody", {}, shown)


def _processing(item: Item, groups: list[list[Row]], dialect: Dialect) -> Markup:
    """Rules for each response that was given, then the sum of marks, then the solution."""
    rows = [row for group in groups for row in group]
    rules = [row.at.if_given(row.played.rules) for row in rows if row.played.rules]
    if not _alone(rows):
        points = [part.points for part in item.question.parts]
        marks = map(_part, groups, points)
        rules.append(rows[0].at.sets("SCORE", dialect.tag("sum", {}, *marks)))
    rules.append(rows[0].at.says(SOLVED, WORKED))
    return dialect.tag("responseProcessing", {}, *rules)


def _part(group: list[Row], points: Fraction) -> Markup:
    """The marks of a part: those of its one ask, or its share of right values."""
    at = group[0].at
    scores = [at.tag("variable", {"identifier": row.at.score}) for row in group]
    if len(scores) == 1:
        return scores[0]
    share = at.value("float", float(points / len(scores)))
    return at.tag("product", {}, at.tag("sum", {}, *scores), share)


def _feedback(item: Item, rows: list[Row], dialect: Dialect) -> Iterator[Markup]:
    """What is said of each mistake, and the worked solution."""
    for one in (one for row in rows for one in row.played.feedback):
        yield _modal(dialect, one.outcome, one.value, inline(one.said, item.lang))
    title = translate(item.lang, "solution.steps")
    yield _modal(dialect, SOLVED, WORKED, solution(item, _source), title)


def _modal(dialect: Dialect, outcome: str, value: str, said: Markup, title: str = "") -> Markup:
    named = {"outcomeIdentifier": outcome, "identifier": value, "showHide": "show"}
    return dialect.flow("modalFeedback", {**named, **({"title": title} if title else {})}, said)


def _source(shown: Figure | PictureFile) -> str:
    return f"../{pictures.path(shown)}"


def _xml(page: Markup) -> Markup:
    """HTML that is well formed as XML says the same."""
    shown = _MATHS.sub('<math xmlns="http://www.w3.org/1998/Math/MathML"', page)
    return Markup(shown.replace(' lang="', ' xml:lang="'))

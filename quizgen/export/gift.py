"""Questions as GIFT, Moodle's plain text: one question for each part that asks one thing.

Several values cannot stand in one question, pictures stand in the text itself, and marks cannot be
said at all.

Sources: Moodle documentation, "GIFT format".
"""

from __future__ import annotations

import base64
from collections.abc import Iterable, Iterator, Mapping
from functools import singledispatch
from itertools import groupby

from markupsafe import Markup

from quizgen.export.answers import Answer, answers, lettered
from quizgen.export.asks import Ask, Choose, Fill, Numeric, Order, Pairs, Truth, Write, as_pairs
from quizgen.export.items import Item, by_slot, suffix
from quizgen.export.kept import asked
from quizgen.export.wording import body, inline, marked, signed, solution, stem, targets
from quizgen.figures import Figure
from quizgen.question.compose import QuestionPart
from quizgen.responses import keys

_SIGNS = {ord(sign): f"\\{sign}" for sign in "\\~=#{}:"} | {ord("\n"): "\\n", ord("\r"): ""}


def write(items: Iterable[Item]) -> bytes:
    """The questions as a file to import.

    Parameters
    ----------
    items : iterable of Item

    Returns
    -------
    bytes
        The same for the same questions.
    """
    return "\n\n".join(_blocks(items)).encode() + b"\n"


def by_hand(item: Item) -> Iterator[tuple[str, str]]:
    """Field and why, of each part that a person marks: here also where several values are asked."""
    for part, found in item.parts:
        ask = _only(found)
        if isinstance(ask, Write):
            yield part.field.id, ask.why


def kept(item: Item) -> Iterator[keys.Entry]:
    """How the one field of each part is read back."""
    for part, found in item.parts:
        fields, behind = [asked(_only(found), part, item.lang)], suffix(part)
        yield keys.Entry(item.mark(behind), f"{item.id}{behind}", fields)


def _blocks(items: Iterable[Item]) -> Iterator[str]:
    for slot, found in groupby(by_slot(items), key=lambda item: item.category):
        yield f"$CATEGORY: $course$/top/quizgen/{slot}"
        for item in found:
            for part, asks in item.parts:
                yield _question(item, part, _only(asks))


def _only(found: tuple[Ask, ...]) -> Ask:
    """The one thing that a part asks."""
    return found[0] if len(found) == 1 else Write("several", ())


def _question(item: Item, part: QuestionPart, ask: Ask) -> str:
    behind = suffix(part)
    text = stem(item, _source) + body(part, (ask,), item.lang, _source)
    text += signed(item, behind)
    told = solution(item, _source, (part.label,))
    tags = "".join(f" [tag:{tag}]" for tag in item.tags)
    name = _text(item.called(behind))
    inside = f"{_inside(ask, item.lang)}####{_text(told)}"
    return f"// [id:{item.id}{behind}]{tags}\n::{name}::[html]{_text(text)}{{{inside}}}"


def _source(figure: Figure) -> str:
    return f"data:image/svg+xml;base64,{base64.b64encode(figure.standalone_svg).decode()}"


def _text(text: str) -> str:
    """A text with the signs of the grammar behind backslashes, on one line."""
    return str(text).translate(_SIGNS)


def _line(one: Answer, typed: str) -> str:
    return typed + (f"#{_text(one.said)}" if one.said else "")


@singledispatch
def _inside(ask: Ask, _lang: str) -> str:
    raise TypeError(type(ask).__name__)


@_inside.register
def _written(_ask: Write, _lang: str) -> str:
    return ""


@_inside.register
def _number(ask: Numeric, lang: str) -> str:
    rows = [
        f"={_share(one.percent)}{_line(one, f'{one.typed}:{one.tolerance}')}"
        for one in answers(ask, lang)
    ]
    return "#" + " ".join(rows)


@_inside.register
def _words(ask: Fill, lang: str) -> str:
    rows = [f"={_share(a.percent)}{_line(a, _text(a.typed))}" for a in answers(ask, lang)]
    return " ".join(rows)


def _share(percent: float) -> str:
    """A right answer has no share: GIFT would not read ``%100%``."""
    return "" if percent == 100 else f"%{percent:.9g}%"


@_inside.register
def _options(ask: Choose, lang: str) -> str:
    """One right option among several is a choice of one, since ``%100%`` is not read."""
    single = len(ask.right) == 1
    rows = []
    for one in answers(ask, lang):
        right, share = one.percent > 0, "" if single else _share(one.percent)
        rows.append(("=" if single and right else "~") + share + _line(one, _text(lettered(one))))
    return " ".join(rows)


@_inside.register
def _truth(ask: Truth, lang: str) -> str:
    return f"{'T' if ask.true else 'F'}#{_text(inline(ask.said, lang))}"


@_inside.register(Pairs)
@_inside.register(Order)
def _pairs(ask: Pairs | Order, lang: str) -> str:
    pairs = as_pairs(ask, lang)
    named: Mapping[str, str] = targets(pairs)
    rows = [(marked(mark, words, lang), named[pairs.right[mark]]) for mark, words in pairs.stems]
    rows += [(Markup(""), name) for mark, name in named.items() if mark not in pairs.right.values()]
    return " ".join(f"={_text(left)} -> {_text(right)}" for left, right in rows)

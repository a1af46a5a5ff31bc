"""Questions as Moodle XML: a category for each slot, a question for each variant.

A part alone becomes a question of Moodle's own type for it. Several parts, or several values, make
one question with embedded fields (cloze), so that its figure and its story stand there once; what
a person marks is an essay beside it.

Sources: Moodle documentation, "Moodle XML format" and "Embedded Answers (Cloze) question type".
"""

from __future__ import annotations

import base64
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, singledispatch
from itertools import groupby
from math import lcm
from typing import NamedTuple

import jinja2
from markupsafe import Markup

from quizgen.export.asks import Ask, Choose, Fill, Numeric, Order, Pairs, Truth, Write, as_pairs
from quizgen.export.items import Item
from quizgen.figures import Figure
from quizgen.locale import word
from quizgen.maths.units import shown as shown_unit
from quizgen.question.compose import Part
from quizgen.question.markup import blocks, inline
from quizgen.question.shown import named
from quizgen.render.html import fragment
from quizgen.render.layouts import environment
from quizgen.render.text import inline as in_text

SHARES = (100, 90, 83.33333, 80, 75, 70, 66.66667, 60, 50, 40, 33.33333, 30, 25, 20, 16.66667,
          14.28571, 12.5, 11.11111, 10, 5, 0)  # fmt: skip
"""The percentages that Moodle knows; a question with another one is left out without a word."""


class Answer(NamedTuple):
    """An answer, its percentage, and what is said to it."""

    typed: str
    percent: float
    said: Markup = Markup("")
    tolerance: str = ""


@dataclass(frozen=True)
class Entry:
    """A question as Moodle has it.

    ``kind`` is Moodle's name of its type, ``ask`` what it asks if it asks one thing.
    """

    item: Item
    kind: str
    id: str
    name: str
    points: Fraction
    text: Markup
    ask: Ask | None = None


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
    rows = sorted(items, key=lambda item: (item.lang, item.slot))
    slots = [
        (f"{lang}/{slot}", [entry for item in found for entry in entries(item)])
        for (lang, slot), found in groupby(rows, key=lambda item: (item.lang, item.slot))
    ]
    page = _layouts().get_template("moodle.xml.j2")
    return page.render(slots=slots).encode()


@cache
def _layouts() -> jinja2.Environment:
    layouts = environment("quizgen.export")
    layouts.globals.update(
        answers=answers,
        base64=lambda figure: base64.b64encode(figure.svg).decode(),
        inline=inline,
        targets=lambda pairs: dict(pairs.targets),
        text=in_text,
        cdata=lambda text: Markup(str(text).replace("]]>", "]]]]><![CDATA[>")),  # noqa: S704
        solution=_solution,
        in_order=lambda order: [dict(order.steps)[mark] for mark in order.right],
    )
    return layouts


def _solution(item: Item) -> Markup:
    """The worked solution, and its picture if it has one of its own."""
    return fragment("worked.html.j2", item=item.paper_item, picture=_picture(item.key.figure))


def entries(item: Item) -> Iterator[Entry]:
    """The questions that an item becomes: one, and an essay for each part that a person marks."""
    by_machine = [(part, found) for part, found in item.parts if not _by_person(found)]
    if by_machine:
        yield _one(item, by_machine) or _cloze(item, by_machine)
    for part, found in item.parts:
        for ask in found:
            if isinstance(ask, Write):
                suffix = f".{part.label}" if by_machine or len(item.parts) > 1 else ""
                text = _stem(item) + _body(part, item.lang)
                yield _entry(item, "essay", suffix, part.points, text, ask)


def _by_person(found: Sequence[Ask]) -> bool:
    return any(isinstance(ask, Write) for ask in found)


def _entry(
    item: Item, kind: str, suffix: str, points: Fraction, text: Markup, ask: Ask | None
) -> Entry:
    number = item.id.rsplit(".", 1)[0]
    name = f"{item.question.title} ({number}{suffix})"
    return Entry(item, kind, f"{item.id}{suffix}", name, points, text, ask)


def _one(item: Item, parts: Sequence[tuple[Part, tuple[Ask, ...]]]) -> Entry | None:
    """A question of Moodle's own type, if only one thing is asked."""
    part, found = parts[0]
    if len(item.parts) > 1 or len(found) > 1:
        return None
    (ask,) = found
    text = _stem(item) + _body(part, item.lang) + _asked(part, item.lang)
    return _entry(item, _kind(ask), "", part.points, text, ask)


@singledispatch
def _kind(ask: Ask) -> str:
    raise TypeError(type(ask).__name__)


_kind.register(Numeric, lambda _ask: "numerical")
_kind.register(Choose, lambda _ask: "multichoice")
_kind.register(Truth, lambda _ask: "truefalse")
_kind.register(Pairs, lambda _ask: "matching")
_kind.register(Order, lambda _ask: "ordering")
_kind.register(Fill, lambda _ask: "shortanswer")


def _stem(item: Item) -> Markup:
    """What stands before the parts."""
    text = blocks(item.question.stem, item.lang)
    return text + _picture(item.question.figure, name="figure.svg")


def _picture(figure: Figure | None, name: str = "solution.svg") -> Markup:
    if figure is None:
        return Markup("")
    tag = Markup('<p><img src="@@PLUGINFILE@@/{}" alt="{}" width="{:.0f}" height="{:.0f}"></p>')
    return tag.format(name, figure.alt, figure.width_pt * 4 / 3, figure.height_pt * 4 / 3)


def _body(part: Part, lang: str) -> Markup:
    label = Markup("<p><strong>({})</strong></p>").format(part.label) if part.label else Markup("")
    return label + blocks(part.body, lang)


def _asked(part: Part, lang: str) -> Markup:
    """How exactly and in which unit an answer is meant."""
    if part.field.control.form != "line":
        return Markup("")
    return Markup("<p><small>{}</small></p>").format(inline(part.field.hint, lang))


def answers(ask: Ask, lang: str) -> list[Answer]:
    """What Moodle compares an answer with, in this order."""
    return list(_answers(ask, lang))


@singledispatch
def _answers(ask: Ask, _lang: str) -> Iterator[Answer]:
    raise TypeError(type(ask).__name__)


@_answers.register
def _numbers(ask: Numeric, lang: str) -> Iterator[Answer]:
    for one in ask.ranges:
        said = inline(one.said, lang)
        yield Answer(repr(one.value), 100 * one.right, said, repr(one.width))


@_answers.register
def _words(ask: Fill, lang: str) -> Iterator[Answer]:
    for typed in ask.right:
        yield Answer(_literal(typed), 100)
    for typed, said in ask.wrong:
        yield Answer(_literal(typed), 0, inline(said, lang))


def _literal(typed: str) -> str:
    """A star stands for anything, unless a backslash is before it."""
    return typed.replace("*", "\\*")


@_answers.register
def _options(ask: Choose, lang: str) -> Iterator[Answer]:
    for option, share in zip(ask.options, _shares(ask), strict=True):
        yield Answer(str(inline(option.words, lang)), share, inline(option.said, lang))


def _shares(ask: Choose) -> list[float]:
    """The percentage of each option: one that is too much takes away what a right one gives."""
    if not ask.many:
        return [100 * option.right for option in ask.options]
    share = _known(Fraction(100, max(len(ask.right), 1)))
    return [share if option.right else -share for option in ask.options]


def _known(share: Fraction) -> float:
    """The nearest percentage that Moodle knows."""
    return min(SHARES, key=lambda known: abs(known - share))


def _cloze(item: Item, parts: Sequence[tuple[Part, tuple[Ask, ...]]]) -> Entry:
    """One question with a field in its text for each value."""
    shares = [part.points / _fields(found, item.lang) for part, found in parts]
    scale = lcm(*(share.denominator for share in shares))
    text = _stem(item)
    for (part, found), share in zip(parts, shares, strict=True):
        text += _body(part, item.lang) + _asked(part, item.lang)
        for ask in found:
            text += _embedded(ask, int(share * scale), item.lang)
    points = sum((part.points for part, _ in parts), Fraction(0))
    return _entry(item, "cloze", "", points, text, None)


def _fields(found: Sequence[Ask], lang: str) -> int:
    """How many fields embed what is asked."""
    return sum(
        len(as_pairs(ask, lang).stems) if isinstance(ask, Pairs | Order) else 1 for ask in found
    )


@singledispatch
def _embedded(ask: Ask, _weight: int, _lang: str) -> Markup:
    raise TypeError(type(ask).__name__)


@_embedded.register
def _embedded_number(ask: Numeric, weight: int, lang: str) -> Markup:
    name = inline((named(ask.name),), lang) + " = " if ask.name else ""
    rows = [(f"{a.typed}:{a.tolerance}", a.percent, a.said) for a in answers(ask, lang)]
    unit = "" if ask.unit in {"", "1"} else f" {shown_unit(ask.unit)}"
    return Markup("<p>{}{}{}</p>").format(name, _field(weight, "NUMERICAL", rows), unit)


@_embedded.register
def _embedded_words(ask: Fill, weight: int, lang: str) -> Markup:
    rows = [(_cloze_text(a.typed), a.percent, a.said) for a in answers(ask, lang)]
    return Markup("<p>{}</p>").format(_field(weight, "SHORTANSWER", rows))


@_embedded.register
def _embedded_options(ask: Choose, weight: int, lang: str) -> Markup:
    rows = [(_cloze_text(a.typed), a.percent, a.said) for a in answers(ask, lang)]
    kind = "MULTIRESPONSE" if ask.many else "MULTICHOICE_V"
    return Markup("<div>{}</div>").format(_field(weight, kind, rows))


@_embedded.register
def _embedded_truth(ask: Truth, weight: int, lang: str) -> Markup:
    said = inline(ask.said, lang)
    rows = [
        (_cloze_text(word(lang, f"ask.{name}")), 100 * right, Markup("") if right else said)
        for name, right in (("true", ask.true), ("false", not ask.true))
    ]
    return Markup("<div>{}</div>").format(_field(weight, "MULTICHOICE_H", rows))


@_embedded.register(Pairs)
@_embedded.register(Order)
def _embedded_pairs(ask: Pairs | Order, weight: int, lang: str) -> Markup:
    """A drop-down of the targets' marks for each stem, since it can hold no formulas."""
    pairs = as_pairs(ask, lang)
    listed = Markup("").join(
        Markup("<li>{} {}</li>").format(mark, inline(words, lang))
        for mark, words in pairs.targets
        if isinstance(ask, Pairs)
    )
    rows = Markup("").join(
        Markup("<li>{} {}</li>").format(inline(words, lang), _drop_down(pairs, mark, weight, lang))
        for mark, words in pairs.stems
    )
    above = Markup("<ul>{}</ul>").format(listed) if listed else Markup("")
    return above + Markup("<ul>{}</ul>").format(rows)


def _drop_down(pairs: Pairs, stem: str, weight: int, lang: str) -> Markup:
    rows = [
        (mark, 100 * (pairs.right[stem] == mark), inline(pairs.said.get((stem, mark), ()), lang))
        for mark, _ in pairs.targets
    ]
    return _field(weight, "MULTICHOICE", rows)


def _field(weight: int, kind: str, rows: Iterable[tuple[str, float, Markup]]) -> Markup:
    """A field of a cloze: ``{2:NUMERICAL:=3.5:0.1~%0%7:0.2#Halved twice.}``."""
    texts = [
        f"%{percent:.9g}%{typed}" + (f"#{_cloze_text(str(said))}" if said else "")
        for typed, percent, said in rows
    ]
    return Markup(f"{{{weight}:{kind}:{'~'.join(texts)}}}")  # noqa: S704 - rows are escaped


_SIGNS = {ord("&"): "&amp;"} | {ord(sign): f"&#{ord(sign)};" for sign in "~#{}=%"}


def _cloze_text(text: str) -> str:
    """A text inside a field: signs of the field's own grammar as entities, which are read once."""
    return text.translate(_SIGNS)

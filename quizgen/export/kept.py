"""What an export leaves behind: how to read the fields of a question back, and what marks it."""

from __future__ import annotations

import html
import re
from collections.abc import Iterable
from functools import singledispatch

import msgspec

from quizgen.export.asks import Ask, Choose, Fill, Numeric, Order, Pairs, Said, Truth, as_pairs
from quizgen.export.items import Item
from quizgen.export.wording import inline, targets
from quizgen.question.compose import QuestionPart
from quizgen.render.text import inlines_to_plain_text as in_text
from quizgen.responses.keys import Asked, Entry, Kept, Shape

_TAG = re.compile(r"<[^>]*>")


def kept(item: Item, entries: Iterable[Entry]) -> Kept:
    """A question with the entries that it became."""
    question = msgspec.Raw(msgspec.json.encode(item.key_question))
    shapes = {part.field.id: _shape(part) for part in item.question.parts}
    return Kept(item.id, item.slot, item.lang, question, shapes, list(entries))


def _shape(part: QuestionPart) -> Shape:
    control = part.field.control
    return Shape(control.form, [box.name for box in control.boxes], control.named)


def asked(ask: Ask, part: QuestionPart, lang: str, name: str = "") -> Asked:
    """A field of a part, and what the system calls it."""
    return msgspec.structs.replace(_asked(ask, part.field.id, lang), name=name)


@singledispatch
def _asked(_ask: Ask, part: str, _lang: str) -> Asked:
    return Asked("written", part)


@_asked.register
def _number(ask: Numeric, part: str, _lang: str) -> Asked:
    return Asked("number", part, unit="" if ask.unit == "1" else ask.unit)


@_asked.register
def _words(_ask: Fill, part: str, _lang: str) -> Asked:
    return Asked("words", part)


@_asked.register
def _truth(_ask: Truth, part: str, _lang: str) -> Asked:
    return Asked("truth", part)


@_asked.register
def _options(ask: Choose, part: str, lang: str) -> Asked:
    options = {option.mark: _texts(option.words, lang) for option in ask.options}
    return Asked("many" if ask.many else "one", part, options=options)


@_asked.register
def _pairs(ask: Pairs, part: str, lang: str) -> Asked:
    options = {mark: _texts(words, lang) for mark, words in ask.stems}
    there = {mark: [text] for mark, text in targets(ask).items()}
    return Asked("pairs", part, options=options, targets=there)


@_asked.register
def _order(ask: Order, part: str, lang: str) -> Asked:
    pairs = _pairs(as_pairs(ask, lang), part, lang)
    return Asked("order", part, options=pairs.options, targets=pairs.targets)


def _texts(words: Said, lang: str) -> list[str]:
    """What an option says once a system has made text of it, and in our own plain text."""
    page = html.unescape(_TAG.sub("", str(inline(words, lang))))
    return list(dict.fromkeys((page, in_text(words))))

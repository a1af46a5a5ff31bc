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

import jinja2
from markupsafe import Markup

from quizgen.bank.markdown import PlainText
from quizgen.export import pictures
from quizgen.export.answers import answers, lettered
from quizgen.export.asks import (
    Ask,
    Choose,
    Fill,
    Numeric,
    Order,
    Pairs,
    Truth,
    Write,
    as_pairs,
    by_person,
)
from quizgen.export.items import Item, suffix
from quizgen.export.kept import asked
from quizgen.export.wording import (
    beside,
    body,
    hints,
    inline,
    marked,
    signed,
    solution,
    spoken,
    stem,
    targets,
)
from quizgen.figures import Figure
from quizgen.locale import translate
from quizgen.question.compose import QuestionPart
from quizgen.render.layouts import jinja_environment
from quizgen.responses import keys

_HERE = Markup("\N{OBJECT REPLACEMENT CHARACTER}")
"""Where a field will stand."""

Asking = tuple[QuestionPart, tuple[Ask, ...]]


@dataclass(frozen=True)
class Entry:
    """A question as Moodle has it.

    ``kind`` is Moodle's name of its type, ``suffix`` tells it from others of its item, ``parts`` is
    what it asks, ``ask`` the same if it is one thing.
    """

    item: Item
    kind: str
    suffix: str
    parts: Sequence[Asking]
    ask: Ask | None = None

    @property
    def category(self) -> str:
        """Where it is kept; not with what else the item becomes, or a quiz would draw either."""
        return f"{self.item.category}{self.suffix.replace('.', '-')}"

    @property
    def id(self) -> str:
        """The same for the same question whenever it is exported."""
        return f"{self.item.id}{self.suffix}"

    @property
    def name(self) -> str:
        """What a course lists it by."""
        return self.item.called(self.suffix)

    @property
    def points(self) -> Fraction:
        """Marks of its parts."""
        return sum((part.points for part, _ in self.parts), Fraction(0))

    @property
    def text(self) -> Markup:
        """What it says, and behind it what tells its responses from those to others."""
        above, below = stem(self.item, _source), signed(self.item, self.suffix)
        if self.kind == "cloze":
            return _no_field(above) + _with_fields(self) + below
        return above + _bodies(self) + below

    @property
    def labels(self) -> list[str]:
        """What its parts are called."""
        return [part.label for part, _ in self.parts]


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
    made = sorted((entry for item in items for entry in entries(item)), key=_category)
    slots = groupby(made, key=_category)
    page = _layouts().get_template("moodle.xml.j2")
    return page.render(slots=slots).encode()


def kept(item: Item) -> Iterator[keys.Entry]:
    """How the fields of what an item becomes are read back."""
    for entry in entries(item):
        fields = [asked(ask, part, item.lang) for part, found in entry.parts for ask in found]
        yield keys.Entry(item.mark(entry.suffix), entry.id, fields, entry.kind == "cloze")


def _category(entry: Entry) -> str:
    return entry.category


@cache
def _layouts() -> jinja2.Environment:
    layouts = jinja_environment("quizgen.export")
    layouts.globals.update(
        answers=answers,
        asked=lambda entry: pictures.asked(entry.item, entry.labels),
        base64=lambda data: base64.b64encode(data).decode(),
        cdata=lambda text: Markup(str(text).replace("]]>", "]]]]><![CDATA[>")),
        hints=hints,
        in_order=lambda order: [(mark, dict(order.steps)[mark]) for mark in order.right],
        inline=inline,
        marked=marked,
        solution=lambda entry: solution(entry.item, _source, entry.labels),
        solved=lambda entry: pictures.solved(entry.item, entry.labels),
        spoken=spoken,
        targets=targets,
    )
    return layouts


def _source(figure: Figure) -> str:
    return f"@@PLUGINFILE@@/{pictures.name(figure)}"


def entries(item: Item) -> Iterator[Entry]:
    """The questions that an item becomes: one, and an essay for each part that a person marks."""
    by_machine = [(part, found) for part, found in item.parts if not by_person(found)]
    if by_machine:
        yield _one(item) or Entry(item, "cloze", "", by_machine)
    for part, found in item.parts:
        for ask in found:
            if isinstance(ask, Write):
                yield Entry(item, "essay", suffix(part), [(part, found)], ask)


def _one(item: Item) -> Entry | None:
    """A question of Moodle's own type, if only one thing is asked."""
    _, found = item.parts[0]
    if len(item.parts) > 1 or len(found) > 1:
        return None
    (ask,) = found
    if isinstance(ask, Order) and not ask.whole:
        ask = as_pairs(ask, item.lang)
    return Entry(item, _kind(ask), "", item.parts, ask)


@singledispatch
def _kind(ask: Ask) -> str:
    raise TypeError(type(ask).__name__)


_kind.register(Numeric, lambda _ask: "numerical")
_kind.register(Choose, lambda _ask: "multichoice")
_kind.register(Truth, lambda _ask: "truefalse")
_kind.register(Pairs, lambda _ask: "matching")
_kind.register(Order, lambda _ask: "ordering")
_kind.register(Fill, lambda _ask: "shortanswer")


def _bodies(entry: Entry) -> Markup:
    lang = entry.item.lang
    return Markup("").join(body(part, found, lang, _source) for part, found in entry.parts)


def _with_fields(entry: Entry) -> Markup:
    """The parts with a field in their text for each value."""
    lang = entry.item.lang
    shares = [part.points / _fields(found, lang) for part, found in entry.parts]
    scale = lcm(*(share.denominator for share in shares))
    text = Markup("")
    for (part, found), share in zip(entry.parts, shares, strict=True):
        text += _no_field(body(part, found, lang, _source))
        for ask in found:
            text += _embedded(ask, int(share * scale), lang)
    return text


def _no_field(text: Markup) -> Markup:
    """A text around fields, in which no brace begins one."""
    return Markup(text.replace("{", "&#123;"))


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
    rows = [(f"{a.typed}:{a.tolerance}", a.percent, a.said) for a in answers(ask, lang)]
    around = _no_field(beside(ask, _HERE, lang))
    return Markup(around.replace(_HERE, _field(weight, "NUMERICAL", rows)))


@_embedded.register
def _embedded_words(ask: Fill, weight: int, lang: str) -> Markup:
    kind = "SHORTANSWER_C" if ask.printed else "SHORTANSWER"
    rows = [(_cloze_text(a.typed), a.percent, a.said) for a in answers(ask, lang)]
    return Markup("<p>{}</p>").format(_field(weight, kind, rows))


@_embedded.register
def _embedded_options(ask: Choose, weight: int, lang: str) -> Markup:
    rows = [(_cloze_text(lettered(a)), a.percent, a.said) for a in answers(ask, lang)]
    kind = "MULTIRESPONSE" if ask.many else "MULTICHOICE_V"
    return Markup("<div>{}</div>").format(_field(weight, kind, rows))


@_embedded.register
def _embedded_truth(ask: Truth, weight: int, lang: str) -> Markup:
    said = inline(ask.said, lang)
    rows = [
        (_cloze_text(translate(lang, f"ask.{name}")), 100 * right, Markup("") if right else said)
        for name, right in (("true", ask.true), ("false", not ask.true))
    ]
    return Markup("<div>{}</div>").format(_field(weight, "MULTICHOICE_H", rows))


@_embedded.register(Pairs)
@_embedded.register(Order)
def _embedded_pairs(ask: Pairs | Order, weight: int, lang: str) -> Markup:
    """A drop-down of the targets' marks for each stem, since it can hold no formulas."""
    pairs = as_pairs(ask, lang)
    listed = [
        _no_field(marked(mark, words, lang))
        for mark, words in pairs.targets
        if words != (PlainText(mark),)
    ]
    rows = [
        _no_field(marked(mark, words, lang)) + " " + _drop_down(pairs, mark, weight, lang)
        for mark, words in pairs.stems
    ]
    return Markup("").join(
        Markup("<p>{}</p>").format(Markup("<br>").join(lines)) for lines in (listed, rows) if lines
    )


def _drop_down(pairs: Pairs, stem: str, weight: int, lang: str) -> Markup:
    """What is said of each target; where that is the same of all, the worked solution says it."""
    said = {mark: pairs.said.get((stem, mark), ()) for mark, _ in pairs.targets}
    alike = len({words for mark, words in said.items() if mark != pairs.right[stem]}) == 1
    rows = [
        (mark, 100 * (pairs.right[stem] == mark), inline(() if alike else words, lang))
        for mark, words in said.items()
    ]
    return _field(weight, "MULTICHOICE", rows)


def _field(weight: int, kind: str, rows: Iterable[tuple[str, float, Markup]]) -> Markup:
    """A field of a cloze: ``{2:NUMERICAL:=3.5:0.1~%0%7:0.2#Halved twice.}``."""
    texts = [
        f"%{percent:.9g}%{typed}" + (f"#{_cloze_text(str(said))}" if said else "")
        for typed, percent, said in rows
    ]
    return Markup(f"{{{weight}:{kind}:{'~'.join(texts)}}}")


_SIGNS = {ord("&"): "&amp;"} | {ord(sign): f"&#{ord(sign)};" for sign in "~#{}=%"}


def _cloze_text(text: str) -> str:
    """A text inside a field: signs of the field's own grammar as entities, which are read once."""
    return text.translate(_SIGNS)

"""Questions as a package for Canvas: QTI 1.2 as Classic Quizzes read it, and New Quizzes take over.

A quiz for each language; each slot is a group of it from which one question is drawn. Canvas asks
one thing at a time, so each part is a question, and each value of a point or a table. A number has
no wrong answers there: known mistakes stay in the worked solution.

Sources: IMS QTI 1.2 ASI; Canvas LMS, lib/cc/qti; text2qti.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, singledispatch
from itertools import groupby

import jinja2
from markupsafe import Markup

from quizgen.bank.pictures import PictureFile
from quizgen.core.files import build_zip
from quizgen.export import pictures
from quizgen.export.answers import answers
from quizgen.export.asks import Ask, Choose, Fill, Numeric, Order, Pairs, Truth, Write, as_pairs
from quizgen.export.items import Item, by_slot, suffix
from quizgen.export.kept import asked
from quizgen.export.wording import (
    body,
    inline,
    marked,
    pictures_at,
    signed,
    solution,
    stem,
    targets,
)
from quizgen.figures import Figure
from quizgen.locale import translate
from quizgen.question.compose import QuestionPart
from quizgen.question.inlines import name_inline
from quizgen.render.layouts import jinja_environment
from quizgen.responses import keys


@dataclass(frozen=True)
class Query:
    """A question as Canvas has it: of one part, ``asks`` are more than one if they are blanks.

    ``place`` says which of how many values of the part it asks.
    """

    item: Item
    part: QuestionPart
    asks: tuple[Ask, ...]
    points: Fraction
    suffix: str
    place: tuple[int, int] = (1, 1)

    @property
    def id(self) -> str:
        """The same whenever it is exported."""
        return f"{self.item.id}{self.suffix}"

    @property
    def title(self) -> str:
        """What a course shows of it."""
        return self.item.called(self.suffix)

    @property
    def group(self) -> str:
        """What a quiz draws one of: the same part of a slot's questions, worth the same."""
        return f"{self.item.slot}{self.suffix} ({float(self.points):g})"

    @property
    def ask(self) -> Ask:
        """What it asks; an order as the place of each step."""
        ask = self.asks[0]
        return as_pairs(ask, self.item.lang) if isinstance(ask, Order) else ask

    @property
    def kind(self) -> str:
        """The name of its type in Canvas."""
        return "fill_in_multiple_blanks" if len(self.asks) > 1 else _kind(self.ask)

    @property
    def text(self) -> Markup:
        """Everything that stands above its fields."""
        item, lang = self.item, self.item.lang
        text = stem(item, _source) + body(self.part, self.asks, lang, _source)
        if len(self.asks) > 1:
            text = Markup(text.replace("[", "&#91;"))
            blanks = (f"{place}. [blank{place}]" for place, _ in enumerate(self.asks, 1))
            text += Markup("<p>{}</p>").format(Markup("<br>").join(blanks))
        return text + self._which + signed(item, self.suffix)

    @property
    def _which(self) -> Markup:
        """Which value of several: by its name, or by its place, as in ``(...; ?)``."""
        place, count = self.place
        if count == 1:
            return Markup("")
        if isinstance(self.ask, Numeric) and self.ask.name:
            name = inline((name_inline(self.ask.name),), self.item.lang)
            return Markup("<p><strong>{} = ?</strong></p>").format(name)
        row = ("?" if one == place else "…" for one in range(1, count + 1))
        return Markup("<p><strong>({})</strong></p>").format("; ".join(row))


@singledispatch
def _kind(ask: Ask) -> str:
    raise TypeError(type(ask).__name__)


_kind.register(Numeric, lambda _ask: "numerical")
_kind.register(Choose, lambda ask: "multiple_answers" if ask.many else "multiple_choice")
_kind.register(Truth, lambda _ask: "true_false")
_kind.register(Pairs, lambda _ask: "matching")
_kind.register(Fill, lambda _ask: "short_answer")
_kind.register(Write, lambda _ask: "essay")


def queries(item: Item) -> Iterator[Query]:
    """The questions that an item becomes."""
    for part, found in item.parts:
        label = suffix(part)
        if len(found) == 1 or all(isinstance(ask, Fill) for ask in found):
            yield Query(item, part, found, part.points, label)
            continue
        for place, ask in enumerate(found, 1):
            share = part.points / len(found)
            yield Query(item, part, (ask,), share, f"{label}.{place}", (place, len(found)))


def kept(item: Item) -> Iterator[keys.Entry]:
    """How the fields of what an item becomes are read back."""
    for query in queries(item):
        fields = [asked(ask, query.part, item.lang) for ask in query.asks]
        yield keys.Entry(item.mark(query.suffix), query.id, fields)


def write(items: Iterable[Item]) -> bytes:
    """The questions as a package: the same bytes for the same questions."""
    return build_zip(contents(items))


def contents(items: Iterable[Item]) -> dict[str, bytes]:
    """The files of a package by their paths, the manifest first."""
    quizzes, figures = {}, dict[str, bytes]()
    for lang, found in groupby(by_slot(items), key=lambda item: item.lang):
        kept_items = list(found)
        made = sorted((one for item in kept_items for one in queries(item)), key=_group)
        groups = [(name, list(row)) for name, row in groupby(made, key=_group)]
        quizzes[f"quizgen-{lang}"] = groups
        for item in kept_items:
            figures |= pictures.shown(item)
    page = _layouts().get_template
    files = {
        "imsmanifest.xml": page("canvas_manifest.xml.j2").render(quizzes=quizzes, files=figures)
    }
    for name, groups in quizzes.items():
        points = sum((row[0].points for _, row in groups), Fraction(0))
        meta = page("canvas_meta.xml.j2").render(name=name, points=float(points))
        with pictures_at(_source):
            files[f"{name}/{name}.xml"] = page("canvas.xml.j2").render(name=name, groups=groups)
        files[f"{name}/assessment_meta.xml"] = meta
    return {name: text.encode() for name, text in files.items()} | figures


def _group(query: Query) -> str:
    return query.group


@cache
def _layouts() -> jinja2.Environment:
    layouts = jinja_environment("quizgen.export")
    layouts.globals.update(
        answers=answers,
        as_text=str.__str__,
        inline=inline,
        marked=marked,
        solution=_solution,
        targets=targets,
        word=translate,
    )
    return layouts


def _solution(query: Query) -> Markup:
    told = any(not isinstance(ask, Numeric) for ask in query.asks)
    return solution(query.item, _source, (query.part.label,), told=told)


def _source(shown: Figure | PictureFile) -> str:
    return f"%24IMS-CC-FILEBASE%24/{pictures.path(shown)}"

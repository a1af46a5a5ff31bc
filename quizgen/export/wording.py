"""What a question says in a system for courses, whose pages have neither our style nor fields."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from functools import singledispatch
from itertools import islice, zip_longest

from markupsafe import Markup

from quizgen.bank.prose import Words
from quizgen.export.asks import Ask, Choose, Fill, Numeric, Order, Pairs, Said, by_person
from quizgen.export.items import Item
from quizgen.figures import Figure
from quizgen.locale import word
from quizgen.question.compose import Part
from quizgen.question.hints import given
from quizgen.question.hints import unit as in_unit
from quizgen.question.markup import blocks, inline
from quizgen.render.html import fragment
from quizgen.render.text import inline as in_text

TRIES = 3
"""How often somebody is given a hint."""

_SPOKEN = re.compile(
    r'<span class="hidden">.*?</span><span aria-hidden="true">(.*?)</span>', re.DOTALL
)
"""A formula in words for listeners, hidden by our style, and the formula: MathML speaks itself."""


def foreign(page: Markup) -> Markup:
    """A piece of our pages as it can stand on others."""
    shown = _SPOKEN.sub(r"\1", str(page)).replace(' tabindex="0"', "")
    return Markup(shown)  # noqa: S704 - made of pieces that are escaped


def stem(item: Item, picture: Markup) -> Markup:
    """What stands before the parts."""
    return foreign(blocks(item.question.stem, item.lang)) + picture


def body(part: Part, found: Sequence[Ask], lang: str) -> Markup:
    """A part, with what it lists if a person marks it, and how its answer is to be typed."""
    label = Markup("<p><strong>({})</strong></p>").format(part.label) if part.label else Markup("")
    listed = _listed(part, lang) if by_person(found) else Markup("")
    told = Markup(" ").join(_told(part, found, lang))
    hint = Markup("<p><small>{}</small></p>").format(told) if told else Markup("")
    return label + foreign(blocks(part.body, lang)) + listed + hint


def _listed(part: Part, lang: str) -> Markup:
    rows = [marked(mark, words, lang) for mark, words in (*part.field.options, *part.field.targets)]
    items = Markup("").join(Markup("<li>{}</li>").format(row) for row in rows)
    return Markup("<ul>{}</ul>").format(items) if rows else Markup("")


def marked(mark: str, words: Said, lang: str) -> Markup:
    """An option behind its letter, which the worked solution names it by."""
    return Markup("{}. {}").format(mark, inline(words, lang))


def targets(pairs: Pairs) -> dict[str, str]:
    """The targets of a matching as text, which is all that a drop-down can show."""
    return {
        mark: mark if words == (Words(mark),) else f"{mark}. {in_text(words)}"
        for mark, words in pairs.targets
    }


def signed(item: Item, suffix: str) -> Markup:
    """The mark of a question, which reports of a course carry with its text."""
    return Markup("<p><small>[{}]</small></p>").format(item.mark(suffix))


def _told(part: Part, found: Sequence[Ask], lang: str) -> Iterable[Markup]:
    """Sentences that say what to type, each once."""
    if by_person(found):
        return [inline(part.field.hint, lang)]
    if len(found) == 1 and isinstance(found[0], Numeric):
        return map(Markup.escape, given(_unit(found[0].unit, lang), *_typed(found[0], lang)))
    told = (sentence for ask in found for sentence in _typed(ask, lang))
    return map(Markup.escape, dict.fromkeys(told))


def _unit(unit: str, lang: str) -> str:
    names = {"%": "ask.percent", "°": "ask.degrees"}
    if unit in names:
        return word(lang, names[unit])
    return in_unit(unit, lang) if unit != "1" else ""


@singledispatch
def _typed(_ask: Ask, _lang: str) -> Iterator[str]:
    yield from ()


@_typed.register
def _number(ask: Numeric, lang: str) -> Iterator[str]:
    yield word(lang, "export.number")
    if ask.precision:
        yield ask.precision


@_typed.register
def _many(ask: Choose, lang: str) -> Iterator[str]:
    if ask.many:
        yield word(lang, "ask.multi")


@_typed.register
def _printed(ask: Fill, lang: str) -> Iterator[str]:
    if ask.printed:
        yield word(lang, "ask.code")


@_typed.register
def _places(_ask: Order, lang: str) -> Iterator[str]:
    yield word(lang, "export.places")


def image(source: str, figure: Figure | None) -> Markup:
    """A picture with its words, if there is one."""
    if figure is None:
        return Markup("")
    tag = Markup('<p><img src="{}" alt="{}" width="{:.0f}" height="{:.0f}"/></p>')
    return tag.format(source, figure.alt, figure.width_pt * 4 / 3, figure.height_pt * 4 / 3)


def solution(item: Item, picture: Markup) -> Markup:
    """The worked solution, and its picture if it has one of its own."""
    return foreign(fragment("worked.html.j2", item=item.paper_item, picture=picture))


def hints(item: Item) -> Iterator[Markup]:
    """One step further in each part with every try: why it is taken."""
    parts = item.key.solution.parts
    for row in islice(zip_longest(*(part.lines for part in parts)), TRIES):
        steps = [
            _behind(part.label, inline(line.why, item.lang))
            for part, line in zip(parts, row, strict=True)
            if line
        ]
        yield Markup("").join(steps)


def _behind(label: str, words: Markup) -> Markup:
    return Markup("<p>{}{}</p>").format(f"({label}) " if label else "", words)

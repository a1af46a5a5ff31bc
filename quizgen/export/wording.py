"""What a question says in a system for courses, whose pages have neither our style nor fields.

How formulas are written is one choice for a whole file: ``formulas`` sets it while one is made.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import partial, singledispatch
from html import escape
from itertools import islice, zip_longest

from markupsafe import Markup
from msgspec.structs import replace

from quizgen import typeset
from quizgen.bank.markdown import Block, Inline, PlainText
from quizgen.bank.pictures import PictureFile
from quizgen.core.errors import require_one_of
from quizgen.export.asks import Ask, Choose, Fill, Numeric, Order, Pairs, Said, by_person
from quizgen.export.items import Item
from quizgen.export.pictures import Source, image
from quizgen.kinds.asking import nonempty
from quizgen.kinds.asking import unit_hint as in_unit
from quizgen.locale import translate
from quizgen.maths.units import format_unit as shown_unit
from quizgen.paper.paper import PaperItem
from quizgen.question import html
from quizgen.question.compose import QuestionPart
from quizgen.question.html import HtmlDialect, display_mathml
from quizgen.question.inlines import name_inline
from quizgen.question.solution import PartSolution, Solution
from quizgen.render.html import render_html_fragment
from quizgen.render.text import inlines_to_plain_text as in_text

TRIES = 3
"""How often somebody is given a hint."""

_STYLED = re.compile(r' (?:class|lang)="[^"]*"')
"""What means nothing without our style; the language is said once of the whole."""


def _tex(node: typeset.Node, lang: str, marks: str = "()") -> str:
    return rf"\{marks[0]}{escape(typeset.to_latex(node, lang), quote=False)}\{marks[1]}"


FORMULAS = {
    "mathml": HtmlDialect(typeset.to_mathml, display_mathml, ours=False),
    "tex": HtmlDialect(_tex, partial(_tex, marks="[]"), ours=False),
}
"""How formulas are written: as MathML, or for a filter like MathJax."""
_way = ContextVar("way", default=FORMULAS["mathml"])


@contextmanager
def pictures_at(source: Callable[[PictureFile], str]) -> Iterator[None]:
    """Let pages refer to pictures of a bank instead of holding them, for as long as this lasts."""
    before = _way.set(_way.get()._replace(source=source))
    try:
        yield
    finally:
        _way.reset(before)


@contextmanager
def formulas(name: str) -> Iterator[None]:
    """Write formulas in a way of ``FORMULAS`` for as long as this lasts.

    Raises
    ------
    ChoiceError
        Naming the ways there are.
    """
    before = _way.set(FORMULAS[require_one_of("way of formulas", name, FORMULAS)])
    try:
        yield
    finally:
        _way.reset(before)


def inline(words: Inline | Said, lang: str) -> Markup:
    """A sentence, or pieces of one."""
    return html.inlines_to_html(words, lang, _way.get())


def _blocks(parts: Sequence[Block], lang: str) -> Markup:
    return html.blocks_to_html(parts, lang, _way.get())


def spoken(page: Markup, lang: str) -> Markup:
    """A page that says which language it is in, whatever that of the course is."""
    return Markup('<div lang="{}">{}</div>').format(lang, page)


def stem(item: Item, source: Source) -> Markup:
    """What stands before the parts."""
    return _blocks(item.question.stem, item.lang) + image(item.question.figure, source)


def body(part: QuestionPart, found: Sequence[Ask], lang: str, source: Source) -> Markup:
    """A part, with what it lists if a person marks it, and how its answer is to be typed."""
    label = Markup("<p><strong>({})</strong></p>").format(part.label) if part.label else Markup("")
    listed = _listed(part, lang) if by_person(found) else Markup("")
    told = Markup(" ").join(_told(part, found, lang))
    hint = Markup("<p><small>{}</small></p>").format(told) if told else Markup("")
    drawing = part.field.drawing
    field = image(drawing.figure if drawing else None, source)
    return label + _blocks(part.body, lang) + field + listed + hint


def _listed(part: QuestionPart, lang: str) -> Markup:
    rows = [marked(mark, words, lang) for mark, words in (*part.field.options, *part.field.targets)]
    items = Markup("").join(Markup("<li>{}</li>").format(row) for row in rows)
    return Markup("<ul>{}</ul>").format(items) if rows else Markup("")


def marked(mark: str, words: Said, lang: str) -> Markup:
    """An option behind its letter, which the worked solution names it by."""
    return Markup("{}. {}").format(mark, inline(words, lang))


def beside(ask: Numeric, field: Markup, lang: str, number: str = "") -> Markup:
    """A field between the name of its number, else which one it is, and its unit."""
    name = inline((name_inline(ask.name),), lang) + " = " if ask.name else number
    unit = "" if ask.unit in {"", "1"} else f" {shown_unit(ask.unit)}"
    return Markup("<p>{}{}{}</p>").format(name, field, unit)


def targets(pairs: Pairs) -> dict[str, str]:
    """The targets of a matching as text, which is all that a drop-down can show."""
    return {
        mark: mark if words == (PlainText(mark),) else f"{mark}. {in_text(words)}"
        for mark, words in pairs.targets
    }


def signed(item: Item, suffix: str) -> Markup:
    """The mark of a question, which reports of a course carry with its text."""
    return Markup("<p><small>[{}]</small></p>").format(item.mark(suffix))


def _told(part: QuestionPart, found: Sequence[Ask], lang: str) -> Iterable[Markup]:
    """Sentences that say what to type, each once."""
    if by_person(found):
        return [inline(part.field.hint, lang)]
    if len(found) == 1 and isinstance(found[0], Numeric):
        return map(Markup.escape, nonempty(_unit(found[0].unit, lang), *_typed(found[0], lang)))
    told = (sentence for ask in found for sentence in _typed(ask, lang))
    return map(Markup.escape, dict.fromkeys(told))


def _unit(unit: str, lang: str) -> str:
    names = {"%": "ask.percent", "°": "ask.degrees"}
    if unit in names:
        return translate(lang, names[unit])
    return in_unit(unit, lang) if unit != "1" else ""


@singledispatch
def _typed(_ask: Ask, _lang: str) -> Iterator[str]:
    yield from ()


@_typed.register
def _number(ask: Numeric, lang: str) -> Iterator[str]:
    yield translate(lang, "export.number")
    if ask.precision:
        yield ask.precision


@_typed.register
def _many(ask: Choose, lang: str) -> Iterator[str]:
    if ask.many:
        yield translate(lang, "ask.multi")


@_typed.register
def _printed(ask: Fill, lang: str) -> Iterator[str]:
    if ask.printed:
        yield translate(lang, "ask.code")


@_typed.register
def _places(_ask: Order, lang: str) -> Iterator[str]:
    yield translate(lang, "export.places")


def solution(
    item: Item, source: Source, labels: Sequence[str] = (), *, told: bool = True
) -> Markup:
    """The worked solution, and its picture if it has one of its own.

    Parameters
    ----------
    item : Item
    source : callable
    labels : sequence of str
        Of which parts; all of them if none is named.
    told : bool
        Whether the system itself says what is wrong with a known mistake.
    """
    rows = zip(item.parts, item.key.solution.parts, strict=True)
    kept = [
        (part, _untold(found, solved) if told and not by_person(found) else solved)
        for (part, found), solved in rows
        if not labels or part.label in labels
    ]
    parts = tuple(part for part, _ in kept)
    whole = item.key.solution if len(parts) == len(item.parts) else _alone(item.key.solution)
    chosen = replace(whole, parts=tuple(solved for _, solved in kept))
    question, key = replace(item.question, parts=parts), replace(item.key, solution=chosen)
    made = PaperItem(question.number, (question,), (key,))
    page = render_html_fragment("worked.html.j2", _way.get(), item=made, figure=item.solved_figure,
                    draw=lambda figure: image(figure, source))  # fmt: skip
    return Markup(_STYLED.sub("", page))


def _alone(whole: Solution) -> Solution:
    """Without the remarks, which are on all parts together."""
    return replace(whole, check=(), note=(), why=(), precision=())


def _untold(found: Sequence[Ask], solved: PartSolution) -> PartSolution:
    """Without what is said to whoever gives a wrong answer."""
    if any(isinstance(ask, Pairs | Order) for ask in found):
        return solved
    return replace(solved, mistakes=(), reasons=())


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

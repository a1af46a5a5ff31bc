"""A formula sheet as a tagged PDF to print: small, in columns, without what is only a remark."""

from __future__ import annotations

from quizgen.bank.prose import Block, Paragraph
from quizgen.locale import word
from quizgen.question.sheet import Group, Line, Said, Sheet
from quizgen.render.typ import (
    blocks,
    compiled,
    document,
    equation,
    inline,
    joined,
    say,
    string,
    within,
    words,
)

SCALE = 0.7
"""Size of a sketch in print: its letters of 10 pt are as small as those beside it."""
PRINTED = ("holds", "limits")
"""The notes that are printed after what the letters mean; the page has the rest."""


def render(sheet: Sheet) -> bytes:
    """Render a formula sheet as a PDF file.

    Raises
    ------
    RenderError
        If Typst refuses the document or a font is missing.
    """
    pictures = {
        _file(line): line.figures[0].standalone_svg
        for group in sheet.groups
        for line in group.lines
        if line.figures
    }
    return compiled({**document("sheet.typ", _source(sheet)), **pictures})


def _file(line: Line) -> str:
    """Name of the file that a formula's sketch is in."""
    return f"sketch-{line.id}.svg"


def _source(sheet: Sheet) -> str:
    langs, main = sheet.langs, sheet.langs[0]
    titles = {lang: f"{sheet.titles[lang]} - {word(lang, 'sheet.title')}" for lang in langs}
    head = joined(langs, [f"#{string(titles[lang])};" for lang in langs])
    opening = (
        f"#show: sheet.with(title: {string(titles[main])}, lang: {string(main)}, head: [{head}])"
    )
    return "\n".join([opening, *(_group(group, langs) for group in sheet.groups)])


def _group(group: Group, langs: tuple[str, ...]) -> str:
    titles = joined(langs, [f"#{string(group.titles[lang])};" for lang in langs])
    return f"#topic[{titles}]\n" + "\n".join(_line(line, langs) for line in group.lines)


def _line(line: Line, langs: tuple[str, ...]) -> str:
    title = joined(langs, [inline(said.title, said.lang) for said in line.said])
    section = f"§ {line.section}" if line.section else ""
    lines = "".join(f"[{equation(maths, langs[0], block=True)}], " for maths in line.lines)
    units = f"#label[{words(langs, 'sheet.units')}:] {inline(line.units, langs[0])}"
    notes = "\n".join(within(said.lang, _notes(said)) for said in line.said)
    return (
        f"#formula({string(line.id)}, [{title}], {string(section)}, ({lines}), {_sketch(line)})"
        f"[{notes}\n\n{units if line.units else ''}]"
    )


def _sketch(line: Line) -> str:
    if not line.figures:
        return "none"
    alt = string(" / ".join(figure.alt for figure in line.figures))
    width = f"{line.figures[0].width_pt * SCALE:.2f}pt"
    return f"image({string(_file(line))}, width: {width}, alt: {alt})"


def _notes(said: Said) -> str:
    """What the letters mean, where the formula holds and where it ends, in one paragraph."""
    rest = [
        f"#label({string(word(said.lang, f'sheet.{name}') + ':')}); {_run(body, said.lang)}"
        for name, body in said.notes.items()
        if name in PRINTED
    ]
    return " ".join([_run(said.notes["about"], said.lang), *rest])


def _run(parts: tuple[Block, ...], lang: str) -> str:
    """A passage of one paragraph within a line."""
    if len(parts) == 1 and isinstance(parts[0], Paragraph):
        return say(lang, inline(parts[0].children, lang))
    return blocks(parts, lang)

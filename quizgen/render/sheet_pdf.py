"""A formula sheet as a tagged PDF to print: small, in columns, without what is only a remark."""

from __future__ import annotations

from quizgen.locale import translate
from quizgen.question.formula_sheet import FormulaSheet, FormulaText, SheetFormula, SheetTopic
from quizgen.render.typst_document import (
    blocks_to_typst,
    compile_pdf,
    document_files,
    in_language,
    inlines_to_typst,
    join_languages,
    say_in_language,
    translate_all,
    typst_equation,
    typst_literal,
)
from quizgen.typeset.prose import Block, Paragraph

SCALE = 0.7
"""Size of a sketch in print: its letters of 10 pt are as small as those beside it."""
PRINTED = ("holds", "limits")
"""The notes that are printed after what the letters mean; the page has the rest."""


def render_sheet_pdf(sheet: FormulaSheet) -> bytes:
    """Return a formula sheet as a PDF file.

    Raises
    ------
    RenderError
        If Typst refuses the document or a font is missing.
    """
    pictures = {
        _name_sketch_file(line): line.figures[0].standalone_svg
        for group in sheet.groups
        for line in group.lines
        if line.figures
    }
    return compile_pdf({**document_files("sheet.typ", _build_typst_source(sheet)), **pictures})


def _name_sketch_file(line: SheetFormula) -> str:
    """Return the file name of a formula's sketch."""
    return f"sketch-{line.id}.svg"


def _build_typst_source(sheet: FormulaSheet) -> str:
    """Return the Typst source of a formula sheet."""
    langs, main = sheet.langs, sheet.langs[0]
    titles = {lang: f"{sheet.titles[lang]} - {translate(lang, 'sheet.title')}" for lang in langs}
    head = join_languages(langs, [f"#{typst_literal(titles[lang])};" for lang in langs])
    opening = (
        f"#show: sheet.with(title: {typst_literal(titles[main])}"
        f", lang: {typst_literal(main)}, head: [{head}])"
    )
    return "\n".join([opening, *(_typeset_group(group, langs) for group in sheet.groups)])


def _typeset_group(group: SheetTopic, langs: tuple[str, ...]) -> str:
    """Return the formulas of one topic under its heading."""
    titles = join_languages(langs, [f"#{typst_literal(group.titles[lang])};" for lang in langs])
    return f"#topic[{titles}]\n" + "\n".join(
        _typeset_sheet_line(line, langs) for line in group.lines
    )


def _typeset_sheet_line(line: SheetFormula, langs: tuple[str, ...]) -> str:
    """Return one formula with its name, sketch and notes."""
    title = join_languages(langs, [inlines_to_typst(said.title, said.lang) for said in line.said])
    section = f"§ {line.section}" if line.section else ""
    lines = "".join(f"[{typst_equation(maths, langs[0], block=True)}], " for maths in line.lines)
    units = (
        f"#label[{translate_all(langs, 'sheet.units')}:] {inlines_to_typst(line.units, langs[0])}"
    )
    notes = "\n".join(in_language(said.lang, _typeset_notes(said)) for said in line.said)
    return (
        f"#formula({typst_literal(line.id)}, [{title}], "
        f"{typst_literal(section)}, ({lines}), {_typeset_sketch(line)})"
        f"[{notes}\n\n{units if line.units else ''}]"
    )


def _typeset_sketch(line: SheetFormula) -> str:
    """Return a formula's sketch as Typst; "" without one."""
    if not line.figures:
        return "none"
    alt = typst_literal(" / ".join(figure.alt for figure in line.figures))
    width = f"{line.figures[0].width_pt * SCALE:.2f}pt"
    return f"image({typst_literal(_name_sketch_file(line))}, width: {width}, alt: {alt})"


def _typeset_notes(said: FormulaText) -> str:
    """Return what the letters mean and where the formula holds, in one paragraph."""
    rest = [
        f"#label({typst_literal(translate(said.lang, f'sheet.{name}') + ':')}"
        f"); {_typeset_inline_passage(body, said.lang)}"
        for name, body in said.notes.items()
        if name in PRINTED
    ]
    return " ".join([_typeset_inline_passage(said.notes["about"], said.lang), *rest])


def _typeset_inline_passage(parts: tuple[Block, ...], lang: str) -> str:
    """Return a passage of one paragraph as Typst within a line."""
    if len(parts) == 1 and isinstance(parts[0], Paragraph):
        return say_in_language(lang, inlines_to_typst(parts[0].children, lang))
    return blocks_to_typst(parts, lang)

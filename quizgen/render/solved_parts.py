"""Worked solutions on paper: each step on lines that break before its signs, reasons beside them.

In: a part of a question with its solution in the languages of a paper. Out: calls of
``pages/paper.typ``.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from quizgen import typeset
from quizgen.locale import format_amount, translate
from quizgen.question.inlines import name_inline
from quizgen.question.solution import PartSolution, Solution, SolutionStep, SolvedMisconception
from quizgen.render.answer_fields import PaperPart, count_columns, typeset_text
from quizgen.render.typst_document import (
    blocks_to_typst,
    in_language,
    inlines_to_typst,
    join_languages,
    stack_languages,
    typst_equation,
    typst_literal,
    typst_passage,
)

SIDE = 0.3
"""Share of the width that reasons beside a solution take."""


def typeset_solved_part(one: PaperPart, drawing: str) -> str:
    """Return a part as it was asked, with steps, answer and reasons.

    Parameters
    ----------
    one : PaperPart
    drawing : str
        The picture of the solved drawing; empty without one.
    """
    steps = [
        _typeset_step([solved.lines[index] for solved in one.solved], one.langs)
        for index in range(len(one.solved[0].lines))
    ]
    drawn = [f"#drawn({drawing})"] if drawing else []
    body = [_typeset_listed(one), *steps, *drawn, _typeset_result(one), _typeset_why(one)]
    worth = format_amount(one.first.points, one.langs[0])
    reasons = [
        "\n".join(_typeset_wrong(wrong, lang) for wrong in (*solved.reasons, *solved.mistakes))
        for solved, lang in zip(one.solved, one.langs, strict=True)
    ]
    return (
        f"#solved({typst_literal(one.first.label)}, {typst_literal(worth)})"
        f"[{typeset_text(one)}][{chr(10).join(filter(None, body))}]"
        f"[{stack_languages(one.langs, reasons)}]"
    )


def _typeset_listed(one: PaperPart) -> str:
    """Return the options and targets that were to choose from, small, in columns."""
    rows = [
        f"#listed({_count_columns(one, side)}, {', '.join(one.list_options(side))})"
        for side in ("options", "targets")
        if getattr(one.first.field, side)
    ]
    return "\n".join(rows)


def _count_columns(one: PaperPart, side: str) -> int:
    """Return in how many columns the options of a side stand."""
    count = len(getattr(one.first.field, side))
    return count_columns(one.count_option_characters(side), count, 1 - SIDE)


def _typeset_step(lines: Sequence[SolutionStep], langs: tuple[str, ...]) -> str:
    """Return one step: a row for each side, and its sentence in each language."""
    first, lang = lines[0], langs[0]
    name = inlines_to_typst((name_inline(first.name),), lang) if first.sides else ""
    rows = [f"({typst_literal(side.sign)}, {typst_side(side.node, lang)})" for side in first.sides]
    whole = "" if rows else typst_equation(first.maths, lang, block=False)
    why = stack_languages(
        langs,
        [
            typst_passage(inlines_to_typst(line.why, one))
            for line, one in zip(lines, langs, strict=True)
        ],
    )
    shown = f"#work([{name}], {', '.join(rows)})" if rows else f"#work-line[{whole}]"
    cite = f"#cite-formula({typst_literal(first.formula)})\n" if first.formula else ""
    return f"{cite}{shown}\n#why[{why}]"


@lru_cache(maxsize=1 << 12)
def typst_side(node: typeset.Node, lang: str) -> str:
    """Return one side of a worked line in Typst, with its words for screen readers."""
    spoken = typst_literal(typeset.to_speech(node, lang))
    return f"side({spoken}, ${typeset.to_typst(node, lang)}$)"


def _typeset_result(one: PaperPart) -> str:
    """Return the answer of a part in each language."""
    answers = [
        _typeset_answer(solved, lang) for solved, lang in zip(one.solved, one.langs, strict=True)
    ]
    return f"#result[{join_languages(one.langs, answers)}]" if any(answers) else ""


def _typeset_answer(solved: PartSolution, lang: str) -> str:
    """Return the answer of a part in a language."""
    shown = f"#strong[{inlines_to_typst(solved.shown, lang)}]; " if solved.shown else ""
    options = [inlines_to_typst(option, lang) for option in solved.options]
    if len(options) <= 1:
        return shown + "".join(options)
    return f"{shown}#list({', '.join(f'[{option}]' for option in options)});"


def _typeset_why(one: PaperPart) -> str:
    """Return what else explains the answer."""
    texts = [
        typst_passage(inlines_to_typst(solved.why, lang)) if solved.why else ""
        for solved, lang in zip(one.solved, one.langs, strict=True)
    ]
    return f"#why[{stack_languages(one.langs, texts)}]" if any(texts) else ""


def _typeset_wrong(wrong: SolvedMisconception, lang: str) -> str:
    """Return a wrong answer, and what is wrong with it."""
    shown, sentence = (
        typst_passage(inlines_to_typst(said, lang)) for said in (wrong.shown, wrong.sentence)
    )
    return f"#slip([{shown}], [{sentence}])"


def typeset_remarks(solutions: Sequence[Solution]) -> str:
    """Return what follows all parts, in each language: explanation, check, precision, note."""
    texts = [
        _typeset_remark(solution, section)
        for section in ("why", "check", "precision", "note")
        for solution in solutions
    ]
    said = "\n".join(filter(None, texts))
    return f"\n#remarks[{said}]" if said else ""


def _typeset_remark(solution: Solution, section: str) -> str:
    """Return one section of a solution with its heading; "" if it is empty."""
    body, lang = getattr(solution, section), solution.lang
    if not body:
        return ""
    key = "precision.title" if section == "precision" else f"solution.{section}"
    title = f"#heading(level: 3)[#{typst_literal(translate(lang, key))};]"
    return in_language(lang, f"{title}\n{blocks_to_typst(body, lang)}")

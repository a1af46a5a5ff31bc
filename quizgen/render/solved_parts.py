"""Worked solutions on paper: each step on lines that break before its signs, with what it earns.

In: a part of a question with its solution in the languages of a paper. Out: calls of
``pages/paper.typ``.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache

from quizgen import typeset
from quizgen.core.shares import rescale_points
from quizgen.locale import format_amount, translate
from quizgen.question.mark_scheme import SideMark, mark_steps
from quizgen.question.solution import (
    PartSolution,
    SchemeLine,
    Solution,
    SolutionStep,
    SolvedMisconception,
    scheme_examples,
)
from quizgen.render.answer_fields import PaperPart, count_columns, typeset_text
from quizgen.render.typst_document import (
    blocks_to_typst,
    in_language,
    inlines_to_typst,
    join_languages,
    stack_languages,
    translate_all,
    typst_literal,
    typst_passage,
)
from quizgen.typeset.prose import name_inline


def typeset_solved_part(one: PaperPart, drawing: str) -> str:
    """Return a part as it was asked, with steps, answer and reasons.

    Parameters
    ----------
    one : PaperPart
    drawing : str
        The picture of the solved drawing; empty without one.
    """
    marks = mark_steps(one.solved[0], one.first.points, has_unit=one.first.field.has_unit)
    result = _typeset_result(one)
    steps = [
        _typeset_step(
            [solved.lines[index] for solved in one.solved],
            one.langs,
            earned,
            hold=bool(result) and index == len(marks) - 1,
        )
        for index, earned in enumerate(marks)
    ]
    body = [
        _typeset_listed(one),
        *steps,
        f"#drawn({drawing})" if drawing else "",
        result,
        _typeset_accepted(one),
        _typeset_criteria(one),
        _typeset_why(one),
        _typeset_wrong_answers(one),
    ]
    worth = format_amount(one.first.points, one.langs[0])
    return (
        f"#solved({typst_literal(one.first.label)}, {typst_literal(worth)})"
        f"[{typeset_text(one)}][{chr(10).join(filter(None, body))}]"
    )


def _typeset_listed(one: PaperPart) -> str:
    """Return the options and targets that were to choose from, small, in columns."""
    rows = [
        f"#listed({_count_columns(one, side)}, {_is_tall(''.join(shown))}, {', '.join(shown)})"
        for side in ("options", "targets")
        if getattr(one.first.field, side) and (shown := one.list_options(side))
    ]
    return "\n".join(rows)


def _is_tall(markup: str) -> str:
    """Return ``true`` for markup with formulas higher than a line: the next one keeps off."""
    signs = ("frac(", "^(", "sqrt(", "floor(", "ceil(")
    return "true" if any(sign in markup for sign in signs) else "false"


def _count_columns(one: PaperPart, side: str) -> int:
    """Return in how many columns the options of a side stand."""
    count = len(getattr(one.first.field, side))
    return count_columns(one.count_option_characters(side), count)


def _typeset_step(
    lines: Sequence[SolutionStep],
    langs: tuple[str, ...],
    earned: Sequence[SideMark],
    *,
    hold: bool,
) -> str:
    """Return one step: a row for each side with its points, and its sentence in each language.

    ``hold`` keeps it on the page of what follows it, the answer.
    """
    first, lang = lines[0], langs[0]
    name = inlines_to_typst((name_inline(first.name),), lang) if first.sides else ""
    rows = [
        f"({typst_literal(side.sign)}, {typst_side(side.node, lang)}, {_typeset_mark(mark, lang)})"
        for side, mark in zip(first.sides, earned, strict=False)
    ]
    if not rows:
        whole = typst_side(first.maths.node, lang)
        rows = [f"([], {whole}, {_typeset_mark(earned[0], lang)})"]
    why = stack_languages(
        langs,
        [
            typst_passage(inlines_to_typst(line.why, one))
            for line, one in zip(lines, langs, strict=True)
        ],
    )
    cite = typst_literal(first.formula)
    held = f"hold: {str(hold).lower()}"
    return f"#work([{name}], {cite}, {held}, {', '.join(rows)})\n#why({held})[{why}]"


def _typeset_mark(mark: SideMark, lang: str) -> str:
    """Return what a side earns, and what for."""
    if not mark.points:
        return "[]"
    words = ", ".join(translate(lang, f"scheme.{name}") for name in mark.earned)
    return f"earned({typst_literal(format_quarters(mark.points, lang))}, {typst_literal(words)})"


QUARTERS = {Fraction(1, 4): "¼", Fraction(1, 2): "½", Fraction(3, 4): "¾"}


def format_quarters(points: Fraction, lang: str) -> str:
    """Return points with their quarters as one sign: 1½."""
    whole, part = divmod(points, 1)
    if part and part not in QUARTERS:
        return format_amount(points, lang)
    return f"{whole or ''}{QUARTERS[part]}" if part else str(whole)


@lru_cache(maxsize=1 << 12)
def typst_side(node: typeset.Node, lang: str) -> str:
    """Return one side of a worked line in Typst, with its words for screen readers."""
    spoken = typst_literal(typeset.to_speech(node, lang))
    return f"side({spoken}, ${typeset.to_typst(node, lang)}$)"


def _typeset_result(one: PaperPart) -> str:
    """Return the answer of a part in each language."""
    points = one.first.points
    answers = [
        _typeset_answer(solved, lang, points)
        for solved, lang in zip(one.solved, one.langs, strict=True)
    ]
    first = one.solved[0]
    is_whole = not (first.lines or first.shares or first.scheme)
    worth = format_quarters(points, one.langs[0]) if is_whole else ""
    said = join_languages(one.langs, answers)
    return f"#result({typst_literal(worth)})[{said}]" if any(answers) else ""


def _typeset_accepted(one: PaperPart) -> str:
    """Return what a marker accepts, and whether a slip of an earlier part counts again."""
    first, rows = one.solved[0], []
    if first.accepted:
        said = [f"#{typst_literal(solved.accepted)};" for solved in one.solved]
        also = translate_all(one.langs, "scheme.also")
        rows.append(f"#accept([{also}], [{join_languages(one.langs, said)}])")
    if first.follows:
        labels = ", ".join(first.follows)
        rows.append(f"#why[{translate_all(one.langs, 'scheme.follow', labels=labels)}]")
    return "\n".join(rows)


def _typeset_criteria(one: PaperPart) -> str:
    """Return what a person marks sentences by, in each language."""
    texts = [
        "\n".join(
            [
                *_typeset_best(solved, lang),
                *(_typeset_criterion(row, lang) for row in solved.scheme),
            ]
        )
        for solved, lang in zip(one.solved, one.langs, strict=True)
    ]
    return stack_languages(one.langs, texts)


def _typeset_best(solved: PartSolution, lang: str) -> list[str]:
    """Return that only the best criteria count, where they have more points than the part."""
    if solved.most is None:
        return []
    best = translate(lang, "solution.best", points=format_quarters(solved.most, lang))
    return [f"#why[#{typst_literal(best)};]"]


def _typeset_criterion(row: SchemeLine, lang: str) -> str:
    """Return a criterion with its points, what counts, what counts half, and what does not."""
    lines = [typst_passage(inlines_to_typst(row.idea, lang))]
    for name, examples in scheme_examples(row):
        head = typst_literal(f"{translate(lang, f'solution.{name}')}: ")
        lines.append(f"#small[#strong({head}) #{typst_literal('; '.join(examples))};]")
    if row.follows:
        lines.append(f"#small[#{typst_literal(translate(lang, 'solution.follows'))};]")
    points = typst_literal(format_quarters(row.points, lang))
    return f"#criterion({points})[{' #linebreak() '.join(lines)}]"


def _typeset_wrong_answers(one: PaperPart) -> str:
    """Return the wrong answers that are known, in each language."""
    texts = [
        "\n".join(
            _typeset_wrong(wrong, lang, one.first.points)
            for wrong in (*solved.reasons, *solved.mistakes)
        )
        for solved, lang in zip(one.solved, one.langs, strict=True)
    ]
    return stack_languages(one.langs, texts)


def _typeset_answer(solved: PartSolution, lang: str, points: Fraction) -> str:
    """Return the answer of a part in a language; what earns points of its own with these."""
    is_told = solved.shown and not solved.drawing  # nobody reads a drawing as its points
    shown = f"#strong[{inlines_to_typst(solved.shown, lang)}]; " if is_told else ""
    ideas = () if solved.scheme else solved.options
    options = [inlines_to_typst(option, lang) for option in ideas]
    if solved.shares:
        shares = [format_quarters(one, lang) for one in rescale_points(solved.shares, points)]
        options = [
            f"{option} #strong({typst_literal(share)});"
            for option, share in zip(options, shares, strict=True)
        ]
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


def _typeset_wrong(wrong: SolvedMisconception, lang: str, points: Fraction) -> str:
    """Return a wrong answer, what it earns, and what is wrong with it."""
    shown, sentence = (
        typst_passage(inlines_to_typst(said, lang)) for said in (wrong.shown, wrong.listed_sentence)
    )
    earns = format_quarters(points * wrong.share, lang) if wrong.share else ""
    tall = _is_tall(shown + sentence)
    return f"#slip({typst_literal(earns)}, {tall}, [{shown}], [{sentence}])"


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

"""What one question of a paper tells about another: its formula, its number, its words, its order.

A question is looked through as it is printed: stem, hints, figure's words, options, pairs, claims,
programs. What it may not hold is what another question asks: formulas of the steps to its answer
(and a keyed formula), its number where nobody would hit it by chance, the sentence that is right,
the criteria of sentences, the order of steps. What a question prints itself is no secret of it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from quizgen.bank.bank import Bank
from quizgen.bank.levels import EXAM
from quizgen.bank.variant import Variant
from quizgen.core.errors import FormulaError
from quizgen.grading.spec import AnySpec
from quizgen.kinds import NUMERIC, choice, gap, match, order, rubric
from quizgen.kinds.grade import show_key
from quizgen.maths.canonical import CanonicalForm, canonical_forms, formulas_in_program
from quizgen.maths.notation import FormulaReadError, format_tree, parse_formula
from quizgen.maths.tree import Expr
from quizgen.paper.paper import Paper
from quizgen.paper.variants import asked_formulas
from quizgen.question.compose import Question, QuestionKey
from quizgen.question.figure import describe_question_figure
from quizgen.render.text import blocks_to_plain_text, inlines_to_plain_text
from quizgen.typeset.prose import (
    Block,
    CodeBlock,
    Emphasis,
    Inline,
    InlineCode,
    ListBlock,
    Paragraph,
    TableBlock,
    TypesetMaths,
)

DIGITS, WHOLE = 3, 4
"""Digits of a number, and of a whole one, that is not there by chance: zeros at the ends aside."""
WORDS = 5
"""Different words that a sentence must have to be recognised in another one."""
SAME = 0.85
"""Share of a sentence's words that another one must have to say the same."""
POINTS = 2
"""Criteria of a text that one sentence of another question must name to tell them."""
NUMBERS = NUMERIC | {"code"}

_SENTENCE = re.compile(r"(?<=[.।?;]) ")
GAP = "____"
STEM = 5
"""Letters by which words are compared."""
USUAL = frozenset(str(2**power - less) for power in range(17) for less in (0, 1))
"""Numbers of levels and largest values: everybody has them in mind."""
THIRD = re.compile(r"0\.(?:3{3,}|6{2,}7)")
"""One and two thirds, rounded: they come up everywhere."""
_NUMBER = re.compile(r"(?<![\w./])[-−]?\d+(?:[ \u00a0\u202f,]\d{3})*(?:\.\d+)?(?![\w.]*\d)")
_WORD = re.compile(r"[^\W\d_\u0980-\u09ff][\w'-]{3,}|[\u0980-\u09ff]{3,}")


@dataclass(frozen=True)
class Leak:
    """One question (``teller``) gives away what a part of another (``asker``) asks."""

    teller: str
    asker: str
    label: str
    what: str
    text: str = ""


@dataclass
class PrintedContent:
    """What a question prints in one language, indexed by what leaks are searched by."""

    sentences: list[str] = field(default_factory=list)
    formulas: dict[CanonicalForm, str] = field(default_factory=dict)
    """Each with the whole formula that it stands in."""

    @cached_property
    def numbers(self) -> set[str]:
        """Return the numbers with enough digits not to be chance, without blanks and signs."""
        return {n for sentence in self.sentences for n in _iter_notable_numbers(sentence)}

    @cached_property
    def words(self) -> list[tuple[str, frozenset[str]]]:
        """Return each sentence with the stems of its words."""
        return [(sentence, _extract_word_stems(sentence)) for sentence in self.sentences]

    @cached_property
    def text(self) -> str:
        """Return all sentences as one text, so that most searches end after one pass."""
        return "\n".join(self.sentences)

    @cached_property
    def vocabulary(self) -> frozenset[str]:
        """Return the word stems of all sentences."""
        return frozenset[str]().union(*(words for _, words in self.words))


@dataclass(frozen=True)
class AskedContent:
    """What answers one part, and so must not stand in another question."""

    label: str
    formulas: Mapping[CanonicalForm, str]
    numbers: frozenset[str]
    sentences: tuple[tuple[str, str], ...]
    scheme: rubric.RubricSpec | None
    steps: tuple[str, ...]

    @property
    def is_checkable(self) -> bool:
        """Whether the part has anything that another question could give away."""
        return bool(self.formulas or self.numbers or self.words or self.criteria or self.steps)

    @cached_property
    def criteria(self) -> dict[str, list[frozenset[str]]]:
        """Return the word stems of each criterion's examples; empty if they are too few to leak."""
        criteria = self.scheme.criteria if self.scheme else {}
        if len(criteria) < POINTS:
            return {}
        return {
            name: [*filter(None, map(_extract_word_stems, one.accept))]
            for name, one in criteria.items()
        }

    @cached_property
    def words(self) -> list[tuple[str, frozenset[str], frozenset[str]]]:
        """Return sentence, required stems and all stems of each sentence that is long enough."""
        found = [
            (
                f"{must} {may}".strip(),
                _extract_word_stems(must),
                _extract_word_stems(f"{must} {may}"),
            )
            for must, may in self.sentences
        ]
        return [one for one in found if len(one[2]) >= WORDS]


@dataclass(frozen=True)
class QuestionContent:
    """What a question prints and what it asks, in one language."""

    template: str
    lang: str
    said: PrintedContent
    secrets: tuple[AskedContent, ...]


def question_content(question: Question, key: QuestionKey) -> QuestionContent:
    """Return what a question prints and asks, without the numbers of its answers.

    Numbers differ in each variant, so a bank is checked without them and a paper with them.
    """
    own = printed_content(question, key.draw)
    asked = tuple(replace(one, numbers=frozenset()) for one in asked_content(question, key, own))
    return QuestionContent(question.template, question.lang, own, asked)


def find_bank_leaks(bank: Bank, questions: Sequence[QuestionContent]) -> dict[Leak, str]:
    """Return the leaks between a bank's questions, each with the first language that has it.

    Templates that exclude each other (``apart``) never stand in one paper and are not compared.
    """
    found: dict[Leak, str] = {}
    known = {one.name: one for one in bank.candidates({one.template: None for one in questions})}
    for asker in questions:
        asked = [one for one in asker.secrets if one.is_checkable]
        for teller in questions if asked else ():
            if teller is asker or teller.lang != asker.lang:
                continue
            what = [(one, *said) for one in asked for said in _iter_leaks(one, teller.said)]
            names = teller.template, asker.template
            if what and not known[teller.template].excludes(known[asker.template]):
                for secret, said, text in what:
                    found.setdefault(Leak(*names, secret.label, said, text), teller.lang)
    return found


def find_paper_leaks(paper: Paper) -> list[Leak]:
    """Return every leak between the questions of a paper, in any of its languages."""
    found: dict[Leak, None] = {}
    for place in range(len(paper.langs)):
        told = [
            printed_content(item.questions[place], item.keys[place].draw) for item in paper.items
        ]
        for asker, own in zip(paper.items, told, strict=True):
            for secret in asked_content(asker.questions[place], asker.keys[place], own):
                for teller, other in zip(paper.items, told, strict=True):
                    if teller is not asker:
                        names = teller.keys[0].template, asker.keys[0].template
                        what = dict.fromkeys(_iter_leaks(secret, other))
                        found |= dict.fromkeys(Leak(*names, secret.label, *w) for w in what)
    return list(found)


def _iter_leaks(secret: AskedContent, other: PrintedContent) -> Iterator[tuple[str, str]]:
    """Yield what ``other`` gives away of a secret, and the text that does it."""
    if not secret.formulas.keys().isdisjoint(other.formulas):
        for form in secret.formulas.keys() & other.formulas.keys():
            text = f"${other.formulas[form]}$"
            yield f"formula {secret.formulas[form]} in {text}", text
    if secret.numbers:
        yield from ((f"number {n}", n) for n in sorted(secret.numbers & other.numbers))
    for sentence, needed, words in secret.words:
        if needed <= other.vocabulary and len(words & other.vocabulary) >= SAME * len(words):
            for line, others in other.words:
                if needed <= others and len(words & others) >= SAME * len(words):
                    yield f"'{sentence}' in {line!r}", line
    if secret.scheme is not None and secret.criteria:
        yield from _met_criteria(secret.scheme, secret.criteria, other)
    places = [other.sentences.index(step) for step in secret.steps if step in other.sentences]
    if len(places) > 1 and places == sorted(places):
        yield f"order of {len(places)} steps", other.sentences[places[0]]


def _met_criteria(
    scheme: rubric.RubricSpec,
    criteria: Mapping[str, Sequence[frozenset[str]]],
    other: PrintedContent,
) -> Iterator[tuple[str, str]]:
    """Yield sentences that meet several criteria, and most of them.

    Only one that has all words of an example for each of them is read.
    """
    for sentence, stems in other.words:
        near = [name for name, listed in criteria.items() if any(one <= stems for one in listed)]
        if len(near) < POINTS:
            continue
        met = [one.name for one in scheme.suggest(sentence).findings if one.status == "found"]
        if len(met) >= POINTS and 2 * len(met) > len(criteria):
            yield f"criteria {', '.join(met)} in {sentence!r}", sentence


def printed_content(question: Question, drawn: Variant) -> PrintedContent:
    """Return the sentences and formulas that a question prints."""
    shown: list[Block] = [*question.stem]
    for part in question.parts:
        rows = [text for _, text in (*part.field.options, *part.field.targets)]
        shown += [*part.body, *(Paragraph(row) for row in (*rows, *part.field.asks))]
    found = PrintedContent(
        [one.strip(" -") for line in blocks_to_plain_text(shown) for one in _SENTENCE.split(line)]
    )
    found.sentences += _SENTENCE.split(
        describe_question_figure(drawn, question.lang, quiz=True) or ""
    )
    for expr in _iter_printed_formulas(shown):
        found.formulas |= dict.fromkeys(canonical_forms(expr), format_tree(expr))
    return found


def _iter_printed_formulas(parts: Iterable[Block | Inline]) -> Iterator[Expr]:
    """Yield the formulas in blocks: typeset ones, those in code and in programs."""
    for part in parts:
        if isinstance(part, TypesetMaths):
            yield from _parse_if_formula(part.typed_text)
        elif isinstance(part, InlineCode):
            yield from _parse_if_formula(part.text)
        elif isinstance(part, CodeBlock):
            yield from formulas_in_program(part.text)
        elif isinstance(part, (Paragraph, Emphasis)):
            yield from _iter_printed_formulas(part.children)
        elif isinstance(part, ListBlock):
            yield from _iter_printed_formulas(block for item in part.items for block in item)
        elif isinstance(part, TableBlock):
            yield from _iter_printed_formulas(
                c for row in (part.head, *part.rows) for cell in row for c in cell
            )


def _parse_if_formula(typed: str) -> Iterator[Expr]:
    """Yield the formula that a text is; nothing if it is none."""
    try:
        yield parse_formula(typed)
    except (FormulaReadError, FormulaError):
        return


def asked_content(
    question: Question, key: QuestionKey, own: PrintedContent
) -> Iterator[AskedContent]:
    """Yield what answers each part, without what the question prints itself (``own``)."""
    for index, part in enumerate(question.parts):
        spec = key.specs[index]
        asked = _asked_formulas(key, index)
        shown = show_key(spec, question.lang) if spec.kind in NUMBERS else ""
        steps = spec.steps if isinstance(spec, order.OrderSpec) else []
        options = {mark: inlines_to_plain_text(text) for mark, text in part.field.options}
        yield AskedContent(
            part.label,
            {form: name for form, name in asked.items() if form not in own.formulas},
            frozenset(_iter_notable_numbers(shown)) - own.numbers,
            tuple(_right_sentences(question, index, spec)),
            spec if isinstance(spec, rubric.RubricSpec) else None,
            tuple(options[mark] for mark in steps),
        )


def _asked_formulas(key: QuestionKey, index: int) -> dict[CanonicalForm, str]:
    """Return the formulas that a part asks and their names.

    A level other than exam makes its own parts, so those of all authored parts count there.
    """
    parts = [index] if key.level == EXAM else range(len(key.draw.template.rules.part))
    return {f: told for part in parts for f, told in asked_formulas(key.draw, part).items()}


def _right_sentences(question: Question, index: int, spec: AnySpec) -> Iterator[tuple[str, str]]:
    """Yield the right statements of a part: words that must recur, and words that may."""
    shown = question.parts[index].field
    options = {mark: inlines_to_plain_text(text) for mark, text in shown.options}
    if isinstance(spec, match.MatchSpec):
        targets = {mark: inlines_to_plain_text(text) for mark, text in shown.targets}
        yield from ((options[left], targets[right]) for left, right in spec.pairs.items())
    elif isinstance(spec, choice.ChoiceSpec) and options:
        yield from (("", text) for n, text in enumerate(options.values(), 1) if n in spec.correct)
    elif isinstance(spec, gap.GapSpec):
        body = (*question.stem, *question.parts[index].body)
        lines = [line for line in blocks_to_plain_text(body) if GAP in line]
        words = [accepted[0] for accepted in spec.gaps()]
        if len(lines) == len(words):
            yield from zip(words, lines, strict=True)


def _iter_notable_numbers(text: str) -> Iterator[str]:
    """Yield the numbers of a text that have too many digits to be there by chance."""
    for found in _NUMBER.findall(text):
        number = re.sub(r"[ \u00a0\u202f,−-]", "", found)
        whole, _, decimals = number.partition(".")
        decimals = decimals.rstrip("0")
        digits = (whole + decimals).lstrip("0") if decimals else whole.strip("0")
        shown = f"{whole}.{decimals}".rstrip(".")
        usual = shown in USUAL or THIRD.fullmatch(shown)
        if len(digits) >= (DIGITS if decimals else WHOLE) and not usual:
            yield shown


def _extract_word_stems(text: str) -> frozenset[str]:
    """Return the first ``STEM`` letters of the longer words, so that endings do not matter."""
    return frozenset(word.casefold()[:STEM] for word in _WORD.findall(text))

"""Proof per template: over many seeds nothing degenerate, nothing that leaks, nothing missing.

For each template: every language is complete; over ``seeds`` draws no trap scores or coincides with
another (each draw is checked, then counted), units fit formulas, figures can be drawn and give
nothing away, the answers' range, the share of duplicates, of kept candidates, and the time per
draw; over a few composed instances no placeholder is left, every
number stands in every language, the printed answer typed back is correct and every trap is
recognised.
"""

from __future__ import annotations

import re
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from flint import arb

from quizgen.bank.dimensions import find_unit_errors
from quizgen.bank.levels import EXAM
from quizgen.bank.markdown import FIELD_MARK, LanguageFile, slot_names
from quizgen.bank.sampler import sampler_for
from quizgen.bank.template import Template
from quizgen.bank.variant import Variant, draw_variant, reference_variant
from quizgen.core.diagnostics import Diagnostic, diagnose
from quizgen.core.errors import MathError, QuizgenError
from quizgen.core.positions import TEXT, Place
from quizgen.grading.diagnosis.carry_forward import are_nearly_equal
from quizgen.grading.spec import AnySpec, SpecBase
from quizgen.kinds.contract import AskedPart, asked_quantities
from quizgen.kinds.grade import grade_answer, show_key
from quizgen.lint.figures import check_figures
from quizgen.lint.foreign_words import find_foreign_words
from quizgen.lint.item_quality import QualityReview
from quizgen.lint.judged_examples import (
    derivation_lines,
    find_derivation_faults,
    find_misjudged_examples,
    find_unsound_schemes,
)
from quizgen.lint.leaks import QuestionContent, question_content
from quizgen.lint.unused_draws import find_unused_draws
from quizgen.locale import FIRST, get_language, localise_numbers
from quizgen.maths.notation import format_tree
from quizgen.maths.numbers import to_float
from quizgen.question.compose import Question, QuestionKey, compose_variant
from quizgen.question.levels import LEVELS, load_level
from quizgen.question.localise import localise
from quizgen.question.part_context import ask_part
from quizgen.render.text import blocks_to_plain_text


class SampleShare(NamedTuple):
    """How many variants a costly check looks at: one in ``one_in``, at least ``least``."""

    least: int
    one_in: int

    def count(self, seeds: int) -> int:
        """Return how many of ``seeds`` variants to look at."""
        return max(self.least, seeds // self.one_in)


COMPOSED = SampleShare(3, 33)
"""Instances that are put into words in every language."""
MARKED = SampleShare(5, 20)
"""Instances whose answers and mistakes are typed back in every language."""
AT_MOST = SampleShare(25, 4)
"""Instances; those among them with a rare mistake are typed back as well."""
RARE = 3
"""Times that every mistake is typed back, as far as it is met."""
VARIED = 4
"""Different questions whose answers cannot all be the same by chance."""
ENOUGH = 20
"""Draws after which a mistake that never gave a wrong answer is one that never does."""
AT_ONCE = 50
"""Draws that are timed as one."""
LEVELLED = 1
"""Instances that are asked at every level, and typed back likewise."""
ComposedLanguages = dict[str, tuple[Question, QuestionKey]]
"""An instance in each of its languages."""
_DRAW = ("draw",)
VERBATIM = frozenset({"code", "program", "sketch"})
"""Kinds whose key is printed as a program writes it."""


GRADES = ("exact", "ball", "checked", "uncertain")
"""How certain a step's value is, from the best."""


@dataclass
class TemplateReport:
    """Counts, ranges and diagnostics of one template over its draws.

    ``seconds`` is processor time of drawing alone; ``heard`` is what the questions print, for the
    leaks between templates. ``certainties`` is, for each step, the least certain grade of its
    values: exact, ball (proved), checked (computed twice) or uncertain.
    """

    template: str
    seeds: int = 0
    distinct: int = 0
    tries: int = 0
    seconds: float = 0.0
    ranges: dict[str, tuple[float, float]] = field(default_factory=dict)
    traps: Counter[str] = field(default_factory=Counter)
    problems: list[Diagnostic] = field(default_factory=list)
    heard: list[QuestionContent] = field(default_factory=list)
    certainties: dict[str, str] = field(default_factory=dict)

    @property
    def certainty(self) -> str:
        """Return the least certain grade of any step: exact, ball, checked or uncertain."""
        return max(self.certainties.values(), key=GRADES.index, default="exact")

    @property
    def acceptance(self) -> float:
        """Return the share of candidates that no condition rejected, 0 to 1."""
        return self.seeds / self.tries if self.tries else 0.0

    @property
    def duplicates(self) -> float:
        """Return the share of variants that repeat an earlier one, 0 to 1."""
        return 1 - self.distinct / self.seeds if self.seeds else 0.0


def lint_template(
    template: Template, seeds: int = 200, langs: tuple[str, ...] = ()
) -> TemplateReport:
    """Return everything that is wrong with a template, from its files and from its variants.

    Parameters
    ----------
    template : Template
    seeds : int
        How many draws to look at.
    langs : tuple of str
        Languages that it must be written in: those of its bank.
    """
    report = TemplateReport(template.id)
    ignored = template.rules.ignore
    clashes = [error.diagnostic(template.file) for error in find_unit_errors(template)]
    found = [*_find_language_problems(template, langs), *clashes]
    report.problems += [problem for problem in found if problem.code not in ignored]
    if report.problems:
        return report
    lessons = QualityReview(template)
    try:
        first = _examine_draws(template, seeds, report, lessons)
        if "uncertain" in report.certainties.values():
            return report  # no digit of it can be printed
        known = [reference_variant(template)] if template.rules.reference is not None else []
        composed = [
            _compose_in_all_languages(one) for one in (*first[: COMPOSED.count(seeds)], *known)
        ]
        for worded in composed:
            report.problems += find_unfilled_placeholders(worded)
        typed = (*_select_telling_variants(first, MARKED.count(seeds)), *known)
        derived = find_derivation_faults(first[: MARKED.count(seeds)])
        report.problems += derived or _select_first_diagnostics(
            answer for one in typed for answer in _iter_misjudged_answers(one)
        )
        for one, worded in zip(first[:LEVELLED], composed, strict=False):
            report.problems += check_levels(one)
            report.heard += [question_content(question, key) for question, key in worded.values()]
        report.problems += find_misjudged_examples(first)
        report.problems += find_unsound_schemes(first)
        report.problems += [*check_figures(first), *_find_constant_answers(template, report)]
        report.problems += [*_find_unused_draws(template), *find_foreign_words(template)]
        report.problems += _diagnose_quality_errors(template, lessons)
        report.problems = [one for one in report.problems if one.code not in ignored]
    except QuizgenError as error:
        if "uncertain" not in report.certainties.values():  # which says it with the step
            report.problems.append(error.diagnostic(template.file))
    report.problems = list(dict.fromkeys(report.problems))
    return report


def _locate_answer(index: int) -> Place:
    """Return where a part's answer stands in ``template.toml``."""
    return ("part", index, "answer")


def _diagnose_quality_errors(template: Template, lessons: QualityReview) -> Iterator[Diagnostic]:
    """Yield the errors of the quality review as diagnostics with their places."""
    labels = [label or "1" for label in template.labels]
    for one in lessons.findings():
        if one.level == "error":
            file, place = template.file, _locate_answer(labels.index(one.label))
            if one.code == "QG304":
                file, place = _get_prose_file(template, template.languages[0]), ("reasons",)
            elif one.code in {"QG309", "QG310"}:
                place = ("claims",)
            yield diagnose(one.code, file, f"part {one.label}: {one.what}", place)


def _select_telling_variants(draws: list[Variant], marked: int) -> Iterator[Variant]:
    """Yield the first ``marked`` variants, and later ones with a misconception that is rare."""
    met = Counter[tuple[int, str]]()
    for place, one in enumerate(draws):
        mistakes = [(part, trap) for part, traps in enumerate(one.traps) for trap in traps]
        if place < marked or any(met[mistake] < RARE for mistake in mistakes):
            met.update(mistakes)
            yield one


def _examine_draws(
    template: Template, seeds: int, report: TemplateReport, lessons: QualityReview
) -> list[Variant]:
    """Count what the variants give into ``report``; return those to be typed back."""
    seen: set[str] = set()
    first: list[Variant] = []
    met: Counter[tuple[tuple[str, ...], ...]] = Counter()
    sampler_for(template)
    for one in _draw_within_limit(template, seeds, report):
        report.seeds += 1
        report.tries += one.tries
        seen.add(one.identity)
        met[one.traps] += 1
        _widen_ranges(report, one)
        report.problems += _find_uncertain_steps(one, report)
        if not any(problem.code == "QG222" for problem in report.problems):
            report.problems += _find_unequal_alternatives(one)
        lessons.add(one)
        if len(first) < AT_MOST.count(seeds):
            first.append(one)
    report.distinct = len(seen)
    for traps, count in met.items():
        for trap in (trap for part in traps for trap in part):
            report.traps[trap] += count
    for part in sampler_for(template).parts:
        report.problems += [
            diagnose(
                "QG207", template.file, f"trap {trap!r} never gives a usable wrong answer", _DRAW
            )
            for trap in part.traps
            if not report.traps[trap] and report.seeds >= ENOUGH
        ]
    return first


def _draw_within_limit(template: Template, seeds: int, report: TemplateReport) -> Iterator[Variant]:
    """Yield variants in batches, and add the time that drawing took to the report.

    Reading the clock for each would cost a part of what is measured.
    """
    for begin in range(0, seeds, AT_ONCE):
        started = time.process_time()
        drawn = [draw_variant(template, seed) for seed in range(begin, min(begin + AT_ONCE, seeds))]
        report.seconds += time.process_time() - started
        yield from drawn


def _find_uncertain_steps(one: Variant, report: TemplateReport) -> Iterator[Diagnostic]:
    """Yield steps whose value cannot be distinguished from zero: no digit can be printed.

    A step is looked at in each draw, and reported once.
    """
    for step in one.template.chain.steps:
        value = one.values[step.name]
        met = report.certainties.get(step.name, "exact")
        if isinstance(value, arb):
            found = one.template.chain.certainties[step.name]
            if met != "uncertain" and value.contains(0) and not value.is_zero():
                drawn = ", ".join(f"{n} = {one.format_value(n)}" for n in one.shown)
                what = (
                    f"step {step.name!r} is 0 or nearly so and cannot be told from it, "
                    f"seed {one.seed} ({drawn})"
                )
                yield diagnose("QG148", one.template.file, what, _DRAW)
                found = "uncertain"
            met = max(met, found, key=GRADES.index)
        report.certainties[step.name] = met


def _find_unequal_alternatives(one: Variant) -> Iterator[Diagnostic]:
    """Yield other formulas of steps that give another value than the step."""
    chain, values = one.template.chain, one.values
    for other in chain.alternatives:
        try:
            found = chain.solve_with_steps([other], values)[other.name]
        except MathError:
            found = None
        if found is None or not are_nearly_equal(found, values[other.name]):
            file = one.template.solver_file or one.template.file
            what = (
                f"{other.name} = {format_tree(other.expr)} gives another value than the step, "
                f"seed {one.seed}"
            )
            yield diagnose("QG222", file, what, ("alternatives", other.name))


def _widen_ranges(report: TemplateReport, one: Variant) -> None:
    """Extend the range of each asked quantity by one variant."""
    for part in one.template.rules.part:
        for name in asked_quantities(part.answer):
            value = to_float(one.shown_values[name])
            low, high = report.ranges.get(name, (value, value))
            report.ranges[name] = (min(low, value), max(high, value))


def _find_unused_draws(template: Template) -> Iterator[Diagnostic]:
    """Yield what is drawn and used nowhere."""
    for name in find_unused_draws(template):
        table = "draw" if name in template.rules.draw else "data"
        what = f"{table}.{name} is drawn, and nothing uses it"
        yield diagnose("QG219", template.file, what, (table, name))


def _find_constant_answers(template: Template, report: TemplateReport) -> Iterator[Diagnostic]:
    """Yield answers that do not vary although the questions do."""
    for part in template.rules.part if report.distinct >= VARIED else ():
        ranges = {name: report.ranges[name] for name in asked_quantities(part.answer)}
        if ranges and all(low == high for low, high in ranges.values()):
            said = ", ".join(f"{name} = {low:.6g}" for name, (low, _) in ranges.items())
            what = f"the answer {said} is the same in all {report.seeds} draws"
            yield diagnose("QG208", template.file, what, _DRAW)


def _get_prose_file(template: Template, lang: str) -> Path:
    """Return the file with a template's prose in a language."""
    return template.path / f"{lang}.md"


def _find_language_problems(template: Template, langs: tuple[str, ...]) -> list[Diagnostic]:
    """Return what is missing in the languages a template must have or has."""
    wanted = langs or tuple(template.texts) or (FIRST,)
    files = {lang: _get_prose_file(template, lang) for lang in (*wanted, *template.texts)}
    problems = [
        diagnose("QG210", files[lang], f"no {lang}.md")
        for lang in wanted
        if lang not in template.texts
    ]
    if not template.texts:
        return problems
    for lang in template.texts:
        problems += [diagnose(code, files[lang], what, place)
                     for code, what, place in _find_missing_texts(template, lang)]  # fmt: skip
    problems += _find_language_differences(template)
    return problems


def _find_missing_texts(template: Template, lang: str) -> Iterator[tuple[str, str, Place]]:
    """Yield code, message and place of each section or sentence that a language lacks."""
    text, chain = template.texts[lang], template.chain
    placed = {
        name.removeprefix(FIELD_MARK)
        for section in text.sections.values()
        for name in slot_names(section)
        if name.startswith(FIELD_MARK)
    }
    for label, part in zip(template.labels, template.rules.part, strict=True):
        if label and label not in {*text.sections, *placed} and "from" not in part.answer:
            yield "QG211", f"section {label!r} is missing", ()
    if (chain.steps or chain.forms) and "check" not in text.sections:
        yield "QG211", "section 'check' is missing", ()
    parts = sampler_for(template).parts
    wanted = {
        "steps": {step.name for part in parts for step in (*part.steps, *part.form_steps)},
        "traps": {trap for part in parts for trap in part.traps},
    }
    listed = {trap for part in template.rules.part for trap in part.answer.get("traps", ())}
    wanted["traps"] |= listed
    wanted["claims"] = set(template.rules.claims)
    wanted["steps"] |= derivation_lines(template)
    known = {
        "claims": wanted["claims"],
        "steps": {*chain.by_name, *chain.form_by_name, *derivation_lines(template)},
        "traps": {*chain.traps, *chain.form_traps, *listed},
    }
    for section, names in wanted.items():
        explained = set(text.named.get(section, {}))
        for name in sorted(names - explained):
            yield "QG212", f"section {section!r} lacks {name!r}", (section,)
        knows = "pool [claims]" if section == "claims" else "solver"
        for name in sorted(explained - known[section]):
            what = f"section {section!r} explains {name!r}, unknown to the {knows}"
            yield "QG213", what, (section, name)


def _find_language_differences(template: Template) -> Iterator[Diagnostic]:
    """Yield values and names that one language shows and another does not."""
    shown = {lang: set(_iter_question_slots(text)) for lang, text in template.texts.items()}
    first, *others = shown
    for lang in others:
        if shown[first] != shown[lang]:
            odd = sorted(shown[first] ^ shown[lang])
            what = f"{first}.md and {lang}.md do not show the same values: {odd}"
            # The one that shows more has the line to look at.
            more = first if odd[0] in shown[first] else lang
            place: Place = (TEXT, f"{{{{ {odd[0]} }}}}")
            yield diagnose("QG214", _get_prose_file(template, more), what, place)
    for section in ("options", "words", "gaps", "points", "claims", "reasons", "why"):
        keys = {lang: set(text.named.get(section, {})) for lang, text in template.texts.items()}
        for lang in others:
            if keys[first] != keys[lang]:
                odd = sorted(keys[first] ^ keys[lang])
                what = f"section {section!r} differs from {first}.md by {odd}"
                stranger = next((name for name in odd if name in keys[lang]), "")
                place = (section, stranger) if stranger else (section,)
                yield diagnose("QG215", _get_prose_file(template, lang), what, place)


def _iter_question_slots(text: LanguageFile) -> Iterator[str]:
    """Yield the placeholders of stem, parts, options and claims."""
    yield from slot_names(text.stem)
    for name, section in text.sections.items():
        if len(name) == 1:
            yield from slot_names(section)
    for asked in ("options", "claims"):
        for sentence in text.named.get(asked, {}).values():
            yield from slot_names(sentence)


def _compose_in_all_languages(one: Variant) -> ComposedLanguages:
    """Return the variant's question and key in each language, without figures."""
    return {lang: compose_variant(one, lang, figures=False) for lang in one.template.languages}


def find_unfilled_placeholders(worded: ComposedLanguages) -> list[Diagnostic]:
    """Return a diagnostic for each placeholder, nan or inf left in a composed question."""
    problems: list[Diagnostic] = []
    for lang, (question, key) in worded.items():
        file = _get_prose_file(key.draw.template, lang)
        bodies = [question.stem, *(part.body for part in question.parts)]
        shown = " ".join(line for body in bodies for line in blocks_to_plain_text(body))
        if re.search(r"\{\{|\}\}|\bnan\b|\binf\b", shown):
            what = f"a placeholder is left in {shown!r}"
            problems.append(diagnose("QG209", file, what))
        remarks = (key.solution.why, key.solution.check, key.solution.note)
        solved = " ".join(line for remark in remarks for line in blocks_to_plain_text(remark))
        if "{{" in solved:
            problems.append(diagnose("QG209", file, "a placeholder is left in the solution"))
    return problems


@dataclass(frozen=True)
class _TypedAnswer:
    """A typed answer that was not marked as it should be.

    ``trap`` is the misconception that was typed; empty if it was the key.
    """

    part: str
    trap: str
    diagnostic: Diagnostic


def _select_first_diagnostics(answers: Iterable[_TypedAnswer]) -> list[Diagnostic]:
    """Return the first diagnostic of each part's key and each misconception.

    It would come again in each draw. Where the key itself is not accepted, misconceptions prove
    nothing.
    """
    found: dict[tuple[str, str], Diagnostic] = {}
    for one in answers:
        found.setdefault((one.part, one.trap), one.diagnostic)
    keys = {part for part, trap in found if not trap}
    return [said for (part, trap), said in found.items() if not trap or part not in keys]


def _iter_misjudged_answers(one: Variant) -> Iterator[_TypedAnswer]:
    """Yield what goes wrong when the key and each misconception of a variant are typed."""
    for index, label in enumerate(one.template.labels):
        yield from _check_printed_answers(one, ask_part(one, index), index, label)


def _check_printed_answers(
    one: Variant, part: AskedPart[AnySpec], index: int, label: str
) -> Iterator[_TypedAnswer]:
    """Yield what goes wrong when one part's key and misconceptions are typed.

    A text typed alike in several languages is graded once: a verdict knows no language.
    """
    seen = set[tuple[str, str]]()
    langs = one.template.languages
    ways = {"": part.spec, **part.mistakes}
    typed = {trap: _format_key_by_language(spec, langs) for trap, spec in ways.items()}
    for lang in langs:
        where = f"seed {one.seed}, {lang}, part {label or '1'}"
        for trap in ways:
            text = typed[trap][lang]
            if (trap, text) not in seen:
                seen.add((trap, text))
                place = _locate_answer(index)
                for code, what in _check_typed_answer(part.spec, trap, text, lang):
                    found = diagnose(code, one.template.file, f"{where}: {what}", place)
                    yield _TypedAnswer(label, trap, found)


def _format_key_by_language(spec: AnySpec, langs: Sequence[str]) -> dict[str, str]:
    """Return the printed key in each language.

    A key that is program text, or is shown by no rule of its own, is formatted once.
    """
    first = show_key(spec, langs[0])
    own = type(spec).show_in is not SpecBase.show_in
    shown = {lang: show_key(spec, lang) if own else first for lang in langs}
    if spec.kind in VERBATIM:
        return shown
    return {lang: localise_numbers(lang, text) for lang, text in shown.items()}


def check_levels(one: Variant) -> list[Diagnostic]:
    """Return the problems of the derived levels: languages must be graded alike, keys accepted."""
    found: list[Diagnostic] = []
    file, place = one.template.file, ("levels",)
    for name in (name for name in LEVELS if name != EXAM and load_level(name).is_applicable(one)):
        asked = [load_level(name).ask(one, lang) for lang in one.template.languages]
        if len({tuple(map(repr, (part.spec for part in each.parts))) for each in asked}) > 1:
            what = f"seed {one.seed}: {name}: languages are not marked alike"
            found.append(diagnose("QG206", file, what, place))
        for part in asked[0].parts:
            where = f"seed {one.seed}, {name}, part {part.label or '1'}"
            lang = asked[0].solution.lang
            typed = [("", _format_key_by_language(part.spec, [lang])[lang])]
            mistakes = localise(lang, part.solved).mistakes  # of a drawing they are only told
            typed += [(mistake.name, mistake.value) for mistake in mistakes if mistake.value]
            found += [
                diagnose(code, file, f"{where}: {what}", place)
                for trap, text in typed
                for code, what in _check_typed_answer(part.spec, trap, text, lang)
            ]
    return found


def _check_typed_answer(
    spec: AnySpec, trap: str, typed: str, lang: str
) -> Iterator[tuple[str, str]]:
    """Yield code and message if a typed key (no ``trap``) or misconception is misjudged."""
    comma = get_language(lang).decimal == "," and spec.kind not in VERBATIM
    verdict = grade_answer(spec, typed, lang=lang, decimal="comma" if comma else "point")
    if trap and verdict.note != f"trap:{trap}":
        yield "QG204", f"trap {trap!r} typed as {typed!r} is {verdict.verdict} ({verdict.note})"
    if not trap and verdict.verdict != "correct" and not verdict.needs_self_marking:
        yield "QG205", f"printed answer {typed!r} is marked {verdict.verdict} ({verdict.note})"

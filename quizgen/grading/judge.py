"""Judging by a specification, whichever kind it is of: the verdict, its sentence, the key in print.

What a student types never raises: it becomes a ``Verdict``. Neither SymPy nor NumPy is imported.
"""

from __future__ import annotations

from fractions import Fraction

import msgspec

from quizgen.grading.diagnosis.numeric_slips import find_common_slip
from quizgen.grading.feedback import feedback_sentence
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import (
    AnswerForm,
    drop_bullets,
    drop_counting,
    drop_equal_reason,
    drop_markup,
    drop_transposed,
    find_conclusion,
    has_second_meaning,
    is_cut_short,
    is_denied,
    is_range_of_shares,
    list_plainer_texts,
    list_readings,
    name_by_index,
    prove_groups,
    write_in_signs,
)
from quizgen.grading.reading.factor_words import drop_bound
from quizgen.grading.reading.labels import AskedNames, put_names_first
from quizgen.grading.reading.normalise import LONGEST_PROSE
from quizgen.grading.reading.spoken_values import list_other_readings
from quizgen.grading.spec import AnySpec, ScalarSpec, WordSpec
from quizgen.grading.verdict import PARTIAL, WRONG, Verdict, ambiguous, attach_message, unreadable
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.precision import working_precision

TWO_READINGS = frozenset({"comma-twice", "two-readings", "sides-differ"})
"""Reasons for asking back that are not the learner's slip: the text can be read in two ways."""

MEASURED = frozenset({"number", "quantity"})
"""Forms of answers that are one number."""

WITHOUT_WORDS = MEASURED | {"values"}
"""Forms of answers in which a word can only be a name or a unit, or deny what follows."""

DENIABLE = WITHOUT_WORDS | {"formula"}
"""Forms of answers that a word of denial turns round."""

DECIDED = frozenset(
    {"unit-not-asked", "unit-other", "percent-not-asked", "unknown-unit-case", "two-readings",
     "used-twice", "no-answer", "too-long", "which-term", "another-word",
     "denied", "sides-differ", "several-answers"}
)  # fmt: skip
"""Notes on what was read well enough: nothing around it makes it unreadable."""

NAMING = frozenset({"cells", "coordinate"})
"""Notes that only name what is wrong."""


FAR_TOO_LONG = 100_000
"""Characters beyond what any kind reads, so that a megabyte costs no more to refuse."""


def judge_answer(spec: AnySpec, typed: str, options: GradingOptions) -> Verdict:
    """Return the verdict on one typed answer, in no language yet.

    It never raises for what was typed: an answer that cannot be read gets an ``unreadable`` or
    ``ambiguous`` verdict, which costs nothing.

    What cannot be read as it stands is tried again without what people write around an answer;
    what it was read as stands in ``read_as``. If that does not help either, it is the answer as
    typed that is asked back, since columns count in it.
    """
    with spec.known_units().activate():
        return _credit_mistake(spec, _judge_as_written(spec, typed, options))


def _credit_mistake(spec: AnySpec, verdict: Verdict) -> Verdict:
    """Return the verdict, with the share that a known mistake still earns."""
    share = getattr(spec, "worth", {}).get(verdict.note.removeprefix("trap:"))
    if verdict.verdict != WRONG or share is None:
        return verdict
    credit = Fraction(str(share))
    return msgspec.structs.replace(verdict, verdict=PARTIAL, credit=credit)


def _judge_as_written(spec: AnySpec, typed: str, options: GradingOptions) -> Verdict:
    """Return the verdict on an answer as it was typed; only then as it may have been meant.

    An undecided answer is read once more without the words around it; if that fails too, the
    learner is asked what was meant.
    """
    if len(typed) > LONGEST_PROSE:  # no answer is so long: nothing is searched for one in it
        return _judge_text(spec, typed[:FAR_TOO_LONG], options)
    form = spec.written_as
    verdict = _judge_text(spec, _prepare(typed, form, spec.value_names()), options)
    doubtful = has_second_meaning if verdict.verdict == WRONG else is_range_of_shares
    if verdict.is_graded and form in MEASURED and doubtful(typed):
        return ambiguous("bullet-or-range", verdict.read_as)
    if verdict.verdict == WRONG and form in MEASURED:
        verdict = _ask_for_reading(spec, typed, options) or verdict
    verdict = _judge_conclusion(spec, typed, verdict, options)
    decided = verdict.is_graded or verdict.note in DECIDED or not typed.strip()
    if decided and verdict.note != "unknown-term":
        return verdict
    bound = drop_bound(typed, spec.bound) if isinstance(spec, ScalarSpec) and spec.bound else ""
    if bound:
        return _judge_as_written(spec, bound, options)
    plainer = _judge_plainer(spec, typed, options)
    return plainer or (verdict if verdict.is_graded else _ask_what_is_meant(form, typed, verdict))


def _judge_conclusion(
    spec: AnySpec, typed: str, verdict: Verdict, options: GradingOptions
) -> Verdict:
    """Return the verdict on what is concluded where the sides of an answer differ, if anything."""
    differ = verdict.note == "sides-differ" and spec.written_as in MEASURED
    concluded = find_conclusion(typed) if differ else ""
    return _judge_text(spec, concluded, options) if concluded else verdict


def _judge_plainer(spec: AnySpec, typed: str, options: GradingOptions) -> Verdict | None:
    """Return the verdict on the answer without what stands around it; None if that is no help."""
    names, ranges = spec.value_names(), spec.may_be_range
    typed = prove_groups(typed) if spec.written_as in {"values", "number", "quantity"} else typed
    for text in list_plainer_texts(typed, spec.written_as, names, ranges=ranges):
        plainer = _judge_conclusion(spec, text, _judge_text(spec, text, options), options)
        if plainer.verdict == WRONG and is_cut_short(typed):
            return None
        if plainer.note != "unknown-term" and (plainer.is_graded or plainer.note in DECIDED):
            return plainer
    return None


def _ask_what_is_meant(form: AnswerForm, typed: str, verdict: Verdict) -> Verdict:
    """Ask back by what is denied or what there is to choose from; else as the kind asks."""
    if form in WITHOUT_WORDS and is_denied(typed):
        return ambiguous("denied")
    readings = list_readings(typed) if form in MEASURED else []
    if not readings:
        return verdict
    return _offer_readings(tuple(readings))


def _ask_for_reading(spec: AnySpec, typed: str, options: GradingOptions) -> Verdict | None:
    """Return the verdict on ``16 (17)`` or ``1.085*10-2``, which a wrong number may mean.

    It is asked back only where another reading earns something: else it costs the same.
    """
    readings = list_other_readings(typed)
    found = [_judge_text(spec, text, options) for text in readings]
    if not any(one.credit for one in found):
        return None
    return found[0] if len(found) == 1 else _offer_readings(readings)


def _offer_readings(readings: tuple[str, ...]) -> Verdict:
    """Return the question which of several readings is meant."""
    quoted = tuple(f"“{one}”" for one in readings)
    return ambiguous("several-answers", " | ".join(readings), readings=quoted, numbers=readings)


def _prepare(typed: str, form: AnswerForm, names: AskedNames) -> str:
    """Return the text that is judged first: without what would make a right answer a wrong one."""
    if form == "values":
        named = name_by_index(put_names_first(drop_transposed(typed), names), names)
        return prove_groups(drop_counting(named))
    if form == "formula":
        return write_in_signs(typed)
    if form == "word":
        return drop_bullets(drop_markup(typed))
    if form in {"number", "quantity"}:
        return prove_groups(drop_equal_reason(typed))
    return drop_markup(typed) if form == "option" else typed


def _judge_text(spec: AnySpec, typed: str, options: GradingOptions) -> Verdict:
    """Return the verdict of a specification on a text; a fault in its notation is one, too.

    A right answer that is denied ("not 5") is ambiguous.
    """
    try:
        verdict = spec.judge(typed, options)
    except FormulaReadError as error:
        return read_error_verdict(error)
    if verdict.is_graded and spec.written_as in DENIABLE and is_denied(typed):
        return ambiguous("denied")
    return verdict


def read_error_verdict(error: FormulaReadError) -> Verdict:
    """Return the verdict on an answer that could not be read: asked back, with its place."""
    note = error.code
    if error.code == "unknown-unit" and error.expected:
        note = "unknown-unit-case"
    asked = ambiguous if note in TWO_READINGS else unreadable
    return asked(note, column=error.column or 1, found=error.found, expected=error.expected)


def explain_verdict(spec: AnySpec, verdict: Verdict, lang: str, *, reveal: bool = True) -> Verdict:
    """Return the verdict with its sentence, and those of its cells, in a language.

    A verdict that has nothing to explain is returned as it is.

    Parameters
    ----------
    spec : AnySpec
    verdict : Verdict
    lang : str
    reveal : bool
        Whether the reasons may be said that tell the right answer: not while there are tries left.
    """
    if not (verdict.note or verdict.cells or verdict.fields):
        return verdict
    cells = tuple(explain_verdict(spec, cell, lang, reveal=reveal) for cell in verdict.cells)
    return attach_message(verdict, _build_sentence(spec, verdict, lang, reveal=reveal), cells)


def _build_sentence(spec: AnySpec, verdict: Verdict, lang: str, *, reveal: bool) -> str:
    """Return the sentence for a verdict's note.

    For a misconception it is the author's own sentence, if there is one. Before it stands the line
    that it is about, where an answer has several.
    """
    sentence = _say_note(spec, verdict, lang, reveal=reveal)
    where = (
        feedback_sentence(lang, "at-line", verdict.fields) if "at_line" in verdict.fields else ""
    )
    return " ".join(filter(None, (where, sentence)))


def _say_note(spec: AnySpec, verdict: Verdict, lang: str, *, reveal: bool) -> str:
    """Return the sentence for a note, wherever in the answer it is about."""
    name = verdict.note.removeprefix("trap:")
    if name == verdict.note:
        said = feedback_sentence(lang, verdict.note, verdict.fields) if name else ""
        reasons = _join_author_reasons(spec, verdict, lang, reveal=reveal)
        return " ".join(filter(None, (said, _find_common_reason(verdict, lang), reasons)))
    return spec.notes.get(lang, {}).get(name) or feedback_sentence(lang, "trap", verdict.fields)


def _join_author_reasons(spec: AnySpec, verdict: Verdict, lang: str, *, reveal: bool) -> str:
    """Return why what was chosen is wrong, in the author's words; empty if there are none.

    Without ``reveal`` a reason that tells the answer in any of its languages is left out.
    """
    known = spec.why.get(lang) if isinstance(spec, WordSpec) else None
    chosen = verdict.fields.get("because", ())
    if not known or not isinstance(chosen, tuple) or not isinstance(spec, WordSpec):
        return ""
    said = (
        known[label]
        for label in chosen
        if label in known
        and (reveal or not any(spec.tells(label, one.get(label, "")) for one in spec.why.values()))
    )
    return " ".join(dict.fromkeys(said))


def _find_common_reason(verdict: Verdict, lang: str) -> str:
    """Return the sentence for the slip that all wrong cells share; empty if there is none.

    A misconception's own sentence is not for cells: it speaks of the answer.
    """
    if verdict.note not in NAMING:
        return ""
    missed = [cell for cell in verdict.cells if cell.credit < 1]
    if len({cell.note for cell in missed}) != 1:
        return ""
    note, fields = find_common_slip(missed)
    return "" if note.startswith("trap:") else feedback_sentence(lang, note, fields)


@working_precision()
def show_spec(spec: AnySpec, lang: str = "en") -> str:
    """Return the key of a specification as it is printed, and as it can be typed back."""
    with spec.known_units().activate():
        return spec.show_in(lang)

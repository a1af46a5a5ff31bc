"""Kind ``order``: steps of a derivation; every order that respects ``before`` is right."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import ClassVar

import msgspec

from quizgen.grading.echo import safe_echo
from quizgen.grading.judging.spelling import fold_word
from quizgen.grading.judging.wordings import find_wording_in, holds_wording
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm, is_denied
from quizgen.grading.reading.normalise import BANGLA_LETTERS, apply_rewrite, normalise_typed
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import HALF, Verdict, correct, verdict_by_share
from quizgen.kinds.asking import assign_letters, make_spec
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    AuthoredPooled,
    FieldProblem,
    InputControl,
    PartContext,
    find_extra_problems,
    find_name_problems,
)
from quizgen.kinds.work import count_listed
from quizgen.locale import translate
from quizgen.locale.word_patterns import WordPattern, set_of_words
from quizgen.maths.notation import FormulaReadError

MOST_STEPS = 40
_LETTERED = r"[A-Za-z](?:(?:,| «and»| «and-in-latin»| «choices.or»)? [A-Za-z])*"
_LEFT_OUT = WordPattern(
    r"(?P<kept>[^()]+) \((?P<aside>[A-Z])(?= [^()]*\b«choices.no-step»(?!\w)) [^()]{3,}\)"
    r"|(?P<behind>.+)(?:[,;:.] ?| ?\(| (?=«choices.without» |«choices.except-steps» ))"
    rf"(?:«choices.without» (?P<out>[^()]+)|«choices.except-steps» (?P<denied>{_LETTERED})"
    rf"|(?P<wrong>{_LETTERED}) (?:«choices.stays» |was )?«choices.is-no-step»"
    r"(?:[,:]? «choices.because» [^()]+)?)[).]*",
    re.IGNORECASE,
)
_LEFT_OUT_FIRST = WordPattern(
    r"«choices.without» (?P<out>[A-Za-z])\s*[:,;–-]\s*(?P<kept>.+)", re.IGNORECASE
)
"""Steps, and others that are said not to belong to them."""
_BETWEEN_STEPS = tuple(
    WordPattern(between, re.IGNORECASE)
    for between in (
        r"\s*(?:[;>→⇒⟶\n|]|-+>|=>)\s*",
        r"\s*<\s*",
        r"\s*,\s*(?:«choices.then» )?|\s+«choices.then»\s+",
        r"\s+[-–—]\s+",
        r"\s+(?=\d{1,2}[.)] )",
        r"(?<=\))\s*",
    )
)
_CORRECTED = WordPattern(r".+?[,;.…] ?«choices.correcting»[,:;.…]? (?P<rest>.+)", re.IGNORECASE)
"""Steps behind others that are taken back."""
_STEP_NUMBER = WordPattern(r"^(?:\d{1,2}[.)]\s+|(?:«choices.first» )+)", re.IGNORECASE)
_COMPARED = re.compile(r"(?<![-=])[<>](?!>)")
_MARKED = re.compile(r"\(([A-Z])\)")
"""The label of a step in brackets behind its words."""
_STEP_LABEL = re.compile(r"([A-Z])(?: ?[(:] ?|(?<!A) (?=[^\W\d]{2}))([^()]+)\)?")
"""The label of a step before its words; ``A`` may be the article of these."""
_LINE = re.compile(
    r"(?<![^\s,;(])\(?(\d{1,2})(?: ?[.):]+ ?| ?[=-] ?(?=[^\W\d])| (?=[^\W\d]))"
    r"([^\s,;.:()\d]+|\d{1,2}(?![.):]))(?![^\s,;.])"
)
_PLACED = (
    (re.compile(r"(?<!\w)(\d{1,2})[=:-]?([A-Z])(?!\w)"), 1, 2),
    (re.compile(r"(?<!\w)([A-Z]) ?[=:-]? ?(\d{1,2})(?!\w)"), 2, 1),
)
"""Letters with their places, ``1D 2F`` and ``D=1, F=2``."""
_TIED = re.compile(
    r"[^\W\d_] ?= ?[^\W\d_]|[^/]*\w ?/ ?\w ?[\s,;>→-]+\w|^[^/]*\w[\s,;>→-]+\w ?/ ?\w"
)
"""Steps set equal or beside each other among others in order: ``B = D > A``, ``E G A/B F``."""


class AuthoredOrder(AuthoredPooled, kw_only=True, tag="order", frozen=True):
    """Steps in their order."""

    listed = "steps"
    steps: tuple[str, ...]
    before: tuple[tuple[str, str], ...] = ()
    together: tuple[tuple[str, ...], ...] = ()
    distractors: tuple[str, ...] = ()
    extra: int | None = None
    traps: dict[str, tuple[str, ...]] = msgspec.field(default_factory=dict)

    def listed_names(self) -> Sequence[str]:
        """Return the steps, and those that belong nowhere."""
        return (*self.steps, *self.distractors)

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield what is wrong with names, pairs of ``before`` and the number of distractors."""
        yield from super().find_problems()
        yield from find_name_problems("distractors", self.distractors, self.take, 0)
        strangers = {name for pair in self.before for name in pair} - set(self.steps)
        if strangers:
            yield ("before",), "QG116", f"names {sorted(strangers)}, which are not steps"
        if lost := {name for group in self.together for name in group} - {*self.steps}:
            yield ("together",), "QG116", f"names {sorted(lost)}, which are not steps"
        if self.take and self.before:
            wrong = "some of the steps can be taken only of one order, without before"
            yield ("take",), "QG115", wrong
        yield from find_extra_problems(self.extra, len(self.distractors))


class OrderSpec(WordSpec, kw_only=True, frozen=True):
    """Order: ``steps``; ``before`` = [[a, b], ...]; ``distractors`` that must stay out.

    ``together`` are groups of steps between which no other one may stand. Without ``before`` the
    listed order is the only one. Steps are typed by their labels, or by their
    ``words``, which ``said`` has in each further language.
    """

    written_as: ClassVar[AnswerForm] = "option"

    steps: list[str]
    before: list[tuple[str, str]] | None = None
    together: list[list[str]] = msgspec.field(default_factory=list)
    distractors: list[str] = msgspec.field(default_factory=list)
    words: dict[str, str] = msgspec.field(default_factory=dict)
    said: list[dict[str, str]] = msgspec.field(default_factory=list)
    traps: dict[str, list[str]] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """Check that ``before`` names steps and contains no circle.

        Raises
        ------
        ValueError
            If not, or if there are no steps, too many, or one twice.
        """
        if not 1 <= len(self.steps) <= MOST_STEPS:
            raise ValueError(f"steps must be 1 to {MOST_STEPS}")
        if len({*self.steps}) < len(self.steps):
            raise ValueError("a step stands twice")
        for pair in self.before or ():
            if not {*pair} <= {*self.steps}:
                raise ValueError(f"before: {pair[0]!r}, {pair[1]!r} are not both steps")
        if any(step in later for step, later in later_steps(self).items()):
            raise ValueError("before contains a circle")

    def pairs(self) -> list[tuple[str, str]]:
        """Return which step directly precedes which."""
        if self.before:
            return self.before
        return list(zip(self.steps, self.steps[1:], strict=False))

    def judge(self, typed: str, _options: GradingOptions, /) -> Verdict:
        """Return the verdict on typed labels; its note names the first line that is wrong.

        Credit counts the steps in order but for the first, less those that do not belong.

        Raises
        ------
        FormulaReadError
            If a label does not exist or stands twice.
        """
        if len(typed) > 1000:
            raise FormulaReadError("too-long", 1001, "1000")
        try:
            chosen = _read_labels(self, typed)
        except FormulaReadError as error:
            chosen = _read_otherwise(self, typed, twice=error.code == "used-twice")
            if not chosen:
                raise
        read_as = " ".join(safe_echo(label) for label in chosen)
        later = later_steps(self)
        if _COMPARED.search(typed) and not first_misplaced(self, chosen[::-1], later):
            whole = len(chosen) == len(self.steps)
            if whole and first_misplaced(
                self, chosen, later
            ):  # C < A is A > C: which way is meant?
                raise FormulaReadError("two-readings", 1, safe_echo(typed))
        steps = [label for label in chosen if label in later]
        intruders = [label for label in chosen if label not in later]
        line = first_misplaced(self, chosen, later)
        if line == 0 and len(steps) == len(self.steps):
            torn = _find_torn_line(self, chosen)
            if not torn:
                return correct(read_as)
            note = _find_misconception_note(self, chosen) or "order-torn"
            return verdict_by_share(HALF, read_as, note, line=torn)
        kept = len(steps) - count_misplaced(steps, later)
        total = max(len(self.steps) - 1, 1)
        credit = max(Fraction(kept - 1 - len(intruders), total), Fraction(0))
        note = "order-distractor" if intruders else "order-missing" if line == 0 else "order-line"
        if line == 0:
            line = len(chosen) + 1
        elif note == "order-distractor":
            line = chosen.index(intruders[0]) + 1
        because = tuple(chosen[line - 1 : line])
        known = _find_misconception_note(self, chosen) or note
        return verdict_by_share(
            min(credit, Fraction(9, 10)), read_as, known, line=line, because=because
        )

    def tells(self, _label: str, reason: str, /) -> bool:
        """Return whether a reason has the words of a step: it says where that belongs."""
        return any(
            holds_wording(reason, words)
            for said in (self.words, *self.said)
            for words in said.values()
        )

    def show(self) -> str:
        """Return one right order."""
        later = later_steps(self)
        rest, shown = list(self.steps), list[str]()
        while rest:
            step = next(s for s in rest if not any(s in later[other] for other in rest))
            rest.remove(step)
            shown.append(step)
        return " ".join(shown)


def _find_torn_line(spec: OrderSpec, chosen: list[str]) -> int:
    """Return the first line (from 1) that stands inside a group that it is not of; 0 if none."""
    for group in spec.together:
        places = [chosen.index(label) for label in group]
        inside = range(min(places), max(places))
        torn = next((i for i in inside if chosen[i] not in group), None)
        if torn is not None:
            return torn + 1
    return 0


def _find_misconception_note(spec: OrderSpec, chosen: list[str]) -> str:
    """Return the note of the known wrong order that this is; empty if it is none."""
    return next((f"trap:{name}" for name, order in spec.traps.items() if order == chosen), "")


def later_steps(spec: OrderSpec) -> dict[str, set[str]]:
    """Return every step that must come later than a step (closed under chains)."""
    later: dict[str, set[str]] = {step: set() for step in spec.steps}
    for first, second in spec.pairs():
        later[first].add(second)
    for middle in spec.steps:
        for step in spec.steps:
            if middle in later[step]:
                later[step] |= later[middle]
    return later


def first_misplaced(spec: OrderSpec, chosen: list[str], later: dict[str, set[str]]) -> int:
    """Return the first line (from 1) that stands too early or does not belong; 0 if none."""
    seen: set[str] = set()
    for position, label in enumerate(chosen, 1):
        needed = {step for step in spec.steps if label in later[step]}
        if label not in later or not needed <= seen:
            return position
        seen.add(label)
    return 0


def count_misplaced(steps: list[str], later: dict[str, set[str]]) -> int:
    """Return how many steps must be taken out so that the rest is in order.

    Pairs in the wrong order form a partial order, so the largest set without such a pair is found
    by matching (Dilworth).
    """
    matched: dict[int, int] = {}
    wrong = {
        i: [j for j in range(i + 1, len(steps)) if steps[i] in later[steps[j]]]
        for i in range(len(steps))
    }

    def place(i: int, tried: set[int]) -> bool:
        """Return whether a step can be matched, moving other matches along if need be."""
        for j in wrong[i]:
            if j not in tried:
                tried.add(j)
                if j not in matched or place(matched[j], tried):
                    matched[j] = i
                    return True
        return False

    return sum(place(i, set()) for i in range(len(steps)))


def _read_labels(spec: OrderSpec, typed: str) -> list[str]:
    """Return the typed labels of steps, in order.

    Raises
    ------
    FormulaReadError
        If a label does not exist or stands twice.
    """
    text = re.sub(r"[\r\n]+", " ", typed.strip())
    source = normalise_typed(text, keep_x=True, longest=1000)
    known = {fold_word(label): label for label in (*spec.steps, *spec.distractors)}
    if _TIED.search(source.text.strip()):
        raise FormulaReadError("label-expected", 1, safe_echo(typed), list(known.values()))
    words = _parse_numbered_lines(source.text) or _split_words(source.text, known)
    if words and not any(fold_word(word) in known for word in words) and _are_runs(words):
        words = list("".join(words))  # EHDB CFGA
    found = [_find_label(word, known) for word in words]
    for label in found:
        if found.count(label) > 1:
            raise FormulaReadError("used-twice", 1, label)
    return found


def _are_runs(words: list[str]) -> bool:
    """Return whether labels are run together: in one word, or in several of capitals."""
    return len(words) == 1 or all(word.isalpha() and word.isupper() for word in words)


def _read_otherwise(spec: OrderSpec, typed: str, *, twice: bool) -> list[str]:
    """Return the labels of steps behind others that are taken back, ``A B C, no: B A C``.

    Else those of steps typed by their words, unless a label stands ``twice``.
    """
    corrected = _CORRECTED.fullmatch(typed.strip())
    try:
        if corrected:
            return _read_labels(spec, corrected["rest"])
    except FormulaReadError:
        return []
    return [] if twice else _read_worded_steps(spec, typed)


def _read_worded_steps(spec: OrderSpec, typed: str) -> list[str]:
    """Return the labels of steps typed by their words, ``radio < red``; none if one is unclear.

    What is said to be left out is, if nothing of it stands among the rest.
    """
    text = apply_rewrite("digits", typed.strip())
    labels = [*spec.steps, *spec.distractors]
    marked = _MARKED.findall(text)
    pieces = [piece for piece in _BETWEEN_STEPS[2].split(_MARKED.sub("", text)) if piece.strip()]
    if len(marked) > 1 and len({*marked}) == len(marked) == len(pieces) and {*marked} <= {*labels}:
        return [] if is_denied(text) else marked
    kept = _LEFT_OUT_FIRST.fullmatch(text) or _LEFT_OUT.fullmatch(text)
    if kept is not None:
        return _read_kept_steps(spec, kept)
    if is_denied(text) or _TIED.search(text):
        return []
    wordings = [[said.get(label, "") for label in labels] for said in (spec.words, *spec.said)]
    for between in _BETWEEN_STEPS:
        pieces = [_STEP_NUMBER.sub("", piece.strip()) for piece in between.split(text)]
        pieces = [piece for piece in pieces if piece]
        if not 1 < len(pieces) <= len(labels):
            continue
        places = [_find_worded_step(piece, labels, wordings) for piece in pieces]
        if all(places) and len({*places}) == len(places):
            return [labels[place - 1] for place in places]
    return []


def _read_kept_steps(spec: OrderSpec, kept: re.Match[str]) -> list[str]:
    """Return the steps beside others that are left out; none if one of them is left out, too."""
    if not all(map(_is_letter, spec.steps)):
        return []
    groups = kept.groupdict()
    try:
        chosen = _read_labels(spec, groups["kept"] or groups["behind"])
    except FormulaReadError:
        return []
    out = next(one for name, one in groups.items() if one and name not in {"kept", "behind"})
    label = re.compile(rf"\b[{''.join(spec.steps)}]\b")
    return [] if out in chosen or label.search(out) else chosen


def _is_letter(label: str) -> bool:
    """Return whether a label is a single letter."""
    return len(label) == 1 and label.isalpha()


def _find_worded_step(piece: str, labels: list[str], wordings: list[list[str]]) -> int:
    """Return the place (from 1) of a step by its words, or by its label before them; 0 if none."""
    words = find_wording_in(piece, wordings, all_named=True)
    named = _STEP_LABEL.fullmatch(piece)
    if named is None or named[1] not in labels:
        return words
    meant = find_wording_in(named[2], wordings, all_named=True)
    return labels.index(named[1]) + 1 if meant in {0, labels.index(named[1]) + 1} else 0


def _parse_numbered_lines(text: str) -> list[str]:
    """Return the labels behind numbers of lines, ``1. B 2. D``, in the order of the numbers.

    None are returned unless the lines are numbered from 1 without a gap.
    """
    for shape, first, second in _PLACED:
        found = {one[first]: one[second] for one in shape.finditer(text)}
        if not shape.sub("", text).strip(" ,;.") and {*map(int, found)} == {
            *range(1, len(found) + 1)
        }:
            return [found[place] for place in sorted(found, key=int)] if len(found) > 1 else []
    pairs = dict(_LINE.findall(text))
    whole = not _LINE.sub("", text).strip(" ,;.")
    if not whole or len(pairs) < 2 or {*map(int, pairs)} != {*range(1, len(pairs) + 1)}:
        return []
    return [pairs[number] for number in sorted(pairs, key=int)]


def _split_words(text: str, known: dict[str, str]) -> list[str]:
    """Return the pieces between blanks, separators and arrows.

    ``B-D`` alone could be a range and is not cut.
    """
    words = [w for w in re.split(r"[\s,;.<>|=()\[\]{}।॥→⇒⟶/:+_]+|-+>", text) if w.strip("-")]
    idle = set_of_words("choices.step-fillers")
    words = [w for w in words if w.casefold() not in idle or fold_word(w) in known]
    cut = [w for word in words for w in word.split("-") if w]
    return cut if len(cut) > 2 and any(fold_word(w) not in known for w in words) else words


def _find_label(word: str, known: dict[str, str]) -> str:
    """Return the label that a word stands for.

    Raises
    ------
    FormulaReadError
        If it stands for none.
    """
    label = known.get(fold_word(word)) or known.get(fold_word(word.translate(BANGLA_LETTERS)))
    if label is None:
        raise FormulaReadError("label-expected", 1, safe_echo(word), list(known.values()))
    return label


def ask(part: PartContext) -> AskedPart[OrderSpec]:
    """Return the steps, and those that do not belong to them, in a drawn order.

    Raises
    ------
    BankError
        If a known wrong order names a step twice, or one that does not exist.
    """
    steps, extra = part.selection()
    options = assign_letters(part.shuffle_names([*steps, *extra]))
    marks = {name: mark for mark, name in options}
    _check_traps(part)
    traps = _list_wrong_orders(part.answer.get("traps", {}), steps, marks)
    told, *said = (
        dict(zip(marks.values(), texts, strict=True)) for texts in part.option_texts(marks)
    )
    spec = make_spec(
        OrderSpec,
        part,
        traps=traps,
        notes=part.misconception_notes(traps) if traps else {},
        why=part.reasons(options),
        steps=[marks[name] for name in steps],
        before=[(marks[first], marks[second]) for first, second in part.answer.get("before", ())],
        together=[[marks[name] for name in group] for group in part.answer.get("together", ())],
        distractors=[marks[name] for name in extra],
        words=told,
        **({"said": said} if said else {}),
    )
    return AskedPart(
        spec,
        InputControl("order"),
        options=options,
        reasons=part.with_reason(options),
        mistakes={
            trap: msgspec.structs.replace(
                spec, steps=wrong, before=None, together=[], distractors=[], traps={}, notes={}
            )
            for trap, wrong in traps.items()
        },
    )


def _check_traps(part: PartContext) -> None:
    """Refuse a wrong order of other steps, or of one step twice.

    Raises
    ------
    BankError
        That names it.
    """
    known = {*part.answer["steps"], *part.answer.get("distractors", ())}
    for trap, order in part.answer.get("traps", {}).items():
        for step in order:
            if step not in known or order.count(step) > 1:
                wrong = "twice" if step in known else "unknown"
                raise part.error(f"answer: traps.{trap}: step {step!r} is {wrong}")


def _list_wrong_orders(
    traps: Mapping[str, Sequence[str]], steps: Sequence[str], marks: Mapping[str, str]
) -> dict[str, list[str]]:
    """Return the known wrong orders of what is shown, without the right one and repetitions."""
    found: dict[str, list[str]] = {}
    for name, wrong in traps.items():
        order = [marks[step] for step in wrong if step in marks]
        if order != [marks[step] for step in steps] and order not in found.values():
            found[name] = order
    return found


def input_hints(spec: OrderSpec, lang: str) -> tuple[str, ...]:
    """Return the sentence on whether all steps belong to the order."""
    return (translate(lang, "ask.order" if spec.distractors else "ask.order_all"),)


KIND = AnswerKind(
    AuthoredOrder,
    OrderSpec,
    ask,
    input_hints,
    paper_hints=input_hints,
    verb="tick",
    work=count_listed("tick", "steps", 2),
)

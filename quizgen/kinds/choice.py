"""Kinds ``choice``, ``multi`` and ``tf``: letters, numbers or the option's own words."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import partial
from typing import Any, ClassVar

import msgspec

from quizgen.core.errors import FormulaError
from quizgen.grading.echo import safe_echo
from quizgen.grading.judging.likeness import list_ordinals, read_count
from quizgen.grading.judging.option_formulas import find_same_formula
from quizgen.grading.judging.spelling import fold_word
from quizgen.grading.judging.wordings import (
    find_wording_in,
    holds_wording,
    says_whole,
    share_words,
)
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import (
    AnswerForm,
    casts_doubt,
    is_denied,
    says_otherwise,
)
from quizgen.grading.reading.normalise import (
    BANGLA_DIGITS,
    BANGLA_LETTERS,
    PICTURES,
    normalise_typed,
)
from quizgen.grading.reading.units import read_unit
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import HALF, Verdict, correct, wrong
from quizgen.grading.verdict import partial as partly
from quizgen.kinds.asking import LETTERS, assign_letters, hint, make_spec
from quizgen.kinds.contract import (
    MOST_OPTIONS,
    VALUE_OPTION,
    AnswerKind,
    AskedPart,
    AuthoredPooled,
    Condition,
    FieldProblem,
    InputControl,
    PartContext,
)
from quizgen.kinds.work import Work
from quizgen.locale import cache_words, fallback_language, translate
from quizgen.locale.word_patterns import WordPattern, set_of_words
from quizgen.maths.notation import FormulaReadError

_FEWEST_VALUES = 2
"""Values that there are to choose from, at least."""
_USUAL_VALUES = 5
"""Options between values where nobody says how many: the key, and what mistakes give."""
_SHORTEST = 4
"""Letters that a part of an option's words must have to be recognised."""

_AROUND = " .!()[]{}\"'*_।॥“”‘’«»"
_QUOTED = " \"'*_“”«»"
_LABELLED = re.compile(
    r"[\[(]?(?P<mark>[A-Za-zক-ঞ]|\d{1,2})(?:[\])]? ?[).:=,-]+ ?|[\])] ?| (?!\())(?P<words>\S.+)"
)
_BEHIND = re.compile(r"(?P<words>.{2,}?) ?[\[(](?P<mark>[A-Za-zক-ঞ])[\])]")
_NOUN_AHEAD = re.compile(r"^[^\W\d_]{3,} (?=[A-Z] ?: )")
"""What options are, before the letter of one: ``camera A: (1; 1)``."""
_FILLING = WordPattern(r"^«choices.option» ", re.IGNORECASE)
_IT_IS = WordPattern(r"^(?:«choices.it»(?: «choices.is»|'s)?|«choices.is») ", re.IGNORECASE)
_DENIED = WordPattern(
    r"(?:(?:«choices.is» )?«choices.not»|«choices.isnt») (?P<word>.+)"
    r"|(?P<before>.+?) «choices.not-behind»",
    re.IGNORECASE,
)
"""A word that is denied: what is not true is false, and the other way round."""
_TRUTH_FIRST = WordPattern(
    r"(?P<first>[^\s,;:.(।]+)(?!(?<=\d)[.,]\d)"
    r"(?:[,;:.।] ?| (?=\()| ?[-–—] | (?=«choices.reasons» ))(?P<rest>.+)"
    r"|(?P<alone>«choices.alone»)(?! «choices.no-reason» ) (?P<more>\S+ \S.*)"
)
"""*Yes* or *false* with a reason behind it; ``0.5`` is neither."""
_TRUTH_CORRECTED = WordPattern(
    r"(?P<head>[^\s,;:.(…]+)"
    r"(?:[,;:.… ]+(?:«choices.correcting»)[,;:.… ]+"
    r"|[,;:.…]+ ?(?!\d)«choices.false»[,;:.…] ?)"
    r"(?P<rest>.+)"
)
"""A verdict taken back for another one: ``false... no, true``."""
_OPEN = re.compile(r"\.\.|…|\?")
"""Signs that something is left open."""
_DENIED_FIRST = re.compile(r"(?P<head>[^,;:.()]+)(?:[,;:.] | \(| [-–—] )(?P<rest>.+)")
"""*Not true* with a reason behind it."""
_SHORT_DENIAL = WordPattern(r"«choices.subjects» «choices.helpers»(?P<no>(?: «choices.not»|n't))?")
"""What is said behind *yes* or *no*: ``it does``, ``they are not``. With more it is a reason."""
_CONCLUSION = WordPattern(
    r".+(?:[,;.] ?| )(?:«so»|->|=>|→|⇒) (?P<rest>(?:«choices.it» «choices.is» |it's )?\S+)",
    re.IGNORECASE | re.DOTALL,
)
"""What is concluded at the end: ``it is linear, so true``, ``less motion blur -> B``."""
_WORKED_OUT = re.compile(r"[^,;]*[=<>≠≤≥][^,;]*\d[^,;]*[,;] ?(?P<rest>[^\d,;=<>]+)")
"""A verdict behind what was worked out: ``0.5^2 = 0.25 < 0.3, true``."""
_PIECES = re.compile(r"[;\n]|,(?=\s*[\[(]?[A-Za-zক-ঞ\d][\])]?\s*[).:=-])")
_BANGLA_WORDS = WordPattern(r"(?!(?:«and»|«choices.or») )[^;,&+]*[\u0980-\u09ff]{3,}[^;,&+]*")
"""Words of Bangla behind a letter, and no further letter."""
_BENGALI = re.compile(r"[\u0980-\u09ff]")
_SET_OFF = re.compile(r"^[\[(]?(?:[^\W_]|\d{2}) ?[\]).:=-]+ ?[^\s,;]{2}|[\[(][^\W\d_][\])]$")
"""A letter with a sign before or behind words of more than one letter."""
_UNFINISHED = re.compile(r"[+/&|(\[{][\s*+/&|(\[{]*$")
"""A sign behind which more was to come: no answer yet."""
_ALTERNATIVE = WordPattern(
    r"(?<![\w\u0980-\u09ff])«choices.or»(?![\w\u0980-\u09ff])", re.IGNORECASE
)
"""A word between options of which only one is meant."""
_SET_APART = (
    WordPattern(
        r"(?P<kept>.+?)[,;]? \(?(?:(?:«and»|«choices.but») )?«choices.instead» (?P<denied>.+)",
        re.IGNORECASE | re.DOTALL,
    ),
    WordPattern(
        r"«choices.not» (?P<denied>.+?)[,;]? «choices.but» (?P<kept>.+)",
        re.IGNORECASE | re.DOTALL,
    ),
)
"""One option set against another: ``B, not E``; ``not E but B``."""
_BRACKETED = re.compile(r"(?P<mark>[A-Za-zক-ঞ]) ?\((?P<words>[^()]{2,})\)")
_ALL_BUT = WordPattern(
    r"«choices.all-before»(?: «choices.are»)?(?: «choices.right»)?,? «choices.except»"
    r"(?: «choices.for»)? (?P<out>.+)"
    r"|(?P<before>.+?) «choices.except-behind» «choices.all-behind»",
    re.IGNORECASE,
)
_ARE_TRUE = WordPattern(r" «choices.are» «choices.right»$| «choices.right-behind»$", re.IGNORECASE)
"""What is said behind options that are chosen."""
_WORDED = WordPattern(r"[,;\n]| (?:«and»|&) ")
"""What stands between several options that are named by their words."""
_NOT = WordPattern(r"\b«choices.not» ")
_LETTER_LAST = re.compile(r"(?P<words>[^\W\d_]{3,}|[^:]*[^\W\d_]{3}[^:]*:) (?P<mark>[A-Z])")
_LONG_WORD = 8
"""Letters of a word that can stand for an option by itself."""
_FILLERS = WordPattern(
    r"(?<![\w\u0980-\u09ff])«choices.between»(?![\w\u0980-\u09ff])", re.IGNORECASE
)


class AuthoredChoice(AuthoredPooled, kw_only=True, tag="choice", frozen=True):
    """One of several options: written ones, or the values of the key and of known mistakes."""

    listed = "options"
    options: dict[str, Condition] = msgspec.field(default_factory=dict)
    right: tuple[int, int] | None = None
    in_order: bool = False
    unit: str | None = None

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield a problem unless ``right`` is [least, most], 1 <= least <= most, of ``take``."""
        if self.of and not self.options:
            if self.right or not isinstance(self.of, str):
                yield ("of",), "QG115", "names one quantity, whose values are the options"
            if self.take and not _FEWEST_VALUES <= self.take <= MOST_OPTIONS:
                yield ("take",), "QG115", f"must be {_FEWEST_VALUES} to {MOST_OPTIONS}"
            return
        yield from super().find_problems()
        if self.unit is not None:
            yield ("unit",), "QG115", "is of values: written options hold their unit"
        if self.right and not (self.take and 1 <= self.right[0] <= self.right[1]):
            yield ("right",), "QG115", "is [least, most] right options among those that take names"


class ChoiceSpec(WordSpec, kw_only=True, frozen=True):
    """Choice: ``options``; ``correct`` = positions from 1.

    ``multi`` gives credit for right minus wrong crosses when ``negative``, else all or nothing
    wrong crosses take right ones away down to zero. ``tf`` needs no options; 1 is true, 2 false.
    ``said`` are the options in each further language.
    """

    written_as: ClassVar[AnswerForm] = "option"

    correct: list[int]
    options: list[str] = msgspec.field(default_factory=list)
    said: list[list[str]] = msgspec.field(default_factory=list)
    negative: bool = True
    traps: dict[str, int | list[int]] = msgspec.field(default_factory=dict)

    def choices(self) -> list[str]:
        """Return the wordings to choose from."""
        return self.options or (["true", "false"] if self.kind == "tf" else [])

    def validate(self) -> None:
        """Check that positions exist; ``choice`` and ``tf`` have one right option.

        Raises
        ------
        ValueError
            If not.
        """
        count = len(self.choices())
        if not count or not all(1 <= i <= count for i in self.correct):
            raise ValueError("correct holds positions from 1 within options")
        if any(len(texts) != count for texts in self.said):
            raise ValueError("said needs as many wordings as options")
        if self.kind != "multi" and len(self.correct) != 1:
            raise ValueError("exactly one option can be correct")

    def judge(self, typed: str, _options: GradingOptions, /) -> Verdict:
        """Return the verdict on chosen options, given as letters, numbers or words.

        Raises
        ------
        FormulaReadError
            If no option can be read, or several where one is asked.
        """
        if len(typed) > 1000:
            raise FormulaReadError("too-long", 1001, "1000")
        if self.kind == "tf":
            return _judge_single_option(self, _read_truth_value(self, typed))
        chosen = _read_options(self, typed)
        if self.kind == "multi":
            return _judge_several_options(self, chosen)
        if len(chosen) > 1:
            raise FormulaReadError("one-option", 1, safe_echo(typed))
        return _judge_single_option(self, chosen[0])

    def tells(self, _label: str, reason: str, /) -> bool:
        """Return whether a reason has the words of a right option."""
        return any(
            holds_wording(reason, texts[one - 1])
            for texts in (self.options, *self.said)
            for one in self.correct[: len(texts)]
        )

    def show(self) -> str:
        """Return the letters of the right options, or the word for true or false."""
        return _format_options(self, self.correct)

    def show_in(self, lang: str, /) -> str:
        """Return the key as `show` does, true and false by their words in a language."""
        return (
            translate(fallback_language(lang), f"ask.{self.show()}")
            if self.kind == "tf"
            else self.show()
        )


def _read_options(spec: ChoiceSpec, typed: str) -> list[int]:
    """Return the positions that an answer chooses, by words, by letters or against others.

    Raises
    ------
    FormulaReadError
        If there is none.
    """
    typed = _ARE_TRUE.sub("", typed.rstrip(" ;,✓✔.")).translate(BANGLA_DIGITS)
    explained = _LETTER_AND_BECAUSE.fullmatch(typed) if spec.kind == "choice" else None
    named = {*_LONE_CAPITAL.findall(typed)} & {*_list_letters(spec)}
    if explained and named == {explained["mark"]}:
        typed = explained["mark"]
    listed = _LETTERS_LAST.fullmatch(typed) if spec.kind == "multi" else None
    listed = listed or (_LETTERS_BECAUSE.fullmatch(typed) if spec.kind == "multi" else None)
    if listed and not casts_doubt(listed["words"] or ""):
        typed = listed["letters"]
    _refuse_taken_back(spec, typed)
    clear = _read_clear_options(spec, typed)
    if clear:
        return clear
    read = (
        _find_option_by_truth(spec, typed)
        or _parse_labelled_options(spec, typed)
        or _read_set_apart(spec, typed)
        or _find_option_by_its_end(spec, typed)
    )
    try:
        read = read or _read_positions(spec, typed)
    except FormulaReadError:
        meant = _find_worded_options(spec, typed) or _find_named_option(spec, typed)
        last = typed.rpartition("=")[2].strip() if spec.kind == "choice" else ""
        if not meant and last != typed and any(map(str.isdigit, last)) and " " in last:
            meant = _find_worded_options(spec, last)
        unclear = meant or _ALTERNATIVE.search(typed) or is_denied(typed)
        same = 0 if unclear else find_same_formula(typed, spec.choices())
        if not (meant or same):
            raise
        return meant or [same]
    return (spec.kind == "choice" and len(read) > 1 and _find_worded_options(spec, typed)) or read


def _refuse_taken_back(spec: ChoiceSpec, typed: str) -> None:
    """Refuse a letter that is taken back or contradicted, and two values with *or* between them.

    Raises
    ------
    FormulaReadError
        ``two-readings`` for ``no A``, ``A, not sure`` and ``A because B is right``.
    """
    plain = [option.replace("\xa0", " ") for option in spec.choices()]
    offered = all(map(_VALUE.fullmatch, plain)) and _ALTERNATIVE.search(typed)
    unclear = offered or _is_letter_denied(spec, typed) or _names_other_in_reason(spec, typed)
    if spec.kind == "choice" and unclear:
        raise FormulaReadError("two-readings", 1, safe_echo(typed))


def _is_letter_denied(spec: ChoiceSpec, typed: str) -> bool:
    """Return whether all words beside a single letter deny it or leave it open, ``A, not sure``."""
    alone = _LONE_CAPITAL.findall(typed)
    rest = _LONE_CAPITAL.sub(" ", typed).strip(_AROUND + ",;:?")
    known = {word.casefold() for texts in (spec.choices(), *spec.said) for word in texts}
    is_letter = len(alone) == 1 and alone[0] in _list_letters(spec)
    return is_letter and bool(rest) and rest.casefold() not in known and _takes_back(rest)


def _names_other_in_reason(spec: ChoiceSpec, typed: str) -> bool:
    """Return whether the reason for a letter names another one, and not as wrong."""
    because = _LETTER_AND_BECAUSE.fullmatch(typed)
    if because is None or _OTHERS_ARE_WRONG.fullmatch(because["why"].strip()):
        return False
    named = {*_LONE_CAPITAL.findall(because["why"])} & {*_list_letters(spec)}
    return bool(named - {because["mark"]})


_LONE_CAPITAL = re.compile(r"(?<![^\W_])[A-Z](?![^\W_])")
_LETTER_AND_BECAUSE = WordPattern(
    r"(?P<mark>[A-Z])[,.:;)]? (?:«choices.because»)(?!\w)(?P<why>.*)", re.DOTALL
)
"""A letter with its reason."""


def _read_clear_options(spec: ChoiceSpec, typed: str) -> list[int]:
    """Return the options of an answer that is one, lists some in full, or says which are not.

    Raises
    ------
    FormulaReadError
        If it contradicts itself, or leaves out what is no option.
    """
    whole, said = _find_option_by_text(spec, typed), [*map(str.casefold, spec.choices())]
    truth = read_truth(typed) if {*said} == {"yes", "no"} else 0
    spoken = [_find_truth_word(one) for one in re.findall(r"[^\W\d_]{2,}", typed)]
    if {*said} == {"yes", "no"} and not (truth or whole) and any(spoken):
        raise FormulaReadError("two-readings", 1, safe_echo(typed))
    if truth or (whole and {*said} == {"yes", "no"}):
        place = whole or said.index(("yes", "no")[truth - 1]) + 1
        return _check_letter(spec, typed, place)
    if whole:
        return [whole]
    if spec.kind == "multi":
        return _read_beside_denied(spec, typed) or _read_listed(spec, typed)
    return _read_last_word(spec, typed)


def _read_beside_denied(spec: ChoiceSpec, typed: str) -> list[int]:
    """Return the options by letters beside others that are said not to be: ``A, B right, C not``.

    A remark in brackets behind them says nothing against them.
    """
    match = _BESIDE_DENIED.fullmatch(typed.strip(_AROUND)) or _LETTERS_REMARKED.fullmatch(typed)
    match = match or _LETTERS_AND_OUT.fullmatch(typed)
    remark = match.groupdict().get("remark") or "" if match else ""
    if match is None or says_otherwise(remark) or casts_doubt(remark):
        return []
    try:
        kept = _read_positions(spec, match["kept"])
        out = match.groupdict().get("out")
        denied = _read_positions(spec, out) if out else []
    except FormulaReadError:
        return []
    return [] if {*kept} & {*denied} else kept


_LETTERS = r"[^\W\d_](?:(?:[, ]+|,? «and» )[^\W\d_])*"
_BESIDE_DENIED = WordPattern(
    rf"(?P<kept>{_LETTERS})(?: «choices.right-behind»| «choices.are» «choices.right»)?"
    rf"(?:,|;| «choices.but») (?P<out>{_LETTERS}) (?:«choices.are» )?«choices.no-option»",
    re.IGNORECASE,
)
_LETTERS_LAST = re.compile(
    r"(?P<words>[^:]*(?:[^\W\d_]|[\u0980-\u09ff]){3}[^:]*): ?(?P<letters>[A-Z](?:[ ,;]+[A-Z])*)"
)
"""Letters behind words that say why."""
_LETTERS_BECAUSE = WordPattern(
    r"(?P<letters>[A-Za-z](?:(?:[, ]+|,? «and» )[A-Za-z])*),? «choices.because»(?!\w)(?P<words>.*)"
)
"""Letters before the reason for them."""
_LETTERS_REMARKED = WordPattern(
    r"(?P<kept>[A-Z](?:(?:[, ]+|,? «and» )[A-Z])*) \((?P<remark>[^()]{3,})\)"
)
_LETTERS_AND_OUT = WordPattern(
    r"(?P<kept>[A-Z](?:(?:[, ]+|,? (?:«and»|«and-in-latin») )[A-Z])*)"
    r"(?: «choices.right-behind»| «choices.are» «choices.right»)?"
    r"(?: [-–—]|[,;]) (?:«choices.only» )?"
    r"(?P<out>[A-Z](?:(?:[, ]+|,? (?:«and»|«and-in-latin») )[A-Z])*)"
    r" (?:(?:«choices.are» )?(?:«choices.wrong»|«choices.no-option»))(?![^\W\d_])(?P<why>.*)"
)
"""All letters, those that are chosen and those that are not: ``A, C – only B is wrong``."""


def _read_listed(spec: ChoiceSpec, typed: str) -> list[int]:
    """Return the options of an answer that lists them in full, or says all, or all but some.

    Raises
    ------
    FormulaReadError
        If those left out are no options.
    """
    every = list(range(1, len(spec.choices()) + 1))
    if typed.casefold().strip(_AROUND) in set_of_words("choices.all"):
        return every
    told = [_find_option_by_text(spec, piece) for piece in _WORDED.split(typed)]
    if len(told) > 1 and all(told):
        return list(dict.fromkeys(told))
    but = _ALL_BUT.fullmatch(re.sub(r" \([^()]*\)$", "", typed).strip(_AROUND))
    left_out = every
    if but:
        out = but["out"] or but["before"]
        named = find_wording_in(out, [spec.choices(), *spec.said], all_named=True)
        left_out = _find_worded_options(spec, out) or ([named] if named else [])
        left_out = left_out or _read_positions(spec, out)
    return [one for one in every if one not in left_out]


def _find_option_by_truth(spec: ChoiceSpec, typed: str) -> list[int]:
    """Return the place of the only option that begins with *Yes* or *No*, as the answer does.

    None if several do, if the answer says neither, or if the words behind it mean another option.
    """
    leading = [read_truth(re.split(r"[,;:. ]", option, maxsplit=1)[0]) for option in spec.choices()]
    if {*leading} - {0} != {1, 2}:
        return []
    first, _, rest = typed.strip(_AROUND).partition(" ")
    truth = read_truth(typed) or _find_truth_word(first.strip(",;:."))
    if not truth or leading.count(truth) != 1 or _ALTERNATIVE.search(typed):
        return []
    place = leading.index(truth) + 1
    denied = _is_turned(spec, place, rest) if read_truth(typed) else says_otherwise(rest)
    meant = _find_wording(spec, typed) in {0, place} and not denied
    return _check_letter(spec, typed, place) if meant else []


def _check_letter(spec: ChoiceSpec, typed: str, place: int) -> list[int]:
    """Return the option of *yes* or *no*, unless the letter of another one stands beside it.

    Raises
    ------
    FormulaReadError
        For ``A yes`` where A is *no*.
    """
    listed = _list_letters(spec)
    named = {one for one in re.findall(r"(?<![^\W_])[A-Z](?![^\W_])", typed) if one in listed}
    if named and LETTERS[place - 1] not in named:
        raise FormulaReadError("two-readings", 1, safe_echo(typed))
    return [place]


def _is_turned(spec: ChoiceSpec, place: int, rest: str) -> bool:
    """Return whether all that an option says behind *Yes* or *No* is said with a denial."""
    own = [texts[place - 1].partition(" ")[2] for texts in (spec.choices(), *spec.said)]
    return is_denied(rest) and not any(map(is_denied, own)) and says_whole(rest, own)


def _find_named_option(spec: ChoiceSpec, typed: str) -> list[int]:
    """Return the option whose letter ends the answer: ``camera D``, ``each one is smaller: D``.

    Also that of ``the fourth``. None is meant where words deny it or another letter stands there.
    """
    reasoned = _find_reasoned_letter(spec, typed)
    if reasoned:
        return reasoned
    text = typed.strip(_AROUND)
    head, _, remark = text.partition(",")
    places = _find_places(spec, head.strip())
    told = _find_wording(spec, remark or text) if places else 0
    counted = any(map(list_ordinals().get, re.findall(r"\w+", remark.casefold())))
    taken_back = says_otherwise(text) or casts_doubt(text) or counted
    if places and told in {0, *places} and not taken_back:
        return places
    if len(text) == 1 and (initial := _find_initial(spec, text)):
        return initial
    named = _LETTER_LAST.fullmatch(text)
    if named is None or says_otherwise(named["words"]) or _find_wording(spec, named["words"]):
        return []
    position = LETTERS.find(named["mark"]) + 1
    return [position] if position <= len(spec.choices()) else []


def _find_places(spec: ChoiceSpec, text: str) -> list[int]:
    """Return the options that are meant by ``the second``: the one that says so, or at this place.

    Values have no place: the second one may be the second number of the question.
    """
    ordinals = [{*map(list_ordinals().get, re.findall(r"\w+", one.casefold()))} - {None}
                for one in spec.choices()]  # fmt: skip
    if any(ordinals):
        said = {*map(list_ordinals().get, re.findall(r"\w+", text.casefold()))} - {None}
        named = [place for place, one in enumerate(ordinals, 1) if said and one == said]
        return named if len(named) == 1 and len(text.split()) <= _FEW_WORDS else []
    if all(_VALUE.fullmatch(option.replace("\xa0", " ")) for option in spec.choices()):
        return []
    return _read_places(text, len(spec.choices()))


_FEW_WORDS = 4
"""Words of an answer that names an option by its ordinal."""


def _find_initial(spec: ChoiceSpec, letter: str) -> list[int]:
    """Return the only option of one word that begins with a letter that is no label: Y, yellow."""
    begun = [
        place
        for place, option in enumerate(spec.choices(), 1)
        if option.isalpha() and option[:1].casefold() == letter.casefold()
    ]
    return begun if len(begun) == 1 and letter.upper() not in _list_letters(spec) else []


def _find_reasoned_letter(spec: ChoiceSpec, typed: str) -> list[int]:
    """Return the option of a letter with its reason: ``B, more light``, ``more light, so B``.

    None is meant where the reason names another option, by its letter or by words only it has, and
    where it takes the letter back (``B, not sure``).
    """
    text = typed.strip()
    ahead = _LETTER_AHEAD.fullmatch(text)
    behind = None if ahead else _CONCLUSION.fullmatch(text) or _LETTER_BEHIND.fullmatch(text)
    if ahead:
        mark, reason = ahead["mark"].upper(), ahead["reason"]
    elif behind:
        mark, reason = behind["rest"].strip(_AROUND), text[: behind.start("rest")]
    else:
        return []
    position = LETTERS.find(mark) + 1 if len(mark) == 1 else 0
    if not 1 <= position <= len(spec.choices()):
        return []
    listed = _list_letters(spec)
    shape = (
        r"(?<!\w)[A-Z](?!\w)"
        if ahead is None or ahead["mark"].isupper()
        else r"(?<!\w)[A-Zb-z](?!\w)"
    )
    named = {one for one in map(str.upper, re.findall(shape, reason)) if one in listed}
    if named - {mark} and not (_OTHERS_ARE_WRONG.fullmatch(reason.strip()) and mark not in named):
        return []
    return [position] if _find_wording(spec, reason) in {0, position} else []


def _read_places(text: str, count: int) -> list[int]:
    """Return the places of ``the fourth``, ``the last one``, ``the first two``; none of others."""
    idle = set_of_words("articles") | set_of_words("choices.place-nouns")
    words = [word for word in text.casefold().split() if word not in idle]
    noun = words[1] if len(words) == len(("second", "camera")) else ""
    if len(noun) > 1 and noun.isalpha() and read_count(noun) < 0:
        words = [one for one in words[:1] if list_ordinals().get(one)] or words
    counted = [list_ordinals().get(word, 0) for word in words]
    if len(words) == 1 and words[0] in set_of_words("choices.last"):
        return [count]
    if len(words) == 1 and counted[0]:
        return [place for place in counted if place <= count]
    many = read_count(words[1]) if len(words) == len(("first", "two")) else 0
    if not 1 < many <= count:
        return []
    if words[0] in set_of_words("choices.last"):
        return list(range(count - many + 1, count + 1))
    return list(range(1, many + 1)) if counted[0] == 1 else []


_LETTER_AHEAD = WordPattern(
    r"[\[(]?(?P<mark>[A-Z]|[a-z](?=[\]),:;]| \())[\])]?(?: ?[,:;.–-] ?| (?=\())"
    r"\(?(?!«choices.doubts»(?!\w))(?P<reason>[^\s(][^()]{6,}?)\)?",
    re.DOTALL,
)
"""A letter and words behind it that give the reason."""
_LETTER_BEHIND = re.compile(r".*[^\W\d_]{3}.*, (?P<rest>[A-Z])", re.DOTALL)
_OTHERS_ARE_WRONG = WordPattern(
    r"(?:(?:[A-Z]|«and»|,|;)\s*)+ ?«choices.are» «choices.wrong»", re.IGNORECASE
)


def _find_worded_options(spec: ChoiceSpec, typed: str) -> list[int]:
    """Return the options that are meant by some of their words; none if one of them is none."""
    if _UNFINISHED.search(typed):
        return []
    if _ALTERNATIVE.search(typed):
        return _find_alternative(spec, typed)
    quoted = _find_quoted_options(spec, typed) if spec.kind == "multi" else []
    if quoted:
        return quoted
    quotes = _IN_QUOTES.findall(typed)
    pieces = (quotes or _WORDED.split(typed)) if spec.kind == "multi" else [typed]
    found = [_find_wording(spec, piece) for piece in pieces if piece.strip()]
    return list(dict.fromkeys(found)) if all(found) else []


def _find_alternative(spec: ChoiceSpec, typed: str) -> list[int]:
    """Return the option that offers two things itself, ``one or two``; none of any other."""
    place = _find_wording(spec, typed)
    texts = [said[place - 1] for said in (spec.choices(), *spec.said)] if place else []
    return [place] if any(map(_ALTERNATIVE.search, texts)) else []


def _find_wording(spec: ChoiceSpec, words: str) -> int:
    """Return the place (from 1) of the option meant by some of its words, in any language.

    A remark in brackets behind them may say why, and must not mean another one.
    """
    languages = [spec.choices(), *spec.said]
    remarked = _REMARKED.fullmatch(words.strip(_AROUND_REMARK))
    found = find_wording_in(words, languages)
    if found or remarked is None or says_otherwise(remarked["remark"]):
        return found
    found = find_wording_in(remarked["words"], languages)
    told = find_wording_in(remarked["remark"], languages)
    return found or told if told in {0, found} or not found else 0


_IN_QUOTES = re.compile(r'["“„]([^"“”„]+)["”“]')
_REMARKED = re.compile(r"(?P<words>[^()]{3,}?) ?\((?P<remark>[^()]+)\)")
_AROUND_REMARK = " .!।"


def _find_quoted_options(spec: ChoiceSpec, typed: str) -> list[int]:
    """Return the options of which an answer consists, word by word; none if more stands in it."""
    rest, found = _fold_signs(typed), []
    listed = [(place, _fold_signs(option)) for place, option in enumerate(spec.choices(), 1)]
    for place, option in sorted(listed, key=lambda row: -len(row[1])):
        if option in rest:
            rest = rest.replace(option, "\n", 1)
            found.append(place)
    return sorted(found) if not _WORDED.sub("", re.sub("\n[,;]?\n", "", rest)).strip() else []


def _fold_signs(text: str) -> str:
    """Return a text with one sign for each relation and separator, and without subscripts."""
    plain = unicodedata.normalize("NFKC", text.replace("−", "-")).replace("_", "")
    plain = plain.replace(">=", "≥").replace("<=", "≤").replace("==", "=")
    return re.sub(r" ?([=<>≤≥,;]) ?", r"\1", plain).replace(",", ";")


def _read_set_apart(spec: ChoiceSpec, typed: str) -> list[int]:
    """Return the options kept in ``B, not E``; none unless all others named are denied.

    What is kept and what is denied must each be read as options, and be different ones.
    """
    for shape in _SET_APART:
        match = shape.fullmatch(typed.strip(_AROUND))
        if match is None:
            continue
        try:
            kept = _read_part(spec, match["kept"])
            denied = _read_part(spec, _NOT.sub("", match["denied"]))
        except FormulaReadError:
            continue
        if kept and denied and not {*kept} & {*denied}:
            return kept
    return []


def _read_part(spec: ChoiceSpec, text: str) -> list[int]:
    """Return the options of what is set apart: one clause of a choice, letters or words of several.

    Raises
    ------
    FormulaReadError
        If there is none.
    """
    if spec.kind == "multi":
        return _read_options(spec, text)
    place = _read_plainly(spec, text)
    return [place] if place else []


def _read_last_word(spec: ChoiceSpec, typed: str) -> list[int]:
    """Return the option that is left when others are denied, corrected or only thought of.

    ``not A, but C``, ``A no sorry C``, ``red is high but the sky is weak, so A blue``.

    Raises
    ------
    FormulaReadError
        If what is concluded is another option than what stands before it.
    """
    text = typed.strip(_AROUND)
    kept = _read_kept_clause(spec, text)
    if kept:
        return [kept]
    for shape in (_CORRECTED, _SECOND_THOUGHT):
        match = shape.fullmatch(text)
        last = _read_plainly(spec, match["rest"]) if match else 0
        head = match["head"] if match else ""
        first = _read_plainly(spec, head) or _read_plainly(spec, head.rpartition(" ")[2])
        if last and (shape is _SECOND_THOUGHT or first):
            return [last]
    match = _CONCLUDED.fullmatch(text)
    last = _read_plainly(spec, match["rest"]) if match else 0
    first = _read_plainly(spec, match["head"]) if match and last else 0
    if first in {0, last} or (
        match and _LETTERED_END.match(match["rest"]) and len(text) > _LONG_WORD
    ):
        return [last] if last else []
    raise FormulaReadError("two-readings", 1, safe_echo(typed))


def _read_plainly(spec: ChoiceSpec, text: str) -> int:
    """Return the option that a clause is, by its letter, its words or both; 0 if it is none."""
    bare = _FINAL.sub("", text.strip(_AROUND + ",;:… "))
    if len(bare) == 1:
        mark = bare.translate(BANGLA_LETTERS).upper()
        return LETTERS.find(mark) + 1 if mark in _list_letters(spec) else 0
    further = _CONCLUDED.fullmatch(bare)
    if further:
        return _read_plainly(spec, further["rest"])
    try:
        labelled = _parse_labelled_option(spec, bare)
    except FormulaReadError:
        return 0
    return labelled or _find_option_by_text(spec, bare) or _find_wording(spec, bare)


def _read_kept_clause(spec: ChoiceSpec, text: str) -> int:
    """Return the only option that a clause names, beside others that are denied; 0 without any."""
    kept, denied, unclear = set[int](), set[int](), list[str]()
    known = [text for texts in (spec.choices(), *spec.said) for text in texts]
    for piece in _CLAUSES.split(text):
        out = _NEGATED.fullmatch(piece.strip(_AROUND))
        if out:
            listed = _ALTERNATIVE.split(out["out"] or out["before"])
            denied |= {_read_plainly(spec, one) or -share_words(one, known) for one in listed}
            unclear += [one for one in listed if not _read_plainly(spec, one)]
        else:
            kept.add(_read_plainly(spec, piece))
    kept -= {0}
    if len(kept) != 1 or not denied - {0} or kept & denied:
        return 0
    (place,) = kept
    own = [texts[place - 1] for texts in (spec.choices(), *spec.said)]
    return 0 if any(share_words(one, own) for one in unclear) else place


_CORRECTED = WordPattern(
    r"(?P<head>.+?)(?:[,;.… ]+(?:«choices.correcting»[,;:.… ]+)+"
    r"|[,;.…]+ ?(?!\d)«choices.false»[,:] ?)(?P<rest>.+)",
    re.IGNORECASE,
)
_SECOND_THOUGHT = WordPattern(
    r"(?P<head>.*)«choices.thought».+ «choices.but» (?P<rest>.+)", re.IGNORECASE
)
_CONCLUDED = WordPattern(
    r"(?P<head>.+)(?:[,;.:]? )(?:«so»|«choices.final»|->|=>|→|⇒)[,:]? (?P<rest>.+)", re.IGNORECASE
)
_FINAL = WordPattern(
    r"^(?:(?:«so»|«choices.final»|«choices.it»(?: «choices.is»|'s)?) )+", re.IGNORECASE
)
_CLAUSES = WordPattern(r"[,;.:]\s+|,? (?:«choices.but») ", re.IGNORECASE)
_NEGATED = WordPattern(
    r"(?:\S+ )?(?:«choices.not») (?P<out>.+)"
    r"|(?P<before>.+?) (?:«choices.are» )?(?:«choices.no-option»)",
    re.IGNORECASE,
)
_LETTERED_END = re.compile(r"[A-Z](?:[) :.].*)?$")


def _find_option_by_its_end(spec: ChoiceSpec, typed: str) -> list[int]:
    """Return the one option that ends in these words, ``half as wide``; none if they are too few.

    Nothing is found where the words left out change the others: ``It does not | become larger``.
    """
    words = typed.casefold().strip(_AROUND)
    if len(words) < _LONG_WORD:
        return []
    hits = [
        (place, option.casefold().strip(_AROUND).removesuffix(words))
        for place, option in enumerate(spec.choices(), 1)
        if re.search(rf"(?<!\w){re.escape(words)}$", option.casefold().strip(_AROUND))
    ]
    holding = [option for option in spec.choices() if words in option.casefold()]
    if len(hits) != 1 or len(holding) != 1 or says_otherwise(hits[0][1]):
        return []
    return [hits[0][0]]


def _read_truth_value(spec: ChoiceSpec, typed: str) -> int:
    """Return 1 for a typed "true", 2 for "false"; the option's own words count, too.

    Raises
    ------
    FormulaReadError
        If it is neither, or a letter and a word that contradict each other.
    """
    text = normalise_typed(typed, keep_x=True, longest=1000).text
    labelled = _LABELLED.fullmatch(text.translate(BANGLA_LETTERS))
    if labelled and labelled["mark"].lower() in {"a", "b", "1", "2"}:
        first, second = (
            "ab12".index(labelled["mark"].lower()) % 2 + 1,
            _find_truth_word(labelled["words"]),
        )
        if second and first != second:
            raise FormulaReadError("two-readings", 1, safe_echo(typed))
        text = labelled["words"] if second else text
    word = _IT_IS.sub("", text.strip(_AROUND)).casefold()
    found = 0 if "?" in text and word.count(" ") else read_truth(text)
    found = found or _find_option_by_text(spec, typed)
    if found or word in {"a", "b"}:
        return found or "ab".index(word) + 1
    raise FormulaReadError("true-or-false", 1, safe_echo(typed))


@partial(cache_words, most=1024)
def read_truth(text: str) -> int:
    """Return 1 for an answer that says true or yes, 2 for false or no; 0 if it says neither.

    What follows such a word is a reason, as long as it does not say the other one: *No, they
    differ*, *true (subtractive mixing)*.
    """
    word = _IT_IS.sub("", text.strip(_AROUND)).casefold().replace("’", "'")
    found = _find_truth_word(word) or _find_denied_truth(word)
    if found:
        return found
    last = _read_corrected_truth(word)
    if last:
        return last
    if _ALTERNATIVE.search(_TRUTH_FIRST.sub(r"\g<first>", word)):
        return 0
    denied = _DENIED_FIRST.fullmatch(word)
    told = _find_denied_truth(denied["head"]) if denied else 0
    if denied and told and not _names_other_truth(denied["rest"], told):
        return told
    match = _TRUTH_FIRST.fullmatch(word)
    first = _find_truth_word(match["first"] or match["alone"]) if match else 0
    if match is None or not first:
        concluded = _CONCLUSION.fullmatch(word) or _WORKED_OUT.fullmatch(word)
        return read_truth(concluded["rest"]) if concluded else 0
    behind = (match["rest"] or match["more"]).strip(_AROUND)
    rest = _IT_IS.sub("", behind)
    said = read_truth(rest) if rest else 0
    denies = _SHORT_DENIAL.fullmatch(behind)
    said = said or (2 if denies and denies["no"] else 1 if denies else 0)
    taken_back = _names_other_truth(rest, first) or _takes_back(behind)
    return first if said == first or not (said or taken_back) else 0


def _read_corrected_truth(word: str) -> int:
    """Return what is said in place of a verdict that is taken back; 0 if none is."""
    corrected = _TRUTH_CORRECTED.fullmatch(word)
    if corrected is None or _OPEN.search(corrected["rest"]):
        return 0
    first, second, *_ = [*re.split(r"[,;:.… ]+", word), ""]
    repeated = first == second
    return (
        read_truth(corrected["rest"]) if _find_truth_word(corrected["head"]) and not repeated else 0
    )


def _takes_back(rest: str) -> bool:
    """Return whether words behind a verdict are no reason, but deny it or leave it open."""
    words = set(re.findall(r"(?:[^\W\d_]|[\u0980-\u09ff]|['’])+", rest.casefold()))
    idle = set_of_words("choices.back-fillers") | set_of_words("choices.or")
    idle = idle | set_of_words("choices.because")
    denying = set_of_words("choices.not") | set_of_words("choices.not-behind")
    said = [word for word in words - idle if not casts_doubt(word)]
    doubted = any(map(casts_doubt, words - idle))
    told = all(_find_truth_word(word) or word in denying for word in said)
    return told and (bool(said) or doubted)


def _names_other_truth(rest: str, first: int) -> bool:
    """Return whether a word behind *true* or *false* says the other one."""
    idle = set_of_words("choices.no-verdict")
    words = re.findall(r"(?:[^\W\d_]|[\u0980-\u09ff]){3,}", rest)
    found = {_find_truth_word(word) for word in words if word not in idle} - {0}
    return bool(found - {first})


def _find_denied_truth(text: str) -> int:
    """Return 2 for *not true*, 1 for *not false*; 0 for what is not denied."""
    match = _DENIED.fullmatch(text)
    said = (match["word"] or match["before"]) if match else ""
    denied = 0 if said in set_of_words("choices.yes") else _find_truth_word(said)
    return 3 - denied if denied else 0


def _find_truth_word(text: str) -> int:
    """Return 1 for a word that says true, 2 for one that says false, maybe behind *yes* or *no*."""
    word = text.strip(_AROUND).casefold()
    first, comma, second = word.partition(", ")
    if comma:
        return _find_truth_word(first) if _find_truth_word(first) == _find_truth_word(second) else 0
    if word in set_of_words("choices.true") or word in set_of_words("choices.false"):
        return 1 if word in set_of_words("choices.true") else 2
    first, blank, second = word.partition(" ")
    told = (
        _find_truth_word(first)
        if blank and second not in set_of_words("choices.taking-back")
        else 0
    )
    return told if told and told == _find_truth_word(second) else 0


def _parse_labelled_options(spec: ChoiceSpec, typed: str) -> list[int]:
    """Return positions of options written with their letter and their words; none if they are not.

    Raises
    ------
    FormulaReadError
        If the words are those of another option than the letter.
    """
    pieces = _PIECES.split(typed.strip()) if spec.kind == "multi" else [typed]
    found = [
        _parse_labelled_option(spec, piece) or _find_option_by_text(spec, piece) for piece in pieces
    ]
    return list(dict.fromkeys(found)) if all(found) else []


def _parse_labelled_option(spec: ChoiceSpec, piece: str) -> int:
    """Return the position of an option written as letter and words, ``B) blue``; 0 if it is not.

    Raises
    ------
    FormulaReadError
        If the words are those of another option than the letter.
    """
    text = normalise_typed(piece, keep_x=True, longest=1000).text.strip(_QUOTED)
    bare = _NOUN_AHEAD.sub("", _FILLING.sub("", text))
    match = _LABELLED.fullmatch(bare) or _BRACKETED.fullmatch(bare) or _BEHIND.fullmatch(text)
    if match is None:
        return 0
    mark = match["mark"].translate(BANGLA_LETTERS)
    position = int(mark) if mark.isdecimal() else LETTERS.find(mark.upper()) + 1
    meant = _find_meant_options(spec, match["words"], foreign=bool(_SET_OFF.search(text)))
    if not 1 <= position <= len(spec.choices()):
        return 0
    if not meant:
        own = _is_own_reason(spec, position, mark, match["words"])
        return position if own or _is_called_otherwise(match) else 0
    if text.startswith("a "):  # the article of "a smaller spot", and no letter
        return meant[0] if len(meant) == 1 else 0
    whole = _find_wording(spec, text) if mark.isdecimal() and not _SET_OFF.search(text) else 0
    if not whole and position not in meant:
        raise FormulaReadError("two-readings", 1, safe_echo(piece))
    return whole or position  # the number of "4 times as much" is no place


def _is_called_otherwise(match: re.Match[str]) -> bool:
    """Return whether one word stands before a letter in brackets: ``Moiré (F)``."""
    words = match["words"]
    behind = match.re is _BEHIND and match["mark"].isupper()
    return behind and len(words) >= _SHORTEST and not (casts_doubt(words) or " " in words)


def _is_own_reason(spec: ChoiceSpec, position: int, mark: str, words: str) -> bool:
    """Return whether words behind a letter, which name no option, go with the one of the letter."""
    if not mark.isupper() or is_denied(words) or _ALTERNATIVE.search(words):
        return False
    own = [texts[position - 1] for texts in (spec.choices(), *spec.said)]
    return bool(_BANGLA_WORDS.fullmatch(words)) or share_words(words, own)


def _find_meant_options(spec: ChoiceSpec, words: str, *, foreign: bool) -> list[int]:
    """Return positions of options that words can mean: by all of an option, or by part of it.

    ``foreign`` words in a script that the options do not use may mean any of them, since the
    wordings of a key are in one language.
    """
    folded = fold_word(words)
    for texts in (spec.choices(), *spec.said):
        options = [fold_word(option) for option in texts]
        same = [place for place, option in enumerate(options, 1) if option == folded]
        if same:
            return same
    options = [fold_word(option) for option in spec.choices()]
    bangla = any(_BENGALI.search(text) for texts in (options, *spec.said) for text in texts)
    if foreign and _BENGALI.search(words) and not bangla:
        return list(range(1, len(options) + 1))
    parts = [
        place
        for place, option in enumerate(options, 1)
        if len(folded) >= _SHORTEST <= len(option) and (folded in option or option in folded)
    ]
    meant = 0 if parts else _find_wording(spec, words)
    return [meant] if meant else parts


def _find_option_by_text(spec: ChoiceSpec, typed: str) -> int:
    """Return the position of the one option with these words; 0 if there is none or several."""
    folded = fold_word(typed)
    hits = {
        place
        for texts in (spec.choices(), *spec.said)
        for place, option in enumerate(texts, 1)
        if fold_word(option) == folded
    } or _find_rounded_values(typed, spec.choices())
    before = typed.partition("=")[0].strip()
    if not hits and before != typed.strip() and not _find_rounded_values(before, spec.choices()):
        last = fold_word(typed.rpartition("=")[2])
        hits = {
            place
            for place, option in enumerate(spec.choices(), 1)
            if fold_word(option) == last and any(map(str.isdigit, last))
        }
    return hits.pop() if len(hits) == 1 else 0


def _find_rounded_values(typed: str, options: list[str]) -> set[int]:
    """Return the places of options that are this number, rounded to the digits typed.

    A whole number with nothing behind it is rather the place of an option.
    """
    plain = _MINUS.sub("-", typed.rpartition("=")[2].replace("−", "-").strip())
    said = _VALUE.fullmatch(plain)
    if said is None or not (said["unit"] or "." in said["number"].replace(",", ".")):
        return set()
    number = said["number"].replace(",", ".")
    places = len(number.partition(".")[2])
    found = set()
    for place, option in enumerate(options, 1):
        listed = _VALUE.fullmatch(option.replace("−", "-").replace("\xa0", " "))
        if listed is None or not _is_same_unit(said["unit"], listed["unit"]):
            continue
        if (
            abs(Fraction(listed["number"].replace(",", ".")) - Fraction(number)) * 10**places
            <= HALF
        ):
            found.add(place)
    return found


def _is_same_unit(typed: str, listed: str) -> bool:
    """Return whether a unit, if one was typed, is that of an option: ``seconds`` for s."""
    if typed in {"", listed} or not listed:
        return typed in {"", listed}
    try:
        one, other = read_unit(typed), read_unit(listed)
    except FormulaError:
        return False
    return (one.factor, one.dimension) == (other.factor, other.dimension)


_MINUS = WordPattern(r"^«minus» (?=\d)", re.IGNORECASE)
_VALUE = re.compile(r"(?P<number>-?\d+(?:[.,]\d+)?) ?(?P<unit>[^\d\s.,;:()\[\]-]*)")


_MARK = re.compile(r"(?:[^\W\d_]|[\u0980-\u09ff])+|\d+|[^\s,;.&+()/|:!\[\]{}\"'*_।॥“”«»]")
"""A letter, a number, or a word in any script as a whole, which a message quotes."""


def _read_positions(spec: ChoiceSpec, typed: str) -> list[int]:
    """Return the positions of typed letters or numbers, each once.

    Raises
    ------
    FormulaReadError
        If there is none, one does not exist, or the text ends in a sign that wants another.
    """
    source = normalise_typed(re.sub(r"[\r\n]+", ",", typed.strip()), keep_x=True, longest=1000)
    text = PICTURES.sub(" ", source.text)
    marks = _MARK.findall(_FILLERS.sub(" ", text))
    found = [position for mark in marks for position in _parse_mark(spec, mark)]
    if not found or _UNFINISHED.search(text):
        raise FormulaReadError("option-expected", 1, safe_echo(typed), _list_letters(spec))
    if len({*found}) > 1 and _ALTERNATIVE.search(text):
        raise FormulaReadError("one-option", 1, safe_echo(typed))
    return list(dict.fromkeys(found))


def _parse_mark(spec: ChoiceSpec, mark: str) -> list[int]:
    """Return the positions of one mark: ``B``, ``2`` or several letters run together.

    Raises
    ------
    FormulaReadError
        If there is no such option.
    """
    letters = mark.translate(BANGLA_LETTERS).upper()
    positions = [int(mark)] if mark.isdecimal() else [LETTERS.find(c) + 1 for c in letters]
    if not all(1 <= position <= len(spec.choices()) for position in positions):
        raise FormulaReadError("option-expected", 1, mark, _list_letters(spec))
    return positions


def _list_letters(spec: ChoiceSpec) -> list[str]:
    """Return the letters of all options, for an error."""
    return list(LETTERS[: len(spec.choices())])


def _judge_single_option(spec: ChoiceSpec, chosen: int) -> Verdict:
    """Return the verdict on one chosen option, right or wrong."""
    read_as = _format_options(spec, [chosen])
    if chosen in spec.correct:
        return correct(read_as)
    return wrong(read_as, _find_misconception_note(spec, [chosen]), because=_list_marks([chosen]))


def _judge_several_options(spec: ChoiceSpec, chosen: list[int]) -> Verdict:
    """Return the verdict on several chosen options: right less wrong ones, of all right ones.

    Without ``negative`` there is no partial credit.
    """
    read_as = _format_options(spec, chosen)
    right = len(set(chosen) & set(spec.correct))
    extra = len(set(chosen) - set(spec.correct))
    if right == len(spec.correct) and not extra:
        return correct(read_as)
    credit = max(Fraction(right - extra, max(len(spec.correct), 1)), Fraction(0))
    note = _find_misconception_note(spec, chosen) or (
        "options-extra" if extra else "options-missing"
    )
    extras = _list_marks(sorted(set(chosen) - set(spec.correct)))
    fields = {"right": right, "of": len(spec.correct), "because": extras}
    if spec.negative and 0 < credit < 1:
        return partly(credit, read_as, note, **fields)
    return wrong(read_as, note, **fields)


def _find_misconception_note(spec: ChoiceSpec, chosen: list[int]) -> str:
    """Return the note of the mistake that chooses just these options; empty if none does."""
    for name, positions in spec.traps.items():
        if sorted(positions if isinstance(positions, list) else [positions]) == sorted(chosen):
            return f"trap:{name}"
    return ""


def _list_marks(chosen: list[int]) -> tuple[str, ...]:
    """Return the letters of positions, by which reasons are stored."""
    return tuple(LETTERS[place - 1] for place in chosen)


def _format_options(spec: ChoiceSpec, chosen: list[int]) -> str:
    """Return chosen options as letters in order, or as ``true`` and ``false``."""
    if spec.kind == "tf":
        return ("true", "false")[chosen[0] - 1]
    return ", ".join(LETTERS[i - 1] for i in sorted(chosen))


def has_value_options(answer: Mapping[str, Any]) -> bool:
    """Whether an authored choice is between values of a quantity, and not between sentences."""
    return bool(answer["kind"] == "choice" and answer.get("of") and not answer.get("options"))


def ask(part: PartContext) -> AskedPart[ChoiceSpec]:
    """Return the options in a drawn order.

    Raises
    ------
    BankError
        Unless exactly one is right in this variant.
    """
    if has_value_options(part.answer):
        return _ask_values(part)
    asked = ask_options(part, InputControl("one", lines=0))
    if len(asked.right) != 1:
        raise part.error(f"{len(asked.right)} options are right")
    return asked


def _ask_values(part: PartContext) -> AskedPart[ChoiceSpec]:
    """Return the value of a quantity among those that known mistakes give, from the least up.

    A mistake that shows the same number as the key or as another mistake is left out. ``take``
    is the number of options; of more mistakes so many are drawn.

    Raises
    ------
    BankError
        If no mistake gives another value.
    """
    (key,), unit = part.answer_values(), part.answer.get("unit", part.units.get(part.answer["of"]))
    wrong = part.misconception_answers()
    values = {part.format_option(key, unit or ""): ("", key)}
    for trap in part.shuffle([*wrong], "/values"):
        (value,) = wrong[trap]
        if len(values) < int(part.answer.get("take") or MOST_OPTIONS):
            values.setdefault(part.format_option(value, unit or ""), (trap, value))
    if len(values) < _FEWEST_VALUES:
        raise part.error("no trap of the solver gives another value to choose")
    rows = sorted(values.items(), key=lambda row: float(row[1][1]))
    places = {trap: place for place, (_, (trap, _)) in enumerate(rows, 1)}
    names = [f"{VALUE_OPTION}{text}" for text, _ in rows]
    right = places.pop("")
    spec = make_spec(
        ChoiceSpec,
        part,
        of=[part.answer["of"]],
        options=[text for text, _ in rows],
        correct=[right],
        traps=places,
        notes=part.misconception_notes(places),
    )
    mistakes = {
        trap: msgspec.structs.replace(spec, correct=[place], traps={}, notes={})
        for trap, place in places.items()
    }
    return AskedPart(
        spec,
        InputControl("one", lines=0),
        options=assign_letters(names),
        right=(("options", names[right - 1]),),
        mistakes=mistakes,
    )


def option_order(part: PartContext) -> tuple[list[str], list[str]]:
    """Return the options' names in a drawn order, and those right in this variant."""
    conditions = part.answer["options"]
    order = part.shuffle_names(part.selection()[0])
    return order, [name for name in order if part.condition_holds(conditions[name])]


def ask_options(part: PartContext, control: InputControl) -> AskedPart[ChoiceSpec]:
    """Return the options in a drawn order, with those that are right in this variant."""
    order, right = option_order(part)
    (wordings, *said), options = part.option_texts(order), assign_letters(order)
    others = {"said": said} if said else {}
    correct = [order.index(name) + 1 for name in right]
    why = part.reasons(options)
    return AskedPart(
        make_spec(ChoiceSpec, part, options=wordings, correct=correct, why=why, **others),
        control,
        options=options,
        reasons=part.with_reason(options),
        right=tuple(("options", name) for name in right),
    )


def count_options(answer: Mapping[str, Any], _points: Fraction, _words: int) -> Work:
    """Return half a claim for each option: they are weighed against each other, not alone."""
    shown = answer.get("take") or len(answer.get("options", ())) or _USUAL_VALUES
    return {"tick": Fraction(shown, 2)}


KIND = AnswerKind(
    AuthoredChoice, ChoiceSpec, ask, hint("ask.choice"), verb="tick", work=count_options
)

"""Values of fields from the one line of text that Moodle makes of a response.

Sources: Moodle, ``summarise_response`` of its question types.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import lru_cache
from typing import TypeVar

from quizgen.grading.echo import safe_echo
from quizgen.lms.manifest import ManifestQuestion, ResponseField
from quizgen.maths.notation import FormulaReadError

# Stands for no response, and for the place of a step that does not belong to an order.
NO_RESPONSE = "-"
ARROW = " -> "

# What would stand in the fields of a part on our own pages: letters or texts, in their order.
FieldValues = list[str]

Given = TypeVar("Given")

_FIRST = re.compile(r"(?P<word>[^\d;]{0,40})1(?P<sign>\s?[:：।.)]\s?)")
_LETTER = re.compile(r"(?:^|; )(\w{1,2})\. ")
# A number without a unit.
_UNITLESS = re.compile(r"[\s\d.,'’+\-−–*·×x^eE/০-৯]+")
# What a system puts between, around or into words when it makes text of a page.
_IGNORED = re.compile(r"[\s_*\u200b-\u200d\ufeff]+")


def parse_summary(question: ManifestQuestion, text: str) -> list[FieldValues | FormulaReadError]:
    """Return the values of each field of a question.

    Parameters
    ----------
    question : ManifestQuestion
    text : str
        The response as a report has it.

    Returns
    -------
    list
        For each field its values, empty if there is no response, or why they cannot be read.
    """
    if text.strip() in {"", NO_RESPONSE}:
        return [[] for _ in question.asks]
    if not question.embedded:
        return [values_or_error(_summary_values, field, text) for field in question.asks]
    # A match is embedded as a field for each stem.
    widths = [len(one.options) if one.kind in {"pairs", "order"} else 1 for one in question.asks]
    try:
        pieces = _split_cloze(text.strip(), sum(widths))
    except FormulaReadError as error:
        return [error for _ in question.asks]
    found: list[FieldValues | FormulaReadError] = []
    for field, width in zip(question.asks, widths, strict=True):
        if width == 1:
            found.append(values_or_error(_summary_values, field, pieces[0]))
        else:
            found.append(values_or_error(_drop_down_values, field, pieces[:width]))
        del pieces[:width]
    return found


def values_or_error(
    read: Callable[[ResponseField, Given], FieldValues], field: ResponseField, given: Given
) -> FieldValues | FormulaReadError:
    """Return what a reader makes of a response, or why it cannot be read."""
    try:
        return read(field, given)
    except FormulaReadError as error:
        return error


def check_letter(letter: str, known: Collection[str]) -> str:
    """Return a letter that a field has.

    Raises
    ------
    FormulaReadError
        If it has not.
    """
    if letter not in known:
        raise FormulaReadError("option-unknown", 1, safe_echo(letter))
    return letter


def _split_cloze(text: str, count: int) -> list[str]:
    """Return the ``count`` answers in ``part 1: 3.5; part 2: B. black``, for any word as ``part``.

    Raises
    ------
    FormulaReadError
        If they are not as many as the fields, or what was typed reads like the next part.
    """
    first = _FIRST.match(text)
    if first is None:
        raise FormulaReadError("parts-apart", 1, safe_echo(text))
    pieces, rest = [], text[first.end() :]
    for number in range(2, count + 2):
        heads = re.split(_head_pattern(first, number), rest)
        if len(heads) != (2 if number <= count else 1):
            raise FormulaReadError("parts-apart", 1, safe_echo(text))
        pieces.append(heads[0].strip())
        rest = heads[-1]
    return pieces


def _head_pattern(first: re.Match[str], number: int) -> str:
    """Return the pattern of the heading of part ``number``, written as the first heading is."""
    sign = re.escape(first["sign"].strip())
    return rf";\s+{re.escape(first['word'])}{number}\s?{sign}(?:\s|$)"


def _summary_values(field: ResponseField, text: str) -> FieldValues:
    """Return the values of one field from its text in a report; empty without a response."""
    if not text.strip():
        return []
    match field.kind:
        case "one" | "many":
            return _list_options(_with_letters(field.options), text)
        case "pairs":
            return _targets_by_stem(field, text)
        case "order" if ARROW in text:
            return steps_by_place(_targets_by_stem(field, text), field)
        case "order":
            return _steps_in_order(field, text)
        case _:
            return [append_unit(text, field.unit)]


def append_unit(text: str, unit: str) -> str:
    """Return a number with the unit that is printed after its field, unless one was typed."""
    return f"{text.strip()} {unit}" if unit and _UNITLESS.fullmatch(text) else text


def _with_letters(options: Mapping[str, list[str]]) -> dict[str, list[str]]:
    """Return the texts of each option, with its letter before them and without."""
    return {
        letter: [form for text in texts for form in (text, f"{letter}. {text}")]
        for letter, texts in options.items()
    }


def _pair_texts(field: ResponseField) -> dict[str, list[str]]:
    """Return the texts that Moodle may write for every pair, by the letters of both sides."""
    return {
        f"{left} {right}": [
            f"{stem}{ARROW}{target}" for stem in stems for target in field.targets[right]
        ]
        for left, stems in _with_letters(field.options).items()
        for right in field.targets
    }


def _bare_text(text: str) -> str:
    """Return a text without blanks and layout, to be compared."""
    return _IGNORED.sub("", unicodedata.normalize("NFKC", text))


@lru_cache(maxsize=8192)
def _bare_option(text: str) -> str:
    """Return the bare text of an option; cached, as each is compared with every response."""
    return _bare_text(text)


def _find_option(options: Mapping[str, Iterable[str]], text: str) -> str:
    """Return the letter of the one option with this text; capitals matter only between options.

    Raises
    ------
    FormulaReadError
        If none has it, or several have.
    """
    bare = _bare_text(text)
    for fold in (str, str.casefold):
        wanted = fold(bare)
        hits = [m for m, texts in options.items() if wanted in map(fold, map(_bare_option, texts))]
        if len(hits) == 1:
            return hits[0]
        if hits:
            raise FormulaReadError("option-twice", 1, safe_echo(text))
    raise FormulaReadError("option-unknown", 1, safe_echo(text))


def _list_options(options: Mapping[str, Iterable[str]], text: str) -> FieldValues:
    """Return the letters of options whose texts are listed, as ``dark; light``.

    Texts may hold semicolons themselves, so longer runs of pieces are tried as well.
    """
    pieces = text.split(";")
    longest = 1 + max(one.count(";") for texts in options.values() for one in texts)
    found: FieldValues = []
    while pieces:
        for count in range(1, longest + 1):
            try:
                found.append(_find_option(options, ";".join(pieces[:count])))
            except FormulaReadError:
                if count == longest:
                    raise
            else:
                del pieces[:count]
                break
        if len(found) > len(options):
            raise FormulaReadError("option-twice", 1, safe_echo(text))
    return found


def _targets_by_stem(field: ResponseField, text: str) -> FieldValues:
    """Return the target of each stem, in the order of the stems; empty where none was chosen."""
    chosen = dict(pair.split(" ") for pair in _list_options(_pair_texts(field), text))
    return [chosen.get(mark, "") for mark in field.options]


def _steps_in_order(field: ResponseField, text: str) -> FieldValues:
    """Return the letters of the steps in a response.

    A report has only the first few characters of each step, so the texts cannot be compared.
    """
    found = _LETTER.findall(text)
    if sorted(found) != sorted(field.options):
        raise FormulaReadError("steps-apart", 1, safe_echo(text))
    return [str(mark) for mark in found]


def _drop_down_values(field: ResponseField, pieces: Sequence[str]) -> FieldValues:
    """Return the targets or the order chosen in a drop-down for each stem."""
    if not any(pieces):
        return []
    letters = [piece and check_letter(piece, field.targets) for piece in pieces]
    return steps_by_place(letters, field) if field.kind == "order" else letters


def steps_by_place(places: Sequence[str], field: ResponseField) -> FieldValues:
    """Return the letters of steps in the order of the places that they were given.

    Raises
    ------
    FormulaReadError
        If two have the same place.
    """
    given = {place for place in places if place not in {"", NO_RESPONSE}}
    pairs = zip(places, field.options, strict=True)
    taken = [(place, mark) for place, mark in pairs if place in given]
    if len(given) < len(taken):
        raise FormulaReadError("place-twice", 1, ", ".join(place for place, _ in taken))
    return [mark for _, mark in sorted(taken, key=lambda one: int(one[0]))]

"""What a field was answered with, from the one line of text that Moodle makes of a response.

Sources: Moodle, ``summarise_response`` of its question types.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache

from quizgen.grading.echo import safe_echo
from quizgen.maths.notation import FormulaReadError
from quizgen.responses.keys import Asked, Entry

NOTHING = "-"
"""What stands where nothing was answered, and what a step without a place is matched to."""
ARROW = " -> "

Values = list[str]
"""What stands in the fields of a part on our own pages: letters or texts, in their order."""

_FIRST = re.compile(r"(?P<word>[^\d;]{0,40})1(?P<sign>\s?[:：।.)]\s?)")
_LETTER = re.compile(r"(?:^|; )(\w{1,2})\. ")
_BARE = re.compile(r"[\s\d.,'’+\-−–*·×x^eE/০-৯]+")
"""A number without a unit."""
_IGNORED = re.compile(r"[\s_*\u200b-\u200d\ufeff]+")
"""What a system puts between, around or into words when it makes text of a page."""


def fields(entry: Entry, text: str) -> list[Values | FormulaReadError]:
    """What each field of an entry was answered with.

    Parameters
    ----------
    entry : Entry
    text : str
        The response as a report has it.

    Returns
    -------
    list
        For each field its values, empty if nothing was answered, or why that is not known.
    """
    if text.strip() in {"", NOTHING}:
        return [[] for _ in entry.asks]
    if not entry.embedded:
        return [_tried(ask, text) for ask in entry.asks]
    widths = [_width(ask) for ask in entry.asks]
    try:
        pieces = _pieces(text.strip(), sum(widths))
    except FormulaReadError as error:
        return [error for _ in entry.asks]
    found: list[Values | FormulaReadError] = []
    for ask, width in zip(entry.asks, widths, strict=True):
        found.append(_tried(ask, *pieces[:width]) if width == 1 else _placed(ask, pieces[:width]))
        del pieces[:width]
    return found


def _width(ask: Asked) -> int:
    """How many fields in a text a field of ours is: one for each stem of pairs."""
    return len(ask.options) if ask.kind in {"pairs", "order"} else 1


def _pieces(text: str, count: int) -> list[str]:
    """The answers in ``part 1: 3.5; part 2: B. black``, whatever the word is in a language.

    Raises
    ------
    ReadError
        If they are not as many as the fields, or what was typed reads like the next part.
    """
    first = _FIRST.match(text)
    if first is None:
        raise FormulaReadError("parts-apart", 1, safe_echo(text))
    pieces, rest = [], text[first.end() :]
    for number in range(2, count + 2):
        heads = re.split(_head(first, number), rest)
        if len(heads) != (2 if number <= count else 1):
            raise FormulaReadError("parts-apart", 1, safe_echo(text))
        pieces.append(heads[0].strip())
        rest = heads[-1]
    return pieces


def _head(first: re.Match[str], number: int) -> str:
    sign = re.escape(first["sign"].strip())
    return rf";\s+{re.escape(first['word'])}{number}\s?{sign}(?:\s|$)"


def _tried(ask: Asked, text: str) -> Values | FormulaReadError:
    if not text.strip():
        return []
    try:
        return _values(ask, text)
    except FormulaReadError as error:
        return error


def _values(ask: Asked, text: str) -> Values:
    match ask.kind:
        case "one" | "many":
            return _listed(_lettered(ask.options), text)
        case "pairs":
            return _by_stem(ask, text)
        case "order":
            return in_places(_by_stem(ask, text), ask) if ARROW in text else _in_order(ask, text)
        case _:
            return [with_unit(text, ask.unit)]


def with_unit(text: str, unit: str) -> str:
    """A number with the unit that stands behind its field, unless another was typed."""
    return f"{text.strip()} {unit}" if unit and _BARE.fullmatch(text) else text


def _lettered(options: Mapping[str, list[str]]) -> dict[str, list[str]]:
    """Options as they stand behind their letter, or without one."""
    return {
        mark: [text for told in texts for text in (told, f"{mark}. {told}")]
        for mark, texts in options.items()
    }


def _arrows(ask: Asked) -> dict[str, list[str]]:
    """Every pair as Moodle writes it, by the letters of both sides."""
    return {
        f"{left} {right}": [
            f"{stem}{ARROW}{target}" for stem in stems for target in ask.targets[right]
        ]
        for left, stems in _lettered(ask.options).items()
        for right in ask.targets
    }


def _bare(text: str) -> str:
    """A text without blanks and the signs of its layout."""
    return _IGNORED.sub("", unicodedata.normalize("NFKC", text))


@lru_cache(maxsize=8192)
def _ours(text: str) -> str:
    """The same of what an option says, which is compared with every response."""
    return _bare(text)


def _which(options: Mapping[str, Iterable[str]], text: str) -> str:
    """The letter of the one option that says this.

    Raises
    ------
    ReadError
        If none does, or several do.
    """
    said = _bare(text)
    for fold in (str, str.casefold):
        wanted = fold(said)
        hits = [m for m, texts in options.items() if wanted in map(fold, map(_ours, texts))]
        if len(hits) == 1:
            return hits[0]
        if hits:
            raise FormulaReadError("option-twice", 1, safe_echo(text))
    raise FormulaReadError("option-unknown", 1, safe_echo(text))


def _listed(options: Mapping[str, Iterable[str]], text: str) -> Values:
    """The letters of options whose texts stand one behind the other, as ``dark; light``.

    Texts may hold semicolons themselves, so longer runs of pieces are tried as well.
    """
    pieces = text.split(";")
    longest = 1 + max(told.count(";") for texts in options.values() for told in texts)
    found: Values = []
    while pieces:
        for count in range(1, longest + 1):
            try:
                found.append(_which(options, ";".join(pieces[:count])))
            except FormulaReadError:
                if count == longest:
                    raise
            else:
                del pieces[:count]
                break
        if len(found) > len(options):
            raise FormulaReadError("option-twice", 1, safe_echo(text))
    return found


def _by_stem(ask: Asked, text: str) -> Values:
    """The target of each stem, in the order of the stems."""
    chosen = dict(pair.split(" ") for pair in _listed(_arrows(ask), text))
    return [chosen.get(mark, "") for mark in ask.options]


def _in_order(ask: Asked, text: str) -> Values:
    """The letters of steps, of each of which a report has but the first few signs."""
    found = _LETTER.findall(text)
    if sorted(found) != sorted(ask.options):
        raise FormulaReadError("steps-apart", 1, safe_echo(text))
    return [str(mark) for mark in found]


def _placed(ask: Asked, pieces: Sequence[str]) -> Values | FormulaReadError:
    """Pairs or an order from a drop-down for each stem, which holds the letters of the targets."""
    if not any(pieces):
        return []
    unknown = [piece for piece in pieces if piece and piece not in ask.targets]
    if unknown:
        return FormulaReadError("option-unknown", 1, safe_echo(unknown[0]))
    try:
        return in_places(pieces, ask) if ask.kind == "order" else [*pieces]
    except FormulaReadError as error:
        return error


def in_places(places: Sequence[str], ask: Asked) -> Values:
    """Steps in the order of the places that they were given.

    Raises
    ------
    ReadError
        If two have the same place.
    """
    given = {place for place in places if place not in {"", NOTHING}}
    pairs = zip(places, ask.options, strict=True)
    taken = [(place, mark) for place, mark in pairs if place in given]
    if len(given) < len(taken):
        raise FormulaReadError("place-twice", 1, ", ".join(place for place, _ in taken))
    return [mark for _, mark in sorted(taken, key=lambda one: int(one[0]))]

"""Languages that a bank brings: whatever its own files do not say is said in English.

``quizgen new language`` writes such files; ``docs/banks.md`` shows them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from itertools import zip_longest
from pathlib import Path
from string import Formatter
from typing import Any

from quizgen.core.errors import BankError
from quizgen.core.untrusted import parse_toml, read_text

TAG = r"[a-z]{2,3}(?:-[A-Z][a-z]{3})?(?:-(?:[A-Z]{2}|[0-9]{3}))?"
"""A language as BCP 47 names it: ``fr``, ``pt-BR``, ``sr-Latn``."""

RIGHT_TO_LEFT = frozenset({"Adlm", "Arab", "Hebr", "Mand", "Nkoo", "Rohg", "Samr", "Syrc", "Thaa"})
"""Scripts that are written from right to left, by ISO 15924."""
_USUAL = {
    **dict.fromkeys(("ar", "ckb", "fa", "ps", "sd", "ug", "ur"), "Arab"),
    **dict.fromkeys(("he", "yi"), "Hebr"),
    "dv": "Thaa",
    "nqo": "Nkoo",
    "syr": "Syrc",
}
"""Language to its script, where that is written from right to left."""

Translation = dict[str, Any]


def is_language_tag(text: str) -> bool:
    """Return whether a text is a language tag of BCP 47.

    Examples
    --------
    >>> tuple(map(is_language_tag, ("fr", "pt-BR", "French", "../fr")))
    (True, True, False, False)
    """
    return re.fullmatch(TAG, text) is not None


def script_of(tag: str) -> str:
    """Return the ISO 15924 script of a language tag: the one it names, else the usual one.

    Examples
    --------
    >>> script_of("he"), script_of("az-Arab-IR"), script_of("ur-Latn"), script_of("fr")
    ('Hebr', 'Arab', 'Latn', 'Latn')
    """
    first, *rest = tag.split("-")
    return next((one for one in rest if len(one) == 4), _USUAL.get(first, "Latn"))


def normalise_language_tag(text: str) -> str:
    """Return a language tag with upper and lower case as BCP 47 writes it.

    Examples
    --------
    >>> tags = "PT-br", "sr-latn", "French"
    >>> tuple(map(normalise_language_tag, tags))
    ('pt-BR', 'sr-Latn', 'french')
    """
    first, *rest = text.lower().split("-")
    return "-".join([first, *(one.title() if len(one) == 4 else one.upper() for one in rest)])


def read_translation(file: Path) -> Translation:
    """Return the table of a TOML file of words that a bank brings.

    Raises
    ------
    BankError
        If it cannot be read or is no TOML; names the file and the line.
    """
    return parse_toml(read_text(file, BankError), file, BankError)


def merge_translation(english: Translation, own: Mapping[str, Any]) -> Translation:
    """Return English words with a language's own in their places.

    Keys that English lacks stay: letters and names that are spoken are open lists. A value of
    another type than the English one is left out, and so is a sentence with other blanks, which
    would be filled with more than was meant. ``check_translation`` reports both.
    """
    found = dict(english)
    for key, value in own.items():
        there = english.get(key)
        if isinstance(there, dict) and isinstance(value, dict):
            found[key] = merge_translation(there, value)
        elif not any(_iter_misfits(there, value)):
            found[key] = value
    return found


def check_translation(
    english: Translation, own: Translation, open_lists: frozenset[str]
) -> Iterator[tuple[str, str]]:
    """Yield (dotted key, message) for every word of a translation that cannot be used.

    Parameters
    ----------
    english : dict
        The same file in English.
    own : dict
        What somebody brings.
    open_lists : frozenset of str
        Tables that may hold any keys.
    """
    for key, value in own.items():
        there = english.get(key)
        if there is None:
            close = " or ".join(map(repr, get_close_matches(key, english, 2)))
            yield key, "quizgen has no such word" + (f"; did you mean {close}?" if close else "")
        elif isinstance(there, dict) and isinstance(value, dict) and key not in open_lists:
            inner = check_translation(there, value, frozenset())
            yield from ((f"{key}.{name}", what) for name, what in inner)
        else:
            yield from ((key, what) for what in _iter_misfits(there, value))


def _iter_misfits(english: object, own: object) -> Iterator[str]:
    """Yield why a value cannot replace the English one: another type, or other blanks in a text.

    ``english`` is None where English has nothing there.
    """
    if english is not None and type(english) is not type(own):
        yield f"is to be {_name_type(english)}, and not {_name_type(own)}"
    elif isinstance(own, str):
        yield from _iter_placeholder_errors(english if isinstance(english, str) else "", own)
    elif isinstance(own, list):
        texts = english if isinstance(english, list) else []
        if texts and all(map(_is_numbered, texts)) and not all(map(_is_numbered, own)):
            yield f"each is to begin with its number, as {texts[0]!r} does"
        for there, value in zip_longest(texts[: len(own)], own):
            yield from _iter_misfits(there, value)
    elif isinstance(own, dict):
        known = english if isinstance(english, dict) else {}
        for name, value in own.items():
            yield from _iter_misfits(known.get(name), value)


def _is_numbered(row: object) -> bool:
    """Return whether a row has a number before its word: ``1000 thousand``, ``1/2 half``."""
    return re.match(r"\d+(?:/[1-9]\d*)? \S", str(row)) is not None


def _name_type(value: object) -> str:
    """Return the type of a TOML value in an author's words."""
    names = {"dict": "a table", "str": "a text", "list": "a list"}
    return names.get(type(value).__name__, "a number")


def _iter_placeholder_errors(english: str, own: str) -> Iterator[str]:
    """Yield what is wrong with the blanks of a sentence: each is a bare name that English has, too.

    ``str.format`` would look into a value at ``{page.__class__}``, and make one of gigabytes at
    ``{page:>99999999}``.
    """
    try:
        wanted, _ = _parse_blanks(english)
        found, more = _parse_blanks(own)
    except ValueError as error:
        yield f"{error} (write {{{{ for a brace)"
        return
    for name in sorted(found - wanted):
        known = ", ".join(f"{{{one}}}" for one in sorted(wanted)) or "none"
        yield f"there is nothing to fill {{{name}}} with (blanks here: {known})"
    for blank in more:
        yield f"{{{blank}}}: a blank is a name between braces and nothing more"


def _parse_blanks(text: str) -> tuple[set[str], list[str]]:
    """Return the names in a sentence's blanks, and the blanks that hold more than a name."""
    names, more = set(), []
    for _, name, form, conversion in Formatter().parse(text):
        if name is None:
            continue
        names.add(name)
        if form or conversion or not re.fullmatch(r"\w*", name):
            more.append(
                name + (f"!{conversion}" if conversion else "") + (f":{form}" if form else "")
            )
    return names, more

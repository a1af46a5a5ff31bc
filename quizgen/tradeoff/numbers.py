"""Numbers on the page as a language writes them."""

from __future__ import annotations

import re
from typing import Any

from quizgen.locale import language, numbers_in
from quizgen.maths.notation import people

_NO_PROSE = re.compile(
    r'<(?:script|style|code|pre|span translate="no")[ >].*?</|<[^>]*>', re.DOTALL
)
"""What stands between prose: program text, names with versions, and markup."""


def in_prose(page: str, lang: str) -> str:
    """A piece of HTML with the decimal sign of a language in what is read.

    Examples
    --------
    >>> in_prose('<p class="a1.5">1.5 times, <code>1.5</code></p>', "de")
    '<p class="a1.5">1,5 times, <code>1.5</code></p>'
    """
    if language(lang).decimal == ".":
        return page
    parts, end = [], 0
    for found in _NO_PROSE.finditer(page):
        parts += [numbers_in(lang, page[end : found.start()]), found[0]]
        end = found.end()
    return "".join([*parts, numbers_in(lang, page[end:])])


def in_places(places: list[list[Any]], lang: str) -> list[list[Any]]:
    """Positions of a slider likewise; their numbers are in pieces, whose points stand alone."""
    sign = language(lang).decimal
    return [
        [x, numbers_in(lang, at), numbers_in(lang, said),
         *(tuple(piece.replace(".", sign) for piece in pieces) for pieces in numbers)]
        for x, at, said, *numbers in places
    ]  # fmt: skip


def short(value: float) -> str:
    """A number in two figures, whole from a hundred on, as people write it.

    Examples
    --------
    >>> short(0.0123), short(1.64e-7), short(243.0), short(470000.0)
    ('0.012', '1.6·10⁻⁷', '243', '4.7·10⁵')
    """
    if 100 <= value < 9999.5:
        return f"{value:.0f}"
    return people.number(f"{value:.2g}")

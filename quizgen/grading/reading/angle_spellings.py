"""Angles as people write them: ``22° 37′``, ``10^o``, ``arctan(0.2)`` for degrees."""

from __future__ import annotations

import re
from collections.abc import Iterator

from quizgen.grading.reading.normalise import LONGEST
from quizgen.locale.word_patterns import WordPattern

_INVERSE = re.compile(
    r"\\?(?:arc(?:tan|sin|cos)|a(?:tan2?|sin|cos))(?![^\W\d_])"
    r"|(?:tan|sin|cos) ?(?:\^ ?\(?-1\)?|\^\{-1\}|⁻¹)"
)
_MINUTES = re.compile(r"(\d+) ?° ?(\d{1,2}) ?['′’](?: ?(\d{1,2}(?:\.\d+)?) ?(?:''|[″\"]))?")
_ARC_MINUTES = WordPattern(r"(\d+(?:[.,]\d+)?) ?«arc-minutes»(?!\w)", re.IGNORECASE)
_CIRCLE = re.compile(r"(?<=\d) ?\^ ?\{? ?(?:o|\\circ) ?\}?")


def list_angle_spellings(typed: str) -> Iterator[str]:
    """Yield the angle as typed, and in the other ways that degrees are meant.

    Inverse functions give degrees on the calculators of most people: ``arctan(0.16) = 9.09°``.
    """
    typed = _CIRCLE.sub("°", typed)
    typed = _ARC_MINUTES.sub(r"(\1/60)°", typed) if len(typed) <= LONGEST else typed
    minutes = _MINUTES.fullmatch(typed.strip())
    if minutes:
        typed = f"({minutes[1]} + {minutes[2]}/60 + {minutes[3] or 0}/3600)°"
    yield typed
    plain = typed.replace("°", "") if typed.count("°") > 1 else typed
    if plain != typed:
        yield plain
    if len(typed) <= LONGEST and _INVERSE.search(plain):
        yield _INVERSE.sub(lambda m: f"(180/pi)*{m[0]}", plain.removesuffix("°"))

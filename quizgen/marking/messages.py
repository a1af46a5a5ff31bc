"""Sentences of the checker in the learner's language, looked up by the language-free note."""

from __future__ import annotations

import re
from collections.abc import Mapping

from quizgen.locale import known, numbers_in, table
from quizgen.marking.echo import safe
from quizgen.maths.notation import people

_CLAUSE = re.compile("⟨([^⟩]*)⟩")
"""Part of a sentence that is left out where nothing is known to fill it in."""


def _table(lang: str) -> dict[str, dict[str, str]]:
    return table(known(lang), "messages")


def sentences(lang: str) -> dict[str, str]:
    """Return the sentences of the notes; an unknown language falls back to English."""
    return _table(lang)["notes"]


def words(lang: str) -> dict[str, str]:
    """Return the names of token kinds and short words used inside sentences."""
    return _table(lang)["words"]


def practice_words(lang: str) -> dict[str, str]:
    """Return the sentences of ``quizgen practice``."""
    return _table(lang)["practice"]


def say(lang: str, note: str, fields: Mapping[str, object]) -> str:
    """Return the sentence for a note.

    Parameters
    ----------
    lang : str
        A language; English if there are no sentences in it.
    note : str
        Key of the sentence; an empty or unknown note has no sentence.
    fields : mapping
        Texts and numbers to fill in; control characters in them are named, long ones cut.
    """
    sentence = sentences(lang).get(note, "")
    if "{" not in sentence:
        return sentence
    shown = _Blanks({key: _field(lang, key, value) for key, value in fields.items()})
    if "⟨" in sentence:
        sentence = _CLAUSE.sub(lambda clause: _known(clause[1], shown), sentence)
    return sentence.format_map(shown)


AS_TYPED = frozenset({"code", "gap", "text"})
"""Kinds whose answers are words, or what a program prints: their points are no decimal signs."""


def read_back(kind: str, read_as: str, lang: str) -> str:
    """What was read of an answer of a kind, with the decimal sign of a language."""
    return read_as if kind in AS_TYPED else numbers_in(lang, read_as)


_NAMES = frozenset({"names", "detail"})
"""Fields that name quantities."""


def _field(lang: str, key: str, value: object) -> str:
    """What a blank is filled with; names of quantities and powers as people write them."""
    if key == "power":
        return people.power_of_ten(str(value))
    if key in _NAMES and isinstance(value, (tuple, list)):
        value = tuple(people.name(str(item)) for item in value)
    elif key in _NAMES:
        value = people.formula(str(value))
    return numbers_in(lang, _shown(lang, value))


def _known(clause: str, shown: Mapping[str, str]) -> str:
    """A clause, if there is something to say in it."""
    return clause if all(shown.get(name) for name in re.findall(r"{(\w+)}", clause)) else ""


class _Blanks(dict[str, str]):
    """A sentence never fails for want of a detail."""

    def __missing__(self, key: str) -> str:
        del key
        return "…"


def _shown(lang: str, value: object) -> str:
    if isinstance(value, (tuple, list)):
        names = words(lang)
        return ", ".join(dict.fromkeys(safe(names.get(str(item), str(item))) for item in value))
    return safe(str(value), 120)

"""Sentences of the checker in the learner's language, looked up by the language-free note."""

from __future__ import annotations

import re
from collections.abc import Mapping

from quizgen.grading.echo import safe_echo
from quizgen.locale import (
    fallback_language,
    get_language,
    load_words,
    localise_numbers,
    translate,
)
from quizgen.maths.notation import pretty

_CLAUSE = re.compile("⟨([^⟩]*)⟩")
"""Part of a sentence that is left out where nothing is known to fill it in."""


def _load_message_table(lang: str) -> dict[str, dict[str, str]]:
    """Return the sentences of the checker in a language, by section and key."""
    return load_words(fallback_language(lang), "messages")


def load_sentences(lang: str) -> dict[str, str]:
    """Return the sentences of the notes; an unknown language falls back to English."""
    return _load_message_table(lang)["notes"]


def load_words_inside(lang: str) -> dict[str, str]:
    """Return the names of token kinds and short words used inside sentences."""
    return _load_message_table(lang)["words"]


def load_practice_words(lang: str) -> dict[str, str]:
    """Return the sentences of ``quizgen practice``."""
    return _load_message_table(lang)["practice"]


def feedback_sentence(lang: str, note: str, fields: Mapping[str, object]) -> str:
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
    sentence = load_sentences(lang).get(note, "")
    if "{" not in sentence:
        return sentence
    shown = _Blanks({key: _format_message_field(lang, key, value) for key, value in fields.items()})
    for key in ECHOED & shown.keys():
        if f"{{{key}}}(" not in sentence and _is_quotable(fields[key]):
            shown[key] = f"“{shown[key]}”"
    if "⟨" in sentence:
        sentence = _CLAUSE.sub(lambda clause: _keep_filled_clause(clause[1], shown), sentence)
    marks = str.maketrans("“”", get_language(fallback_language(lang)).quotes)
    return sentence.format_map(shown).translate(marks)


AS_TYPED = frozenset({"code", "gap", "program", "rubric"})
"""Kinds whose answers are words, or what a program prints: their points are no decimal signs."""


def format_read_back(kind: str, read_as: str, lang: str) -> str:
    """Return what was read of an answer of a kind, with words and decimal sign of a language."""
    if kind == "tf":
        return name_truth(kind, read_as, lang)
    return read_as if kind in AS_TYPED else localise_numbers(lang, read_as)


def name_truth(kind: str, answer: str, lang: str) -> str:
    """Return the answer to a statement in the words it was asked in; any other answer as it is.

    Pages and forms hold ``true`` and ``false``, whatever the language.
    """
    told = kind == "tf" and answer in {"true", "false"}
    return translate(fallback_language(lang), f"ask.{answer}") if told else answer


ECHOED = frozenset({"found", "typed"})
"""Fields that hold what the learner typed: it stands in quotation marks."""


def _is_quotable(value: object) -> bool:
    """Whether a field is a text of its own; a bare number is a count of something."""
    return isinstance(value, str) and bool(value) and not value.isdigit()


_NAMES = frozenset({"names", "detail"})
"""Fields that name quantities."""
_PROGRAM_TEXT = frozenset({"call", "code", "got"})
"""Fields that are program text, whose points are no decimal signs."""


def _format_message_field(lang: str, key: str, value: object) -> str:
    """Return what a blank is filled with; names of quantities and powers as people write them."""
    if key in _PROGRAM_TEXT:
        return _format_shown_value(lang, value)
    if key == "power":
        return pretty.format_power_of_ten(str(value))
    if key in _NAMES and isinstance(value, (tuple, list)):
        value = tuple(pretty.format_name(str(item)) for item in value)
    elif key in _NAMES:
        value = pretty.format_formula(str(value))
    return localise_numbers(lang, _format_shown_value(lang, value))


def _keep_filled_clause(clause: str, shown: Mapping[str, str]) -> str:
    """Return a clause, or an empty text if one of its blanks has nothing to fill it in."""
    return clause if all(shown.get(name) for name in re.findall(r"{(\w+)}", clause)) else ""


class _Blanks(dict[str, str]):
    """The texts for a sentence's blanks; one that is missing never fails the sentence."""

    def __missing__(self, key: str) -> str:
        """Return an ellipsis for a blank that nothing fills."""
        del key
        return "…"


def _format_shown_value(lang: str, value: object) -> str:
    """Return a value as text, a list with commas, shortened and without control characters."""
    if isinstance(value, (tuple, list)):
        names = load_words_inside(lang)
        return ", ".join(
            dict.fromkeys(safe_echo(names.get(str(item), str(item))) for item in value)
        )
    return safe_echo(str(value), 120)

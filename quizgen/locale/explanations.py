"""What a diagnostic says in the language of an author: ``locale/<lang>/diagnostics.toml``.

English is what the checks say themselves. In another language the sentence of the rule comes first
and the English one, which has the names and numbers of the place, in brackets after it. What has no
rule, such as an error about a class, is translated by its sentence: ``locale/<lang>/errors.toml``.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from functools import cache

import msgspec

from quizgen.core.diagnostics import CODES, Diagnostic
from quizgen.locale import FIRST, SHIPPED


def list_explained_languages() -> list[str]:
    """Return the languages that diagnostics are said in, English first."""
    return [FIRST, *sorted(file.parent.name for file in SHIPPED.glob("*/diagnostics.toml"))]


@cache
def load_explanations(lang: str) -> dict[str, list[str]]:
    """Return code to what is wrong and, where there is one, what mends it."""
    file = SHIPPED / lang / "diagnostics.toml"
    return tomllib.loads(file.read_text("utf-8")) if file.exists() else {}


def explain_diagnostic(diagnostic: Diagnostic, lang: str) -> Diagnostic:
    """Return a diagnostic in a language; unchanged where that has no sentence for its rule.

    A hint that a check wrote for this place stays as it is, since it names what to write there.
    """
    found = load_explanations(lang).get(diagnostic.code)
    if lang == FIRST or found is None:
        return diagnostic
    hint = diagnostic.hint
    if hint == CODES[diagnostic.code].hint:
        hint = "".join(found[1:])
    message = explain_message(diagnostic.code, diagnostic.message, lang)
    return msgspec.structs.replace(diagnostic, message=message, hint=hint)


def explain_message(code: str, message: str, lang: str) -> str:
    """Return a message of a rule in a language, without what mends it."""
    found = load_explanations(lang).get(code)
    if lang == FIRST or found is None:
        return message
    return f"{found[0].removesuffix('.')} ({message})"


def choose_explained_language(langs: Sequence[str]) -> str:
    """Return the language that authors of a bank are told in: its first, English where it has it.

    English, too, where there are no explanations in that language.
    """
    lang = next(iter(langs), FIRST)
    return lang if FIRST not in langs and lang in list_explained_languages() else FIRST


@cache
def load_error_patterns(lang: str) -> tuple[tuple[re.Pattern[str], str], ...]:
    """Return what matches each English sentence of an error, and the sentence for it."""
    file = SHIPPED / lang / "errors.toml"
    said = tomllib.loads(file.read_text("utf-8"))["sentences"] if file.exists() else {}
    found = []
    for english in sorted(said, key=len, reverse=True):
        pieces = _BLANK.split(english)
        body = "".join(
            f"(?P<at{piece}>.*?)" if place % 2 else re.escape(piece)
            for place, piece in enumerate(pieces)
        )
        found.append((re.compile(f"(?P<place>(?:.*?: )?){body}"), said[english]))
    return tuple(found)


def translate_error(message: str, lang: str) -> str:
    """Return an error in a language, after its place; as it is if it is none of the listed."""
    for pattern, sentence in load_error_patterns(lang):
        if match := pattern.fullmatch(message):
            place = _LINE.sub(TRANSLATED_LINE.get(lang, r"\g<0>"), match["place"])
            return place + _BLANK.sub(lambda blank: match[f"at{blank[1]}"], sentence)
    return message


_BLANK = re.compile(r"\{(\d)\}")
_LINE = re.compile(r"\bline (\d+)")
TRANSLATED_LINE = {"de": r"Zeile \1"}
"""How the place of an error names a line."""

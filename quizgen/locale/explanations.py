"""What a diagnostic says in the language of an author: ``locale/<lang>/diagnostics.toml``.

English is what the checks say themselves. In another language the sentence of the rule comes first
and the English one, which has the names and numbers of the place, in brackets after it.
"""

from __future__ import annotations

import tomllib
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
    message = f"{found[0].removesuffix('.')} ({diagnostic.message})"
    return msgspec.structs.replace(diagnostic, message=message, hint=hint)

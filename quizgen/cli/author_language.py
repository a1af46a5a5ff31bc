"""In which language an error is told: that of the command, else that of the bank it is about."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from contextlib import suppress
from itertools import chain
from pathlib import Path

from quizgen.core.errors import QuizgenError
from quizgen.core.untrusted import parse_toml
from quizgen.locale import FIRST

LANGUAGE = "--lang"
TEMPLATES = "templates"
CLASS = "class.toml"


def explain_error(error: QuizgenError, arguments: Sequence[str] | None = None) -> str:
    """Return an error in one line, by the words of lint in the author's language.

    Parameters
    ----------
    error : QuizgenError
    arguments : sequence of str, optional
        Of the command, which may name a language; those of the process if they are not given.
    """
    from quizgen.locale.explanations import (
        explain_diagnostic,
        list_explained_languages,
        translate_error,
    )

    given = sys.argv[1:] if arguments is None else arguments
    lang = _find_option(given, LANGUAGE) or _find_bank_language(error.file) or _find_lang(given)
    if lang not in list_explained_languages()[1:]:
        return str(error)
    if not error.rule or error.file is None:
        return translate_error(str(error), lang)
    said = explain_diagnostic(error.diagnostic(error.file), lang)
    hint = f"; {said.hint}" if said.hint else ""
    return f"{str(error).removesuffix(error.message)}{said.message}{hint}"


def _find_option(arguments: Sequence[str], option: str) -> str:
    """Return what a command line gives for an option; empty if it does not give it."""
    for place, argument in enumerate(arguments):
        if argument == option:
            return "".join(arguments[place + 1 : place + 2])
        if argument.startswith(f"{option}="):
            return argument.removeprefix(f"{option}=")
    return ""


def _find_lang(arguments: Sequence[str]) -> str:
    """Return the language of the class or of the bank that a command line names; else empty."""
    for file in (Path(argument, CLASS) for argument in arguments):
        with suppress(OSError, ValueError, QuizgenError):  # the error that is told may be of it
            return str(parse_toml(file.read_text("utf-8"), file, QuizgenError).get("lang", ""))
    bank = _find_option(arguments, "--bank")
    return _find_bank_language(Path(bank, TEMPLATES, "bank.toml")) if bank else ""


def _find_bank_language(file: Path | None) -> str:
    """Return the language in which the bank of a file is written; English if that is one of them.

    The questions beside the file tell, else the first of its bank.
    """
    for folder in file.absolute().parents if file else ():
        texts = [*folder.glob("*.md")] or [
            *chain.from_iterable(
                one.glob("*.md") for one in sorted(folder.glob(f"{TEMPLATES}/*/*"))
            )
        ]
        langs = sorted({text.stem for text in texts if len(text.stem) == len(FIRST)})
        if langs or (folder / TEMPLATES).is_dir():
            return FIRST if FIRST in langs else "".join(langs[:1])
    return ""

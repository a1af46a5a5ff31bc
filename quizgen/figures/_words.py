"""Figures in words: ``<lang>.toml`` beside the modules of figures."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from quizgen.errors import BankError
from quizgen.locale import FIRST
from quizgen.outside import located, read_bytes


@cache
def words_of(module: str, lang: str) -> dict[str, str]:
    """Sentences of a figure, from ``<lang>.toml`` beside it; in English where there is none.

    Parameters
    ----------
    module : str
        ``__file__`` of the figure; its table is called as the file is, without the suffix.
    lang : str
        A language.

    Raises
    ------
    BankError
        If there is no such file, it is no TOML, or it has no table of this figure.
    """
    place = Path(module)
    file = place.with_name(f"{lang}.toml")
    if not file.is_file():
        file = place.with_name(f"{FIRST}.toml")
    sentences = _table(file).get(place.stem)
    if not isinstance(sentences, dict):
        raise BankError(f"{file}: no table [{place.stem}], the figure's sentences")
    return sentences


def forget_words() -> None:
    """Have the sentences of all figures read again."""
    words_of.cache_clear()
    _table.cache_clear()


@cache
def _table(file: Path) -> dict[str, Any]:
    with located(file, BankError):
        return tomllib.loads(read_bytes(file, BankError).decode())

"""``quizgen mark --batch``: JSON Lines in, JSON Lines out, in constant memory."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import msgspec

from quizgen.core.decoding import json_decoder
from quizgen.core.errors import QuizgenError
from quizgen.kinds.grade import grade_answer


class BatchItem(msgspec.Struct):
    """One answer to mark."""

    spec: dict[str, Any]
    typed: str
    lang: str = "en"
    decimal: str = "auto"


_DECODER = json_decoder(BatchItem)
_ENCODER = msgspec.json.Encoder()


def grade_lines(lines: Iterable[bytes | str]) -> Iterator[bytes]:
    """Yield the verdict on each line; a line that is no task becomes a line with ``error``.

    Parameters
    ----------
    lines : iterable of bytes or str
        ``{"spec": {...}, "typed": "...", "lang": "en", "decimal": "auto"}``.

    Yields
    ------
    bytes
        One JSON object per line that is not blank, without line end, in order.
    """
    for number, line in enumerate(lines, 1):
        if line.strip():
            yield _ENCODER.encode(_one(line, number))


def _one(line: bytes | str, number: int) -> dict[str, Any]:
    """Return the verdict on one line as a table, or a table with ``error``."""
    try:
        task = _DECODER.decode(line)
        return grade_answer(task.spec, task.typed, lang=task.lang, decimal=task.decimal).as_json()
    except (msgspec.MsgspecError, QuizgenError, UnicodeDecodeError, RecursionError) as error:
        return {"error": f"line {number}: {error}"}

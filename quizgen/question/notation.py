"""A composed question with its numbers as a language writes them.

Numbers come with a decimal point, from draws, templates and figures. What a learner reads of them
gets the sign of its language here, once it is all put together; formulas get it where they are
written. Programs, keys and what is typed back stay as they are.
"""

from __future__ import annotations

from typing import Any, TypeVar

import msgspec
from msgspec.structs import replace

from quizgen.bank.prose import Code, CodeBlock, Formula, Slot, Words
from quizgen.figures import Drawing
from quizgen.locale import language, numbers_in
from quizgen.question.contract import Control
from quizgen.question.shown import Maths

Said = TypeVar("Said")
LEFT = (Code, CodeBlock, Control, Drawing, Formula, Slot)
"""What has no numbers for a learner, or its own way to write them."""


def in_notation(lang: str, said: Said) -> Said:
    """What is said in a language, with the decimal sign of that language.

    Parameters
    ----------
    lang : str
    said : prose, or a structure that holds some
        Whatever else it holds stays as it is.
    """
    return said if language(lang).decimal == "." else _written(lang, said)


def _written(lang: str, said: Any) -> Any:
    if isinstance(said, Words):
        return Words(numbers_in(lang, said.text))
    if isinstance(said, Maths):
        return replace(said, lang=lang)
    if isinstance(said, tuple):
        parts = [_written(lang, part) for part in said]
        return said._make(parts) if hasattr(said, "_make") else tuple(parts)
    if isinstance(said, msgspec.Struct) and not isinstance(said, LEFT):
        names = said.__struct_fields__
        return replace(said, **{name: _written(lang, getattr(said, name)) for name in names})
    return said

"""A composed question with its numbers as a language writes them.

Numbers come with a decimal point, from draws, templates and figures. What a learner reads of them
gets the sign of its language here, once it is all put together; formulas get it where they are
written. Programs, keys and what is typed back stay as they are.
"""

from __future__ import annotations

import re
from typing import Any, TypeVar

import msgspec
from msgspec.structs import replace

from quizgen.bank.pictures import PictureFile
from quizgen.bank.prose import Code, CodeBlock, Formula, Slot, Words
from quizgen.figures import FieldPicture
from quizgen.locale import from_right, language, numbers_in
from quizgen.question.contract import Control
from quizgen.question.shown import Maths

Said = TypeVar("Said")
LEFT = (Code, CodeBlock, Control, FieldPicture, Formula, PictureFile, Slot)
"""What has no numbers for a learner, or its own way to write them."""
_LEFT_TO_RIGHT = "\u200e"
"""What stands behind it is written so, as far as it can be either way: signs, digits, blanks."""
_WITH_UNIT = re.compile(r"(?<![\w.,])[−+-]?\d[\d.,\u202f]*[ \u00a0](?=[A-Za-zµ°Ω%])")
"""A number before a unit, which would else stand to the right of it among other letters."""


def in_notation(lang: str, said: Said) -> Said:
    """What is said in a language, with the decimal sign of that language.

    Parameters
    ----------
    lang : str
    said : prose, or a structure that holds some
        Whatever else it holds stays as it is.
    """
    as_it_is = language(lang).decimal == "." and not from_right(lang)
    return said if as_it_is else _written(lang, said)


def _written(lang: str, said: Any) -> Any:
    if isinstance(said, Words):
        text = numbers_in(lang, said.text)
        return Words(_WITH_UNIT.sub(rf"{_LEFT_TO_RIGHT}\g<0>", text) if from_right(lang) else text)
    if isinstance(said, Maths):
        return replace(said, lang=lang)
    if isinstance(said, tuple):
        parts = [_written(lang, part) for part in said]
        return said._make(parts) if hasattr(said, "_make") else tuple(parts)
    if isinstance(said, msgspec.Struct) and not isinstance(said, LEFT):
        names = said.__struct_fields__
        return replace(said, **{name: _written(lang, getattr(said, name)) for name in names})
    return said

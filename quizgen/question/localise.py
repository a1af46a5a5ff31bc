"""A composed question with its numbers as a language writes them.

Numbers come with a decimal point, from variants, templates and figures. What a learner reads of
them gets the sign of its language here, once it is all put together; formulas get it where they are
written. Programs, keys and what is typed back stay as they are.
"""

from __future__ import annotations

import re
from typing import Any, TypeVar

import msgspec
from msgspec.structs import replace

from quizgen.bank.pictures import PictureFile
from quizgen.figures import FieldPicture
from quizgen.kinds.contract import InputControl
from quizgen.locale import get_language, is_right_to_left, localise_numbers
from quizgen.typeset.prose import (
    CodeBlock,
    InlineCode,
    InlineFormula,
    LaidOutFormula,
    PlainText,
    Slot,
    TypesetMaths,
)

Localisable = TypeVar("Localisable")
LEFT = (
    InlineCode,
    CodeBlock,
    InputControl,
    FieldPicture,
    InlineFormula,
    LaidOutFormula,
    PictureFile,
    Slot,
)
"""What has no numbers for a learner, or its own way to write them."""
_LEFT_TO_RIGHT = "\u200e"
"""What stands behind it is written so, as far as it can be either way: signs, digits, blanks."""
_WITH_UNIT = re.compile(r"(?<![\w.,])[−+-]?\d[\d.,\u202f]*[ \u00a0](?=[A-Za-zµ°Ω%])")
"""A number before a unit, which would else stand to the right of it among other letters."""


def localise(lang: str, said: Localisable) -> Localisable:
    """Return blocks or inlines with their numbers as a language writes them.

    Parameters
    ----------
    lang : str
    said : prose, or a structure that holds some
        Whatever else it holds stays as it is.
    """
    as_it_is = get_language(lang).decimal == "." and not is_right_to_left(lang)
    return said if as_it_is else _localise_inlines(lang, said)


def _localise_inlines(lang: str, said: Any) -> Any:
    """Return the same structure with its numbers as the language writes them.

    It goes into tuples and structs of any kind, but into none of ``LEFT``. In a language that
    is read from right to left, numbers with a unit are marked to stay together.
    """
    if isinstance(said, PlainText):
        text = localise_numbers(lang, said.text)
        return PlainText(
            _WITH_UNIT.sub(rf"{_LEFT_TO_RIGHT}\g<0>", text) if is_right_to_left(lang) else text
        )
    if isinstance(said, TypesetMaths):
        return replace(said, lang=lang)
    if isinstance(said, tuple):
        parts = [_localise_inlines(lang, part) for part in said]
        return said._make(parts) if hasattr(said, "_make") else tuple(parts)
    if isinstance(said, msgspec.Struct) and not isinstance(said, LEFT):
        names = said.__struct_fields__
        return replace(
            said, **{name: _localise_inlines(lang, getattr(said, name)) for name in names}
        )
    return said

"""Regular expressions that are compiled when they are first asked.

Marking knows two hundred of them, and compiling all would take longer than most answers need: a
paper is made without any, and an answer asks those of its kind.
"""

from __future__ import annotations

import re
from typing import Any, cast


class _Pattern:
    """Stands for a pattern; what it is asked for is the compiled one's from then on."""

    def __init__(self, text: str, flags: int) -> None:
        self._given = text, flags
        self.pattern = text

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):  # nobody's question to a pattern, but copying asks such things
            raise AttributeError(name)
        found = getattr(re.compile(*self._given), name)
        setattr(self, name, found)
        return found


def lazy(text: str, flags: int = 0) -> re.Pattern[str]:
    """Give a pattern that is compiled when it is first asked.

    Parameters
    ----------
    text : str
        A regular expression.
    flags : int
        As ``re.compile`` takes them.
    """
    return cast("re.Pattern[str]", _Pattern(text, flags))

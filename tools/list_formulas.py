"""Write the list of what formulas may hold: ``uv run python tools/do.py formulas``."""

from __future__ import annotations

import re
from pathlib import Path

from quizgen.typeset.latex_commands import GROUPS

PAGE = Path(__file__).parent.parent / "docs" / "formulas.md"
_LIST = re.compile(r"(?<=<!-- commands -->\n).*?(?=<!-- end of commands -->)", re.DOTALL)


def list_commands() -> str:
    """A table of every example, a row each group."""
    rows = [
        f"| {group} | {' '.join(map(_quote, examples))} |" for group, examples in GROUPS.items()
    ]
    return "\n".join(["| | |", "|---|---|", *rows, ""])


def _quote(example: str) -> str:
    """An example as code in a cell of a table."""
    return f"`{example}`".replace("|", r"\|")


def write_list(page: str) -> str:
    """The page with the list as it is now."""
    table = list_commands()
    return _LIST.sub(lambda _found: table, page)


def main() -> None:
    """Write the page."""
    PAGE.write_text(write_list(PAGE.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()

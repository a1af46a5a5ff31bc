"""Measure again what accuracy costs and put table and plots into ``docs/accuracy.md``."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

PAGE = Path("docs/accuracy.md")
PLOTS = ("overview", "gaussian-tail-input", "iterations")
"""Those that the page shows, kept beside it."""
MEASURED = re.compile(r"^`quizgen tradeoff` on .*?(?=\n\n[^|`>])", re.DOTALL | re.MULTILINE)
"""From the machine and the sentence to the last row of the table."""


def main() -> None:
    """Run the command that the page names, and copy what came out."""
    with TemporaryDirectory() as folder:
        made = Path(folder)
        subprocess.run(["quizgen", "tradeoff", "--out", folder], check=True)
        for name in PLOTS:
            shutil.copy(made / f"{name}.svg", PAGE.with_suffix("") / f"{name}.svg")
        table, _, _ = (made / "tradeoff.md").read_text("utf-8").rstrip().rpartition("\n\n")
    text = PAGE.read_text("utf-8")
    PAGE.write_text(MEASURED.sub(lambda _: table, text, count=1), "utf-8")


if __name__ == "__main__":
    main()

"""The figures that docs/figures.md shows whole, for tests, benchmarks and its pictures."""

from __future__ import annotations

import re
from pathlib import Path

from quizgen.bank.solvers import import_module_file

PAGE = Path(__file__).parents[2] / "docs" / "figures.md"
_BLOCK = re.compile(
    r"```(python|toml|markdown)\n(?:# |<!-- )(\S+?\.\w+)(?: -->)?\n(.*?)```", re.DOTALL
)


def read_blocks() -> dict[str, str]:
    """File name, as the first line of a block says it, to the block."""
    return {name: text for _, name, text in _BLOCK.findall(PAGE.read_text(encoding="utf-8"))}


def load_examples(folder: Path):
    """Write the figures of the page into a folder and import them: name to module."""
    folder.mkdir(parents=True, exist_ok=True)
    found = {}
    for file, text in read_blocks().items():
        if file.endswith(".py"):
            name = "box_plot" if file == "figure.py" else Path(file).stem
            (folder / f"{name}.py").write_text(text, encoding="utf-8")
            found[name] = import_module_file(folder, name)
    return found


VALUES = {"box_plot": {"A": [8, 12, 14, 15, 19], "B": [13, 15, 16, 20, 25]}}
"""Of examples whose parameters have no defaults."""

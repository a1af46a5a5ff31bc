"""Refresh the exact versions in ``pyproject.toml``: ``uv run python tools/pin.py``.

Writes what the current environment has, by name and version only, into
``[tool.uv] constraint-dependencies``; a lock file would record index addresses.
"""

from __future__ import annotations

import re
from importlib.metadata import distributions
from pathlib import Path

FILE = Path(__file__).parent.parent / "pyproject.toml"


def list_pins() -> list[str]:
    """Return ``name==version`` of every installed package but this one, sorted."""
    found = {re.sub(r"[-_.]+", "-", d.metadata["Name"]).lower(): d.version for d in distributions()}
    found.pop("quizgen", None)
    return [f"{name}=={version}" for name, version in sorted(found.items())]


def main() -> None:
    """Rewrite the versions in ``pyproject.toml``."""
    pins = list_pins()
    block = "constraint-dependencies = [\n" + "".join(f'    "{pin}",\n' for pin in pins) + "]"
    text = FILE.read_text(encoding="utf-8")
    new = re.sub(r"constraint-dependencies = \[[^\]]*\]", block, text)
    for pin in pins:  # what a wheel is built with
        new = re.sub(rf'"{pin.partition("==")[0]}==[^"]*"', f'"{pin}"', new)
    FILE.write_text(new, encoding="utf-8")


if __name__ == "__main__":
    main()

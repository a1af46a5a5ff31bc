"""Commands to be printed: in the form in which the user started this one, ready to be pasted."""

from __future__ import annotations

import os
import shlex
import shutil
import sys
from pathlib import Path


def command(*arguments: str | Path) -> str:
    """A quizgen command that works from where the user stands."""
    return joined([*_started(), *map(str, arguments)])


def joined(words: list[str]) -> str:
    """Words as a line of the shell."""
    if os.name == "nt":
        from subprocess import list2cmdline

        return list2cmdline(words)
    return shlex.join(words)


def _started() -> list[str]:
    """How this program was started: by uv, as a module, or by its name or path."""
    if os.environ.get("UV_RUN_RECURSION_DEPTH"):
        return ["uv", "run", *_project(), "quizgen"]
    script = Path(sys.argv[0])
    if script.name == "__main__.py":
        return [_found(Path(sys.executable)), "-m", "quizgen"]
    return [_found(script) if script.stem == "quizgen" else "quizgen"]


def _project() -> list[str]:
    """What uv must be told if the user stands outside the project."""
    home = Path(sys.prefix).parent
    inside = Path.cwd().is_relative_to(home) or not (home / "pyproject.toml").exists()
    return [] if inside else ["--project", str(home)]


def _found(program: Path) -> str:
    """A program's name if the shell finds the same one by it, else its path."""
    found = shutil.which(program.name)
    return program.name if found and Path(found).samefile(program) else str(program)

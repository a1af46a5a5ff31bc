"""The commands that people use: ``uv run python tools/do.py NAME``; see ``COMMANDS``."""

from __future__ import annotations

import subprocess
import sys

FOLDERS = ("quizgen", "solvers", "templates", "tests", "benchmarks", "tools")
"""Where Python stands that is formatted."""
COMMANDS: dict[str, tuple[list[str], ...]] = {
    "test": (["pytest"],),
    "style": (
        ["ruff", "check"],
        ["ruff", "format", "--check", *FOLDERS],
        ["mypy"],
        [sys.executable, "tools/measure.py"],
    ),
    "proof": (["quizgen", "lint", "--seeds", "1000"],),
    "speed": (
        [sys.executable, "benchmarks/bank.py"],
        [sys.executable, "benchmarks/papers.py"],
        [sys.executable, "benchmarks/figures.py"],
        [sys.executable, "benchmarks/marking.py"],
        [sys.executable, "benchmarks/web.py"],
    ),
    "counts": ([sys.executable, "tools/count.py"],),
    "accuracy": ([sys.executable, "tools/accuracy.py"],),
    "bounds": ([sys.executable, "tests/numerics/prove.py"],),
    "pins": ([sys.executable, "tools/pin.py"],),
    "fonts": ([sys.executable, "tools/pack_fonts.py"],),
    "formulas": ([sys.executable, "tools/list_formulas.py"],),
    "figures": ([sys.executable, "tools/figures.py"],),
    "picture": ([sys.executable, "tools/picture.py"],),
    "docs": (
        [
            "uv",
            "run",
            "--group",
            "docs",
            "sphinx-build",
            "-W",
            "--keep-going",
            "-q",
            "docs",
            "site",
        ],
    ),
    "mutants": ([sys.executable, "tools/mutate.py"],),
    "scenes": ([sys.executable, "tools/scenes.py"],),
}
"""What to type, and what it runs."""


def main(names: list[str]) -> int:
    """Run the commands of each name, up to the first that fails; return its exit code."""
    unknown = [name for name in names if name not in COMMANDS]
    if unknown or not names:
        print(f"usage: tools/do.py {'|'.join(COMMANDS)}", file=sys.stderr)
        return 2
    return next(
        (
            code
            for name in names
            for command in COMMANDS[name]
            if (code := subprocess.run(command, check=False).returncode)
        ),
        0,
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

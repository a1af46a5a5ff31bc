"""The console blocks of the documents: what is typed, what is shown, and a place to type it.

A line of a block is a command. A block ``text`` that follows a block is what its last command
prints, where ``...`` stands for what differs from run to run. A comment ``<!-- file: NAME -->``
before a block says that the reader saves it under that name.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parent.parent
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
CHECKOUT = ("quizgen", "solvers", "templates", "pyproject.toml", "uv.lock", "README.md")

_BLOCK = re.compile(
    r"^(?:<!-- file: (?P<file>\S+) -->\n)?```(?P<language>\w*)\n(?P<body>.*?)^```$",
    re.DOTALL | re.MULTILINE,
)


INTERRUPTED = 130


class Step(NamedTuple):
    """A command of a page, or (with a name) a file that is saved before the next one."""

    line: int
    text: str
    shown: str = ""
    file: str = ""


def languages(page: Path) -> set[str]:
    """What the blocks of a page say they are."""
    return {block["language"] for block in _BLOCK.finditer(page.read_text("utf-8"))}


def steps(page: Path) -> list[Step]:
    """What a reader does who follows a page from top to bottom."""
    text, found, end = page.read_text("utf-8"), list[Step](), 0
    for block in _BLOCK.finditer(text):
        line = text.count("\n", 0, block.start()) + 2
        follows = not text[end : block.start()].strip()
        if block["file"]:
            found.append(Step(line, block["body"], file=block["file"]))
        elif block["language"] == "console":
            found += _commands(block["body"], line)
            end = block.end()
        elif block["language"] == "text" and found and follows:
            found[-1] = found[-1]._replace(shown=block["body"])
    return found


def _commands(body: str, line: int) -> Iterator[Step]:
    for number, text in enumerate(body.splitlines(), line):
        if text.strip() and not text.startswith("#"):
            yield Step(number, text)


def typed(step: Step) -> str:
    """A command without the remark behind it."""
    return re.sub(r"\s+#\s.*", "", step.text)


def save(step: Step, folder: Path) -> None:
    """Save a file of a page where the page says."""
    file = folder / step.file
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(step.text, "utf-8")


def checkout(folder: Path) -> Path:
    """A copy of the project, so that a command may change it."""
    for source in filter(Path.exists, (ROOT / name for name in CHECKOUT)):
        (shutil.copytree if source.is_dir() else shutil.copy2)(source, folder / source.name)
    return folder


def run(text: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Type a line in a checkout; ``uv`` takes this environment as it is, without the network."""
    environment = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith(("UV", "PYTHON", "VIRTUAL_ENV", "COLUMNS"))
    }
    environment |= {
        "PYTHONPATH": str(folder),
        "UV_PROJECT_ENVIRONMENT": sys.prefix,
        "UV_NO_SYNC": "1",
        "UV_OFFLINE": "1",
        "XDG_CONFIG_HOME": str(folder / "settings"),
        "XDG_DATA_HOME": str(folder / "data"),
        "BROWSER": "true",
    }
    if re.search(r"\bquizgen serve\b", text):
        return _served(text, folder, environment)
    return subprocess.run(text, shell=True, cwd=folder, env=environment, capture_output=True,
                          text=True, stdin=subprocess.DEVNULL, check=False)  # fmt: skip


def _served(
    text: str, folder: Path, environment: dict[str, str]
) -> subprocess.CompletedProcess[str]:
    """A server, ended by Ctrl-C as soon as it has said where it is."""
    with subprocess.Popen(f"exec {text}", shell=True, cwd=folder, env=environment, text=True,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, start_new_session=True) as server:  # fmt: skip
        said = server.stdout.readline()
        os.killpg(server.pid, signal.SIGINT)
        rest, errors = server.communicate(timeout=60)
    ended = 0 if server.returncode == INTERRUPTED else server.returncode  # what uv makes of Ctrl-C
    return subprocess.CompletedProcess(text, ended, said + rest, errors)


def agrees(shown: str, printed: str) -> bool:
    """Whether a page shows what was printed: a line ``...`` stands for any lines, also for none.

    The environment lies outside the copy, which is why uv must be told the project.
    """
    printed = re.sub(r" --project (?:'[^']*'|\S+)", "", printed)
    pattern = "".join(
        r"(?:[^\n]*\n)*?" if line == "..." else re.escape(line).replace(r"\.\.\.", ".*") + r"\n"
        for line in shown.strip().splitlines()
    )
    return re.fullmatch(pattern, printed.strip() + "\n") is not None

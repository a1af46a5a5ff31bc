"""Which check of quizgen finds what: read from the source, so that no list can be out of date.

A check is a function that says a message. What lint looks for itself stands in ``AUDIT``; what is
found while a bank is read is told by the module that reads.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

PACKAGE = Path(__file__).parents[2] / "quizgen"
AUDIT = ("audit/decks.py", "audit/dimensions.py", "audit/lacking.py", "audit/leaks.py",
         "audit/lint.py", "audit/looks.py", "audit/pictures.py", "audit/teach.py", "cli/lint.py")  # fmt: skip
READING = (
    "bank",
    "kinds",
    "maths",
    "marking",
    "figures",
    "question",
    "cards",
    "locale",
    "outside.py",
)
"""What reads banks and complains."""
ELSEWHERE = {
    "quizgen.lint.item_quality:examine", "quizgen.lint.item_quality:_pool_findings",
    "quizgen.cli.lint:lint", "quizgen.cli.lint:_told", "quizgen.cli.lint:_tells",
    "quizgen.cli.lint:_said",
}  # fmt: skip
"""What ``lint`` says with ``--teach`` and ``--papers`` alone, its help, and of errors of quizgen."""
HANDED_ON = {
    "quizgen.bank.solvers:authored": r"^\S+: \w+(?:Error|Exit): ",
    "quizgen.maths.notation:parse": r"part \d+: column \d+: ",
}
"""What hands on errors that it does not word itself, and what they look like."""
FEWEST = 8
"""Letters that a message has at least, blanks aside."""
BLANK = None
Pieces = tuple[str | None, ...]


class Saying(NamedTuple):
    """A message as it stands in the source: which check says it, its words, and blanks between."""

    check: str
    pieces: Pieces

    @property
    def letters(self) -> int:
        """How much of a message is told by it."""
        return sum(len(piece) for piece in self.pieces if piece)

    @property
    def pattern(self) -> str:
        """What the message looks like when it is filled in; its place may be told before it."""
        rest = self.pieces
        while len(rest) > 1 and rest[0] is BLANK and (rest[1] or "").startswith((": ", ".md: ")):
            rest = ((rest[1] or "").partition(": ")[2], *rest[2:])
        told = "".join(".*" if piece is BLANK else re.escape(piece) for piece in rest)
        return re.sub(
            r"^(?:solver:\\ |\.\*/\w+\\\.toml:\\ |no\\ \.\*)", lambda m: _place(m[0]), told
        )


def _place(said: str) -> str:
    """The place that a message begins with, which is told elsewhere."""
    return said if said.startswith("no") else ""


@cache
def sayings(*files: str) -> tuple[Saying, ...]:
    """Every text of functions of these files and folders that may be a message."""
    paths = [path for name in files for path in
             ([PACKAGE / name] if name.endswith(".py") else sorted((PACKAGE / name).rglob("*.py")))]  # fmt: skip
    return tuple(saying for path in paths for saying in _of_file(path))


def _of_file(path: Path) -> Iterator[Saying]:
    module = ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts)
    tree = ast.parse(path.read_text("utf-8"))
    for function in [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]:
        for text in _texts(function):
            found = Saying(f"{module}:{function.name}", tuple(_pieces(text)))
            if found.check not in ELSEWHERE and _is_message(found):
                yield found


def _is_message(saying: Saying) -> bool:
    """Whether a text is long enough for a message, and none that goes on where another ends."""
    first, spaced = saying.pieces[0] or "", any(" " in (one or "") for one in saying.pieces)
    return spaced and (saying.letters >= FEWEST or first == "no ") and not first.startswith(";")


def _texts(function: ast.FunctionDef) -> Iterator[ast.expr]:
    """Texts that a function gives back, raises or adds: no docstring, and no mere part of one."""
    parents = {child: node for node in ast.walk(function) for child in ast.iter_child_nodes(node)}
    for node in ast.walk(function):
        if not isinstance(node, ast.JoinedStr | ast.Constant):
            continue
        if isinstance(node, ast.Constant) and not isinstance(node.value, str):
            continue
        above = parents[node]
        note = isinstance(above, ast.Tuple) and _is_note(above)
        called = isinstance(above, ast.Call) and not _says(above, parents[above])
        part = isinstance(above, ast.Assign | ast.Expr | ast.JoinedStr | ast.FormattedValue
                          | ast.Attribute | ast.BoolOp | ast.Compare | ast.Subscript)  # fmt: skip
        if not (note or called or part):
            yield node


def _says(call: ast.Call, above: ast.AST) -> bool:
    """Whether what is called takes messages: an error that is raised, or a list of them."""
    name = getattr(call.func, "attr", None) or getattr(call.func, "id", "")
    return isinstance(above, ast.Raise) or name in {"append", "complaint", "_complaint"}


def _is_note(pair: ast.Tuple) -> bool:
    """Whether it is what ``lint --teach`` alone says."""
    first = pair.elts[0]
    return isinstance(first, ast.Constant) and first.value == "note"


def _pieces(text: ast.expr) -> Iterator[str | None]:
    for part in text.values if isinstance(text, ast.JoinedStr) else [text]:
        yield str(part.value) if isinstance(part, ast.Constant) else BLANK


def said_by(message: str) -> str:
    """The check that says a message: of all that may, the one that tells most of it."""
    for check, pattern in HANDED_ON.items():
        if re.search(pattern, message):
            return check
    own, read = sayings(*AUDIT), sayings(*READING)
    every = (*own, *read) if message.startswith("templates/cards/") else (*read, *own)
    fitting = [one for one in every if re.search(one.pattern, message)]
    return max(fitting, key=lambda one: one.letters).check if fitting else ""

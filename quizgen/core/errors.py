"""Every error a caller may see, as one tree.

::

    QuizgenError
    |-- BankError        a template, solver or bank folder is wrong (names file and place)
    |-- BlueprintError   a blueprint file is wrong (names file, key and what is allowed)
    |-- SamplingError    a template cannot produce an admissible draw
    |-- MathError        a formula has no value for these numbers (pole, negative root, ...)
    |   `-- UndecidedError  the value is too close to a branch point to certify
    |-- FormulaError     mathematics typed by an author or a student cannot be read
    |-- PaperCodeError   a paper's code cannot be rebuilt here
    |-- RenderError      an output could not be made or written
    |-- StoreError       the database of the browser's server, or its port, cannot be opened
    |-- KeyFileError     a key or an answer file cannot be read
    |-- WorkerError      processes that did the work died, one after the other
    |-- ClassError       a class's roster or folder is wrong, or would be spoiled
    |-- MissingExtraError  packages of an extra are not installed (says what to type)
    |-- AttemptFinishedError  a part in practice is answered again after it has ended
    `-- InvalidChoiceError  an argument is none of the values allowed (names them)

Two more are defined with their subject: ``SceneError`` in ``camera.setup.scene``, and
``FormulaReadError`` in ``maths.notation.lexer``, the ``FormulaError`` that knows what was found and
what was expected.
``DomainError`` in ``numerics.domain`` is a plain ``ValueError``: array functions know nothing of
quizgen.

What a student types never raises out of the checker: it becomes a verdict.
"""

from __future__ import annotations

from collections.abc import Collection
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from quizgen.core.diagnostics import Diagnostic
    from quizgen.core.positions import Place

# Extra of pyproject.toml to the modules that are imported of it. Without "image" the same pictures
# are computed, only more slowly; "lms" and "anki" need no packages yet; "circuits" is for figures
# of banks; without "irt" tables of earlier classes have classical values alone.
EXTRA_MODULES = {
    "web": (
        "starlette", "uvicorn", "python_multipart", "sqlalchemy", "alembic", "fsrs", "argon2",
        "segno",
    ),
    "class": ("xlsxwriter", "segno"),
    "lms": (),
    "anki": (),
    "print": ("pikepdf",),
    "postgres": ("psycopg",),
    "cluster": ("distributed",),
    "image": ("cv2",),
    "scan": ("cv2", "zxingcpp", "pypdfium2"),
    "circuits": ("schemdraw",),
    "irt": ("mirt",),
}  # fmt: skip


class QuizgenError(Exception):
    """Base of all errors that the command line shows as one line.

    The code that raises one knows the place in the file's own terms, and a reader further out
    knows the file and adds it (``core.untrusted.error_context``). The line is looked up when the
    error is shown.

    Parameters
    ----------
    *args : object
        The message.
    rule : str
        Code in docs/diagnostics.md of what is wrong.
    file : pathlib.Path, optional
        What it is about.
    place : tuple of str or int
        Where in the file, as ``core.positions`` finds it.
    line : int
        Where, if that is known; counted from 1.
    """

    rule: str
    file: Path | None
    place: Place
    line: int

    def __init__(
        self,
        *args: object,
        rule: str = "",
        file: Path | None = None,
        place: Place = (),
        line: int = 0,
    ) -> None:
        super().__init__(*args)
        self.rule, self.file, self.place, self.line = rule, file, place, line

    @property
    def message(self) -> str:
        """The message without file and line."""
        return Exception.__str__(self)

    def __str__(self) -> str:
        """Return ``file:line: message``, as far as file and line are known."""
        if self.file is None:
            return self.message
        found = self.diagnostic(self.file)
        line = f":{found.span.line}" if found.span else ""
        return f"{self.file}{line}: {self.message}"

    def diagnostic(self, file: Path) -> Diagnostic:
        """Return the error as a diagnostic of lint, about ``file`` unless it names a file itself.

        An error without a code of its own gets ``DEFAULT``.
        """
        from quizgen.core.diagnostics import DEFAULT, diagnose

        own = self.file or file
        return diagnose(self.rule or DEFAULT, own, self.message, self.place, line=self.line)


class BankError(QuizgenError):
    """A template, a solver or a bank folder is wrong."""


class BlueprintError(QuizgenError):
    """A blueprint file is wrong."""


class SamplingError(QuizgenError):
    """A template cannot produce an admissible draw."""


class MathError(QuizgenError, ValueError):
    """A formula has no finite real value for these numbers."""


class UndecidedError(MathError):
    """A comparison could not be certified at the working precision."""


class FormulaError(QuizgenError, ValueError):
    """Typed mathematics cannot be read.

    Parameters
    ----------
    message : str
        What is wrong and what was expected.
    column : int, optional
        Position in the typed text, counted from 1.
    """

    def __init__(self, message: str, column: int | None = None) -> None:
        super().__init__(message)
        self.column = column


class PaperCodeError(QuizgenError):
    """A paper's code cannot be rebuilt here."""


class RenderError(QuizgenError):
    """An output could not be made or written."""


class StoreError(QuizgenError):
    """The database of the browser's server, or its port, cannot be opened."""


class KeyFileError(QuizgenError):
    """A key or an answer file cannot be read."""


class WorkerError(QuizgenError):
    """Processes that did the work died."""


class ClassError(QuizgenError):
    """A class's roster or folder is wrong, or would be spoiled."""


class MissingExtraError(QuizgenError):
    """Packages of an extra are not installed.

    Parameters
    ----------
    extra : str
        Its name in ``pyproject.toml``.
    feature : str
        What needs it, as the user typed it.
    """

    def __init__(self, extra: str, feature: str) -> None:
        super().__init__(f'{feature} needs more packages; type: pip install "quizgen[{extra}]"')


class AttemptFinishedError(QuizgenError):
    """A part in practice is answered, given up or judged again after it has ended."""


class InvalidChoiceError(QuizgenError, ValueError):
    """An argument is none of the values allowed."""


def require_one_of(what: str, value: object, allowed: Collection[str]) -> str:
    """Return ``value`` if it is one of those allowed; ``what`` names the argument in the message.

    Raises
    ------
    InvalidChoiceError
        Naming the argument, its value and what is allowed.
    """
    if isinstance(value, str) and value in allowed:
        return value
    raise InvalidChoiceError(f"{what}: {value!r} (allowed: {', '.join(allowed)})")


def has_extra(extra: str) -> bool:
    """Return whether the packages of an extra are installed; none of them is imported."""
    return all(find_spec(module) is not None for module in EXTRA_MODULES[extra])


def require_extra(extra: str, feature: str) -> None:
    """Raise an error if the packages of an extra are not installed.

    ``feature`` is what needs them, as the user typed it: a command or an option.

    Raises
    ------
    MissingExtraError
        Naming the feature and the line to type.
    """
    if not has_extra(extra):
        raise MissingExtraError(extra, feature)

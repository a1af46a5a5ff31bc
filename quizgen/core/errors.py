"""Every error a caller may see, as one tree.

::

    QuizgenError
    |-- BankError        a template, solver or bank folder is wrong (names file and place)
    |-- BlueprintError   a blueprint file is wrong (names file, key and what is allowed)
    |-- DrawError        a template cannot produce an admissible draw
    |-- MathError        a formula has no value for these numbers (pole, negative root, ...)
    |   `-- Undecided    the value is too close to a branch point to certify
    |-- FormulaError     mathematics typed by an author or a student cannot be read
    |-- CodeError        a paper's code cannot be rebuilt here
    |-- RenderError      an output could not be made or written
    |-- StoreError       the database of the browser's server, or its port, cannot be opened
    |-- KeyFileError     a key or an answer file cannot be read
    |-- WorkerError      processes that did the work died, one after the other
    |-- ClassError       a class's roster or folder is wrong, or would be spoiled
    |-- AttemptFinishedError  a part in practice is answered again after it has ended
    `-- ChoiceError      an argument is none of the values allowed (names them)

Two more stand beside their subject: ``SceneError`` in ``camera.scene``, and ``ReadError`` in
``maths.notation.lexer``, the ``FormulaError`` that knows what was found and what was expected.
``DomainError`` in ``arrays.domain`` is a plain ``ValueError``: array functions know nothing of
quizgen.

What a student types never raises out of the checker: it becomes a verdict.
"""

from collections.abc import Collection


class QuizgenError(Exception):
    """Base of all errors that the command line shows as one line."""


class BankError(QuizgenError):
    """A template, a solver or a bank folder is wrong."""


class BlueprintError(QuizgenError):
    """A blueprint file is wrong."""


class SamplingError(QuizgenError):
    """A template cannot produce an admissible draw."""


class MathError(QuizgenError, ValueError):
    """A formula has no finite real value for these numbers."""


class UndecidedError(MathError):  # noqa: N818 - a state of knowledge, not a failure
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


class AttemptFinishedError(QuizgenError):
    """A part in practice is answered, given up or judged again after it has ended."""


class InvalidChoiceError(QuizgenError, ValueError):
    """An argument is none of the values allowed."""


def require_one_of(what: str, value: object, allowed: Collection[str]) -> str:
    """Return a value that is one of those allowed.

    Raises
    ------
    ChoiceError
        Naming the argument, its value and what is allowed.
    """
    if isinstance(value, str) and value in allowed:
        return value
    raise InvalidChoiceError(f"{what}: {value!r} (allowed: {', '.join(allowed)})")

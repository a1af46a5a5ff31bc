"""What an answer kind does on the asking side: its contract, and the values it hands over.

A kind is two modules of one name. ``quizgen/grading/kinds`` has its ``Spec`` and marks what is
typed; ``quizgen/question/kinds`` makes that ``Spec`` from a draw and says how a learner answers.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Generic, Literal, NamedTuple, Protocol, TypeVar

import msgspec

from quizgen.bank.variant import Variant
from quizgen.figures import DrawingField, Line
from quizgen.grading.spec import AnySpec
from quizgen.question.inlines import TextOrInlines

S = TypeVar("S", bound=AnySpec)

Form = Literal["line", "lines", "one", "many", "truth", "pairs", "order", "gaps"]
"""What a learner fills in: a line or more of text, one or many of the lettered options, true or
false, a target for each option, the options in order, a word for each gap."""

Named = tuple[str, str]
"""A mark (letter or number) and the name of a sentence, or a section and a name in it."""


class Box(NamedTuple):
    """A value of an answer that has several: its name, empty where it is its place, and unit."""

    name: str
    unit: str = ""


class Control(msgspec.Struct, frozen=True):
    """How a learner answers: all that an output needs to know about a kind.

    Parameters
    ----------
    form : str
        What is filled in.
    lines : int
        Ruled lines that writing it by hand takes; 0 where the options themselves are ticked.
    boxes : tuple of Box
        Where an answer has several values, a box for each in the order in which they are typed; a
        learner may type all of them in one line just as well.
    named : bool
        Whether a value needs its name before it, as cells of a table do.
    board : DrawingField, optional
        The field that is drawn in, if the answer is a drawing.
    """

    form: Form
    lines: int = 1
    boxes: tuple[Box, ...] = ()
    named: bool = False
    board: DrawingField | None = None

    @property
    def reckoned(self) -> bool:
        """Whether there is something to work out on the way to the answer."""
        return self.form == "line" or bool(self.boxes and self.form == "lines")

    @property
    def several(self) -> bool:
        """Whether a page has a field for each of several values."""
        return bool(self.boxes) or self.form == "pairs"

    @property
    def ticked(self) -> bool:
        """Whether options are ticked, with no further place for the answer."""
        return self.lines == 0


LINE = Control("line")


class Built(msgspec.Struct, Generic[S], frozen=True):
    """One part of a draw as its kind makes it.

    Parameters
    ----------
    spec : Spec
        What it is marked by.
    control : Control
    options, targets : tuple of (str, str)
        Marks and names (in section ``options``) of the lettered options, and of the right side of
        a matching, in the order in which they are shown.
    right : tuple of (str, str)
        Section and name of the sentences that tell the right answer in words.
    reasons : tuple of (str, str)
        What a learner may choose wrongly (an option's mark, a pair of marks) and the name of the
        sentence in section ``reasons`` that says why it is wrong.
    statements : tuple of (str, str)
        Section and name of the sentences that are asked: a claim, or sentences with a gap each.
    source : str
        Where the reason that tells the right answer is to be found.
    drawn : tuple of lines
        What the solution draws in the field of the control.
    mistakes : mapping of str to Spec
        Each known mistake and the spec of which its answer would be the key.
    """

    spec: S
    control: Control = LINE
    options: tuple[Named, ...] = ()
    targets: tuple[Named, ...] = ()
    right: tuple[Named, ...] = ()
    reasons: tuple[Named, ...] = ()
    statements: tuple[Named, ...] = ()
    source: str = ""
    drawn: tuple[Line, ...] = ()
    mistakes: Mapping[str, S] = msgspec.field(default_factory=dict)


class QuestionKind(Protocol[S]):
    """The asking side of an answer kind; usually a module of ``quizgen/question/kinds``."""

    def build(self, drawn: Variant, index: int) -> Built[S]:
        """Make the spec of a part, and what stands beside its field.

        Raises
        ------
        BankError
            If the authored answer is not complete.
        """

    def hints(self, spec: S, lang: str) -> tuple[TextOrInlines, ...]:
        """Sentences that tell the learner how to type the answer, from how it is marked.

        Where the answer has several values, the first says how they are typed in one line; a page
        with a field for each leaves it out.
        """

    def printed(self, spec: S, lang: str) -> TextOrInlines:
        """The key as the solution states it; empty where sentences tell it."""

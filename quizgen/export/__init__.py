"""Questions for other systems: one module per format over one model of what is asked.

In: composed questions with their keys. Out: the bytes of a file that a system for courses imports,
and what a person has to mark there. Must never know: how a question was drawn or how typed answers
are read.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, NamedTuple

from quizgen.core.errors import require_one_of

if TYPE_CHECKING:
    from quizgen.export.items import Item
    from quizgen.responses.keys import Entry

FORMATS = {
    "moodle": "moodle.xml",
    "gift": "gift.txt",
    "qti21": "qti21.zip",
    "qti3": "qti3.zip",
    "canvas": "canvas.zip",
}
"""The formats there are, and what their files are called."""
TEX = ("moodle", "gift", "canvas")
"""Those whose systems may have a filter for formulas in TeX; QTI has MathML."""


class Exporter(NamedTuple):
    """What a format's module offers.

    ``write`` gives the bytes of a file, the same for the same questions; ``by_hand`` the fields of
    a question that a person marks there, each with the reason; ``kept`` the questions that one
    becomes, so that their responses can be read.
    """

    write: Callable[[Iterable[Item]], bytes]
    by_hand: Callable[[Item], Iterator[tuple[str, str]]]
    kept: Callable[[Item], Iterator[Entry]]


def exporter(name: str) -> Exporter:
    """The functions of a format, loaded when it is asked for.

    Raises
    ------
    ChoiceError
        Naming the formats there are.
    """
    chosen = require_one_of("format", name, FORMATS)
    from quizgen.export.items import by_hand

    match chosen:
        case "gift":
            from quizgen.export import gift

            return Exporter(gift.write, gift.by_hand, gift.kept)
        case "canvas":
            from quizgen.export import canvas

            return Exporter(canvas.write, by_hand, canvas.kept)
        case "qti21":
            from quizgen.export.qti.item import kept
            from quizgen.export.qti.package import write_qti21

            return Exporter(write_qti21, by_hand, kept)
        case "qti3":
            from quizgen.export.qti.item import kept
            from quizgen.export.qti.package import write_qti3

            return Exporter(write_qti3, by_hand, kept)
        case _:
            from quizgen.export import moodle

            return Exporter(moodle.write, by_hand, moodle.kept)

"""Questions for learning management systems, and the marks of what was answered there.

In: composed questions with their keys; later, reports of responses. Out: the bytes of a file to
import with a manifest of how its responses are read; marks as for a form, or a class. Must never
know: how a question was drawn, or that there is HTTP.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from quizgen.core.errors import require_one_of

if TYPE_CHECKING:
    from quizgen.lms.items import ExportItem
    from quizgen.lms.manifest import ManifestQuestion

# Format to the name of the file that is written by default.
FORMATS = {
    "moodle": "moodle.xml",
    "qti21": "qti21.zip",
    "qti3": "qti3.zip",
    "canvas": "canvas.zip",
}
# Systems that may have a filter for formulas in TeX; QTI has MathML.
TEX_FORMATS = ("moodle", "canvas")
# End of the name of a manifest, after the name of the export it belongs to.
MANIFEST_SUFFIX = ".keys.jsonl"


@dataclass(frozen=True, slots=True)
class Exporter:
    """What a format's module offers.

    ``write`` gives the bytes of a file, equal for equal questions; ``list_questions`` the
    questions that one item becomes, so that their responses can be read.
    """

    write: Callable[[Iterable[ExportItem]], bytes]
    list_questions: Callable[[ExportItem], Iterator[ManifestQuestion]]


def get_exporter(name: str) -> Exporter:
    """Return the functions of a format, whose module is imported only now.

    Raises
    ------
    InvalidChoiceError
        Naming the formats there are.
    """
    match require_one_of("format", name, FORMATS):
        case "canvas":
            from quizgen.lms.canvas import canvas_manifest, write_canvas

            return Exporter(write_canvas, canvas_manifest)
        case "qti21":
            from quizgen.lms.qti.item import qti_manifest
            from quizgen.lms.qti.package import write_qti21

            return Exporter(write_qti21, qti_manifest)
        case "qti3":
            from quizgen.lms.qti.item import qti_manifest
            from quizgen.lms.qti.package import write_qti3

            return Exporter(write_qti3, qti_manifest)
        case _:
            from quizgen.lms.moodle import moodle_manifest, write_moodle

            return Exporter(write_moodle, moodle_manifest)

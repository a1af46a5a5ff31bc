"""Questions as a package for Canvas: QTI 1.2 as Classic Quizzes read it, and New Quizzes take over.

A quiz for each language; each slot is a group of it from which one question is drawn. Canvas asks
one thing at a time, so each part is a question, and each value of a point or a table. A number has
no wrong answers there: misconceptions stay in the worked solution.

Sources: IMS QTI 1.2 ASI; Canvas LMS, lib/cc/qti; text2qti.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import groupby

import jinja2
from markupsafe import Markup

from quizgen.bank.pictures import PictureFile
from quizgen.core.files import build_zip
from quizgen.figures import Figure
from quizgen.lms.interactions import (
    Interaction,
    NumericInteraction,
    OrderInteraction,
    TextEntryInteraction,
    order_as_match,
)
from quizgen.lms.items import CourseQuestion, ExportItem, group_by_slot, part_suffix
from quizgen.lms.manifest import ManifestQuestion
from quizgen.lms.manifest_writer import manifest_question
from quizgen.lms.markup import (
    all_images,
    image_path,
    option_html,
    part_html,
    pictures_from,
    question_mark,
    solution_html,
    stem_html,
    target_texts,
    to_course_html,
)
from quizgen.lms.weighted_answers import weighted_answers
from quizgen.locale import translate
from quizgen.render.layouts import jinja_environment
from quizgen.typeset.prose import name_inline

_QUESTION_TYPES = {
    "number": "numerical",
    "one": "multiple_choice",
    "many": "multiple_answers",
    "truth": "true_false",
    "pairs": "matching",
    "words": "short_answer",
    "written": "essay",
}


@dataclass(frozen=True)
class CanvasQuestion(CourseQuestion):
    """A question as Canvas has it: of one part, with several interactions only if all are blanks.

    ``place`` says which of how many values of the part it asks.
    """

    place: tuple[int, int] = (1, 1)

    @property
    def points(self) -> Fraction:
        """Marks of its value: all values of a part have the same."""
        return super().points / self.place[1]

    @property
    def group(self) -> str:
        """The group that a quiz draws it from: the same part of a slot, with the same marks."""
        return f"{self.item.slot}{self.suffix} ({float(self.points):g})"

    @property
    def interactions(self) -> tuple[Interaction, ...]:
        """What it asks."""
        return self.parts[0][1]

    @property
    def interaction(self) -> Interaction:
        """What it asks if that is one thing; an order as the place of each step."""
        first = self.interactions[0]
        return (
            order_as_match(first, self.item.lang) if isinstance(first, OrderInteraction) else first
        )

    @property
    def type(self) -> str:
        """The name of its type in Canvas."""
        if len(self.interactions) > 1:
            return "fill_in_multiple_blanks"
        return _QUESTION_TYPES[self.interaction.kind]

    @property
    def html(self) -> Markup:
        """Everything that stands above its fields."""
        item, (part, found) = self.item, self.parts[0]
        body = part_html(part, found, item.lang, _file_address, alone=True)
        text = stem_html(item, _file_address) + body
        if len(found) > 1:
            text = Markup(text.replace("[", "&#91;"))  # noqa: S704 - the same page
            blanks = (f"{place}. [blank{place}]" for place, _ in enumerate(found, 1))
            text += Markup("<p>{}</p>").format(Markup("<br>").join(blanks))
        return text + self._asked_value + question_mark(item, self.suffix)

    @property
    def _asked_value(self) -> Markup:
        """Which value of several: by its name, or by its place, as in ``(...; ?)``."""
        place, count = self.place
        if count == 1:
            return Markup("")
        if isinstance(self.interaction, NumericInteraction) and self.interaction.name:
            name = to_course_html((name_inline(self.interaction.name),), self.item.lang)
            return Markup("<p><strong>{} = ?</strong></p>").format(name)
        row = ("?" if one == place else "…" for one in range(1, count + 1))
        return Markup("<p><strong>({})</strong></p>").format("; ".join(row))


def canvas_questions(item: ExportItem) -> Iterator[CanvasQuestion]:
    """Yield the questions that an item becomes."""
    for part, found in item.parts:
        suffix = part_suffix(part)
        if len(found) == 1 or all(isinstance(one, TextEntryInteraction) for one in found):
            yield CanvasQuestion(item, suffix, [(part, found)])
            continue
        for place, one in enumerate(found, 1):
            yield CanvasQuestion(item, f"{suffix}.{place}", [(part, (one,))], (place, len(found)))


def canvas_manifest(item: ExportItem) -> Iterator[ManifestQuestion]:
    """Yield how the responses to each question of an item are read back."""
    return map(manifest_question, canvas_questions(item))


def write_canvas(items: Iterable[ExportItem]) -> bytes:
    """Return the questions as a package, equal for equal questions."""
    return build_zip(canvas_files(items))


def canvas_files(items: Iterable[ExportItem]) -> dict[str, bytes]:
    """Return the files of a package by their paths, the manifest first."""
    quizzes, figures = {}, dict[str, bytes]()
    for lang, found in groupby(group_by_slot(items), key=lambda item: item.lang):
        of_lang = list(found)
        questions = sorted(
            (one for item in of_lang for one in canvas_questions(item)), key=_get_group
        )
        groups = [(name, list(row)) for name, row in groupby(questions, key=_get_group)]
        quizzes[f"quizgen-{lang}"] = groups
        for item in of_lang:
            figures |= all_images(item)
    page = _load_layouts().get_template
    files = {
        "imsmanifest.xml": page("canvas_manifest.xml.j2").render(quizzes=quizzes, files=figures)
    }
    for name, groups in quizzes.items():
        points = sum((row[0].points for _, row in groups), Fraction(0))
        meta = page("canvas_meta.xml.j2").render(name=name, points=float(points))
        with pictures_from(_file_address):
            files[f"{name}/{name}.xml"] = page("canvas.xml.j2").render(name=name, groups=groups)
        files[f"{name}/assessment_meta.xml"] = meta
    return {name: text.encode() for name, text in files.items()} | figures


def _get_group(question: CanvasQuestion) -> str:
    """Return the group of a question: the key that questions are sorted and grouped by."""
    return question.group


@cache
def _load_layouts() -> jinja2.Environment:
    """Return the Jinja environment with the layouts of a Canvas package."""
    layouts = jinja_environment("quizgen.lms")
    layouts.globals.update(
        answers=weighted_answers,
        as_text=str.__str__,
        inline=to_course_html,
        marked=option_html,
        solution=_canvas_solution,
        targets=target_texts,
        word=translate,
    )
    return layouts


def _canvas_solution(question: CanvasQuestion) -> Markup:
    """Return the worked solution of a question, without feedback that Canvas gives itself."""
    ((part, found),) = question.parts
    has_feedback = any(not isinstance(one, NumericInteraction) for one in found)
    return solution_html(question.item, _file_address, (part.label,), has_feedback=has_feedback)


def _file_address(shown: Figure | PictureFile) -> str:
    """Return the address of a package's file, as Canvas resolves it."""
    return f"%24IMS-CC-FILEBASE%24/{image_path(shown)}"

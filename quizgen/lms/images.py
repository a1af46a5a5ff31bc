"""Figures and pictures of a question as files that a page refers to."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Collection, Iterable

from markupsafe import Markup

from quizgen.bank.pictures import PictureFile
from quizgen.figures import Figure
from quizgen.lms.items import ExportItem

# From a figure to the address that a page finds it at.
FigureAddress = Callable[[Figure], str]


def image_name(figure: Figure) -> str:
    """Return the name of a figure's file, equal for figures that look the same."""
    return f"{hashlib.sha256(figure.standalone_svg).hexdigest()[:16]}.svg"


def image_path(shown: Figure | PictureFile) -> str:
    """Return the path of an image in a package."""
    return f"figures/{shown.file if isinstance(shown, PictureFile) else image_name(shown)}"


def image_tag(figure: Figure | None, source: FigureAddress) -> Markup:
    """Return a figure as HTML with its alternative text, or nothing if there is no figure."""
    if figure is None:
        return Markup("")
    tag = Markup('<p><img src="{}" alt="{}" width="{:.0f}" height="{:.0f}"/></p>')
    return tag.format(source(figure), figure.alt, figure.width_pt * 4 / 3, figure.height_pt * 4 / 3)


def question_images(item: ExportItem, labels: Collection[str]) -> dict[str, bytes]:
    """Return the files that the text of some parts shows: the figure, and fields to draw in."""
    drawings = (part.field.drawing for part in item.question.parts if part.label in labels)
    return _figure_files([item.question.figure, *(one.figure for one in drawings if one)])


def solution_images(item: ExportItem, labels: Collection[str]) -> dict[str, bytes]:
    """Return the files that the solution of some parts shows: its figure, and right drawings."""
    rows = zip(item.question.parts, item.key.solution.parts, strict=True)
    drawings = (done.drawing for part, done in rows if part.label in labels)
    return _figure_files([item.solution_figure, *(one.figure for one in drawings if one)])


def all_images(item: ExportItem) -> dict[str, bytes]:
    """Return all files of a question and its solution by their paths in a package."""
    labels = [part.label for part in item.question.parts]
    found = question_images(item, labels) | solution_images(item, labels)
    drawn = {f"figures/{name}": data for name, data in found.items()}
    pictures = item.key.draw.template.pictures.values()
    return drawn | {image_path(picture): picture.data for picture in pictures}


def _figure_files(figures: Iterable[Figure | None]) -> dict[str, bytes]:
    return {image_name(figure): figure.standalone_svg for figure in figures if figure}

"""What a question shows - what is drawn, and pictures of its bank - as files beside a page."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Collection, Iterable

from markupsafe import Markup

from quizgen.bank.pictures import PictureFile
from quizgen.export.items import Item
from quizgen.figures import Figure

Source = Callable[[Figure], str]
"""Where a page finds a figure."""


def name(figure: Figure) -> str:
    """What its file is called; those that look the same are one."""
    return f"{hashlib.sha256(figure.standalone_svg).hexdigest()[:16]}.svg"


def path(shown: Figure | PictureFile) -> str:
    """Where it is in a package."""
    return f"figures/{shown.file if isinstance(shown, PictureFile) else name(shown)}"


def image(figure: Figure | None, source: Source) -> Markup:
    """A picture with its words, if there is one."""
    if figure is None:
        return Markup("")
    tag = Markup('<p><img src="{}" alt="{}" width="{:.0f}" height="{:.0f}"/></p>')
    return tag.format(source(figure), figure.alt, figure.width_pt * 4 / 3, figure.height_pt * 4 / 3)


def asked(item: Item, labels: Collection[str]) -> dict[str, bytes]:
    """Files that the text of some parts shows: the figure, and fields to draw in."""
    drawings = (part.field.drawing for part in item.question.parts if part.label in labels)
    return _files([item.question.figure, *(one.figure for one in drawings if one)])


def solved(item: Item, labels: Collection[str]) -> dict[str, bytes]:
    """Files that the solution of some parts shows: its figure, and what was to be drawn."""
    rows = zip(item.question.parts, item.key.solution.parts, strict=True)
    drawings = (done.drawing for part, done in rows if part.label in labels)
    return _files([item.solved_figure, *(one.figure for one in drawings if one)])


def shown(item: Item) -> dict[str, bytes]:
    """All files of a question and its solution, by their paths in a package."""
    labels = [part.label for part in item.question.parts]
    found = asked(item, labels) | solved(item, labels)
    drawn = {f"figures/{name}": data for name, data in found.items()}
    pictures = item.key.draw.template.pictures.values()
    return drawn | {path(picture): picture.data for picture in pictures}


def _files(figures: Iterable[Figure | None]) -> dict[str, bytes]:
    return {name(figure): figure.standalone_svg for figure in figures if figure}

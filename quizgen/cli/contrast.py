"""What ``simulate --compare`` writes: two pictures, their difference, and the table."""

from __future__ import annotations

from base64 import b64encode
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from quizgen.core.errors import InvalidChoiceError

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from quizgen.camera.comparison import Codes
    from quizgen.camera.simulation import Photo

_STYLE = """
body { font: 16px/1.4 system-ui, sans-serif; margin: 1.5em; color: #1b1f24; background: #fff }
.pictures { display: flex; flex-wrap: wrap; gap: 1em }
figure { margin: 0; flex: 1 1 20em; max-width: 48em }
img { width: 100%; image-rendering: pixelated }
.table { overflow-x: auto }
table { border-collapse: collapse; margin: 1em 0 }
th, td { text-align: left; padding: .2em .8em .2em 0; border-bottom: 1px solid #d0d7de }
@media (max-width: 34em) {
  body { margin: 1em }
  table { font-size: .75em }
  th, td { padding-right: .4em }
}
"""


def check_target(target: Path | None) -> None:
    """Refuse an ending before anything is computed.

    Raises
    ------
    ChoiceError
        If the file is neither a picture nor a page.
    """
    from quizgen.camera.pixels.codecs import WRITERS

    endings = (*WRITERS, ".html")
    if target is not None and target.suffix.lower() not in endings:
        raise InvalidChoiceError(f"cannot write {target} (endings: {', '.join(endings)})")


def comparison_file(
    target: Path,
    title: str,
    photos: Mapping[str, Photo],
    told: tuple[Sequence[str], ...],
    notes: Iterable[str] = (),
) -> bytes:
    """A file that shows two pictures and how they differ.

    Parameters
    ----------
    target : Path
        ``.html`` for a page with the table, else three pictures beside each other.
    title : str
        The scene's.
    photos : mapping of str to Photo
        Two pictures, by what they show.
    told : tuple of sequence of str
        Head and rows of the table.
    notes : iterable of str
        Sentences below it.
    """
    from quizgen.camera.comparison import amplify_difference, concatenate_pictures
    from quizgen.camera.pixels.codecs import WRITERS

    one, other = photos.values()
    scale, apart = amplify_difference(one.values, other.values)
    pictures = one.pixels(), other.pixels(), _write_on(apart, f"difference x {scale}")
    if target.suffix.lower() != ".html":
        return WRITERS[target.suffix.lower()](concatenate_pictures(*pictures))
    names = *photos, f"difference × {scale}"
    return _render_page(title, zip(names, pictures, strict=True), told, notes).encode()


def _write_on(codes: Codes, text: str) -> Codes:
    """A picture with its scale on it, as far as it has room."""
    import numpy as np
    from PIL import Image, ImageDraw, ImageFont

    picture = Image.fromarray(codes)
    size = max(8, codes.shape[0] // 24)
    font = ImageFont.load_default(size)
    ImageDraw.Draw(picture).text(
        (size // 2, size // 2), text, (255, 255, 255), font, stroke_width=1, stroke_fill=(0, 0, 0)
    )
    return np.asarray(picture)


def _render_page(
    title: str,
    pictures: Iterable[tuple[str, Codes]],
    told: tuple[Sequence[str], ...],
    notes: Iterable[str],
) -> str:
    head, *rows = told
    figures = "".join(_render_figure(name, codes) for name, codes in pictures)
    body = "".join(_render_table_row("td", row) for row in rows)
    below = "".join(f"<p>{escape(note)}</p>\n" for note in notes)
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta name="viewport" content="width=device-width">\n'
        f"<title>{escape(title)}</title>\n<style>{_STYLE}</style>\n</head>\n<body>\n"
        f'<h1>{escape(title)}</h1>\n<div class="pictures">\n{figures}</div>\n'
        f'<div class="table">\n<table>\n<thead>{_render_table_row("th", head)}</thead>\n'
        f"<tbody>\n{body}</tbody>\n</table>\n</div>\n{below}</body>\n</html>\n"
    )


def _render_figure(name: str, codes: Codes) -> str:
    from quizgen.camera.pixels.codecs import encode_photo

    data = b64encode(encode_photo(codes)).decode()
    source = f"data:image/png;base64,{data}"
    label = escape(name)
    return f'<figure><img src="{source}" alt="{label}"><figcaption>{label}</figcaption></figure>\n'


def _render_table_row(cell: str, texts: Sequence[str]) -> str:
    return "<tr>" + "".join(f"<{cell}>{escape(text)}</{cell}>" for text in texts) + "</tr>\n"

"""A field to draw in is shown in every format, empty above and drawn in the solution."""

from __future__ import annotations

import html
import io
import re
import zipfile

import pytest

from quizgen.lms import FORMATS, get_exporter
from quizgen.lms.items import items_from_templates


def pages(data: bytes) -> str:
    """What a file says, without the signs that its own grammar needs."""
    if not zipfile.is_zipfile(io.BytesIO(data)):
        return re.sub(r"\\(.)", r"\1", data.decode())
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        names = [name for name in archive.namelist() if name.endswith(".xml")]
        return html.unescape("".join(archive.read(name).decode() for name in names))


@pytest.mark.parametrize("name", FORMATS)
def test_an_essay_shows_the_field_to_draw_in(bank, name):
    item = next(items_from_templates(bank, ["recognise-and-sketch-distortion"], 0, 1, ["en"]))
    text = pages(get_exporter(name).write([item]))
    shown = re.findall(r'<img src="[^"]+" alt="([^":]+): x from', text)
    assert shown == ["An empty field to draw in", "The drawing that was wanted"]
    assert "<svg" not in text
    assert "<figure" not in text

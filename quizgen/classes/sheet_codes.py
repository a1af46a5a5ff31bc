"""What the code of a page of an answer sheet says, signed with the secret of the class."""

from __future__ import annotations

import re

from quizgen.classes.class_folder import ClassFolder, PrintedHead
from quizgen.classes.pseudonyms import sheet_seal
from quizgen.core.errors import ClassError
from quizgen.grading.echo import safe_echo
from quizgen.render.answer_sheet import VERSION

PREFIX = "Q"
_CODE_TEXT = re.compile(rf"{PREFIX}\d+:(?P<paper>\w+):(?P<page>\d{{1,3}}):[0-9A-F]{{8}}")


def format_sheet_code(secret: str, code: str, page: int) -> str:
    """Return what the code of a page says: layout, paper, page, and a seal under the secret."""
    bare = code.replace("-", "")
    return f"{PREFIX}{VERSION}:{bare}:{page}:{sheet_seal(secret, code, VERSION, page)}"


def find_sheet_page(folder: ClassFolder, text: str) -> tuple[PrintedHead, int]:
    """Return whose page of an answer sheet has a code, and which page it is.

    Raises
    ------
    ClassError
        If the code is of no page of this class, or was not made with its secret.
    """
    found = _CODE_TEXT.fullmatch(text.strip().upper())
    if found:
        page = int(found["page"])
        for head, _ in folder.places().values():
            for code in head.codes:
                made = format_sheet_code(folder.settings.secret, code, page)
                if code.replace("-", "") == found["paper"] and made == found[0]:
                    return head, page
    raise ClassError(f"{folder.path}: no page of this class has the code {safe_echo(text)!r}")

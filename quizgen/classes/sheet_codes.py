"""What the code of a page of a sheet or paper says, signed with the secret of the class."""

from __future__ import annotations

import re

from quizgen.classes.class_folder import ClassFolder, PrintedHead
from quizgen.classes.pseudonyms import sheet_seal
from quizgen.core.errors import ClassError
from quizgen.grading.echo import safe_echo

PREFIX = "Q"
_CODE_TEXT = re.compile(
    rf"{PREFIX}(?P<version>\d):(?P<paper>\w+):(?P<page>\d{{1,3}}):[0-9A-F]{{8}}"
)


def format_sheet_code(secret: str, code: str, version: int, page: int) -> str:
    """Return what the code of a page says: layout, paper, page, and a seal under the secret."""
    bare = code.replace("-", "")
    return f"{PREFIX}{version}:{bare}:{page}:{sheet_seal(secret, code, version, page)}"


class SheetIndex:
    """Whose page of an answer sheet has which code, and where the line of its key begins.

    Parameters
    ----------
    folder : ClassFolder
    """

    def __init__(self, folder: ClassFolder) -> None:
        self.folder = folder
        self._secret = folder.settings.secret
        self._owners = {
            code.replace("-", ""): (head, at, code)
            for head, at in folder.places().values()
            for code in head.codes
        }

    def find_page(self, text: str) -> tuple[PrintedHead, int, int] | None:
        """Return head, byte offset of the key's line, and page; None if the code is not ours."""
        found = _CODE_TEXT.fullmatch(text.strip().upper())
        if found and found["paper"] in self._owners:
            head, at, code = self._owners[found["paper"]]
            version, page = int(found["version"]), int(found["page"])
            if format_sheet_code(self._secret, code, version, page) == found[0]:
                return head, at, page
        return None


def find_sheet_page(folder: ClassFolder, text: str) -> tuple[PrintedHead, int]:
    """Return whose page of an answer sheet has a code, and which page it is.

    Raises
    ------
    ClassError
        If the code is of no page of this class, or was not made with its secret.
    """
    found = SheetIndex(folder).find_page(text)
    if found is None:
        raise ClassError(f"{folder.path}: no page of this class has the code {safe_echo(text)!r}")
    return found[0], found[2]

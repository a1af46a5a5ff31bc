"""Pictures of what stands on paper: ``scans/<paper>/<part>.png`` in the folder of a class.

``scans/report.json`` tells what was read on them. A class without scans has none of it.
"""

from __future__ import annotations

import re
from pathlib import Path

from quizgen.classes.class_folder import PrintedHead

FOLDER, REPORT = "scans", "report.json"
_PART = re.compile(r"\d{1,3}[a-z]{0,2}")


def find_crop(folder: Path, head: PrintedHead, part: str) -> Path | None:
    """Return the picture of a part of a student's paper; None if there is none.

    Parameters
    ----------
    folder : pathlib.Path
        That of the class.
    head : PrintedHead
        Of the paper.
    part : str
        As it is printed, such as ``7a``. Nothing outside the folder is ever returned.
    """
    if not _PART.fullmatch(part):
        return None
    scans = (folder / FOLDER).resolve()
    for paper in (*head.codes, *(code.replace("-", "") for code in head.codes)):
        path = (scans / paper / f"{part}.png").resolve()
        if path.is_relative_to(scans) and path.is_file():
            return path
    return None

"""What templates of a bank are called: as their folders are, and each name once."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path

from quizgen.core.errors import BankError
from quizgen.core.untrusted import error_context, require_identifier


def find_template_folders(templates: Path, beside: Collection[str]) -> dict[str, list[Path]]:
    """Name to all folders that are called so, although one alone may be.

    Parameters
    ----------
    templates : pathlib.Path
    beside : collection of str
        Folders in it that hold something else.
    """
    found: dict[str, list[Path]] = {}
    others = {templates / name for name in beside}
    for folder in sorted(path.parent for path in templates.glob("**/template.toml")):
        if folder not in others:
            found.setdefault(folder.name, []).append(folder)
    return found


def check_name(folders: Sequence[Path]) -> None:
    """Refuse a template that cannot be called by its name; the others stay what they are.

    Raises
    ------
    BankError
        If it is no name, or another folder has it, too.
    """
    folder, *others = folders
    file = folder / "template.toml"
    with error_context(file, BankError):
        require_identifier(folder.name, "folder", BankError)
    if others:
        also = ", ".join(map(str, others))
        what = f"two templates share the name {folder.name!r}: also {also}"
        raise BankError(what, rule="QG125", file=file)

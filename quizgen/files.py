"""Writing files whole or not at all, and reading tables whose mistakes are one located line."""

from __future__ import annotations

import contextlib
import os
import secrets
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from quizgen.errors import KeyFileError, RenderError
from quizgen.outside import parse_json, parse_toml, read_text


def write_all(folder: Path, contents: Mapping[str, bytes]) -> list[Path]:
    """Write several files so that either all of them appear or none changes.

    Parameters
    ----------
    folder : pathlib.Path
        Made if it does not exist.
    contents : mapping of str to bytes
        File name to content.

    Raises
    ------
    RenderError
        If the folder cannot be written (read-only, full); nothing is left behind.
    """
    mark = f".{os.getpid()}-{secrets.token_hex(4)}.part"
    staged: dict[Path, Path] = {}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, data in contents.items():
            target = folder / name
            if target.is_dir():
                raise RenderError(f"{target}: is a folder")
            temporary = folder / f"{name}{mark}"
            staged[target] = temporary
            _write_synced(temporary, data)
        for target, temporary in staged.items():
            temporary.replace(target)
    except OSError as error:
        raise RenderError(f"{error.filename or folder}: {error.strerror or error}") from error
    finally:
        for temporary in staged.values():
            with contextlib.suppress(OSError):
                temporary.unlink(missing_ok=True)
    return list(staged)


def _write_synced(path: Path, data: bytes) -> None:
    with path.open("wb") as stream:
        stream.write(data)
        stream.flush()
        os.fsync(stream.fileno())


def read_table(path: Path) -> Mapping[str, Any]:
    """Read a TOML file (by its suffix) or a JSON file; numbers with a point stay text.

    Raises
    ------
    KeyFileError
        Naming the file and, if possible, the line.
    """
    text = read_text(path, KeyFileError)
    if path.suffix == ".toml":
        return parse_toml(text, path, KeyFileError, parse_float=str)
    table = parse_json(text, path, KeyFileError)
    if not isinstance(table, dict):
        raise KeyFileError(f"{path}: a table is expected, not {type(table).__name__}")
    return table

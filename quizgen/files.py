"""Writing files whole or not at all, and reading tables whose mistakes are one located line."""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from quizgen.errors import KeyFileError, RenderError

LARGEST_FILE = 20_000_000
"""Bytes of the largest table that is read."""


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
    text = _text(path)
    try:
        if path.suffix == ".toml":
            return tomllib.loads(text, parse_float=str)
        table = json.loads(text, parse_float=str)
    except json.JSONDecodeError as error:
        raise KeyFileError(f"{path}: line {error.lineno}: {error.msg}") from None
    except (tomllib.TOMLDecodeError, RecursionError, ValueError) as error:
        raise KeyFileError(f"{path}: {error}") from None
    if not isinstance(table, dict):
        raise KeyFileError(f"{path}: a table is expected, not {type(table).__name__}")
    return table


def _text(path: Path) -> str:
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise KeyFileError(f"{path}: larger than {LARGEST_FILE // 10**6} MB")
        return path.read_text("utf-8")
    except OSError as error:
        raise KeyFileError(f"{path}: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise KeyFileError(f"{path}: not UTF-8 text (byte {error.start})") from None

"""Writing files whole or not at all, and reading tables whose mistakes are one located line."""

from __future__ import annotations

import contextlib
import io
import os
import re
import shutil
import signal
import threading
import time
from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path
from types import FrameType
from typing import Any

from quizgen.core.errors import KeyFileError, RenderError
from quizgen.core.untrusted import parse_json, parse_toml, read_text

STALE = 3600.0
"""Seconds after which what a killed run left behind is swept away."""

USUAL, PRIVATE = 0o666, 0o600
"""Mode of a new file, less what the process takes away; that of one which only its owner reads."""

_DAY = (1980, 1, 1, 0, 0, 0)
"""The date of everything in an archive."""

_LEFT_BEHIND = re.compile(r"\..*\.\d+-[0-9a-f]{8}\.part", re.DOTALL)


def _get_final_path_name(path: str) -> str:
    """Return the name that a file will have once written.

    A path that is not staged stays as it is.
    """
    return re.sub(r"\.([^/\\]*)\.\d+-[0-9a-f]{8}\.part", r"\1", path)


def open_private(path: Path, *, truncate: bool = False) -> io.BufferedWriter:
    """Return a binary stream that appends to a file only its owner may read.

    Parameters
    ----------
    path : pathlib.Path
        Made if it does not exist.
    truncate : bool
        Empty the file first, in place of adding to it.
    """
    flags = os.O_WRONLY | os.O_CREAT | getattr(os, "O_BINARY", 0)
    number = os.open(path, flags | (os.O_TRUNC if truncate else os.O_APPEND), PRIVATE)
    return os.fdopen(number, "wb")


def sync_folder(folder: Path) -> None:
    """Wait until the names in a folder are on the disk: else a power cut may take them back.

    Parameters
    ----------
    folder : pathlib.Path
    """
    if os.name == "nt":  # where folders cannot be opened
        return
    number = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(number)
    finally:
        os.close(number)


def restrict_folder(folder: Path) -> None:
    """Let nobody but its owner look into a folder, nor read what is in it.

    Links are not followed. What somebody else owns stays as it is.

    Parameters
    ----------
    folder : pathlib.Path
    """
    for place, _, files in os.walk(folder):
        modes = [(Path(place), 0o700), *((Path(place, name), PRIVATE) for name in files)]
        for path, mode in modes:
            # a link has all bits, and what it leads to may stand anywhere
            with contextlib.suppress(OSError):
                if not path.is_symlink() and path.stat().st_mode & 0o077:
                    path.chmod(mode)


def build_zip(contents: Mapping[str, bytes], *, packed: bool = True) -> bytes:
    """Return a zip archive of files in the order given: the same bytes on any day and system.

    Parameters
    ----------
    contents : mapping of str to bytes
        Path in the archive to content.
    packed : bool
        Whether they are made smaller, which another version of zlib may do otherwise.
    """
    import zipfile

    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name, data in contents.items():
            entry = zipfile.ZipInfo(name, _DAY)
            entry.compress_type = zipfile.ZIP_DEFLATED if packed else zipfile.ZIP_STORED
            entry.external_attr = 0o644 << 16
            entry.create_system = 3
            archive.writestr(entry, data)
    return out.getvalue()


def write_all(
    folder: Path,
    contents: Mapping[str, bytes],
    mode: int = USUAL,
    private: Collection[str] = (),
) -> list[Path]:
    """Write several files so that all of them appear or none changes; return their paths.

    A folder that is new appears with everything in it. In one that exists, the last file seals the
    set: it goes first and comes back last, so a run that is killed never leaves it with others
    that it does not belong to.

    Parameters
    ----------
    folder : pathlib.Path
        Made if it does not exist.
    contents : mapping of str to bytes
        File name, or path below the folder, to content; what needs the others comes last.
    mode : int
        Who may read the files; with ``PRIVATE`` none but their owner looks into new folders.
    private : collection of str
        Names of files that only their owner reads, whatever the others are: keys and solutions.

    Raises
    ------
    RenderError
        If the folder cannot be written (read-only, full); nothing is left behind.
    """
    new = not folder.exists()
    mark = f".{os.getpid()}-{os.urandom(4).hex()}.part"
    around = folder.parent if new else folder
    stage = around / (f".{folder.name}{mark}" if new else f".{mark}")
    try:
        around.mkdir(parents=True, exist_ok=True)
        _remove_stale_stages(around)
        modes = {name: PRIVATE if name in private else mode for name in contents}
        _write_staged_files(stage, folder, contents, modes, mode)
        with _delay_interrupts():
            _move_staged_files(stage, folder, list(contents), mode, new=new)
    except OSError as error:
        place = _get_final_path_name(str(error.filename or folder))
        raise RenderError(f"{place}: {error.strerror or error}") from error
    finally:
        shutil.rmtree(stage, ignore_errors=True)
    return [folder / name for name in contents]


def _write_staged_files(
    stage: Path,
    folder: Path,
    contents: Mapping[str, bytes],
    modes: Mapping[str, int],
    mode: int,
) -> None:
    """Write all files to a hidden folder, each with its mode, before any is moved to its place.

    Raises ``RenderError`` if a folder stands where a file should; ``mode`` is that of new folders.
    """
    _make_folder(stage, mode)
    for name, data in contents.items():
        if (folder / name).is_dir():
            raise RenderError(f"{folder / name}: is a folder")
        _make_folder((stage / name).parent, mode)
        (stage / name).touch(modes[name])
        _write_synced(stage / name, data)


def _make_folder(folder: Path, mode: int) -> None:
    """Create a folder and its missing parents, closed to others if ``mode`` is ``PRIVATE``.

    File names are private, too: they may be those of students.
    """
    for one in reversed([path for path in (folder, *folder.parents) if not path.exists()]):
        one.mkdir(0o700 if mode == PRIVATE else 0o777, exist_ok=True)


def _move_staged_files(
    stage: Path, folder: Path, names: list[str], mode: int, *, new: bool
) -> None:
    """Move the staged files into their folder, the last one last.

    A new folder is moved in one step.
    """
    if new:
        stage.rename(folder)
        sync_folder(folder.parent)
        return
    if len(names) > 1:
        (folder / names[-1]).unlink(missing_ok=True)
    for name in names:
        _make_folder((folder / name).parent, mode)
        (stage / name).replace(folder / name)
    for place in {(folder / name).parent for name in names}:
        sync_folder(place)


def _remove_stale_stages(folder: Path) -> None:
    """Delete staging folders that killed runs left more than ``STALE`` seconds ago."""
    for path in folder.iterdir():
        if not _LEFT_BEHIND.fullmatch(path.name):
            continue
        with contextlib.suppress(OSError):
            if time.time() - path.lstat().st_mtime > STALE:
                _remove_path(path)


def _remove_path(path: Path) -> None:
    """Delete a file, a link or a folder with all that is in it."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink()


@contextlib.contextmanager
def _delay_interrupts() -> Iterator[None]:
    """Hold Ctrl-C back until the block is over, then raise it; only the main thread can."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    waiting: list[int] = []

    def wait(number: int, _frame: FrameType | None) -> None:
        """Note a signal instead of acting on it."""
        waiting.append(number)

    before = signal.signal(signal.SIGINT, wait)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if waiting:
            signal.raise_signal(waiting[0])


def _write_synced(path: Path, data: bytes) -> None:
    """Write a file and wait until it is on the disk."""
    with path.open("wb") as stream:
        stream.write(data)
        stream.flush()
        os.fsync(stream.fileno())


def read_table(path: Path, meant: Callable[[str], str] = str) -> Mapping[str, Any]:
    """Return the table in a JSON or TOML file; numbers with a point stay text: 0.50 keeps its zero.

    The suffix decides on the format, else the first character: ``{`` begins JSON.

    Parameters
    ----------
    path : pathlib.Path
    meant : callable
        Applied to the text of a TOML file before it is parsed, to mend what people mistype.

    Raises
    ------
    KeyFileError
        Naming the file and, if possible, the line.
    """
    text = read_text(path, KeyFileError)
    suffix = path.suffix.lower()
    if suffix == ".toml" or (suffix != ".json" and not text.lstrip().startswith("{")):
        return parse_toml(meant(text), path, KeyFileError, parse_float=str)
    table = parse_json(text, path, KeyFileError)
    if not isinstance(table, dict):
        raise KeyFileError(f"{path}: a table is expected, not {type(table).__name__}")
    return table

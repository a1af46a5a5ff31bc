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
    """What a file will be called that is still being written; any other path as it is."""
    return re.sub(r"\.([^/\\]*)\.\d+-[0-9a-f]{8}\.part", r"\1", path)


def open_private(path: Path, *, anew: bool = False) -> io.BufferedWriter:
    """Open a file that only its owner reads, to add to its end.

    Parameters
    ----------
    path : pathlib.Path
        Made if it does not exist.
    anew : bool
        Write it from its beginning instead.
    """
    flags = os.O_WRONLY | os.O_CREAT | getattr(os, "O_BINARY", 0)
    number = os.open(path, flags | (os.O_TRUNC if anew else os.O_APPEND), PRIVATE)
    return os.fdopen(number, "wb")


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
    """Files as a zip archive, in their order: the same bytes on any day.

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
    """Write several files so that either all of them appear or none changes.

    A folder that is new appears with everything in it. In one that exists, the last file seals the
    set: it goes first and comes back last, so a run that is killed never leaves it beside others
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
    """Write everything where nobody looks."""
    _make_folder(stage, mode)
    for name, data in contents.items():
        if (folder / name).is_dir():
            raise RenderError(f"{folder / name}: is a folder")
        _make_folder((stage / name).parent, mode)
        (stage / name).touch(modes[name])
        _write_synced(stage / name, data)


def _make_folder(folder: Path, mode: int) -> None:
    """Make a folder and those around it: names of files, such as of students, tell something."""
    for one in reversed([path for path in (folder, *folder.parents) if not path.exists()]):
        one.mkdir(0o700 if mode == PRIVATE else 0o777, exist_ok=True)


def _move_staged_files(
    stage: Path, folder: Path, names: list[str], mode: int, *, new: bool
) -> None:
    """Move what was staged to where it belongs, the last file last."""
    if new:
        stage.rename(folder)
        return
    if len(names) > 1:
        (folder / names[-1]).unlink(missing_ok=True)
    for name in names:
        _make_folder((folder / name).parent, mode)
        (stage / name).replace(folder / name)


def _remove_stale_stages(folder: Path) -> None:
    """Remove what runs that were killed long ago left behind."""
    for path in folder.iterdir():
        if not _LEFT_BEHIND.fullmatch(path.name):
            continue
        with contextlib.suppress(OSError):
            if time.time() - path.lstat().st_mtime > STALE:
                _remove_path(path)


def _remove_path(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink()


@contextlib.contextmanager
def _delay_interrupts() -> Iterator[None]:
    """Let Ctrl-C wait until all files stand where they belong."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    waiting: list[int] = []

    def wait(number: int, _frame: FrameType | None) -> None:
        waiting.append(number)

    before = signal.signal(signal.SIGINT, wait)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if waiting:
            signal.raise_signal(waiting[0])


def _write_synced(path: Path, data: bytes) -> None:
    with path.open("wb") as stream:
        stream.write(data)
        stream.flush()
        os.fsync(stream.fileno())


def read_table(path: Path, meant: Callable[[str], str] = str) -> Mapping[str, Any]:
    """Read a JSON file or, by its suffix or its first sign, a TOML file; 0.50 stays text.

    Parameters
    ----------
    path : pathlib.Path
    meant : callable
        What becomes of a TOML file that people write by hand before it is read.

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

"""Files that responses come in: a table, or an archive of such."""

from __future__ import annotations

import lzma
import zipfile
import zlib
from collections.abc import Callable, Collection, Iterable, Iterator
from io import BytesIO
from pathlib import Path

from quizgen.core.errors import KeyFileError
from quizgen.core.untrusted import decode_text, read_bytes
from quizgen.responses.attempts import Attempt, Lost
from quizgen.responses.qti import from_xml
from quizgen.responses.tables import from_csv, from_json

LARGEST = 60_000_000
"""Bytes of the largest report that is read, unpacked."""
MOST_FILES = 20_000
DAMAGED = (
    zipfile.BadZipFile, zlib.error, lzma.LZMAError, RuntimeError, ValueError, EOFError, OSError,
)  # fmt: skip
"""What reading an archive raises if it is damaged, locked or packed in an unknown way."""

Reader = Callable[[str, Path, Collection[str], Lost], Iterator[Attempt]]

READERS: dict[str, Reader] = {".csv": from_csv, ".tsv": from_csv, ".txt": from_csv,
                              ".json": from_json, ".xml": from_xml}  # fmt: skip
"""What reads a file, by its suffix."""
KNOWN = ", ".join(READERS)


def attempts(paths: Iterable[Path], known: Collection[str], lost: Lost) -> Iterator[Attempt]:
    """Attempts in files.

    Parameters
    ----------
    paths : iterable of pathlib.Path
    known : collection of str
        Marks and ids of the questions there are.
    lost : callable
        Told, with file and line, of all that cannot be read; it stops nothing else.
    """
    for path in paths:
        try:
            for name, data in _files(path):
                yield from _read(name, data, known, lost)
        except KeyFileError as error:
            lost(str(error))


def _files(path: Path) -> Iterator[tuple[Path, bytes]]:
    data = read_bytes(path, KeyFileError, LARGEST)
    return _unpacked(path, data) if path.suffix.lower() == ".zip" else iter([(path, data)])


def _read(path: Path, data: bytes, known: Collection[str], lost: Lost) -> Iterator[Attempt]:
    try:
        yield from _reader(path)(decode_text(data, path, KeyFileError), path, known, lost)
    except KeyFileError as error:
        lost(str(error))


def _reader(path: Path) -> Reader:
    found = READERS.get(path.suffix.lower())
    if found is None:
        raise KeyFileError(f"{path}: no file of responses (known: {KNOWN} and .zip)")
    return found


def _unpacked(path: Path, data: bytes) -> Iterator[tuple[Path, bytes]]:
    """The files of an archive that can be read, as long as they are not too large together."""
    left = LARGEST
    try:
        with zipfile.ZipFile(BytesIO(data)) as archive:
            inside = [one for one in archive.infolist() if not one.is_dir()]
            if len(inside) > MOST_FILES:
                raise KeyFileError(f"{path}: more than {MOST_FILES} files")
            readable = [one for one in inside if Path(one.filename).suffix.lower() in READERS]
            if not readable:
                raise KeyFileError(f"{path}: no file of responses in it (known: {KNOWN})")
            for one in readable:
                with archive.open(one) as stream:
                    content = stream.read(left + 1)
                left -= len(content)
                if left < 0:
                    raise KeyFileError(f"{path}: larger than {LARGEST // 10**6} MB unpacked")
                yield path / one.filename, content
    except DAMAGED as error:
        raise KeyFileError(f"{path}: not an archive that can be read ({error})") from None

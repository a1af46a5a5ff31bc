"""Files of responses: tables, result reports, and archives of them."""

from __future__ import annotations

import lzma
import zipfile
import zlib
from collections.abc import Callable, Collection, Iterable, Iterator
from io import BytesIO
from pathlib import Path

from quizgen.core.errors import KeyFileError
from quizgen.core.untrusted import decode_text, read_bytes
from quizgen.lms.attempts import QuizAttempt, ReportLoss
from quizgen.lms.qti.results import attempts_from_qti
from quizgen.lms.response_tables import attempts_from_csv, attempts_from_json

# Bytes of the largest report that is read, unpacked.
LARGEST_REPORT = 60_000_000
MOST_FILES = 20_000
# What reading an archive raises if it is damaged, locked or packed in an unknown way.
ARCHIVE_ERRORS = (
    zipfile.BadZipFile, zlib.error, lzma.LZMAError, RuntimeError, ValueError, EOFError, OSError,
)  # fmt: skip

ResponseReader = Callable[[str, Path, Collection[str], ReportLoss], Iterator[QuizAttempt]]

RESPONSE_READERS: dict[str, ResponseReader] = {
    ".csv": attempts_from_csv,
    ".tsv": attempts_from_csv,
    ".txt": attempts_from_csv,
    ".json": attempts_from_json,
    ".xml": attempts_from_qti,
}
KNOWN_SUFFIXES = ", ".join(RESPONSE_READERS)


def read_attempts(
    paths: Iterable[Path], known: Collection[str], lost: ReportLoss
) -> Iterator[QuizAttempt]:
    """Yield the attempts in files.

    Parameters
    ----------
    paths : iterable of pathlib.Path
    known : collection of str
        Tokens and ids of the questions of the manifest.
    lost : callable
        Called with the file and line of all that cannot be read; the rest is read.
    """
    for path in paths:
        try:
            for name, data in _read_files(path):
                yield from _read_report(name, data, known, lost)
        except KeyFileError as error:
            lost(str(error))


def _read_files(path: Path) -> Iterator[tuple[Path, bytes]]:
    data = read_bytes(path, KeyFileError, LARGEST_REPORT)
    return _unpack(path, data) if path.suffix.lower() == ".zip" else iter([(path, data)])


def _read_report(
    path: Path, data: bytes, known: Collection[str], lost: ReportLoss
) -> Iterator[QuizAttempt]:
    try:
        yield from _reader_for(path)(decode_text(data, path, KeyFileError), path, known, lost)
    except KeyFileError as error:
        lost(str(error))


def _reader_for(path: Path) -> ResponseReader:
    found = RESPONSE_READERS.get(path.suffix.lower())
    if found is None:
        raise KeyFileError(f"{path}: no file of responses (known: {KNOWN_SUFFIXES} and .zip)")
    return found


def _unpack(path: Path, data: bytes) -> Iterator[tuple[Path, bytes]]:
    """The files of an archive that can be read, unless they are too large together."""
    left = LARGEST_REPORT
    try:
        with zipfile.ZipFile(BytesIO(data)) as archive:
            inside = [one for one in archive.infolist() if not one.is_dir()]
            if len(inside) > MOST_FILES:
                raise KeyFileError(f"{path}: more than {MOST_FILES} files")
            readable = [
                one for one in inside if Path(one.filename).suffix.lower() in RESPONSE_READERS
            ]
            if not readable:
                raise KeyFileError(f"{path}: no file of responses in it (known: {KNOWN_SUFFIXES})")
            for one in readable:
                with archive.open(one) as stream:
                    content = stream.read(left + 1)
                left -= len(content)
                if left < 0:
                    raise KeyFileError(f"{path}: larger than {LARGEST_REPORT // 10**6} MB unpacked")
                yield path / one.filename, content
    except ARCHIVE_ERRORS as error:
        raise KeyFileError(f"{path}: not an archive that can be read ({error})") from None

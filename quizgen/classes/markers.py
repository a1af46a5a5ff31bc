"""Who marks what: ``markers.json``, a table of markers for each item, written whole.

Several first markers of an item share its answers in equal stretches. A second marker sees all of
them and nothing of the first. Where people sign in, only who is named here, or manages the server,
sees anything of the class.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from pathlib import Path

import msgspec

from quizgen.classes.lock import lock_folder
from quizgen.core.decoding import decode_json
from quizgen.core.errors import ClassError
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import read_bytes

FILE = "markers.json"
MOST, LONGEST = 50, 100
"""Markers of an item; characters of a name."""


class ItemMarkers(msgspec.Struct, frozen=True, omit_defaults=True):
    """First and second markers of an item; without any, everybody marks all of it."""

    first: tuple[str, ...] = ()
    second: tuple[str, ...] = ()

    def is_second(self, who: str) -> bool:
        """Return whether somebody is to mark blindly, and not as the first."""
        return _is_named(who, self.second) and not _is_named(who, self.first)

    def owns(self, who: str, place: int, count: int) -> bool:
        """Return whether an answer is in the share of a first marker.

        Parameters
        ----------
        who : str
        place, count : int
            Where the answer stands among how many.
        """
        if not self.first:
            return not self.is_second(who)
        return _fold_name(self.first[place * len(self.first) // count]) == _fold_name(who)


class ClassMarkers(msgspec.Struct, frozen=True):
    """The markers of a class, by item."""

    items: dict[str, ItemMarkers] = {}

    def of(self, item: str) -> ItemMarkers:
        """Return the markers of an item."""
        return self.items.get(item, ItemMarkers())

    def names(self, who: str) -> bool:
        """Return whether somebody marks anything here."""
        return any(_is_named(who, (*one.first, *one.second)) for one in self.items.values())


def read_markers(folder: Path) -> ClassMarkers:
    """Return who marks what; nobody if there is no file.

    Raises
    ------
    ClassError
        Naming the file.
    """
    path = folder / FILE
    if not path.exists():
        return ClassMarkers()
    try:
        return decode_json(read_bytes(path, ClassError), ClassMarkers)
    except msgspec.DecodeError as error:
        raise ClassError(f"{path}: {error}") from None


def write_markers(folder: Path, item: str, markers: ItemMarkers) -> None:
    """Replace the markers of one item.

    Raises
    ------
    ClassError
        If there are too many, or another command writes there.
    """
    for names in (markers.first, markers.second):
        if len(names) > MOST or any(len(name) > LONGEST for name in names):
            raise ClassError(f"at most {MOST} markers, {LONGEST} characters each")
    with lock_folder(folder):
        items = {**read_markers(folder).items, item: markers}
        data = msgspec.json.format(msgspec.json.encode(ClassMarkers(items)), indent=1) + b"\n"
        write_all(folder, {FILE: data}, PRIVATE)


def split_names(text: str) -> tuple[str, ...]:
    """Return names that were typed with commas between them, each once."""
    return tuple(dict.fromkeys(filter(None, (name.strip() for name in text.split(",")))))


def _is_named(who: str, names: Sequence[str]) -> bool:
    """Return whether somebody is among names, compared as names of accounts are."""
    return _fold_name(who) in map(_fold_name, names)


def _fold_name(name: str) -> str:
    """Return a name in the form in which accounts are compared."""
    return unicodedata.normalize("NFKC", name).casefold()

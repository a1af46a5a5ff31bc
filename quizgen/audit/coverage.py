"""What of the curriculum the templates cover, and what is still open.

Each template names what it covers (``covers = ["F09", "C11b", "W03", "TR07"]``); a figure covers
itself wherever it is used.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from quizgen.bank.folder import Bank


def _numbered(letter: str, last: int, digits: int = 2) -> tuple[str, ...]:
    return tuple(f"{letter}{number:0{digits}d}" for number in range(1, last + 1))


SUB_PARTS = (
    "A1a A1b A1c A1d A2 A3 A4a A4b A5 B6a B6b B7a B7b B7c B8 B9a B9b B10a B10b C11a C11b "
    "C12a C12b C12c C12d C12e C13a C13b C13c C14a C14b C14c C15a C15b D16a D16b D16c "
    "D17a D17b D17c D18a D18b D18c D18d D18e D19a D19b D19c D20a D20b D20c"
)

INVENTORY: Mapping[str, tuple[str, ...]] = {
    "formulas": _numbered("F", 46),
    "worked examples": _numbered("W", 18),
    "trial exam": ("Q1a", "Q1b", "Q1c-i", "Q1c-ii", "Q1d", "Q4a"),
    "mock questions": tuple(SUB_PARTS.split()),
    "sections": _numbered("S", 24),
    "figures": tuple(f"FIG{number}" for number in range(1, 10)),
    "code": _numbered("K", 28),
    "traps": _numbered("TR", 28),
    "statements": ("TF1", "TF2", "TF3"),
}
"""Group to the names of its items; each of the three statement sets holds six statements."""

BEYOND = re.compile(r"X-[ABCD]\d\d|EC?\d{1,2}")
"""Items past the notes: additional templates, and corrections of the notes."""

FIGURES = {
    "pinhole": "FIG1", "distorted_grid": "FIG2", "hsv_edits": "FIG3", "bayer": "FIG4",
    "noise": "FIG5", "gaussian": "FIG6", "depth_of_field": "FIG7", "luminosity": "FIG8",
    "normalisation": "FIG9",
}  # fmt: skip


@dataclass(frozen=True)
class Row:
    """One group: how much of it is covered, by which templates, and the holes."""

    group: str
    covered: Mapping[str, tuple[str, ...]]
    holes: tuple[str, ...]

    @property
    def total(self) -> int:
        """Items of the group."""
        return len(self.covered) + len(self.holes)


def coverage(bank: Bank) -> list[Row]:
    """Coverage of every group of the inventory."""
    by_item: dict[str, list[str]] = {}
    for name in bank.paths:
        for item in _covered(bank, name):
            by_item.setdefault(item, []).append(name)
    return [_row(group, items, by_item) for group, items in INVENTORY.items()]


def covering(bank: Bank, item: str) -> list[str]:
    """Templates that cover an item, or a part of it: ``C12`` finds ``C12a``."""
    wanted = re.compile(rf"{re.escape(item)}(?:-?[a-z].*)?")
    return [name for name in bank.paths if any(map(wanted.fullmatch, _covered(bank, name)))]


def unknown(bank: Bank) -> list[tuple[str, str]]:
    """Template and item wherever a template claims something the curriculum does not have.

    A whole question (``C12``) is known by its sub-parts (``C12a``).
    """
    items = [item for items in INVENTORY.values() for item in items]
    whole = {re.sub(r"(?<=\d)[a-z]$|-.*$", "", item) for item in items}
    known = {*items, *whole}
    return [
        (name, item)
        for name in bank.paths
        for item in bank.rules(name).covers
        if item not in known and not BEYOND.fullmatch(item)
    ]


def _covered(bank: Bank, name: str) -> Iterable[str]:
    rules = bank.rules(name)
    figure = FIGURES.get(rules.figure.name) if rules.figure else None
    return {*rules.covers, *([figure] if figure else [])}


def _row(group: str, items: tuple[str, ...], by_item: Mapping[str, list[str]]) -> Row:
    covered = {item: tuple(by_item[item]) for item in items if item in by_item}
    return Row(group, covered, tuple(item for item in items if item not in by_item))

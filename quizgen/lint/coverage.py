"""What of its curriculum a bank covers, and what is still open.

Each template names what it covers (``covers = ["F09", "C11b", "W03", "TR07"]``); a figure covers
itself wherever it is used. What there is to cover stands in the bank's ``curriculum.toml``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from quizgen.bank.bank import Bank


@dataclass(frozen=True)
class CoverageGroup:
    """Coverage of one curriculum group: each covered item with its templates, and the holes."""

    group: str
    covered: Mapping[str, tuple[str, ...]]
    holes: tuple[str, ...]

    @property
    def total(self) -> int:
        """Return the number of items of the group."""
        return len(self.covered) + len(self.holes)


def curriculum_coverage(bank: Bank) -> list[CoverageGroup]:
    """Return the coverage of every group of the curriculum, in its order."""
    by_item: dict[str, list[str]] = {}
    for name in bank.template_paths:
        for item in _list_covered_items(bank, name):
            by_item.setdefault(item, []).append(name)
    inventory = bank.curriculum.inventory
    return [_build_coverage_row(group, items, by_item) for group, items in inventory.items()]


def verb_coverage(bank: Bank) -> list[CoverageGroup]:
    """Return, verb by verb, which items that ask for it are asked so by a template."""
    found = []
    for verb, items in bank.curriculum.verbs.items():
        by_item: dict[str, list[str]] = {}
        for name in bank.template_paths:
            asked = bank.rules(name).verbs
            for item in (item for item, own in asked.items() if own == verb):
                by_item.setdefault(item, []).append(name)
        found.append(_build_coverage_row(verb, items, by_item))
    return found


def templates_covering(bank: Bank, item: str) -> list[str]:
    """Return the templates that cover an item or a part of it: ``C12`` finds ``C12a``."""
    wanted = re.compile(rf"{re.escape(item)}(?:-?[a-z].*)?")
    return [
        name
        for name in bank.template_paths
        if any(map(wanted.fullmatch, _list_covered_items(bank, name)))
    ]


def _list_covered_items(bank: Bank, name: str) -> Iterable[str]:
    """Return the curriculum items that a template covers, that of its figure too."""
    rules = bank.rules(name)
    figure = bank.curriculum.figures.get(rules.figure.name) if rules.figure else None
    return {*rules.covers, *([figure] if figure else [])}


def _build_coverage_row(
    group: str, items: tuple[str, ...], by_item: Mapping[str, list[str]]
) -> CoverageGroup:
    """Return one group's coverage, from its items and the templates of every item."""
    covered = {item: tuple(by_item[item]) for item in items if item in by_item}
    return CoverageGroup(group, covered, tuple(item for item in items if item not in by_item))

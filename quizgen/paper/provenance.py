"""Which banks a paper was made from, and whether those that are here are the same.

A digest is of the files behind the questions of the paper, so a bank in which another question has
changed since is still the same one for it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from typing import TYPE_CHECKING

import msgspec

from quizgen.core.cache import compute_digest
from quizgen.core.errors import PaperCodeError

if TYPE_CHECKING:
    from quizgen.bank.bank import Bank

SHOWN = 12
"""Signs of a digest."""


class BankRecord(msgspec.Struct, frozen=True):
    """A bank that a paper was made from.

    Parameters
    ----------
    name, version : str
        As its ``bank.toml`` says.
    digest : str
        Of the files behind the templates.
    templates : tuple of str
        Those in the paper, as they are called in the bank.
    """

    name: str
    version: str
    digest: str
    templates: tuple[str, ...]

    def __str__(self) -> str:
        """Return name, version and digest, as a page names the bank."""
        return " ".join(filter(None, (self.name, self.version, f"({self.digest})")))


def record_banks(bank: Bank, names: Iterable[str]) -> tuple[BankRecord, ...]:
    """Return what a paper notes of the banks that its templates stand in.

    Parameters
    ----------
    bank : Bank
    names : iterable of str
        The templates of a paper.
    """
    homes = [bank.owner_of(name) for name in names]
    return tuple(
        _record_bank(part, tuple(sorted({own for home, own in homes if home is part})))
        for part in bank.members
        if any(home is part for home, _ in homes)
    )


@cache
def _record_bank(bank: Bank, templates: tuple[str, ...]) -> BankRecord:
    """Return what a paper notes of one bank: name, version, digest of its templates' files."""
    digest = compute_digest(
        *(part for name in templates for part in _read_template_contents(bank, name))
    )
    return BankRecord(bank.name, bank.metadata.version, digest[:SHOWN], templates)


@cache
def _read_template_contents(bank: Bank, name: str) -> tuple[bytes, ...]:
    """Return the files of a template, cached: it stands in many of many papers."""
    return bank.template_files(name)


def describe_differences(used: Iterable[BankRecord], banks: Iterable[Bank]) -> str:
    """Return how the banks here differ from those of a paper, in one line; empty if equal."""
    return "; ".join(_iter_differences(used, {bank.name: bank for bank in banks}))


@contextmanager
def bank_difference_context(used: Callable[[], Iterable[BankRecord]], bank: Bank) -> Iterator[None]:
    """Add to an error which banks differ from those of the paper that cannot be rebuilt.

    Parameters
    ----------
    used : callable
        Gives the banks of the paper, where they are asked for.
    bank : Bank
    """
    try:
        yield
    except PaperCodeError as error:
        told = describe_differences(used(), bank.members)
        raise PaperCodeError(f"{error}{told and '; '}{told}") from error


def _iter_differences(used: Iterable[BankRecord], here: Mapping[str, Bank]) -> Iterator[str]:
    """Yield one line for each bank that is missing here or not as it was."""
    for one in used:
        if one.name not in here:
            yield f"{one.name}: not among the banks here (--bank {one.name}, or its folder)"
            continue
        part = here[one.name]
        gone = [name for name in one.templates if name not in part.template_paths]
        if part.metadata.version != one.version:
            yield (
                f"{one.name}: version {part.metadata.version or 'unknown'} here, "
                f"{one.version or 'unknown'} on the paper"
            )
        elif gone:
            yield f"{one.name}: no template {gone[0]!r} here, which the paper asks"
        elif _record_bank(part, one.templates).digest != one.digest:
            yield f"{one.name}: other files here than on the paper, of the same version"

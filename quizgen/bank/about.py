"""What a bank says about itself: ``templates/bank.toml`` and ``templates/curriculum.toml``.

Both may be missing: a bank needs nothing but its templates.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TypeVar

import msgspec

from quizgen.bank.complaints import in_words
from quizgen.errors import BankError, FormulaError
from quizgen.locale import FIRST
from quizgen.locale.brought import is_tag
from quizgen.maths.units import System, system
from quizgen.outside import parse_toml, read_text
from quizgen.shapes import converted

S = TypeVar("S", bound=msgspec.Struct)

_RANGE = re.compile(r"(\D+)(\d+)\.\.\1(\d+)")


class About(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """What ``bank.toml`` says.

    ``languages`` are those it is written in, ``title`` is the chapter's by language, and
    ``topics`` are its topics in order, each with its title by language. ``terms`` are words of the
    subject, none of which is another one misspelt; ``counted`` has the words that may stand beside
    a number, by the name that an answer gives as ``counts``; ``units`` are those besides the listed
    ones, each as Pint defines units; ``photographs`` are the figures that are pictures of a camera,
    of which a blueprint may ask for some. ``requires`` are the versions of quizgen that it works
    with.
    """

    name: str = ""
    version: str = ""
    licence: str = ""
    authors: tuple[str, ...] = ()
    requires: str = ""
    languages: tuple[str, ...] = ()
    terms: tuple[str, ...] = ()
    counted: dict[str, tuple[str, ...]] = {}
    title: dict[str, str] = {}
    topics: dict[str, dict[str, str]] = {}
    units: tuple[str, ...] = ()
    photographs: frozenset[str] = frozenset()

    @property
    def system(self) -> System:
        """The listed units and its own."""
        return system(self.units)


class Curriculum(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """What there is to cover.

    ``groups`` lists the items of each group, ``F01..F46`` being a row of numbers; ``figures``
    says which item a figure covers; items past the curriculum are any of ``beyond`` and a number.
    """

    groups: dict[str, tuple[str, ...]] = {}
    figures: dict[str, str] = {}
    beyond: tuple[str, ...] = ()

    @property
    def inventory(self) -> Mapping[str, tuple[str, ...]]:
        """Group to the names of its items, rows of numbers written out."""
        return {
            group: tuple(item for row in rows for item in _items(row))
            for group, rows in self.groups.items()
        }


def _items(row: str) -> Iterator[str]:
    match = _RANGE.fullmatch(row)
    if match is None:
        yield row
        return
    letters, first, last = match.groups()
    for number in range(int(first), int(last) + 1):
        yield f"{letters}{number:0{len(first)}d}"


def read_struct(path: Path, kind: type[S]) -> S:
    """Read one of a bank's files; a missing one is an empty one.

    Raises
    ------
    BankError
        Naming the file and the key.
    """
    if not path.exists():
        return kind()
    try:
        return converted(parse_toml(read_text(path, BankError), path, BankError), kind)
    except msgspec.ValidationError as error:
        raise BankError(f"{path}: {in_words(error, kind)}") from error


def read_about(path: Path) -> About:
    """Read ``bank.toml``; a missing one says nothing.

    Raises
    ------
    BankError
        Naming the file and the key, also where this version of quizgen is none it works with.
    """
    about = read_struct(path, About)
    for lang in about.languages:
        if not is_tag(lang):
            raise BankError(f'{path}: languages: {lang!r} is no language (write "fr", or "pt-BR")')
    try:
        system(about.units)
    except FormulaError as error:
        raise BankError(f"{path}: units: {error}") from error
    if about.requires:
        _check_version(path, about.requires)
    return about


def _check_version(path: Path, requires: str) -> None:
    from importlib.metadata import version

    from packaging.specifiers import InvalidSpecifier, SpecifierSet

    here = version("quizgen")
    try:
        fits = SpecifierSet(requires).contains(here, prereleases=True)
    except InvalidSpecifier as error:
        raise BankError(f'{path}: requires: {requires!r} is not like ">=0.1"') from error
    if not fits:
        raise BankError(f"{path}: requires: quizgen {requires}, and this is {here}")


def in_language(texts: Mapping[str, str], lang: str, otherwise: str) -> str:
    """A text in a language, else in English, else in the first that it has, else another text."""
    return texts.get(lang) or texts.get(FIRST) or next(iter(texts.values()), "") or otherwise


def marked_with(about: About, answers: Sequence[Mapping[str, object]]) -> Iterator[bytes]:
    """The words of ``bank.toml`` that a template's answers are marked with."""
    if any("counts" in answer for answer in answers):
        yield msgspec.json.encode(about.counted)
    if any(answer.get("kind") == "gap" for answer in answers):
        yield msgspec.json.encode(about.terms)
    if about.units:
        yield msgspec.json.encode(about.units)

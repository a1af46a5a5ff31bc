"""What a bank says about itself: ``templates/bank.toml`` and ``templates/curriculum.toml``.

Both may be missing: a bank needs nothing but its templates.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TypeVar

import msgspec

from quizgen.core.complaints import complaint_of
from quizgen.core.decoding import convert
from quizgen.core.errors import BankError, FormulaError
from quizgen.core.untrusted import error_context, parse_toml, read_text
from quizgen.locale import FIRST
from quizgen.locale.custom import is_language_tag
from quizgen.maths.units import UnitRegistry, build_unit_registry

S = TypeVar("S", bound=msgspec.Struct)

_RANGE = re.compile(r"(\D+)(\d+)\.\.\1(\d+)")


class BankMetadata(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """What ``bank.toml`` says.

    ``languages`` are those it is written in, ``title`` is the chapter's by language, and
    ``topics`` are its topics in order, each with its title by language. ``terms`` are words of the
    subject, none of which is another one misspelt; ``synonyms`` are groups of them that mean the
    same in a learner's sentence, each under a name; ``counted`` has the words that may stand beside
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
    synonyms: dict[str, tuple[str, ...]] = {}
    counted: dict[str, tuple[str, ...]] = {}
    title: dict[str, str] = {}
    topics: dict[str, dict[str, str]] = {}
    units: tuple[str, ...] = ()
    photographs: frozenset[str] = frozenset()

    @property
    def system(self) -> UnitRegistry:
        """Return the units that quizgen lists, with the bank's own added."""
        return build_unit_registry(self.units)


class NotesSection(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A section of the notes: its number, its title by language, the items that stand in it."""

    section: str
    title: dict[str, str]
    items: tuple[str, ...]


class Curriculum(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """What there is to cover.

    ``groups`` lists the items of each group, ``F01..F46`` being a row of numbers; ``verbs`` lists
    the items that ask to explain, define, derive, ... in words of one's own; ``figures``
    says which item a figure covers; items past the curriculum are any of ``beyond`` and a number;
    ``notes`` are the sections of the notes, in their order.
    """

    groups: dict[str, tuple[str, ...]] = {}
    verbs: dict[str, tuple[str, ...]] = {}
    figures: dict[str, str] = {}
    beyond: tuple[str, ...] = ()
    notes: tuple[NotesSection, ...] = ()

    @property
    def sections(self) -> Mapping[str, str]:
        """Return the number of the section in which each item of the notes stands."""
        return {
            item: one.section
            for one in self.notes
            for row in one.items
            for item in _expand_range(row)
        }

    @property
    def inventory(self) -> Mapping[str, tuple[str, ...]]:
        """Return the names of the items of each group, rows of numbers written out."""
        return {
            group: tuple(item for row in rows for item in _expand_range(row))
            for group, rows in self.groups.items()
        }


def _expand_range(row: str) -> Iterator[str]:
    """Yield the names that a row such as ``B01..B12`` stands for; any other row as it is."""
    match = _RANGE.fullmatch(row)
    if match is None:
        yield row
        return
    letters, first, last = match.groups()
    for number in range(int(first), int(last) + 1):
        yield f"{letters}{number:0{len(first)}d}"


def read_optional(path: Path, kind: type[S]) -> S:
    """Return the content of one of a bank's files; for a missing file, that of an empty one.

    Raises
    ------
    BankError
        Naming the file and the key.
    """
    if not path.exists():
        return kind()
    table = parse_toml(read_text(path, BankError), path, BankError)
    try:
        return convert(table, kind)
    except msgspec.ValidationError as error:
        with error_context(path, BankError):
            raise complaint_of(error, kind, table) from error


def read_metadata(path: Path) -> BankMetadata:
    """Return what ``bank.toml`` says; empty metadata if there is no such file.

    Raises
    ------
    BankError
        Naming the file and the key, also where this version of quizgen is none it works with.
    """
    about = read_optional(path, BankMetadata)
    with error_context(path, BankError):
        for index, lang in enumerate(about.languages):
            if not is_language_tag(lang):
                what = f'languages: {lang!r} is no language (write "fr", or "pt-BR")'
                raise BankError(what, rule="QG108", place=("languages", index))
        try:
            build_unit_registry(about.units)
        except FormulaError as error:
            place = ("units", _find_unsound_unit(about.units))
            raise BankError(f"units: {error}", rule="QG122", place=place) from error
        if about.requires:
            _check_version(about.requires)
    return about


def _find_unsound_unit(units: tuple[str, ...]) -> int:
    """Return the index of the first definition that cannot be read with those before it."""
    for count in range(len(units)):
        try:
            build_unit_registry(units[: count + 1])
        except FormulaError:
            return count
    return 0


def _check_version(requires: str) -> None:
    """Raise ``BankError`` if this version of quizgen is not what the bank requires.

    ``packaging`` is imported here: few banks require a version, and every command reads one.
    """
    from importlib.metadata import version

    from packaging.specifiers import SpecifierSet

    here = version("quizgen")
    try:
        fits = SpecifierSet(requires).contains(here, prereleases=True)
    except ValueError as error:  # no specifier, or a number of thousands of digits
        what = f'requires: {requires!r} is not like ">=1.0"'
        raise BankError(what, rule="QG124", place=("requires",)) from error
    if not fits:
        what = f"requires: quizgen {requires}, and this is {here}"
        raise BankError(what, rule="QG124", place=("requires",))


def pick_language(texts: Mapping[str, str], lang: str, otherwise: str) -> str:
    """Return a text in a language, else in English, else in its first, else ``otherwise``."""
    return texts.get(lang) or texts.get(FIRST) or next(iter(texts.values()), "") or otherwise


def grading_words(about: BankMetadata, answers: Sequence[Mapping[str, object]]) -> Iterator[bytes]:
    """Yield the words of ``bank.toml`` that a template's answers are graded with."""
    if any("counts" in answer for answer in answers):
        yield msgspec.json.encode(about.counted)
    if any(answer.get("kind") == "gap" for answer in answers):
        yield msgspec.json.encode(about.terms)
    if any(answer.get("kind") == "rubric" for answer in answers):
        yield msgspec.json.encode(about.synonyms)
    if about.units:
        yield msgspec.json.encode(about.units)

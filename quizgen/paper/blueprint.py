"""Blueprints: small TOML files that say which questions a paper holds.

::

    [title]
    en = "Mock exam"
    bn = "..."
    [[slot]]
    tier = "A"            # and/or: topic = "optics", templates = ["rgb-to-hsv"]
    count = 5
    points = 2            # marks of each question, shared out over its parts (default: its own)

``reference`` lists the templates that make up the notes' own paper. A topic's name (``optics``), a
topic with minutes (``optics.45``) or ``all.90`` is a blueprint without a file: questions of that
topic, tiers in turn, as many as the time allows.
"""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import msgspec

from quizgen.bank.folder import Bank, builtin
from quizgen.errors import BlueprintError
from quizgen.locale import languages, word

MOST_QUESTIONS = 200


class SlotRule(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A group of questions: how many, and which templates may fill them."""

    count: int = 1
    tier: str | None = None
    topic: str | None = None
    templates: tuple[str, ...] = ()
    points: float | None = None


class Blueprint(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """What a paper consists of."""

    title: dict[str, str]
    slot: tuple[SlotRule, ...]
    minutes: int | None = None
    reference: tuple[str, ...] = ()
    name: str = ""
    source: str = ""
    topic: str = ""
    budget: int = 0


EVERYTHING = "all"


def of_topic(bank: Bank, topic: str, minutes: int = 0) -> Blueprint:
    """Blueprint without a file: a topic (or ``all``), within a time (0: no limit)."""
    name = f"{topic}.{minutes}" if minutes else topic
    title = {lang: f"{word(lang, 'paper.exam')}: {_subject(bank, topic, lang)}"
             for lang in languages()}  # fmt: skip
    return Blueprint(title, (), None, (), name, name, topic, minutes)


def _subject(bank: Bank, topic: str, lang: str) -> str:
    return bank.title(lang) if topic == EVERYTHING else bank.topic_title(topic, lang)


def topics(bank: Bank) -> list[str]:
    """Topic names of a bank, ``all`` last."""
    return [*bank.topics, EVERYTHING]


def load_blueprint(name_or_file: str, bank: Bank | None = None) -> Blueprint:
    """Load a bank's blueprint by name, a topic of the bank, or a file.

    Parameters
    ----------
    name_or_file : str
        For example ``mock``, ``optics.45`` or ``papers/week3.toml``.
    bank : Bank, optional
        The built-in bank if left out.

    Raises
    ------
    BlueprintError
        Naming file, key and what is allowed.
    """
    bank = builtin() if bank is None else bank
    known = bank.blueprints
    topic = re.fullmatch(r"(.+?)(?:\.(\d{1,4}))?", name_or_file)
    if name_or_file not in known and topic and topic[1] in topics(bank):
        return of_topic(bank, topic[1], int(topic[2] or 0))
    path = known.get(name_or_file, Path(name_or_file))
    try:
        source = path.read_text(encoding="utf-8")
    except OSError as error:
        names = ", ".join(known) or "none"
        raise BlueprintError(
            f"no blueprint {name_or_file!r} (the bank has: {names}; or the path of a TOML file)"
        ) from error
    except UnicodeDecodeError as error:
        raise BlueprintError(f"{path}: {error}") from error
    return _convert(source, path.stem, str(path))


def _convert(source: str, name: str, where: str) -> Blueprint:
    try:
        blueprint = msgspec.convert(tomllib.loads(source), Blueprint)
    except tomllib.TOMLDecodeError as error:
        raise BlueprintError(f"{where}: not valid TOML: {error}") from error
    except msgspec.ValidationError as error:
        raise BlueprintError(f"{where}: {error}{_allowed(str(error))}") from error
    _check(blueprint, where)
    return msgspec.structs.replace(blueprint, name=name, source=source)


def _allowed(message: str) -> str:
    if "unknown field" not in message:
        return ""
    kind = SlotRule if "$.slot" in message else Blueprint
    internal = {"name", "source", "topic", "budget"} if kind is Blueprint else set()
    names = sorted({f.encode_name for f in msgspec.structs.fields(kind)} - internal)
    return f" (allowed: {', '.join(names)})"


def _check(blueprint: Blueprint, where: str) -> None:
    if not blueprint.slot:
        raise BlueprintError(f"{where}: at least one [[slot]] is needed")
    for index, slot in enumerate(blueprint.slot, 1):
        if slot.tier is not None and slot.tier not in tuple("ABCD"):
            raise BlueprintError(f"{where}: slot {index}: tier {slot.tier!r} (allowed: A, B, C, D)")
        if slot.points is not None and slot.points <= 0:
            raise BlueprintError(f"{where}: slot {index}: points must be positive")
        if not 1 <= slot.count <= MOST_QUESTIONS:
            raise BlueprintError(f"{where}: slot {index}: count must be 1 to {MOST_QUESTIONS}")
    if "en" not in blueprint.title:
        raise BlueprintError(f"{where}: title.en is missing")

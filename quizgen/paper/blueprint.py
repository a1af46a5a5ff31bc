"""Blueprints: small TOML files that say which questions a paper holds.

::

    [title]
    en = "Mock exam"
    bn = "..."
    [[slot]]
    tier = "A"            # and/or: topic = "optics", templates = ["a-question"]
    count = 5
    points = 2            # marks of each question, shared out over its parts (default: its own)
    level = "guided"      # exam, guided, transfer, mixed (default: the paper's)

What the paper as a whole is to hold may be asked for: ``total = 100`` points exactly,
``minutes = [110, 120]``, at least ``figures = 6`` of ``figure_kinds = 4`` and ``photographs = 2``.
With ``[quota.verb]``, ``[quota.tier]`` or ``[quota.topic]`` so many points of verbs, tiers or
topics are asked for, such as ``"write + derive" = [25, 60]``; ``shared = 4`` is how many questions
papers of neighbouring seeds may have in common.
``pauses = false`` forbids to stop the clock where it is sat in a browser, ``true`` allows it.
``colour = false`` leaves out questions whose figures cannot be read on grey paper.

``reference`` lists the templates that make up the notes' own paper. A topic's name (``optics``), a
topic with minutes (``optics.45``) or ``all.90`` is a blueprint without a file: questions of that
topic, tiers in turn, as many as the time allows.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TypeAlias

import msgspec

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.bank.levels import CHOICES, EXAM
from quizgen.bank.qualified_names import BETWEEN
from quizgen.core.complaints import complaint_of
from quizgen.core.decoding import convert
from quizgen.core.errors import BlueprintError
from quizgen.core.positions import Place
from quizgen.core.untrusted import NAMES, error_context, is_identifier, parse_toml, read_text
from quizgen.kinds.contract import MOST_MINUTES, MOST_POINTS
from quizgen.kinds.work import VERBS
from quizgen.locale import list_languages, translate

MOST_QUESTIONS = 200
"""Questions of a paper."""
MOST_TOTAL = UNLIMITED = 10_000
"""Points that a paper may be asked to have."""
TOGETHER = " + "
"""Between the names of a quota that count together."""
QuotaProblem: TypeAlias = tuple[Place, str, str]
"""Where, the code of the diagnostic, and what is wrong."""
QUOTAS: Mapping[str, tuple[str, ...]] = {"verb": VERBS, "tier": tuple("ABCD"), "topic": ()}
"""What quotas may be of, and what each can name; topics are those of the bank."""
_CODE_NAME = re.compile(r"[\w .-]{1,80}")


class SlotRule(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A group of questions: how many, and which templates may fill them."""

    count: int = 1
    tier: str | None = None
    topic: str | None = None
    templates: tuple[str, ...] = ()
    points: float | None = None
    level: str | None = None


class BlueprintFile(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """What a blueprint's file says."""

    title: dict[str, str]
    slot: tuple[SlotRule, ...]
    minutes: int | tuple[int, int] | None = None
    reference: tuple[str, ...] = ()
    total: float | None = None
    quota: dict[str, dict[str, tuple[float, float]]] = {}
    shared: int | None = None
    figures: int = 0
    figure_kinds: int = 0
    photographs: int = 0
    aids: dict[str, str] = {}
    pauses: bool | None = None
    colour: bool = True

    @property
    def has_constraints(self) -> bool:
        """Return whether it asks for something of the paper as a whole."""
        at_least = self.figures or self.figure_kinds or self.photographs
        return bool(self.total or at_least or isinstance(self.minutes, tuple))


class Blueprint(BlueprintFile, frozen=True):
    """What a paper consists of: of slots, or of a topic within a time.

    ``level`` is that of the questions whose slot names none.
    """

    name: str = ""
    source: str = ""
    topic: str = ""
    budget: int = 0
    file: Path | None = None
    level: str = EXAM


def split_quota(key: str) -> tuple[str, ...]:
    """Return the verbs, tiers or topics that count together under a key."""
    return tuple(key.split(TOGETHER))


EVERYTHING = "all"
MOCK = "mock"
TRIAL = "trial"
"""Name of the blueprint that mirrors the real exam."""


def longest_minutes(blueprint: Blueprint) -> int:
    """Return the minutes that a blueprint states, the upper bound of two; 0 for none."""
    stated = blueprint.minutes
    return max(stated) if isinstance(stated, tuple) else stated or 0


def default_blueprint_name(bank: Bank) -> str:
    """Return the name of the default: the bank's mock exam; without one, all that there is."""
    alone = len(bank.members) == 1 and MOCK in bank.blueprints
    return MOCK if alone else f"{EVERYTHING}.90"


def topic_blueprint(bank: Bank, topic: str, minutes: int = 0) -> Blueprint:
    """Return a blueprint without a file: a topic (or ``all``) in a time, 0 for no limit."""
    name = f"{topic}.{minutes}" if minutes else topic
    title = {lang: f"{translate(lang, 'paper.exam')}: {_find_topic_title(bank, topic, lang)}"
             for lang in list_languages()}  # fmt: skip
    return Blueprint(title, (), name=name, source=name, topic=topic, budget=minutes)


def _find_topic_title(bank: Bank, topic: str, lang: str) -> str:
    """Return the title of a topic, or that of the bank for everything."""
    return bank.title(lang) if topic == EVERYTHING else bank.topic_title(topic, lang)


def topic_choices(bank: Bank) -> list[str]:
    """Return the topic names of a bank, ``all`` last."""
    return [*bank.topics, EVERYTHING]


def load_blueprint(name_or_file: str, bank: Bank | None = None) -> Blueprint:
    """Return a blueprint by its name in the bank, by a topic, or from a file.

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
    bank = builtin_bank() if bank is None else bank
    found = find_blueprint(name_or_file, bank)
    if found is not None:
        return found
    path = Path(name_or_file)
    if not _path_exists(path):
        names = ", ".join(bank.blueprints) or "none"
        raise BlueprintError(
            f"no blueprint {name_or_file!r} (the bank has: {names}; or the path of a TOML file;"
            " --topic needs none)"
        )
    return _read_blueprint(path)


def _path_exists(path: Path) -> bool:
    """Return whether a path exists; False also for a text that can be no path."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def find_blueprint(name: str, bank: Bank) -> Blueprint | None:
    """Return a bank's blueprint by name, or that of a topic; None if it has neither.

    Never a file by its path: names also come from papers' codes, which anyone may have written.
    """
    topic = re.fullmatch(r"(.+?)(?:\.(\d{1,4}))?", name, re.ASCII)
    if name in bank.blueprints:
        return _qualify_blueprint(_read_blueprint(bank.blueprints[name]), name, bank)
    if topic and topic[1] in topic_choices(bank):
        return topic_blueprint(bank, topic[1], int(topic[2] or 0))
    return None


def _qualify_blueprint(plan: Blueprint, name: str, bank: Bank) -> Blueprint:
    """Return a bank's own blueprint with the names that templates have in a combined bank.

    So combined with other banks it goes on asking the questions of its own.
    """
    names = bank.template_names_for(name)
    if not names:
        return plan
    every = tuple(here for here in names.values() if not bank.rules(here).beyond)
    slots = tuple(
        msgspec.structs.replace(
            slot, templates=tuple(names.get(own, own) for own in slot.templates) or every
        )
        for slot in plan.slot
    )
    reference = tuple(names.get(own, own) for own in plan.reference)
    return msgspec.structs.replace(plan, name=name, slot=slots, reference=reference)


def _read_blueprint(path: Path) -> Blueprint:
    """Return a blueprint from its file; the file's name becomes part of every code."""
    if not _CODE_NAME.fullmatch(path.stem):
        raise BlueprintError(
            f"{path.stem!r} cannot stand in a code (allowed: letters, digits, blanks, '_', "
            "'.' and '-', at most 80)",
            rule="QG108",
            file=path,
        )
    return _parse_blueprint(read_text(path, BlueprintError), path.stem, path)


def _parse_blueprint(source: str, name: str, where: Path) -> Blueprint:
    """Return the checked content of a blueprint's file.

    Raises ``BlueprintError`` at the place that is wrong.
    """
    table = parse_toml(source, where, BlueprintError)
    try:
        found = convert(table, BlueprintFile)
    except msgspec.ValidationError as error:
        fault = complaint_of(error, BlueprintFile, table)
        rule, place = fault.rule, fault.place
        raise BlueprintError(fault.message, rule=rule, file=where, place=place) from error
    with error_context(where, BlueprintError):
        _check_blueprint(found)
    given = msgspec.structs.asdict(found)
    return Blueprint(**given, name=name, source=source, file=where)


def _check_blueprint(blueprint: BlueprintFile) -> None:
    """Raise ``BlueprintError`` if a blueprint has no slots, too many questions, or wrong names."""
    if not blueprint.slot:
        raise BlueprintError("at least one [[slot]] is needed", rule="QG105")
    for index, slot in enumerate(blueprint.slot):
        for key, problem in _check_slot(slot):
            what = f"slot {index + 1}: {problem}"
            raise BlueprintError(what, rule="QG107", place=("slot", index, key))
    for index, name in enumerate(blueprint.reference):
        if not _is_template_name(name):
            what, place = f"reference: {name!r} is no name (allowed: {NAMES})", ("reference", index)
            raise BlueprintError(what, rule="QG108", place=place)
    total = max(sum(slot.count for slot in blueprint.slot), len(blueprint.reference))
    if total > MOST_QUESTIONS:
        raise BlueprintError(f"{total} questions (at most {MOST_QUESTIONS})", rule="QG110")
    for key, problem in _check_paper_constraints(blueprint):
        raise BlueprintError(problem, rule="QG107", place=(key,))
    for where, rule, problem in _find_quota_problems(blueprint):
        raise BlueprintError(problem, rule=rule, place=where)


def _check_paper_constraints(blueprint: BlueprintFile) -> Iterator[tuple[str, str]]:
    """Yield the key, and what is wrong with it, of demands on the paper as a whole."""
    span = blueprint.minutes or 1
    first, last = span if isinstance(span, tuple) else (span, span)
    if not 1 <= first <= last <= MOST_MINUTES:
        yield "minutes", f"minutes must be 1 to {MOST_MINUTES}, or [least, most]"
    if blueprint.total is not None and not 0 < blueprint.total <= MOST_TOTAL:
        yield "total", f"total must be positive and at most {MOST_TOTAL}"
    for name in ("figures", "figure_kinds", "photographs"):
        if not 0 <= getattr(blueprint, name) <= MOST_QUESTIONS:
            yield name, f"{name} must be 0 to {MOST_QUESTIONS}"
    if not any(blueprint.title.values()):
        yield "title", "title: is empty (write it in the language of the bank, such as title.en)"


def _find_quota_problems(blueprint: BlueprintFile) -> Iterator[QuotaProblem]:
    """Yield the place, code and problem of quotas that cannot hold, whatever the bank has."""
    for group, limits in blueprint.quota.items():
        for key, span in limits.items():
            yield from _check_quota(("quota", group, key), span)
    worth = [slot.points for slot in blueprint.slot for _ in range(slot.count)]
    if blueprint.quota:
        yield from _check_sums(blueprint, worth)
    if blueprint.shared is not None and not (blueprint.quota and blueprint.shared >= 0):
        yield ("shared",), "QG322", "shared must be 0 or more, in a blueprint with [quota]"


def _check_quota(place: tuple[str, str, str], span: tuple[float, float]) -> Iterator[QuotaProblem]:
    """Yield unknown names of a quota, and a span that is none."""
    _, group, key = place
    if group not in QUOTAS:
        yield place[:2], "QG320", f"quota.{group} is unknown (allowed: {', '.join(QUOTAS)})"
        return
    allowed = QUOTAS[group]
    for name in split_quota(key):
        if name not in allowed if allowed else not is_identifier(name):
            listed = f" (allowed: {', '.join(allowed)})" if allowed else " is no name"
            yield place, "QG320", f"quota.{group}: {name!r}{listed}"
    least, most = span
    if not 0 <= least <= most <= UNLIMITED:
        what = f"[{least:g}, {most:g}] is not [least, most] of 0 to {UNLIMITED} points"
        yield place, "QG321", f"quota.{group}.{key}: {what}"


def _check_sums(blueprint: BlueprintFile, worth: Sequence[float | None]) -> Iterator[QuotaProblem]:
    """Yield sums of a blueprint with quotas that contradict each other."""
    total = blueprint.total
    if total is None:
        return
    known = [one for one in worth if one is not None]
    if len(known) == len(worth) and sum(known) != total:
        what = f"total = {total:g} cannot be met: the slots give {sum(known):g} points"
        yield ("total",), "QG322", what
    for group, limits in blueprint.quota.items():
        names = [name for key in limits for name in split_quota(key)]
        least = sum(low for low, _ in limits.values())
        if least > total and len(set(names)) == len(names):
            what = f"quota.{group} asks for {least:g} points at least, and the total is {total:g}"
            yield ("quota", group), "QG322", what


def _check_slot(slot: SlotRule) -> Iterator[tuple[str, str]]:
    """Yield the key, and what is wrong with it, of a slot."""
    if slot.tier is not None and slot.tier not in tuple("ABCD"):
        yield "tier", f"tier {slot.tier!r} (allowed: A, B, C, D)"
    if slot.points is not None and not 0 < slot.points <= MOST_POINTS:
        yield "points", f"points must be positive and at most {MOST_POINTS}"
    if slot.level is not None and slot.level not in CHOICES:
        yield "level", f"level {slot.level!r} (allowed: {', '.join(CHOICES)})"
    if not 1 <= slot.count <= MOST_QUESTIONS:
        yield "count", f"count must be 1 to {MOST_QUESTIONS}"
    names = [("templates", name) for name in slot.templates]
    names += [] if slot.topic is None else [("topic", slot.topic)]
    for key, name in names:
        if not _is_template_name(name):
            yield key, f"{name!r} is no name (allowed: {NAMES})"


def _is_template_name(name: str) -> bool:
    """Return whether a text can name a template, with or without its bank in front."""
    bank, _, own = name.rpartition(BETWEEN)
    return is_identifier(own) and (not bank or is_identifier(bank))

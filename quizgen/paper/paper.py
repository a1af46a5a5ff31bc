"""From a blueprint and a seed to a paper, and from a paper's code back to the same paper."""

from __future__ import annotations

import hashlib
import json
import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from decimal import Decimal
from fractions import Fraction
from itertools import repeat
from typing import Any

from quizgen import locale
from quizgen.bank.draw import Draw, draw
from quizgen.bank.folder import Bank
from quizgen.bank.prose import Block, CodeBlock
from quizgen.bank.template import Template, minutes_of
from quizgen.errors import BlueprintError, CodeError, DrawError
from quizgen.paper.blueprint import EVERYTHING, Blueprint, SlotRule, load
from quizgen.question.compose import Key, Question, identity, instance, put_into_words

FORMAT = "quizgen-key/1"
ENGINE = "1"
"""Rises when the same code would give another paper; part of every code."""
REFERENCE = "reference"
"""Stands for the seed in the code of a paper with the numbers of the notes."""
SUPERSCRIPTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
REDRAWS = 50
"""Tries to avoid the same numbers twice in one paper."""


@dataclass(frozen=True)
class Item:
    """One question of a paper in every language of the paper."""

    number: str
    questions: tuple[Question, ...]
    keys: tuple[Key, ...]

    @property
    def points(self) -> Fraction:
        """Marks of the question."""
        return self.questions[0].points


@dataclass(frozen=True)
class Paper:
    """A paper: its questions, and the code that rebuilds it."""

    code: str
    blueprint: Blueprint
    langs: tuple[str, ...]
    items: tuple[Item, ...]
    variety: int = 0
    """How many different papers the blueprint can make; 0 if not counted."""

    @property
    def points(self) -> Fraction:
        """Marks of all questions."""
        return sum((item.points for item in self.items), Fraction(0))

    @property
    def variety_text(self) -> str:
        """The number of possible papers, short: 40, or 3.1 × 10^27."""
        if self.variety < 10**6:
            return str(self.variety)
        mantissa, _, exponent = f"{Decimal(self.variety):.1e}".partition("e+")
        return f"{mantissa} × 10{exponent.translate(SUPERSCRIPTS)}"

    @property
    def minutes(self) -> int:
        """Working time."""
        return self.blueprint.minutes or sum(item.questions[0].minutes for item in self.items)

    def title(self, lang: str) -> str:
        """Title in a language, English where the blueprint has no other."""
        return self.blueprint.title.get(lang) or self.blueprint.title["en"]


def languages(choice: str) -> tuple[str, ...]:
    """Languages of ``en``, ``bn`` or ``both``."""
    return locale.languages() if choice == "both" else (choice,)


def parse_code(code: str) -> tuple[str, str, str, str]:
    """Take a paper's code apart: blueprint, seed, languages, digest.

    Raises
    ------
    CodeError
        If it is not a code.
    """
    match = re.fullmatch(r"(.+)-(\d{1,10}|reference)-(en|bn|both)-([0-9a-f]{6})", code.strip())
    if match is None:
        raise CodeError(f"{code!r} is not a paper's code (like mock-1234-en-0a1b2c)")
    return match[1], match[2], match[3], match[4]


def build(
    bank: Bank,
    blueprint: Blueprint,
    seed: int,
    choice: str = "en",
    *,
    figures: bool = True,
    progress: Callable[[str], None] = lambda _name: None,
) -> Paper:
    """Build a paper.

    Parameters
    ----------
    bank : Bank
    blueprint : Blueprint
    seed : int
    choice : str
        ``en``, ``bn`` or ``both``.
    figures : bool
        Whether to draw the figures.
    progress : callable
        Told each question's template as it is done.

    Raises
    ------
    BlueprintError
        If no template fits a slot.
    """
    drawn = list(_draws(bank, blueprint, seed))
    code = f"{blueprint.name}-{seed}-{choice}-{_digest(blueprint, drawn)}"
    items = []
    weights = _weights(blueprint)
    for number, (one, points) in enumerate(zip(drawn, weights, strict=False), 1):
        items.append(_item(one, languages(choice), str(number), points, figures=figures))
        progress(one.template.id)
    return Paper(code, blueprint, languages(choice), tuple(items), variety(bank, blueprint))


def _item(
    one: Draw,
    langs: tuple[str, ...],
    number: str,
    points: float | None = None,
    *,
    figures: bool = True,
) -> Item:
    pairs = [put_into_words(one, lang, number=number, figures=figures) for lang in langs]
    first = pairs[0][0]
    questions = tuple(_worth(_programs_once(question, first), points) for question, _ in pairs)
    return Item(number, questions, tuple(key for _, key in pairs))


def _programs_once(question: Question, first: Question) -> Question:
    """Leave a program out of the second language where the first one shows the same."""
    if question is first:
        return question
    shown = {block for block in (*first.stem, *_bodies(first)) if isinstance(block, CodeBlock)}
    parts = tuple(
        replace(p, body=tuple(b for b in p.body if b not in shown)) for p in question.parts
    )
    return replace(question, stem=tuple(b for b in question.stem if b not in shown), parts=parts)


def _bodies(question: Question) -> Iterator[Block]:
    for part in question.parts:
        yield from part.body


def _worth(question: Question, points: float | None) -> Question:
    """Share the marks of a slot out over the parts, as their own marks stand to each other."""
    if points is None:
        return question
    scale = Fraction(str(points)) / question.points
    return replace(
        question, parts=tuple(replace(p, points=p.points * scale) for p in question.parts)
    )


def _weights(blueprint: Blueprint) -> Iterator[float | None]:
    """Marks that the blueprint gives to each question; no end where it gives none."""
    for slot in blueprint.slot:
        yield from repeat(slot.points, slot.count)
    yield from repeat(None)


def rebuild(bank: Bank, code: str, blueprint: Blueprint | None = None, **options: Any) -> Paper:
    """Build the paper of a code again.

    Raises
    ------
    CodeError
        If the templates behind it have changed since.
    """
    name, seed, choice, _ = parse_code(code)
    plan = blueprint or load(name)
    if seed == REFERENCE:
        paper = reference_paper(bank, plan, choice)
    else:
        paper = build(bank, plan, int(seed), choice, **options)
    if paper.code != code.strip():
        raise CodeError(
            f"{code} was made with other templates or another version: "
            f"this installation would make {paper.code}"
        )
    return paper


def single(template: Template, seed: str | int, lang: str, *, figures: bool = True) -> Paper:
    """A paper of one question, for looking at a template."""
    pair = put_into_words(instance(template, seed), lang, figures=figures)
    title = {"en": template.id}
    blueprint = Blueprint(title, (SlotRule(templates=(template.id,)),), name=template.id)
    return Paper(f"{template.id}-{seed}", blueprint, (lang,), (Item("1", (pair[0],), (pair[1],)),))


def reference_paper(bank: Bank, blueprint: Blueprint, choice: str) -> Paper:
    """The paper with the numbers printed in the notes."""
    if not blueprint.reference:
        raise BlueprintError(f"blueprint {blueprint.name!r} lists no reference questions")
    templates = [bank.template(name) for name in blueprint.reference]
    drawn = [instance(t, REFERENCE if t.rules.reference is not None else 0) for t in templates]
    code = f"{blueprint.name}-{REFERENCE}-{choice}-{_digest(blueprint, drawn)}"
    langs = languages(choice)
    items = tuple(_item(one, langs, str(number)) for number, one in enumerate(drawn, 1))
    return Paper(code, blueprint, langs, items)


def _digest(blueprint: Blueprint, drawn: list[Draw]) -> str:
    total = hashlib.sha256(f"{ENGINE}\n{blueprint.source}".encode())
    for one in drawn:
        total.update(f"{one.template.id}:{one.template.digest}\n".encode())
    return total.hexdigest()[:6]


def _draws(bank: Bank, blueprint: Blueprint, seed: int) -> Iterator[Draw]:
    seen: set[str] = set()
    for place, template in enumerate(_chosen(bank, blueprint, seed), 1):
        for again in range(REDRAWS):
            one = draw(template, seed, f"{place}.{again}" if again else place)
            if identity(one) not in seen:
                break
        else:
            raise DrawError(f"template {template.id!r}: no further distinct instance")
        seen.add(identity(one))
        yield one


def _chosen(bank: Bank, blueprint: Blueprint, seed: int) -> Iterator[Template]:
    """Templates in order of the paper."""
    chosen = _timed(bank, blueprint, seed) if blueprint.topic else _slotted(bank, blueprint, seed)
    return (bank.template(name) for name in chosen)


def _slotted(bank: Bank, blueprint: Blueprint, seed: int) -> list[str]:
    """Fill the slots: each template is used once before any is used again."""
    uses: dict[str, int] = {}
    chosen: list[str] = []
    for index, slot in enumerate(blueprint.slot, 1):
        fitting = _fitting(bank, slot, index)
        for place in range(slot.count):
            best = min(
                fitting,
                key=lambda name: (
                    _gives_away(bank, name, chosen),
                    uses.get(name, 0),
                    _rank(seed, index, place, bank.origin(name)),
                ),
            )
            uses[best] = uses.get(best, 0) + 1
            chosen.append(best)
    return chosen


def _gives_away(bank: Bank, name: str, chosen: list[str]) -> bool:
    """Whether a question and one already in the paper tell each other's answer."""
    return any(
        name in bank.rules(other).apart or other in bank.rules(name).apart for other in chosen
    )


def _timed(bank: Bank, blueprint: Blueprint, seed: int) -> list[str]:
    """Questions of a topic, tiers in turn, as many as the minutes allow; then sorted by tier."""
    rules = {name: bank.rules(name) for name in bank.paths}
    open_names = [n for n in rules if blueprint.topic in (EVERYTHING, rules[n].topic)]
    left = blueprint.budget or sum(minutes_of(rules[n]) for n in open_names)
    chosen: list[str] = []
    tiers = sorted({rules[n].tier for n in open_names})
    while True:
        before = len(chosen)
        for turn, tier in enumerate(tiers):
            fitting = [
                n for n in open_names
                if n not in chosen and rules[n].tier == tier and minutes_of(rules[n]) <= left
                and not _gives_away(bank, n, chosen)
            ]  # fmt: skip
            if fitting:
                best = min(fitting, key=lambda n: _rank(seed, turn, len(chosen), bank.origin(n)))
                chosen.append(best)
                left -= minutes_of(rules[best])
        if len(chosen) == before:
            break
    if not chosen:
        raise BlueprintError(f"no question of topic {blueprint.topic!r} fits the time")
    return sorted(chosen, key=lambda n: rules[n].tier)


def variety(bank: Bank, blueprint: Blueprint) -> int:
    """How many different papers a blueprint of slots can make (0 for a topic without slots).

    Questions count as a set; a template without numbers counts as one question.
    """
    total = 1 if blueprint.slot else 0
    for index, slot in enumerate(blueprint.slot, 1):
        pools = [bank.rules(name).pool or 1 for name in _fitting(bank, slot, index)]
        rounds, rest = divmod(slot.count, len(pools))
        ways = [1] + [0] * rest
        for pool in pools:
            even, more = math.comb(pool, rounds), math.comb(pool, rounds + 1)
            ways = [ways[k] * even + (ways[k - 1] * more if k else 0) for k in range(rest + 1)]
        total *= ways[rest]
    return total


def _rank(seed: int, index: int, place: int, origin: str) -> bytes:
    return hashlib.sha256(f"choose/{seed}/{index}/{place}/{origin}".encode()).digest()


def _fitting(bank: Bank, slot: SlotRule, index: int) -> list[str]:
    names = list(slot.templates) or list(bank.paths)
    for name in slot.templates:
        bank.rules(name)
    fitting = [
        name for name in names
        if (slot.tier is None or bank.rules(name).tier == slot.tier)
        and (slot.topic is None or bank.rules(name).topic == slot.topic)
    ]  # fmt: skip
    if not fitting:
        raise BlueprintError(
            f"slot {index}: no template has tier {slot.tier or 'any'} and topic "
            f"{slot.topic or 'any'}"
        )
    return fitting


def key_table(paper: Paper) -> dict[str, Any]:
    """The answer key as plain JSON: everything that marking needs."""
    return {
        "format": FORMAT,
        "code": paper.code,
        "title": {lang: paper.title(lang) for lang in paper.langs},
        "langs": list(paper.langs),
        "questions": [_key_entry(item) for item in paper.items],
    }


def _key_entry(item: Item) -> dict[str, Any]:
    question, key = item.questions[0], item.keys[0]
    return {
        "number": item.number,
        "template": key.template,
        "identity": key.identity,
        "topic": question.topic,
        "tier": question.tier,
        "title": {q.lang: q.title for q in item.questions},
        "points": str(question.points),
        "chain": key.chain,
        "parts": [
            {"id": part.field.id, "points": str(part.points), "spec": spec}
            for part, spec in zip(question.parts, key.specs, strict=True)
        ],
    }


def key_bytes(paper: Paper) -> bytes:
    """``key.json``."""
    text = json.dumps(key_table(paper), ensure_ascii=False, indent=1, sort_keys=True)
    return (text + "\n").encode()


def form_bytes(paper: Paper) -> bytes:
    """``answers.toml``: a blank form."""
    lines = [
        f"# {paper.title(paper.langs[0])} - {paper.code}",
        f"code = {json.dumps(paper.code)}",
        "",
        "[student]",
        'name = ""',
        f'lang = "{paper.langs[0]}"',
        'decimal = "auto"   # auto, point or comma',
        "",
        "[answers]",
    ]
    for item in paper.items:
        question = item.questions[0]
        lines.append(f"# {item.number}. {question.title}")
        for part in question.parts:
            hint = " ".join(part.field.hints)
            lines.append(f'"{part.field.id}" = ""' + (f"   # {hint}" if hint else ""))
    return ("\n".join(lines) + "\n").encode()

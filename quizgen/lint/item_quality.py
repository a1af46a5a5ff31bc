"""Whether questions teach: answers that vary, nothing that gives them away, a reason everywhere.

Each finding is about one part of a template over many draws. An ``error`` is what no question may
have; a ``note`` is worth a look. ``lint`` looks at its own draws for the errors, and only the sizes
of whole pools are left to be counted here.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any, Literal

from quizgen.bank.pools import count_pool_variants
from quizgen.bank.sampler import sampler_for, solve_candidate
from quizgen.bank.template import Template
from quizgen.bank.variant import Variant, draw_variant
from quizgen.lint.answer_entropy import CLOSED, AnswerTally
from quizgen.lint.figures import figure_text
from quizgen.lint.workload import check_workload
from quizgen.maths.precision import working_precision
from quizgen.question.interpolation import Interpolator, inlines_to_text
from quizgen.question.part_context import ask_part

FEW, MANY = 0.8, 1.5
"""Bits that the answer of a part must have: of 2 or 3 options, and of more."""
WANTED_BITS = {"tf": FEW, "order": FEW, "match": MANY, "gap": MANY, "multi": MANY}
LONGEST = 0.5
"""Share of draws in which the right one of 3 or more options may be clearly the longest."""
SPREAD = 5.0
"""Standard deviations by which a place may have the right option more or less often."""
CLAIMS = 8
"""Claims that a pool needs for each part that takes one."""
DIFFERENT = 10
"""Questions that a template must be able to make, at least."""
ENOUGH = 50
"""Draws from which shares can be told."""
COUNTED, POOLED = 200, 20_000
"""Candidates that are walked through to count a pool; more where parts have pools."""

Level = Literal["error", "note"]
Said = Iterator[tuple[Level, str, str]]
"""How bad it is, its code, and what it is."""


@dataclass(frozen=True, slots=True)
class QualityFinding:
    """What was found in a part (``label``; empty: in the whole template)."""

    template: str
    label: str
    level: Level
    code: str
    what: str


class QualityReview:
    """What stands between a template and teaching, by its draws, which are looked at one by one."""

    def __init__(self, template: Template) -> None:
        self.template = template
        self.seen = {index: AnswerTally(str(part.answer["kind"]))
                     for index, part in enumerate(template.rules.part)
                     if part.answer.get("kind") in CLOSED}  # fmt: skip
        self.first: Variant | None = None

    def add(self, one: Variant) -> None:
        """Take a draw into account."""
        self.first = self.first or one
        fillers = [Interpolator(one, lang) for lang in self.template.languages] if self.seen else []
        for index, part in self.seen.items():
            part.add(one, index, fillers)

    def findings(self) -> Iterator[QualityFinding]:
        """What was found, by part."""
        for index, label in enumerate(self.template.labels):
            said = [*_claims_findings(self.template)] if index == 0 else []
            said += _check_authored_reasons(self.template, index)
            said += _check_option_letters(self.first, index) if self.first else []
            if index in self.seen:
                said += _seen_findings(self.template, index, self.seen[index])
            for level, code, what in said:
                if code not in self.template.rules.ignore:
                    yield QualityFinding(self.template.id, label or "1", level, code, what)


def review_template(template: Template, seeds: int = 200) -> list[QualityFinding]:
    """Look at one template over many draws, and count its pool.

    Parameters
    ----------
    template : Template
    seeds : int
        How many draws to look at.
    """
    lessons, different = QualityReview(template), set[str]()
    for seed in range(seeds):
        one = draw_variant(template, seed)
        different.add(one.identity)
        lessons.add(one)
    said = [*_pool_findings(template, len(different), seeds)]
    said += [("note", "QG315", what) for what in check_workload(template)]
    ignored = template.rules.ignore
    found = [QualityFinding(template.id, "", *one) for one in said if one[1] not in ignored]
    return [*found, *lessons.findings()]


def _seen_findings(template: Template, index: int, seen: AnswerTally) -> Said:
    if seen.draws < ENOUGH:
        return
    answer = template.rules.part[index].answer
    wanted = WANTED_BITS.get(seen.kind, MANY if seen.most >= 4 else FEW)
    if seen.most_bits < wanted:
        yield "error", "QG301", f"its answer has {seen.bits:.2f} bits, at least {wanted} are wanted"
    yield from _choice_findings(seen)
    if seen.kind == "choice" and not answer.get("in_order"):
        share = seen.draws / seen.most
        most = SPREAD * math.sqrt(share * (1 - 1 / seen.most))
        odd = [p for p in range(1, seen.most + 1) if abs(seen.places[p] - share) > most]
        if odd:
            what = f"the right option stands too often or too seldom at {odd}"
            yield "error", "QG302", what


def _choice_findings(seen: AnswerTally) -> Said:
    never = sorted(set(seen.shown) - set(seen.right))
    if never:
        yield "note", "QG313", f"never right: {', '.join(never)}"
    always = sorted(name for name, count in seen.shown.items() if seen.right[name] == count)
    if always and seen.kind == "multi" and len(always) + len(never) == len(seen.shown):
        yield "note", "QG314", "each option is always right or always wrong"
    for lang, count in seen.longest.items() if seen.kind == "choice" else ():
        if seen.most >= 3 and count > LONGEST * seen.draws:
            share = f"{count / seen.draws:.0%}"
            what = f"{lang}: the right option is clearly the longest in {share} of the draws"
            yield "error", "QG303", what


def _check_authored_reasons(template: Template, index: int) -> Said:
    """What is missing in the files, whatever is drawn."""
    answer = template.rules.part[index].answer
    reasons = {name for text in template.texts.values() for name in text.named.get("reasons", ())}
    told = reasons | {name.partition(" = ")[0] for name in reasons}
    lacking = [name for name in _to_explain(template, answer, reasons) if name not in told]
    if lacking:
        yield "error", "QG304", f"no reason for {', '.join(lacking)}"
    if answer["kind"] == "tf" and not {"from", "claim"} & answer.keys():
        yield "error", "QG305", "a statement without a name has no reason: make it a claim"
    if answer["kind"] in {"order", "expression"} and not answer.get("traps"):
        yield "error", "QG306", "no trap names a wrong answer"


EXPLAINED = {"choice": ("options",), "multi": ("options",), "match": ("pairs",),
             "order": ("steps", "distractors")}  # fmt: skip
"""Kind to the keys of its answer whose names need a reason."""


def _to_explain(template: Template, answer: Mapping[str, Any], reasons: set[str]) -> list[str]:
    """Names that need a sentence in section ``reasons``."""
    if "from" in answer:
        return list(template.rules.claims)
    if answer["kind"] in {"tf", "gap"}:
        names = answer.get("gaps", [answer["claim"]] if "claim" in answer else [])
        return [told for name in names for told in _list_drawable_phrases(template, name, reasons)]
    return [name for key in EXPLAINED.get(answer["kind"], ()) for name in answer.get(key, ())]


def _list_drawable_phrases(template: Template, name: str, reasons: set[str]) -> tuple[str, ...]:
    """The name itself, or each phrase that may be drawn for it."""
    rule = template.rules.draw.get(name)
    return rule.words if rule and name not in reasons else (name,)


def _pool_findings(template: Template, different: int, seeds: int) -> Said:
    rules = template.rules
    if different < min(DIFFERENT, seeds):
        yield "error", "QG307", f"{different} different questions in {seeds} draws"
    counted = count_pool(template)
    if counted and not rules.pool:
        yield "note", "QG308", f"there are {counted} different questions"
    elif counted and counted != rules.pool:
        yield "error", "QG308", f"there are {counted} different questions, not {rules.pool}"


def _claims_findings(template: Template) -> Said:
    rules = template.rules
    asked = sum("from" in part.answer for part in rules.part)
    if len(rules.claims) < CLAIMS * asked:
        what = f"{len(rules.claims)} claims for {asked} parts, {CLAIMS * asked} are wanted"
        yield "error", "QG309", what
    listed = {name for part in rules.part for field in ("options", "pairs", "steps", "gaps")
              for name in part.answer.get(field, ())}  # fmt: skip
    twice = sorted(listed & set(rules.claims))
    if twice:
        what = f"claims and options share names, and so their reason: {', '.join(twice)}"
        yield "error", "QG310", what


def count_pool(template: Template) -> int:
    """How many different questions there are; 0 if there are too many candidates to count."""
    plan, rules = sampler_for(template), template.rules
    free = [variable for variable in plan.variables if variable.choices]
    pooled = rules.claims or any("take" in part.answer for part in rules.part)
    if math.prod(len(v.choices) for v in free) > (POOLED if pooled else COUNTED):
        return 0
    total = 0
    for values in product(*(variable.choices for variable in free)):
        shown, words = dict(zip((v.name for v in free), values, strict=True)), dict[str, str]()
        with working_precision():
            for variable in plan.variables:
                if variable.formula is not None:
                    variable.derive(shown, words)
        kept = solve_candidate(plan, shown)
        if not isinstance(kept, str):
            total += count_pool_variants(Variant(template, "0", "0", 1, shown, words, *kept))
    return total


_MARK = re.compile(r"(?<![\w'])([A-L])(?![\w'])(?! =)(?<!A(?= (?!and |or )[a-z]))")
"""A letter that stands alone and is neither a quantity nor an article."""
_PICTURE = re.compile(r"[^\W\d]{2,15} (\d)")


def _check_option_letters(one: Variant, index: int) -> Said:
    """Letters of options that the figure shows too, and numbered pictures out of order."""
    lang = one.template.languages[0]
    shown = set(_MARK.findall(figure_text(one, lang, quiz=True)))
    options = ask_part(one, index).options
    clash = sorted(shown & {mark for mark, _ in options})
    if clash:
        yield "error", "QG311", f"options and figure both have letters {', '.join(clash)}"
    filler = Interpolator(one, lang)
    found = [
        _PICTURE.fullmatch(inlines_to_text(filler.sentence("options", name))) for _, name in options
    ]
    places = [int(match[1]) for match in found if match]
    if len(places) == len(found) > 1 and places != list(range(1, len(found) + 1)):
        yield "error", "QG312", "numbered pictures are out of order: use in_order"

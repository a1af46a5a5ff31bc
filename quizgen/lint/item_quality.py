"""Whether questions teach: answers that vary, nothing that gives them away, a reason everywhere.

Each finding is about one part of a template over many draws. An ``error`` is what no question may
have; a ``note`` is worth a look. ``lint`` looks at its own draws for the errors, and only the sizes
of whole pools are left to be counted here.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any, Literal

from quizgen.bank.markdown import slot_names
from quizgen.bank.pools import count_pool_variants, matching_pairs, select_from_pool
from quizgen.bank.rules import total_points
from quizgen.bank.sampler import sampler_for, solve_candidate
from quizgen.bank.template import Template
from quizgen.bank.variant import Variant, draw_variant
from quizgen.kinds import choice, true_false
from quizgen.kinds.contract import asked_form
from quizgen.lint.figures import figure_text
from quizgen.lint.unused_draws import find_unused_draws
from quizgen.maths.precision import working_precision
from quizgen.question.interpolation import Interpolator, inlines_to_text
from quizgen.question.part_context import VariantPart, ask_part

FEW, MANY = 0.8, 1.5
"""Bits that the answer of a part must have: of 2 or 3 options, and of more."""
LIKELY = 0.9
"""Bits of two answers that are about as likely as each other: at most two to one."""
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
    """One finding about a part of a template; an empty ``label`` means the whole template."""

    template: str
    label: str
    level: Level
    code: str
    what: str


class QualityReview:
    """Collects variants of a template and judges whether its parts test and teach something."""

    def __init__(self, template: Template) -> None:
        self.template = template
        self.seen = {index: AnswerTally(str(part.answer["kind"]))
                     for index, part in enumerate(template.rules.part)
                     if part.answer.get("kind") in CLOSED}  # fmt: skip
        self.first: Variant | None = None

    def add(self, one: Variant) -> None:
        """Count one variant."""
        self.first = self.first or one
        fillers = [Interpolator(one, lang) for lang in self.template.languages] if self.seen else []
        for index, part in self.seen.items():
            part.add(one, index, fillers)

    def findings(self) -> Iterator[QualityFinding]:
        """Yield what was found over all variants added, part by part."""
        for index, label in enumerate(self.template.labels):
            said = [*_check_claims(self.template)] if index == 0 else []
            said += _check_authored_reasons(self.template, index)
            said += _check_option_letters(self.first, index) if self.first else []
            if index in self.seen:
                said += _check_tally(self.template, index, self.seen[index])
            for level, code, what in said:
                if code not in self.template.rules.ignore:
                    yield QualityFinding(self.template.id, label or "1", level, code, what)


def review_template(template: Template, seeds: int = 200) -> list[QualityFinding]:
    """Return what keeps a template from testing well, over ``seeds`` variants and its pool.

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
    said = [*_check_pool(template, len(different), seeds)]
    said += [("note", "QG315", what) for what in check_workload(template)]
    ignored = template.rules.ignore
    found = [QualityFinding(template.id, "", *one) for one in said if one[1] not in ignored]
    return [*found, *lessons.findings()]


def _check_tally(template: Template, index: int, seen: AnswerTally) -> Said:
    """Yield what the tally of one part shows: too little entropy, a favoured position, ...

    Nothing with fewer than ``ENOUGH`` variants, where shares are chance.
    """
    if seen.draws < ENOUGH:
        return
    answer = template.rules.part[index].answer
    wanted = WANTED_BITS.get(seen.kind, MANY if seen.most >= 4 else FEW)
    if seen.most_bits < wanted:
        # Reject or keep, higher or lower: two answers that are about as likely are a fair question.
        decision = seen.kind == "choice" and len(seen.answers) == 2 and seen.bits >= LIKELY
        what = f"its answer has {seen.bits:.2f} bits, at least {wanted} are wanted"
        yield "note" if decision else "error", "QG301", what
    if choice.has_value_options(answer):
        return
    yield from _check_options(seen)
    if seen.kind == "choice" and not answer.get("in_order"):
        share = seen.draws / seen.most
        most = SPREAD * math.sqrt(share * (1 - 1 / seen.most))
        odd = [p for p in range(1, seen.most + 1) if abs(seen.places[p] - share) > most]
        if odd:
            what = f"the right option stands too often or too seldom at {odd}"
            yield "error", "QG302", what


def _check_options(seen: AnswerTally) -> Said:
    """Yield options that are never right, always right, or betrayed by their length."""
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
    """Yield reasons and traps that a part's files lack, whatever is drawn."""
    answer = template.rules.part[index].answer
    reasons = {name for text in template.texts.values() for name in text.named.get("reasons", ())}
    told = reasons | {name.partition(" = ")[0] for name in reasons}
    lacking = [
        name for name in _list_names_to_explain(template, answer, reasons) if name not in told
    ]
    if lacking:
        yield "error", "QG304", f"no reason for {', '.join(lacking)}"
    if answer["kind"] == "tf" and not {"from", "claim"} & answer.keys():
        yield "error", "QG305", "a statement without a name has no reason: make it a claim"
    named = answer.get("traps") or asked_form(answer)
    if answer["kind"] in {"order", "expression", "program"} and not named:
        yield "error", "QG306", "no trap names a wrong answer"


EXPLAINED = {"choice": ("options",), "multi": ("options",), "match": ("pairs",),
             "order": ("steps", "distractors"), "witness": ("demands",),
             "program": ("cases",)}  # fmt: skip
"""Kind to the keys of its answer whose names need a reason."""


def _list_names_to_explain(
    template: Template, answer: Mapping[str, Any], reasons: set[str]
) -> list[str]:
    """Return the names of options, claims or steps that need a sentence in ``reasons``."""
    if "from" in answer:
        return list(template.rules.claims)
    if answer["kind"] in {"tf", "gap"}:
        names = answer.get("gaps", [answer["claim"]] if "claim" in answer else [])
        return [told for name in names for told in _list_drawable_phrases(template, name, reasons)]
    return [name for key in EXPLAINED.get(answer["kind"], ()) for name in answer.get(key, ())]


def _list_drawable_phrases(template: Template, name: str, reasons: set[str]) -> tuple[str, ...]:
    """Return the name itself, or each phrase that may be drawn for it."""
    rule = template.rules.draw.get(name)
    return rule.words if rule and name not in reasons else (name,)


def _check_pool(template: Template, different: int, seeds: int) -> Said:
    """Yield too few different questions, and a pool size that differs from the declared one.

    ``different`` were counted among ``seeds`` variants.
    """
    rules = template.rules
    if different < min(DIFFERENT, seeds):
        yield "error", "QG307", f"{different} different questions in {seeds} draws"
    counted = count_pool(template)
    if counted and not rules.pool:
        yield "note", "QG308", f"there are {counted} different questions"
    elif counted and counted != rules.pool:
        yield "error", "QG308", f"there are {counted} different questions, not {rules.pool}"


def _check_claims(template: Template) -> Said:
    """Yield a pool of claims that is too small, or shares names with options."""
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
    """Return the number of different questions; 0 if there are too many candidates to count.

    A quantity that nothing uses makes no other question. Lists are never counted.
    """
    plan, rules = sampler_for(template), template.rules
    if plan.has_lists or any(v.lookup for v in plan.variables):
        return 0
    unused = find_unused_draws(template)
    free = [variable for variable in plan.variables if variable.choices]
    choices = [v.choices[:1] if v.name in unused else v.choices for v in free]
    pooled = rules.claims or any("take" in part.answer for part in rules.part)
    if math.prod(map(len, choices)) > (POOLED if pooled else COUNTED):
        return 0
    total = 0
    for values in product(*choices):
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
    """Yield option letters that the figure uses too, and numbered pictures out of order."""
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


FAR = 2.0
"""Factor by which points are far from the minutes."""


def check_workload(template: Template) -> Iterator[str]:
    """Yield points that are a factor ``FAR`` from the working time."""
    points, minutes = float(total_points(template.rules)), float(template.minutes)
    if not minutes / FAR <= points <= minutes * FAR:
        yield f"{points:g} points, where it takes about {minutes:.1f} minutes"


CLOSED = frozenset({"choice", "multi", "tf", "match", "order", "gap"})
"""Kinds whose answer is picked out of what is shown, or is a word that is known before."""
CLEARLY = 1.1
"""An option is noticed as the longest if it has a tenth more letters than any other."""


@dataclass
class AnswerTally:
    """Counts of what was right and shown in one closed part, over many variants.

    Parameters
    ----------
    kind : str
    draws : int
    answers : Counter
        What is right, by name; for pairs, steps and gaps also what is shown.
    shown, right : Counter
        How often each option came up, and was right.
    most : int
        Options shown at once.
    places : Counter
        Where the right option stood, from 1.
    longest : Counter
        Language to the draws in which a right option was clearly the longest.
    """

    kind: str
    draws: int = 0
    answers: Counter[str] = field(default_factory=Counter)
    shown: Counter[str] = field(default_factory=Counter)
    right: Counter[str] = field(default_factory=Counter)
    most: int = 0
    places: Counter[int] = field(default_factory=Counter)
    longest: Counter[str] = field(default_factory=Counter)
    _lengths: dict[tuple[str, str], int] = field(default_factory=dict)

    @property
    def bits(self) -> float:
        """Return the entropy of the answers in bits."""
        return entropy_bits(self.answers.values())

    @property
    def most_bits(self) -> float:
        """Return the entropy plus two standard errors: few draws must not fail a good part."""
        shares = [count / self.draws for count in self.answers.values()]
        squares = sum(share * math.log2(share) ** 2 for share in shares)
        return self.bits + 2 * math.sqrt(max(0.0, squares - self.bits**2) / self.draws)

    def add(self, drawn: Variant, index: int, fillers: Sequence[Interpolator]) -> None:
        """Count part ``index`` of a variant; one ``filler`` for each language."""
        self.draws += 1
        if self.kind not in {"choice", "multi"}:
            self.answers[_describe_answer(self.kind, drawn, index)] += 1
            return
        if choice.has_value_options(drawn.template.rules.part[index].answer):
            ((_, value),) = ask_part(drawn, index).right
            self.answers[value] += 1
            return
        names, right = choice.option_order(VariantPart(drawn, index))
        if self.kind == "choice" and len(right) != 1:
            ask_part(drawn, index)  # says what is wrong
        self.answers["+".join(sorted(right))] += 1
        self.most = max(self.most, len(names))
        for place, name in enumerate(names, 1):
            self.shown[name] += 1
            if name in right:
                self.right[name] += 1
                self.places[place] += 1
        for filler in fillers:
            lengths = {name: self._measure_option(filler, name) for name in names}
            self.longest[filler.lang] += _find_longest_option(lengths) in right

    def _measure_option(self, filler: Interpolator, name: str) -> int:
        """Return the letters of an option in one language.

        The length of an option that is the same in every variant is stored.
        """
        known = self._lengths.get((filler.lang, name))
        if known is None:
            known = len(inlines_to_text(filler.sentence("options", name)))
            if ("options", name) in filler.text.unslotted_sentences:
                self._lengths[filler.lang, name] = known
        return known


def _find_longest_option(lengths: dict[str, int]) -> str:
    """Return the option that is clearly the longest; empty if none is."""
    name = max(lengths, key=lambda one: lengths[one])
    others = [length for other, length in lengths.items() if other != name]
    return name if lengths[name] >= CLEARLY * max(others, default=0) else ""


def _describe_answer(kind: str, drawn: Variant, index: int) -> str:
    """Return what a learner must know to answer this variant, as text that is equal if it is."""
    if kind == "tf":
        part = VariantPart(drawn, index)
        return str(part.condition_holds(true_false.selected_statement(part)[1]))
    shown = select_from_pool(drawn, index)
    names = [*shown.names, *shown.extra]
    if kind == "match":
        pairs = matching_pairs(drawn, index)
        names = [f"{name}={pairs.get(name, '')}" for name in names]
    if kind == "gap":
        text = drawn.template.texts[drawn.template.languages[0]]
        if any(any(slot_names(text.sentence("gaps", name) or ())) for name in names):
            return "+".join(gap[0] for gap in ask_part(drawn, index).spec.gaps())
        names = [drawn.words.get(name, name) for name in names]
        return "+".join(names if len({*shown.names}) == len(names) else sorted(names))
    return "+".join(sorted(names))


def entropy_bits(counts: Iterable[int]) -> float:
    """Return the Shannon entropy in bits of a distribution given by counts."""
    found = [count for count in counts if count]
    total = sum(found)
    return math.log2(total) - sum(n * math.log2(n) for n in found) / total if found else 0.0

"""Kind ``order``: steps of a derivation; every order that respects ``before`` is right."""

from __future__ import annotations

import re
from fractions import Fraction

import msgspec

from quizgen.grading.echo import safe_echo
from quizgen.grading.judging.spelling import fold_word
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.normalise import BANGLA_LETTERS, normalise_typed
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import Verdict, correct, verdict_by_share
from quizgen.maths.notation import FormulaReadError

MOST_STEPS = 40
_LINE = re.compile(
    r"(?<![^\s,;(])\(?(\d{1,2})(?: ?[.):]+ ?| ?[=-] ?(?=[^\W\d])| (?=[^\W\d]))"
    r"([^\s,;.:()\d]+|\d{1,2}(?![.):]))(?![^\s,;.])"
)
_FILLERS = frozenset({"then", "dann", "danach", "and", "und", "তারপর", "এরপর", "এবং"})


class Spec(WordSpec, kw_only=True, frozen=True):
    """Order: ``steps``; ``before`` = [[a, b], ...]; ``distractors`` that must stay out.

    Without ``before`` the listed order is the only one. Steps are typed by their labels.
    """

    steps: list[str]
    before: list[tuple[str, str]] | None = None
    distractors: list[str] = msgspec.field(default_factory=list)
    traps: dict[str, list[str]] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """``before`` must speak of the steps and contain no circle."""
        if not 1 <= len(self.steps) <= MOST_STEPS:
            raise ValueError(f"steps must be 1 to {MOST_STEPS}")
        if len({*self.steps}) < len(self.steps):
            raise ValueError("a step stands twice")
        for pair in self.before or ():
            if not {*pair} <= {*self.steps}:
                raise ValueError(f"before: {pair[0]!r}, {pair[1]!r} are not both steps")
        if any(step in later for step, later in followers(self).items()):
            raise ValueError("before contains a circle")

    def pairs(self) -> list[tuple[str, str]]:
        """Which step directly precedes which."""
        if self.before:
            return self.before
        return list(zip(self.steps, self.steps[1:], strict=False))

    def judge(self, typed: str, _options: GradingOptions, /) -> Verdict:
        """Judge a typed order."""
        if len(typed) > 1000:
            raise FormulaReadError("too-long", 1001, "1000")
        chosen = _labels(self, typed)
        read_as = " ".join(safe_echo(label) for label in chosen)
        later = followers(self)
        steps = [label for label in chosen if label in later]
        intruders = [label for label in chosen if label not in later]
        line = first_wrong(self, chosen, later)
        if line == 0 and len(steps) == len(self.steps):
            return correct(read_as)
        kept = len(steps) - conflicts(steps, later)
        total = max(len(self.steps) - 1, 1)
        credit = max(Fraction(kept - 1 - len(intruders), total), Fraction(0))
        note = "order-distractor" if intruders else "order-missing" if line == 0 else "order-line"
        if line == 0:
            line = len(chosen) + 1
        elif note == "order-distractor":
            line = chosen.index(intruders[0]) + 1
        because = tuple(chosen[line - 1 : line])
        known = _trap(self, chosen) or note
        return verdict_by_share(
            min(credit, Fraction(9, 10)), read_as, known, line=line, because=because
        )

    def show(self) -> str:
        """Return one right order."""
        later = followers(self)
        rest, shown = list(self.steps), list[str]()
        while rest:
            step = next(s for s in rest if not any(s in later[other] for other in rest))
            rest.remove(step)
            shown.append(step)
        return " ".join(shown)


def _trap(spec: Spec, chosen: list[str]) -> str:
    return next((f"trap:{name}" for name, order in spec.traps.items() if order == chosen), "")


def followers(spec: Spec) -> dict[str, set[str]]:
    """Every step that must come later than a step (closed under chains)."""
    later: dict[str, set[str]] = {step: set() for step in spec.steps}
    for first, second in spec.pairs():
        later[first].add(second)
    for middle in spec.steps:
        for step in spec.steps:
            if middle in later[step]:
                later[step] |= later[middle]
    return later


def first_wrong(spec: Spec, chosen: list[str], later: dict[str, set[str]]) -> int:
    """Return the first line (from 1) that stands too early or does not belong; 0 if none."""
    seen: set[str] = set()
    for position, label in enumerate(chosen, 1):
        needed = {step for step in spec.steps if label in later[step]}
        if label not in later or not needed <= seen:
            return position
        seen.add(label)
    return 0


def conflicts(steps: list[str], later: dict[str, set[str]]) -> int:
    """Return how many steps must be taken out so that the rest is in order.

    Pairs in the wrong order form a partial order, so the largest set without such a pair is found
    by matching (Dilworth).
    """
    matched: dict[int, int] = {}
    wrong = {
        i: [j for j in range(i + 1, len(steps)) if steps[i] in later[steps[j]]]
        for i in range(len(steps))
    }

    def place(i: int, tried: set[int]) -> bool:
        for j in wrong[i]:
            if j not in tried:
                tried.add(j)
                if j not in matched or place(matched[j], tried):
                    matched[j] = i
                    return True
        return False

    return sum(place(i, set()) for i in range(len(steps)))


def _labels(spec: Spec, typed: str) -> list[str]:
    text = re.sub(r"[\r\n]+", " ", typed.strip())
    source = normalise_typed(text, keep_x=True, longest=1000)
    known = {fold_word(label): label for label in (*spec.steps, *spec.distractors)}
    words = _numbered(source.text) or _words(source.text, known)
    if len(words) == 1 and fold_word(words[0]) not in known:
        words = list(words[0])
    found = [_known(word, known) for word in words]
    for label in found:
        if found.count(label) > 1:
            raise FormulaReadError("used-twice", 1, label)
    return found


def _numbered(text: str) -> list[str]:
    """Labels behind the numbers of lines, ``1. B 2. D``, in the order of the numbers."""
    pairs = dict(_LINE.findall(text))
    whole = not _LINE.sub("", text).strip(" ,;.")
    if not whole or len(pairs) < 2 or {*map(int, pairs)} != {*range(1, len(pairs) + 1)}:
        return []
    return [pairs[number] for number in sorted(pairs, key=int)]


def _words(text: str, known: dict[str, str]) -> list[str]:
    """Cut at blanks, separators and arrows; ``B-D`` alone could be a range and stays whole."""
    words = [w for w in re.split(r"[\s,;.<>|=()\[\]{}।॥→⇒⟶/:]+|-+>", text) if w.strip("-")]
    words = [w for w in words if w.casefold() not in _FILLERS or fold_word(w) in known]
    cut = [w for word in words for w in word.split("-") if w]
    return cut if len(cut) > 2 and any(fold_word(w) not in known for w in words) else words


def _known(word: str, known: dict[str, str]) -> str:
    label = known.get(fold_word(word)) or known.get(fold_word(word.translate(BANGLA_LETTERS)))
    if label is None:
        raise FormulaReadError("label-expected", 1, safe_echo(word), list(known.values()))
    return label

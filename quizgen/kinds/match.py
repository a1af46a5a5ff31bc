"""Kind ``match``: pairs of labels, ``A3 B1`` or ``A:3, B:1`` or one per line."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import ClassVar

import msgspec

from quizgen.grading.echo import safe_echo
from quizgen.grading.judging.likeness import list_ordinals
from quizgen.grading.judging.spelling import fold_word
from quizgen.grading.judging.wordings import find_wording, find_wording_in, holds_wording
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm, is_denied
from quizgen.grading.reading.normalise import (
    BANGLA_DIGITS,
    BANGLA_LETTERS,
    LONE_LETTER,
    PICTURES,
    normalise_typed,
)
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import Verdict, correct, verdict_by_share
from quizgen.kinds.asking import assign_letters, make_spec
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    AuthoredPooled,
    FieldProblem,
    InputControl,
    PartContext,
    find_extra_problems,
    find_name_problems,
)
from quizgen.kinds.work import count_listed
from quizgen.locale import translate
from quizgen.locale.word_patterns import WordPattern, set_of_words
from quizgen.maths.notation import FormulaReadError

_SEPARATORS = re.compile(r"[\s,;.|&\[\]{}।॥]+")
_ARROWS = re.compile(r"\s*(?:->|=>|<->|--|[-:=>()→↔⇒⇔⟶⟷↦])+\s*|(?<=\w)[/_](?=\w)")
_TAKEN_BACK = WordPattern(
    r"\b([A-Z]) ?[:=→-]? ?\d+[,;]? «choices.correcting»[,:]? (?=\1)", re.IGNORECASE
)
"""A pair behind which the same left side stands again: ``C3 no C5``."""
_PAIRED = re.compile(r"[:=→⇒]|->|(?<![\w.,/])\d(?![\w.,/°])")
"""A sign or a number by which a piece is a pair, and not only its right side."""
_COMMAS = re.compile(r"[;,\n](?![^(]*\))\s*")
"""What stands between sides in order, outside brackets."""
_LEFT_OVER = WordPattern(
    r"(?<=\d)[ ,;.]*\(?(?:\d+(?:(?:,| «and») \d+)*) "
    r"(?:«choices.stays» «choices.left»|«choices.fits-nothing»)\)?\.?$",
    re.IGNORECASE,
)
"""Right sides that are said to belong to nothing, behind the pairs."""
_GROUPS = tuple(
    map(
        WordPattern,
        (
            r"[;\n]",
            r"[;\n]|\. ",
            r"[,;\n](?![^(]*\))\s*(?=[A-Z]\b)",
            r"[;\n]| (?:«and»|&) ",
            r"[,;\n]",
            r"[,;\n]| (?:«and»|&) ",
            r"[,;\n]|\. ",
        ),
    )
)
"""What may stand between pairs, or between all that belong to one right side."""
_RUN_OF_LABELS = WordPattern(r"(?<![^\W_])([A-Z])(?:, ?| (?:«and»|&) )(?=[A-Z](?![^\W_]))")
_REST = WordPattern(
    r"^(?:«and» )?(?:«articles» )?«choices.rest»(?: «choices.are»)?(?= |:|=)[ :=]*"
    r"|[ :=]*«choices.rest»$",
    re.IGNORECASE,
)
"""All left sides that have not been named: ``BCE = CCD, rest CMOS``."""
_SIDES = WordPattern(r"\s*(?:-+>|=>|[:=→⇒])+\s*|\s+(?:-|«choices.belongs»)\s+")
_NUMBER_LAST = re.compile(r"(?P<words>.*[^\W\d_].*?) ?(?:\((?P<number>\d)\))")
"""Words of a pair, and the number of its right side in brackets behind them."""
_NUMBERED_LABEL = re.compile(r"[A-Z] ?(?:[:=→]|-+>|[-–])? ?\d(?!\d)")
"""A pair of labels, whatever words stand behind it."""
_TOKENS = re.compile(r"(?:[\s,:=→>()]|-+>|(?<!\w)-|-(?!\w)|(?<=[^\W\d_])-(?=\d(?!\w)))+")
_RANGE_OF_LABELS = WordPattern(r"(?<!\w)([A-Z])(?: ?[-–] ?| «to» )([A-Z])(?!\w)")
_LABEL_FIRST = re.compile(r"(?P<label>[A-Z])\)? ?(?:[:=→]|-+>|[-–] ) ?(?P<words>.+)")
"""The label of a left side with the words of the right one."""


class AuthoredMatch(AuthoredPooled, kw_only=True, tag="match", frozen=True):
    """What belongs together."""

    listed = "pairs"
    pairs: dict[str, str]
    distractors: tuple[str, ...] = ()
    extra: int | None = None
    in_order: bool = False
    reuse: bool = False

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield what is wrong with names, and with the number of distractors that are shown."""
        yield from find_name_problems("distractors", self.distractors, self.take, 0)
        yield from super().find_problems()
        others = {*self.pairs.values()} if self.take else ()
        yield from find_extra_problems(self.extra, len(self.distractors) + len(others))


class MatchSpec(WordSpec, kw_only=True, frozen=True):
    """Match: ``pairs`` = {left label: right label}; ``reuse`` allows a right label twice.

    ``words`` are the wordings of both sides by their labels, which may be typed in their place;
    ``said`` are those of each further language.
    """

    written_as: ClassVar[AnswerForm] = "option"

    pairs: dict[str, str]
    reuse: bool = False
    words: dict[str, str] = msgspec.field(default_factory=dict)
    said: list[dict[str, str]] = msgspec.field(default_factory=list)
    traps: dict[str, dict[str, str]] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """Check that there are pairs.

        Raises
        ------
        ValueError
            If there are none.
        """
        if not self.pairs:
            raise ValueError("pairs must not be empty")

    def allows_reuse(self) -> bool:
        """Return whether a right label may be used more than once."""
        return self.reuse or len(set(self.pairs.values())) < len(self.pairs)

    def judge(self, typed: str, _options: GradingOptions, /) -> Verdict:
        """Return the verdict on typed pairs: the share of right ones.

        Raises
        ------
        FormulaReadError
            If no pairs can be read, or a label is used twice.
        """
        if len(typed) > 1000:
            raise FormulaReadError("too-long", 1001, "1000")
        try:
            found = _read_whole_lefts(self, typed) or _read_pairs(self, typed)
        except FormulaReadError as error:
            found = {} if error.code == "used-twice" else _read_otherwise(self, typed)
            if not found:
                raise
        read_as = " ".join(f"{safe_echo(left)}{safe_echo(right)}" for left, right in found.items())
        right = sum(self.pairs[left] == chosen for left, chosen in found.items())
        if right == len(self.pairs):
            return correct(read_as)
        missed = tuple(left for left, wanted in self.pairs.items() if found.get(left) != wanted)
        note = "pairs-missing" if all(name not in found for name in missed) else "pairs"
        trap = _find_misconception_note(self, found)
        return verdict_by_share(
            Fraction(right, len(self.pairs)),
            read_as,
            trap or note,
            right=right,
            of=len(self.pairs),
            names=missed,
            because=tuple(
                label for left in missed for label in _list_reason_labels(left, found.get(left))
            ),
        )

    def tells(self, label: str, reason: str, /) -> bool:
        """Return whether the reason for a left side has the words of its right one."""
        left = next((one for one in self.pairs if label.startswith(one)), "")
        right = self.pairs.get(left, "")
        return any(holds_wording(reason, one.get(right, "")) for one in (self.words, *self.said))

    def show(self) -> str:
        """Return the pairs as they can be typed."""
        return ", ".join(f"{left}:{right}" for left, right in self.pairs.items())


def _list_reason_labels(left: str, chosen: str | None) -> tuple[str, ...]:
    """Return what a reason can be given for: this pair, else any wrong one of its left side."""
    return (f"{left}{chosen}", left) if chosen else ()


def _find_misconception_note(spec: MatchSpec, found: dict[str, str]) -> str:
    """Return the note of the mistake that gives just these pairs; empty if none does."""
    for name, pairs in spec.traps.items():
        if pairs == found:
            return f"trap:{name}"
    return ""


def _read_pairs(spec: MatchSpec, typed: str) -> dict[str, str]:
    """Return left label to right label, as typed.

    Raises
    ------
    FormulaReadError
        If no pairs can be read, or a label is used twice.
    """
    typed = _TAKEN_BACK.sub("", _LEFT_OVER.sub("", typed.strip()))
    source = normalise_typed(re.sub(r"[\r\n]+", " ", typed), keep_x=True, longest=1000)
    text = PICTURES.sub(" ", source.text)
    text = LONE_LETTER.sub(lambda letter: letter[0].translate(BANGLA_LETTERS), text)
    left = {fold_word(label): label for label in spec.pairs}
    right = {fold_word(label): label for label in spec.pairs.values()}
    found: dict[str, str] = {}
    for first, second in _split_pairs(text, left):
        _add_pair(
            spec, found, left.get(first, ""), _find_right_label(second, right), (first, second)
        )
    if not found:
        raise FormulaReadError("pairs-expected", 1, safe_echo(typed))
    return found


def _read_whole_lefts(spec: MatchSpec, typed: str) -> dict[str, str]:
    """Return the pairs of ``curve 1: e^x, curve 2: |x|``: left sides in full; else none."""
    lefts = {
        fold_word(said[label]): label
        for said in (spec.words, *spec.said)
        for label in spec.pairs
        if label in said
    }
    found: dict[str, str] = {}
    for piece in _COMMAS.split(typed.strip(" .")):
        head, sign, words = piece.partition(":")
        left = lefts.get(fold_word(head), "") if sign else ""
        right = _find_side(spec, words.strip(), _list_targets(spec)) if left else ""
        if not right or left in found:
            return {}
        found[left] = right
    return found if spec.allows_reuse() or len({*found.values()}) == len(found) else {}


def _read_otherwise(spec: MatchSpec, typed: str) -> dict[str, str]:
    """Return pairs by the right sides alone, in order, or by the words of either side; else none.

    Raises
    ------
    FormulaReadError
        If a label is used twice.
    """
    if is_denied(typed):
        return {}
    text = typed.strip().strip(".").translate(BANGLA_DIGITS)
    found: dict[str, str] = {}
    for left, right in _list_rights_in_order(spec, text) or _read_groups(spec, text):
        _add_pair(spec, found, left, right, (left, right))
    return found


def _list_rights_in_order(spec: MatchSpec, text: str) -> list[tuple[str, str]]:
    """Return ``2 1 5 4`` and ``2154`` as right sides of the left ones in order; else none."""
    marks = re.split(r"[\s,;|/-]+", text)
    if len(marks) == 1 and text.isdecimal() and len(text) == len(spec.pairs):
        marks = list(text)
    if len(marks) == len(spec.pairs) and all(mark.isdecimal() for mark in marks):
        return list(zip(spec.pairs, marks, strict=True))
    if _PAIRED.search(text):
        return []
    pieces = text.split() if len(text.split()) == len(spec.pairs) else _COMMAS.split(text)
    worded = [_find_side(spec, words.strip(","), _list_targets(spec)) for words in pieces]
    return list(zip(spec.pairs, worded, strict=True)) if _is_whole(spec, worded) else []


def _is_whole(spec: MatchSpec, worded: list[str]) -> bool:
    """Return whether words name a right side for each left one, none twice that may not be."""
    named = all(worded) and len(worded) == len(spec.pairs)
    return named and (spec.allows_reuse() or len({*worded}) == len(worded))


def _read_groups(spec: MatchSpec, text: str) -> list[tuple[str, str]]:
    """Return the pairs of ``CCD: A, B; CMOS: C`` or ``HSV 2, YUV 1``; none if one is unclear."""
    text = _RANGE_OF_LABELS.sub(lambda ends: _list_range(spec, ends), text)
    text = _RUN_OF_LABELS.sub(r"\1 ", text)
    readings = [_read_split(spec, between.split(text)) for between in _GROUPS]
    return max(readings, key=len, default=[])


def _read_split(spec: MatchSpec, pieces: list[str]) -> list[tuple[str, str]]:
    """Return the pairs of all pieces of an answer; none if there is only one, or one is unclear."""
    groups = [piece.strip() for piece in pieces if piece.strip()]
    if len(groups) < len(("one", "other")):
        return []
    rest = _REST.search(groups[-1])
    read = [_read_group(spec, group) for group in (groups[:-1] if rest else groups)]
    if rest and all(read):
        named = {left for pairs in read for left, _ in pairs}
        others = "".join(left for left in spec.pairs if left not in named)
        read.append(_read_group(spec, f"{others}: {_REST.sub('', groups[-1])}"))
    if sum(map(bool, read)) == len(groups) - 1 and not rest:
        read = _complete_groups(spec, groups, read)
    return [pair for pairs in read for pair in pairs] if all(read) else []


def _list_range(spec: MatchSpec, ends: re.Match[str]) -> str:
    """Return the left labels from the first to the last, ``A-D``; else what was typed."""
    labels = [label for label in spec.pairs if ends[1] <= label <= ends[2]]
    return " ".join(labels) if {ends[1], ends[2]} <= {*labels} else ends[0]


def _complete_groups(
    spec: MatchSpec, groups: list[str], read: list[list[tuple[str, str]]]
) -> list[list[tuple[str, str]]]:
    """Return the groups with the one pair whose left side has a name that nobody knows.

    It is the left side that no other pair has, if there are enough of these and its right side is
    clear.
    """
    named = [left for pairs in read for left, _ in pairs]
    missing = [left for left in spec.pairs if left not in named]
    sides = _SIDES.split(groups[read.index([])])
    if len(missing) != 1 or len(named) < FEWEST_NAMED or len(sides) != len(("left", "right")):
        return read
    left, right = _find_pair(spec, *sides)
    return [pairs or [(missing[0], right)] for pairs in read] if right and not left else read


def _read_group(spec: MatchSpec, group: str) -> list[tuple[str, str]]:
    """Return the pairs of one right side with its left ones, by labels or words; else none."""
    marked = _read_marked_pair(spec, group)
    if marked:
        return [marked]
    pairs = _read_tokens(spec, group)
    return pairs if pairs or _NUMBERED_LABEL.match(group) else _read_sides(spec, group)


def _read_marked_pair(spec: MatchSpec, group: str) -> tuple[str, str] | None:
    """Return a pair whose right side is numbered behind its words, or its left one before them."""
    numbered = _NUMBER_LAST.fullmatch(group)
    if numbered and numbered["number"] in _list_targets(spec):
        return _find_numbered_pair(spec, numbered["words"], numbered["number"])
    headed = _LABEL_FIRST.fullmatch(group)
    words = headed["words"] if headed and headed["label"] in spec.pairs else ""
    labelled = words[:1].isdecimal() or _is_run_of_labels(spec, words[:1])
    right = "" if labelled else _find_side(spec, words, _list_targets(spec))
    return (headed["label"], right) if headed and right else None


def _read_tokens(spec: MatchSpec, group: str) -> list[tuple[str, str]]:
    """Return the pairs of labels with a right side in words, or of a number with a left one."""
    tokens = [token for token in _TOKENS.split(group) if token and token not in set_of_words("and")]
    runs = [token for token in tokens if _is_run_of_labels(spec, token)]
    lefts = [label for token in runs for label in token]
    rest = " ".join(token for token in tokens if token not in runs)
    digits = [token for token in tokens if token.isdecimal()]
    if len(lefts) == len(digits) == 1 and digits[0] in _list_targets(spec):
        meant = _find_named_side(spec, rest.replace(digits[0], ""))
        return [(lefts[0], digits[0])] if meant in {"", digits[0]} else []
    if lefts:
        right = rest if rest in _list_targets(spec) else _find_side(spec, rest, _list_targets(spec))
        return [(left, right) for left in lefts] if right else []
    if len(digits) == 1 and digits[0] in _list_targets(spec):
        words = " ".join(token for token in tokens if token not in digits)
        left = _find_side(spec, words, list(spec.pairs)) or _find_place(spec, words)
        return [(left, digits[0])] if left else []
    return []


def _find_place(spec: MatchSpec, words: str) -> str:
    """Return the label of the left side that is called by its place, ``first one``; else empty."""
    idle = set_of_words("choices.place-nouns") | set_of_words("articles")
    kept = [word for word in words.casefold().split() if word not in idle]
    place = list_ordinals().get(kept[0], 0) if len(kept) == 1 else 0
    return list(spec.pairs)[place - 1] if 1 <= place <= len(spec.pairs) else ""


def _read_sides(spec: MatchSpec, group: str) -> list[tuple[str, str]]:
    """Return the pair of two sides in words, parted by a sign or at the only fitting place."""
    sides = _SIDES.split(group)
    if len(sides) == len(("left", "right")):
        pair = _find_pair(spec, *sides)
        return [pair] if all(pair) else []
    spoken = group.split()
    cuts = range(1, len(spoken)) if len(sides) == 1 and len(spoken) <= MOST_WORDS else ()
    found = {_find_pair(spec, " ".join(spoken[:cut]), " ".join(spoken[cut:])) for cut in cuts}
    found = {pair for pair in found if all(pair)}
    return [*found] if len(found) == 1 else []


def _find_numbered_pair(spec: MatchSpec, words: str, number: str) -> tuple[str, str] | None:
    """Return the pair of ``V = 0 gives black (3)``; None if its words name no or another side."""
    label, _, rest = words.strip().partition(" ")
    named = label.strip(":") if label.strip(":") in spec.pairs else ""
    meant = _find_named_side(spec, rest if named else words)
    if named:
        return (named, number) if meant in {"", number} and not is_denied(rest) else None
    spoken = words.split()
    heads = (" ".join(spoken[:cut]) for cut in range(min(len(spoken), MOST_WORDS), 0, -1))
    left = next(filter(None, (_find_side(spec, head, list(spec.pairs)) for head in heads)), "")
    return (left, number) if left else None


def _find_pair(spec: MatchSpec, first: str, second: str) -> tuple[str, str]:
    """Return the labels of a left side in words and a right one; empty where none is meant."""
    targets = _list_targets(spec)
    numbered = _NUMBERED_SIDE.fullmatch(second.strip())
    right = numbered[1] if numbered and numbered[1] in targets else ""
    return _find_side(spec, first, list(spec.pairs)), right or _find_side(spec, second, targets)


def _is_run_of_labels(spec: MatchSpec, token: str) -> bool:
    """Return whether a piece consists of left labels, as ``DF`` does, and ``CCD`` does not."""
    return token.isupper() and {*token} <= {*spec.pairs} and len({*token}) == len(token)


def _list_targets(spec: MatchSpec) -> list[str]:
    """Return the labels of all right sides, with those that fit nowhere."""
    return [label for label in spec.words if label not in spec.pairs] or [*spec.pairs.values()]


def _find_side(spec: MatchSpec, words: str, labels: Sequence[str]) -> str:
    """Return the label whose wording is meant; empty if none or several may be."""
    wordings = [[said.get(label, "") for label in labels] for said in (spec.words, *spec.said)]
    place = find_wording_in(words, wordings, all_named=True)
    return labels[place - 1] if place else ""


FEWEST_NAMED = 2
"""Left sides that are named, so that the last one need not be."""


def _find_named_side(spec: MatchSpec, words: str) -> str:
    """Return the label of the right side whose own words these are; empty for none or several."""
    labels = _list_targets(spec)
    listed = ([said.get(label, "") for label in labels] for said in (spec.words, *spec.said))
    places = {find_wording(words, wordings, all_named=True) for wordings in listed} - {0}
    return labels[places.pop() - 1] if len(places) == 1 else ""


MOST_WORDS = 12
"""Words of a pair that nothing parts."""
_NUMBERED_SIDE = WordPattern(r"(?:(?:«pictures»|«choices.numbered») )?(\d)", re.IGNORECASE)


def _find_right_label(second: str, right: dict[str, str]) -> str:
    """Return the right label; a distractor, which no pair uses, stands for itself."""
    return right.get(second) or (second.upper() if len(second) <= 3 else "")


def _split_pairs(text: str, left: dict[str, str]) -> list[tuple[str, str]]:
    """Return the pairs of ``A3``, ``A 3``, or of several run together, ``A3B1``.

    ``3A 1B`` has the numbers first: that is certain only when every left label comes second.

    Raises
    ------
    FormulaReadError
        If a label is left without a partner.
    """
    words = [w for w in map(fold_word, _SEPARATORS.split(_ARROWS.sub(" ", text))) if w]
    words = [w for w in words if w in left or w not in set_of_words("choices.pair-fillers")]
    label = "|".join(re.escape(name) for name in sorted(left, key=len, reverse=True))
    run = re.compile(rf"(?:(?:{label})\d{{1,2}})+|(?:\d{{1,2}}(?:{label}))+")
    flat: list[str] = []
    for piece in words:
        together = piece not in left and run.fullmatch(piece)
        flat += re.findall(rf"{label}|\d{{1,2}}", piece) if together else [piece]
    if len(flat) % 2:
        raise FormulaReadError("pairs-expected", 1, safe_echo(text))
    firsts, seconds = flat[::2], flat[1::2]
    if {*seconds} >= left.keys() and not {*firsts} & left.keys():
        firsts, seconds = seconds, firsts
    return list(zip(firsts, seconds, strict=True))


def _add_pair(
    spec: MatchSpec, found: dict[str, str], name: str, chosen: str, typed: tuple[str, str]
) -> None:
    """Add one pair to those read.

    Raises
    ------
    FormulaReadError
        If a label does not exist, or is used twice.
    """
    if not name or not chosen:
        raise FormulaReadError("pairs-expected", 1, safe_echo(typed[1] if name else typed[0]))
    if name in found:
        raise FormulaReadError("used-twice", 1, name)
    if chosen in found.values() and not spec.allows_reuse():
        raise FormulaReadError("used-twice", 1, chosen)
    found[name] = chosen


def ask(part: PartContext) -> AskedPart[MatchSpec]:
    """Return both sides, each in a drawn order of its own."""
    (names, extra), pairs = part.selection(), part.matching_pairs()
    left = assign_letters(part.shuffle_names(names, "/left"))
    targets = sorted({*(pairs[name] for name in names), *extra})
    right = part.shuffle(targets, "/right")
    places = {name: str(place) for place, name in enumerate(right, 1)}
    named = [
        *left,
        *((f"{mark}{places[n]}", f"{name} = {n}") for mark, name in left for n in right),
    ]
    matched = {mark: places[pairs[name]] for mark, name in left}
    labels = [*matched, *places.values()]
    told, *said = (
        dict(zip(labels, texts, strict=True))
        for texts in part.option_texts([*(name for _, name in left), *right])
    )
    others = {"said": said} if said else {}
    return AskedPart(
        make_spec(MatchSpec, part, pairs=matched, words=told, why=part.reasons(named), **others),
        InputControl("pairs"),
        options=left,
        targets=tuple((places[n], n) for n in right),
        reasons=part.with_reason(named),
    )


def say_how(spec: MatchSpec, lang: str) -> tuple[str, ...]:
    """Return how pairs are typed, and whether a right side may be used twice."""
    return (translate(lang, "ask.match_reuse" if spec.allows_reuse() else "ask.match"),)


def say_on_paper(spec: MatchSpec, lang: str) -> tuple[str, ...]:
    """Return that a right side may be used twice, where it may."""
    return (translate(lang, "on_paper.reuse"),) if spec.allows_reuse() else ()


KIND = AnswerKind(
    AuthoredMatch,
    MatchSpec,
    ask,
    say_how,
    paper_hints=say_on_paper,
    verb="tick",
    work=count_listed("tick", "pairs"),
)

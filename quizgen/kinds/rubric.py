"""Kind ``rubric``: sentences in own words, marked by criteria that a person ticks.

The program suggests which criteria an answer meets and quotes what it goes by; it decides nothing.
What counts, what earns half, what is refused: examples in the language files, one list for each
criterion. They are what is looked for, and what the mark scheme prints.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import lru_cache
from typing import Annotated, Any, Literal, NamedTuple

import msgspec
from msgspec import Meta

from quizgen.core.decoding import json_decoder
from quizgen.core.errors import FormulaError
from quizgen.grading.echo import safe_echo
from quizgen.grading.judging.statements import (
    Evidence,
    Example,
    Meaning,
    Statement,
    Subject,
    Words,
    read_subject,
    read_words,
)
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.normalise import refuse_invisible, refuse_long_prose
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.spec import AnySpec, WordSpec
from quizgen.grading.verdict import Verdict, ambiguous
from quizgen.kinds.asking import make_spec
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    AuthoredAnswer,
    FieldProblem,
    InputControl,
    PartContext,
    SchemeRow,
    find_name_problems,
)
from quizgen.kinds.work import Work
from quizgen.locale import translate
from quizgen.maths.constants import Scalar
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.numbers import parse_written_number

HALF = Fraction(1, 2)
WORDS_A_LINE = 6
"""Words of handwriting on a ruled line."""
FEWEST_LINES, MOST_LINES = 2, 10

Status = Literal["found", "half", "follows", "refused", "open", "missing"]
"""What is suggested of a criterion: ``refused`` if it is denied or contradicted, ``open`` if its
words are there and a person must look, ``follows`` if it is right after an own earlier mistake."""


class AuthoredRubric(AuthoredAnswer, kw_only=True, tag="rubric", frozen=True):
    """Sentences, and the criteria that they are marked by."""

    criteria: Annotated[
        dict[str, Scalar],
        Meta(description="points of each criterion; more than the part has if the best count."),
    ]
    mistakes: Annotated[
        dict[str, str],
        Meta(description="known wrong ideas, each with the criterion that it contradicts."),
    ] = msgspec.field(default_factory=dict)
    follows: Annotated[
        dict[str, str],
        Meta(description="criteria that count where they follow from a wrong earlier one."),
    ] = msgspec.field(default_factory=dict)

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield what is wrong with points and names."""
        yield from find_name_problems("criteria", tuple(self.criteria), 0)
        for name, points in self.criteria.items():
            try:
                sound = 0 < parse_written_number(points) <= MOST_POINTS_OF_ONE
            except FormulaError:
                sound = False
            if not sound:
                wrong = f"points: more than 0, at most {MOST_POINTS_OF_ONE}"
                yield ("criteria", name), "QG230", wrong
        for field in ("mistakes", "follows"):
            for name, other in getattr(self, field).items():
                if other and other not in self.criteria:
                    yield (field, name), "QG230", f"{other!r} is no criterion"
        for name in self.follows:
            if name not in self.criteria:
                yield ("follows", name), "QG230", f"{name!r} is no criterion"


MOST_POINTS_OF_ONE = 20


class Criterion(msgspec.Struct, kw_only=True, frozen=True, omit_defaults=True,
                forbid_unknown_fields=True):  # fmt: skip
    """One criterion: its points, and examples of what counts, what half, what not.

    ``follows`` names the criterion that it may follow from although that one is wrong. ``about``
    are words for what it is said of, where a part compares things: said of another thing, it does
    not count.
    """

    points: Scalar
    accept: list[str]
    half: list[str] = []
    refuse: list[str] = []
    follows: str = ""
    about: list[str] = []

    @property
    def worth(self) -> Fraction:
        """Return its points as an exact number."""
        return parse_written_number(self.points)


class Finding(NamedTuple):
    """What is suggested of a criterion.

    Parameters
    ----------
    name : str
    status : Status
    points : Fraction
        That would follow.
    quote : str
        The clause of the answer that it goes by; empty if there is none.
    """

    name: str
    status: Status
    points: Fraction
    quote: str = ""


class Suggestion(NamedTuple):
    """What is suggested of an answer.

    Parameters
    ----------
    findings : tuple of Finding
        In the order of the criteria.
    points : Fraction
        In all, at most those of the part.
    mistakes : tuple of str
        Known wrong ideas that were recognised.
    touched : bool
        Whether any word of the matter is there.
    spots : tuple of (int, int)
        Where the words stand that it goes by.
    """

    findings: tuple[Finding, ...]
    points: Fraction
    mistakes: tuple[str, ...]
    touched: bool
    spots: tuple[tuple[int, int], ...]


class RubricSpec(WordSpec, kw_only=True, frozen=True):
    """Criteria of a part with ``full`` points.

    ``ideas`` maps a language to the sentence of each criterion, ``model`` to the model answer;
    ``mistakes`` maps a known wrong idea to its examples, ``notes`` holds its sentence.
    ``synonyms`` are words of the subject that mean the same.
    """

    full: Scalar
    criteria: dict[str, Criterion]
    ideas: dict[str, dict[str, str]] = msgspec.field(default_factory=dict)
    model: dict[str, str] = msgspec.field(default_factory=dict)
    mistakes: dict[str, list[str]] = msgspec.field(default_factory=dict)
    synonyms: list[list[str]] = msgspec.field(default_factory=list)

    def validate(self) -> None:
        """Check what a mark scheme needs.

        Raises
        ------
        ValueError
            If a criterion has no example, or the criteria do not make up the points of the part.
        """
        if not self.criteria or not all(one.accept for one in self.criteria.values()):
            raise ValueError("every criterion needs an example of what counts")
        if sum(one.worth for one in self.criteria.values()) < parse_written_number(self.full):
            raise ValueError("the criteria have fewer points than the part")

    def count_needed_criteria(self) -> int:
        """Return how many criteria make up the points of the part: fewer where the best count."""
        worth = sorted((one.worth for one in self.criteria.values()), reverse=True)
        full = parse_written_number(self.full)
        return next(n for n in range(1, len(worth) + 1) if sum(worth[:n]) >= full)

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return what is suggested of a text, for a person who decides.

        Its points are those that the part is worth where it is asked.

        Raises
        ------
        FormulaReadError
            If it is empty, too long, or holds invisible characters.
        """
        refuse_long_prose(typed)
        if not typed.strip():
            raise FormulaReadError("no-answer", 1)
        refuse_invisible(SourceText.of(typed.strip("\u200e\u200f\ufeff")), "\r\n\t\u200c\u200d")
        made = self.suggest(typed)
        found = [one.name for one in made.findings if one.status in EARNING]
        refused = [one.name for one in made.findings if one.status == "refused"]
        missing = [one.name for one in made.findings if one.status in {"open", "missing"}]
        full = parse_written_number(self.full)
        worth = options.points or full
        note = "self-mark" if found or refused else "self-mark-open"
        return ambiguous(
            note if found or refused or made.touched else "self-mark-none",
            safe_echo(" ".join(typed.split()), 80),
            right=_format_points(made.points * worth / full),
            of=_format_points(worth),
            found=tuple(found),
            missing=tuple(missing),
            refused=tuple(refused),
            because=made.mistakes,
        )

    def suggest(self, typed: str) -> Suggestion:
        """Return which criteria a text meets, each with the clause that it goes by.

        It is cached: who marks a class looks at each text twice, for its marks and for the queue.
        """
        return _suggest(msgspec.json.encode(self), typed)

    def look_for_criteria(self, typed: str) -> Suggestion:
        """Return which criteria a text meets, searched anew."""
        subject = read_subject(tuple(map(tuple, self.synonyms)))
        text = Statement(typed, subject)
        read = {name: self._read_examples(name, subject) for name in self.criteria}
        examples = [example for listed in read.values() for example in listed]
        wrong = {
            name: [subject.read(text, "denied") for text in listed]
            for name, listed in self.mistakes.items()
        }
        text.know(subject.collect_words(examples, [one for own in wrong.values() for one in own]))
        named = {name: read_words(one.about, subject) for name, one in self.criteria.items()}
        evidence = {
            name: text.find(listed, named[name], _list_others(named, name))
            for name, listed in read.items()
        }
        first = {name: _sum_up(found) for name, found in evidence.items()}
        findings, spots = [], set[tuple[int, int]]()
        for name, one in self.criteria.items():
            status, by = first[name]
            if one.follows and _is_turned(evidence[name]) and _is_turned(evidence[one.follows]):
                status = "follows"
            points = one.worth * SHARES.get(status, Fraction(0))
            quote = safe_echo(" ".join(text.quote(by).split()), 80) if by else ""
            findings.append(Finding(name, status, points, quote))
            spots |= set(text.spans(by)) if by and status in EARNING else set()
        mistakes = tuple(
            name
            for name, listed in wrong.items()
            if any(one.meaning == "denied" for one in text.find(listed))
        )
        earned = min(
            sum((f.points for f in findings), Fraction(0)), parse_written_number(self.full)
        )
        return Suggestion(
            tuple(findings),
            min(earned, parse_written_number(self.full)),
            mistakes,
            text.touches(examples),
            tuple(sorted(spots)),
        )

    def _read_examples(self, name: str, subject: Subject) -> list[Example]:
        """Return the examples of a criterion, ready to be looked for."""
        one = self.criteria[name]
        listed: tuple[tuple[Meaning, list[str]], ...] = (
            ("said", one.accept),
            ("half", one.half),
            ("denied", one.refuse),
        )
        return [subject.read(text, sign) for sign, texts in listed for text in texts]

    def show(self) -> str:
        """Return the names of the criteria."""
        return "; ".join(self.criteria)

    def show_in(self, lang: str, /) -> str:
        """Return the model answer; the ideas if none is written."""
        return self.model.get(lang) or " ".join(self.list_ideas(lang).values()) or self.show()

    def list_ideas(self, lang: str) -> Mapping[str, str]:
        """Return the sentence of each criterion in a language, else in the first there is."""
        return self.ideas.get(lang) or next(iter(self.ideas.values()), {})


@lru_cache(maxsize=4096)
def _suggest(spec: bytes, typed: str) -> Suggestion:
    """Return what is suggested of a text by a specification as JSON."""
    return _decode(spec).look_for_criteria(typed)


_decode = json_decoder(RubricSpec).decode


def suggest_marks(spec: AnySpec, typed: str) -> Suggestion | None:
    """Return what is suggested of an own sentence; None for a blank, and for every other kind."""
    return spec.suggest(typed) if isinstance(spec, RubricSpec) and typed.strip() else None


def share_of_marks(
    marks: Mapping[str, Fraction], points: Mapping[str, Fraction], full: Fraction
) -> Fraction:
    """Return the share of a part's points that ticked criteria earn.

    Parameters
    ----------
    marks : mapping of str to Fraction
        Share of each ticked criterion: 1 or a half. Names that are no criteria are left out.
    points : mapping of str to Fraction
        Of each criterion.
    full : Fraction
        Points of the part.
    """
    earned = sum((marks[name] * points[name] for name in marks.keys() & points.keys()), Fraction(0))
    return min(earned / full, Fraction(1))


EARNING = frozenset({"found", "half", "follows"})
SHARES = {"found": Fraction(1), "half": HALF, "follows": Fraction(1)}


def _list_others(named: Mapping[str, frozenset[Words]], name: str) -> frozenset[Words]:
    """Return the words for what other criteria are said of, and this one is not."""
    mine = named[name]
    return frozenset[Words]().union(*named.values()) - mine if mine else mine


def _sum_up(found: list[Evidence]) -> tuple[Status, Evidence | None]:
    """Return what all clauses together suggest, and the evidence that it goes by.

    A contradiction outweighs what is right: both together say nothing. One whose words lie far
    apart does not, where the idea is said.
    """
    if any(one.meaning == "said" for one in found):
        found = [one for one in found if one.meaning != "denied" or not one.is_loose]
    for meaning, status in (
        ("denied", "refused"), ("said", "found"), ("half", "half"), ("open", "open"),
    ):  # fmt: skip
        for one in found:
            if one.meaning == meaning:
                return status, one  # type: ignore[return-value]
    return "missing", None


def _is_turned(found: list[Evidence]) -> bool:
    """Return whether an idea was stated the wrong way round, and nothing else of it."""
    return bool(found) and all(one.turned for one in found)


def _format_points(points: Fraction) -> str:
    """Return points as a decimal."""
    return f"{float(points):g}"


def ask(part: PartContext) -> AskedPart[RubricSpec]:
    """Return the criteria with their examples.

    Raises
    ------
    BankError
        If a language file lacks what a criterion needs.
    """
    answer = part.answer
    mistakes: Mapping[str, str] = answer.get("mistakes", {})
    follows: Mapping[str, str] = answer.get("follows", {})
    refused = {name: part.accepted_words(name, "refuse") for name in mistakes}
    criteria = {
        name: Criterion(
            points=points,
            accept=part.accepted_words(name, "accept"),
            half=part.accepted_words(name, "half"),
            refuse=part.accepted_words(name, "refuse")
            + [w for m, of in mistakes.items() if of == name for w in refused[m]],
            follows=follows.get(name, ""),
            about=part.accepted_words(name, "about"),
        )
        for name, points in answer["criteria"].items()
    }
    names = [(name, name) for name in criteria]
    used = [
        words
        for one in criteria.values()
        for words in (*one.accept, *one.half, *one.refuse, *one.about)
    ]
    used += [words for listed in refused.values() for words in listed]
    spec = make_spec(
        RubricSpec,
        part,
        full=part.points,
        criteria=criteria,
        ideas=part.sentences("points", names),
        model=part.model_answers(),
        mistakes=refused,
        notes=part.sentences("reasons", [(name, name) for name in mistakes]) if mistakes else {},
        synonyms=part.synonyms(used),
    )
    model = spec.show_in(next(iter(spec.ideas), ""))
    said = len(model.split()) * spec.count_needed_criteria() // len(criteria)
    lines = -(-said // WORDS_A_LINE)
    return AskedPart(
        spec,
        InputControl("lines", lines=min(max(lines, FEWEST_LINES), MOST_LINES)),
        right=tuple(("points", name) for name in criteria),
        reasons=tuple((words[0], name) for name, words in refused.items() if words),
        scheme=tuple(
            SchemeRow(name, one.worth, one.follows, bool(one.half))
            for name, one in criteria.items()
        ),
    )


FEW = 2
"""Criteria that one or two sentences can meet."""


def input_hints(spec: RubricSpec, lang: str) -> tuple[str, ...]:
    """Return the sentence on own words, as short as the criteria allow."""
    count = spec.count_needed_criteria()
    return (
        translate(lang, "ask.rubric")
        if count <= FEW
        else translate(lang, "ask.rubric_many").format(n=count),
    )


def explain_key(spec: RubricSpec, lang: str) -> str:
    """Return the model answer; empty if none is written: the ideas state it then."""
    return spec.model.get(lang, "")


def count_words(answer: Mapping[str, Any], points: Fraction, words: int) -> Work:
    """Return the words to be written: of a model answer that says more, the share that counts."""
    whole = sum(map(parse_written_number, answer["criteria"].values()))
    return {"word written": words * min(Fraction(1), points / whole)}


KIND = AnswerKind(
    AuthoredRubric,
    RubricSpec,
    ask,
    input_hints,
    explain_key,
    input_hints,
    verb="write",
    work=count_words,
)

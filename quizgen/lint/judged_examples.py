"""Whether answers that bring examples are judged as they say: checks, mark schemes, derivations."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

import msgspec

from quizgen.bank.template import Template
from quizgen.bank.variant import Variant
from quizgen.core.diagnostics import Diagnostic, diagnose
from quizgen.core.positions import Place
from quizgen.grading.judging.statements import read_subject
from quizgen.kinds.derivation import DerivationSpec
from quizgen.kinds.grade import grade_answer
from quizgen.kinds.rubric import RubricSpec, Status
from quizgen.maths.numbers import parse_written_number
from quizgen.question.part_context import VariantPart, ask_part

DRAWS = 20
"""Draws in which each example is judged."""
NONSENSE = ("?", "((((", "0/0", "qwertz uiop", "9" * 200, "x" * 5000)
"""Answers that earn nothing, whatever is asked, and that no check may fail at."""


def find_misjudged_examples(draws: Iterable[Variant]) -> Iterator[Diagnostic]:
    """Yield each example that is not judged as it says, once, and each failure of a check."""
    said = set[tuple[int, int]]()
    for one in list(draws)[:DRAWS]:
        for index, part in enumerate(one.template.rules.part):
            if not part.example:
                continue
            spec = ask_part(one, index).spec
            examples = [
                *VariantPart(one, index).examples(),
                *((text, Fraction(0)) for text in NONSENSE),
            ]
            for place, (typed, share) in enumerate(examples):
                verdict = grade_answer(spec, typed, lang=one.template.languages[0])
                fault = str(verdict.fields.get("fault", ""))
                if (index, place) in said or (not fault and verdict.credit == share):
                    continue
                said.add((index, place))
                earned = f"earns {verdict.credit} of the points, not {share}"
                found = f"cannot be judged: {fault}" if fault else earned
                what = f"seed {one.seed}: {typed[:60]!r} {found}"
                own = place < len(part.example)
                at = ("part", index, "example", place) if own else ("part", index, "answer")
                yield diagnose("QG221", one.template.file, what, at)
                if fault:
                    return  # one that takes too long does so for each answer of each draw


DIFFERENT = 8
"""Different mark schemes of a part that are read: conditions and values change its examples."""


def find_unsound_schemes(draws: Iterable[Variant]) -> Iterator[Diagnostic]:
    """Yield each example that is not read as its list says, and each model answer that falls short.

    A problem is told once, whatever the number of draws that have it.
    """
    told = set[str]()
    read: dict[int, list[bytes]] = {}
    for one in draws:
        for index in range(len(one.template.rules.part)):
            spec = ask_part(one, index).spec
            if not isinstance(spec, RubricSpec):
                continue
            before, written = read.setdefault(index, []), msgspec.json.encode(spec)
            if written in before or len(before) >= DIFFERENT:
                continue
            before.append(written)
            place: Place = ("part", index, "answer")
            found = (*_misread_examples(spec), *_bare_examples(spec), *_weak_models(spec))
            for code, what in found:
                if what not in told:
                    told.add(what)
                    yield diagnose(code, one.template.file, f"seed {one.seed}: {what}", place)


def _misread_examples(spec: RubricSpec) -> Iterator[tuple[str, str]]:
    """Yield code and words for each example that its own criterion does not read as meant."""
    for name, one in spec.criteria.items():
        lists: tuple[tuple[list[str], frozenset[Status]], ...] = (
            (one.accept, frozenset({"found"})),
            (one.half, frozenset({"half"})),
            (one.refuse, frozenset({"refused"})),
        )
        for examples, wanted in lists:
            for text in examples:
                status = next(f.status for f in spec.suggest(text).findings if f.name == name)
                if status not in wanted:
                    yield "QG231", f"{name}: {text!r} is {status}, not {' or '.join(wanted)}"


def _bare_examples(spec: RubricSpec) -> Iterator[tuple[str, str]]:
    """Yield code and words for each example of scale words alone that may be of another criterion.

    *Larger* is found wherever something is said to be larger.
    """
    subject = read_subject(tuple(map(tuple, spec.synonyms)))
    read = {
        name: [subject.read(text, "said") for text in (*one.accept, *one.half)]
        for name, one in spec.criteria.items()
    }
    scales = {name: {scale for one in read[name] for scale in one.scales} for name in read}
    for name, examples in read.items():
        others = set[str]().union(*(scales[other] for other in scales if other != name))
        for one in examples:
            if one.is_bare and not others.isdisjoint(one.scales):
                yield "QG324", f"{name}: {one.text!r}"


def _weak_models(spec: RubricSpec) -> Iterator[tuple[str, str]]:
    """Yield code and words for each model answer that does not earn all points."""
    for lang, text in spec.model.items():
        made = spec.suggest(text)
        if made.points < parse_written_number(spec.full):
            rest = ", ".join(f"{f.name} {f.status}" for f in made.findings if f.status != "found")
            yield "QG232", f"the model answer in {lang} leaves out: {rest}"


def derivation_lines(template: Template) -> set[str]:
    """Return the names of all lines of a template's derivations, each with its sentence."""
    answers = (part.answer for part in template.rules.part)
    return {name for one in answers if one.get("kind") == "derivation" for name in one["lines"]}


def find_derivation_faults(draws: Iterable[Variant]) -> list[Diagnostic]:
    """Return what is wrong with the lines of derivations, each fault once."""
    found: dict[tuple[str, str], Diagnostic] = {}
    for drawn in draws:
        for index, part in enumerate(drawn.template.rules.part):
            if part.answer.get("kind") == "derivation":
                for code, what in _iter_faults(drawn, index):
                    said = f"part {drawn.template.labels[index] or '1'}: {what}"
                    place = ("part", index, "answer")
                    key = (code, what.partition(":")[0])
                    found.setdefault(key, diagnose(code, drawn.template.file, said, place))
    return [*found.values()]


def _iter_faults(drawn: Variant, index: int) -> Iterator[tuple[str, str]]:
    """Yield code and message of each fault of one derivation."""
    spec = ask_part(drawn, index).spec
    if not isinstance(spec, DerivationSpec):
        return
    yield from spec.find_faults()
    points = parse_written_number(drawn.template.rules.part[index].points)
    if spec.total != points:
        yield "QG242", f"lines and reasons have {spec.total} points, the part has {points}"

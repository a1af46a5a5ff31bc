"""Whether a mark scheme recognises its own examples, and its model answer meets its criteria."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import msgspec

from quizgen.bank.variant import Variant
from quizgen.core.diagnostics import Diagnostic, diagnose
from quizgen.core.positions import Place
from quizgen.kinds.rubric import RubricSpec, Status
from quizgen.maths.numbers import parse_written_number
from quizgen.question.part_context import ask_part

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
            for code, what in (*_misread_examples(spec), *_weak_models(spec)):
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


def _weak_models(spec: RubricSpec) -> Iterator[tuple[str, str]]:
    """Yield code and words for each model answer that does not earn all points."""
    for lang, text in spec.model.items():
        made = spec.suggest(text)
        if made.points < parse_written_number(spec.full):
            rest = ", ".join(f"{f.name} {f.status}" for f in made.findings if f.status != "found")
            yield "QG232", f"the model answer in {lang} leaves out: {rest}"

"""Kind ``checked``: what no other kind can judge, judged by ``check.py`` beside the template."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import msgspec

from quizgen.grading.checking import CheckValue, run_check
from quizgen.grading.echo import safe_echo
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.normalise import refuse_invisible, refuse_long_prose
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import Verdict, ambiguous, unreadable, verdict_by_share
from quizgen.kinds.asking import explain_as_code, hint, make_spec
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    AuthoredAnswer,
    FieldProblem,
    PartContext,
    find_name_problems,
)
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.numbers import format_for_key

LEAST_EXAMPLES = 3
"""A right answer, a wrong one, and one that makes no sense."""


class AuthoredChecked(AuthoredAnswer, kw_only=True, tag="checked", frozen=True):
    """An answer that a function of ``check.py`` judges; ``traps`` are the sentences it may say."""

    function: str = "check"
    traps: tuple[str, ...] = ()

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield what is wrong with the names of sentences."""
        yield from find_name_problems("traps", self.traps, 0, least=0)


class CheckedSpec(WordSpec, kw_only=True, frozen=True):
    """Checked: ``check`` = digest of check.py; ``function`` in it; ``values`` that it is given.

    ``example`` is a right answer, which is printed.
    """

    check: str
    example: str
    function: str = "check"
    values: dict[str, CheckValue] = msgspec.field(default_factory=dict)

    def judge(self, typed: str, _options: GradingOptions, /) -> Verdict:
        """Return the verdict of the author's check; a person decides where that cannot run.

        Raises
        ------
        FormulaReadError
            If it is empty, too long, or holds invisible characters, or the check cannot read it.
        """
        refuse_long_prose(typed)
        if not typed.strip():
            raise FormulaReadError("no-answer", 1)
        refuse_invisible(SourceText.of(typed), "\r\n\t\u200c\u200d")
        outcome = run_check(self.check, self.function, self.values, typed.strip())
        echo = safe_echo(" ".join(typed.split()), 80)
        note = f"trap:{outcome.says}" if outcome.says else ""
        if outcome.fault:
            return ambiguous("unchecked", echo, fault=outcome.fault)
        if outcome.share is None:
            return unreadable(note or "not-understood", echo)
        return verdict_by_share(outcome.share, echo, note)

    def show(self) -> str:
        """Return a right answer."""
        return self.example


def ask(part: PartContext) -> AskedPart[CheckedSpec]:
    """Return the check with the numbers of the variant, and a right answer of its examples."""
    right = next((text for text, share in part.examples() if share == 1), None)
    if right is None or len(part.examples()) < LEAST_EXAMPLES:
        what = f"{LEAST_EXAMPLES} [[part.example]] are needed: right, wrong, and one without sense"
        raise part.error(what, "QG110")
    names = part.answer.get("traps", ())
    spec = make_spec(
        CheckedSpec,
        part,
        check=part.check_digest,
        example=right,
        values=_list_values(part),
        traps={},
        notes=part.misconception_notes(names) if names else {},
    )
    return AskedPart(spec)


def _list_values(part: PartContext) -> Mapping[str, CheckValue]:
    """Return the quantities of a variant as a key holds them: numbers, lists, phrases."""
    found: dict[str, CheckValue] = {
        name: str(format_for_key(value)) for name, value in part.shown_values.items()
    }
    found |= {name: [str(format_for_key(one)) for one in of] for name, of in part.lists.items()}
    for name, text in part.words.items():
        listed, _, place = name.partition("[")
        if place:
            found[listed] = [*found.get(listed, ()), text]
        else:
            found[name] = text
    return found


KIND = AnswerKind(AuthoredChecked, CheckedSpec, ask, hint("ask.checked"), explain_as_code)

"""Kind ``program``: a function in NumPy, which a locked process runs on hidden inputs."""

from __future__ import annotations

import keyword
import re
from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import msgspec

from quizgen.core.decoding import convert
from quizgen.grading.echo import safe_echo
from quizgen.grading.options import GradingOptions
from quizgen.grading.programs import ProgramInput, ProgramOutcome, run_program
from quizgen.grading.reading.normalise import refuse_invisible, refuse_long_prose, strip_code_fence
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import Verdict, ambiguous, unreadable, verdict_by_share, wrong
from quizgen.kinds.asking import make_spec, misconception_specs, sentence_with_code
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    AuthoredAnswer,
    FieldProblem,
    InputControl,
    PartContext,
)
from quizgen.kinds.work import Work
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.numbers import to_float

if TYPE_CHECKING:
    from quizgen.typeset.prose import TextOrInlines

TYPES = ("bool", "uint8", "uint16", "int16", "int32", "int64", "float32", "float64")
"""Types of the arrays that a function is given."""
INPUTS = "inputs"
"""Name of the demand that a function leaves what it is given as it is."""
ROOM = 3
"""Lines more than the solution takes, for whoever writes more loosely."""


class ProgramCase(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """What a function is called with, and what a right result weighs among the others."""

    args: list[Any]
    worth: int = 1


class AuthoredProgram(AuthoredAnswer, kw_only=True, tag="program", frozen=True):
    """A function to write, a solution, wrong ones by name, and hidden inputs."""

    function: str
    parameters: str
    solution: str
    cases: dict[str, ProgramCase]
    keeps: int = 0
    traps: dict[str, str] = msgspec.field(default_factory=dict)

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield what is wrong apart from types."""
        if not self.function.isidentifier() or keyword.iskeyword(self.function):
            yield ("function",), "QG108", "a name of Python is expected"
        if not self.cases:
            yield ("cases",), "QG110", "one hidden input at least is needed"
        if INPUTS in self.cases:
            yield ("cases", INPUTS), "QG125", "the name of what keeps asks for"
        for name, case in self.cases.items():
            if case.worth < 1:
                yield ("cases", name, "worth"), "QG112", "a whole number above 0"


class ProgramSpec(WordSpec, kw_only=True, frozen=True):
    """Program: ``function`` with ``parameters``; ``solution``; ``cases`` = hidden inputs by name.

    An array is ``{uint8 = [[0, 50], [100, 255]]}``. ``keeps`` is what it weighs that the inputs
    stay as they are. A trap is a wrong program: whoever does the same in all cases made that
    mistake.
    """

    function: str
    parameters: str
    solution: str
    cases: dict[str, ProgramCase]
    keeps: int = 0
    traps: dict[str, str] = msgspec.field(default_factory=dict)

    def judge(self, typed: str, _options: GradingOptions, /) -> Verdict:
        """Return the verdict by the cases in which a program does what the solution does.

        Raises
        ------
        FormulaReadError
            If it is empty, too long, or holds invisible characters.
        """
        refuse_long_prose(typed)
        program = _read_text(typed)
        cases: dict[str, list[ProgramInput]] = {n: case.args for n, case in self.cases.items()}
        outcome = run_program(
            program,
            function=self.function,
            parameters=self.parameters,
            solution=self.solution,
            traps=self.traps,
            cases=cases,
        )
        echo = safe_echo(" ".join(program.split()), 80)
        if outcome.fault:
            return ambiguous("unchecked", echo, fault=outcome.fault)
        if outcome.refused == "program-time":
            return wrong(echo, outcome.refused)
        if outcome.refused:
            return unreadable(outcome.refused, echo, line=outcome.line, code=outcome.found)
        return self._judge_outcome(outcome, echo)

    def _judge_outcome(self, outcome: ProgramOutcome, echo: str) -> Verdict:
        """Return the verdict on a program that ran."""
        worth = {name: case.worth for name, case in self.cases.items()}
        missed = list(outcome.missed)
        if self.keeps:
            worth[INPUTS] = self.keeps
            missed += [INPUTS] * outcome.changed
        total = sum(worth.values())
        credit = Fraction(total - sum(worth[name] for name in missed), total)
        details = dict(outcome.difference)
        note = details.pop("note", "program-inputs")
        return verdict_by_share(
            credit,
            echo,
            f"trap:{outcome.trap}" if outcome.trap else note,
            right=len(worth) - len(missed),
            of=len(worth),
            call=outcome.call,
            because=tuple(missed[:1]),
            **details,
        )

    def show(self) -> str:
        """Return the solution."""
        return self.solution


_PROMPT = re.compile(r"^(?:>>>|\.\.\.) ?", re.MULTILINE)
_TYPOGRAPHIC = str.maketrans({"−": "-", "–": "-", "\u00a0": " ", "\u202f": " ", "“": '"', "”": '"',
                              "‘": "'", "’": "'", "·": "*", "×": "*",
                              **dict(zip("০১২৩৪৫৬৭৮৯", "0123456789", strict=True))})  # fmt: skip
"""What an editor or a phone writes in place of characters of Python."""


def _read_text(typed: str) -> str:
    """Return a program without a fence or prompts around it, in characters of Python.

    Raises
    ------
    FormulaReadError
        If there is none, or it holds invisible characters.
    """
    plain = typed.replace("\r\n", "\n").expandtabs(4).translate(_TYPOGRAPHIC)
    source = strip_code_fence(SourceText.of(plain))
    refuse_invisible(source, "\n")
    program = _PROMPT.sub("", source.text).strip("\n")
    if not program.strip():
        raise FormulaReadError("no-answer", 1)
    return f"{program}\n"


def ask(part: PartContext) -> AskedPart[ProgramSpec]:
    """Return the solution, the wrong programs and the hidden inputs with the drawn values.

    Raises
    ------
    BankError
        If an array has no listed type.
    """
    answer = convert(part.answer, AuthoredProgram)
    solution = part.fill_program(answer.solution).strip("\n") + "\n"
    traps = {
        name: part.fill_program(text).strip("\n") + "\n" for name, text in answer.traps.items()
    }
    names = [*answer.cases, *([INPUTS] if answer.keeps else [])]
    spec = make_spec(
        ProgramSpec,
        part,
        parameters=part.fill_program(answer.parameters),
        solution=solution,
        cases={
            name: {"args": [_fill_input(part, one) for one in case.args], "worth": case.worth}
            for name, case in answer.cases.items()
        },
        traps=traps,
        notes=part.misconception_notes(traps) if traps else {},
        why=part.reasons([(name, name) for name in names]),
    )
    control = InputControl("lines", lines=solution.count("\n") + ROOM, keeps_lines=True)
    mistakes = misconception_specs(spec, "solution")
    return AskedPart(spec, control, mistakes=mistakes, is_long=True)


def _fill_input(part: PartContext, authored: Any) -> ProgramInput:
    """Return an input with numbers in place of formulas.

    Raises
    ------
    BankError
        If it is no number, formula or array of a listed type.
    """
    if isinstance(authored, dict):
        ((kind, values),) = authored.items() if len(authored) == 1 else [("", None)]
        if kind not in TYPES or not isinstance(values, list):
            raise part.error(f"an array is {{ TYPE = [...] }} with one of {', '.join(TYPES)}")
        return {kind: _fill_numbers(part, values)}
    return _fill_number(part, authored)


def _fill_numbers(part: PartContext, values: list[Any]) -> list[Any]:
    """Return nested lists with numbers in place of formulas."""
    return [
        _fill_numbers(part, one) if isinstance(one, list) else _fill_number(part, one)
        for one in values
    ]


def _fill_number(part: PartContext, authored: object) -> int | float:
    """Return the value of a formula or a number: a whole one where it is whole and has no point."""
    if isinstance(authored, (int, float)):
        return authored
    value = part.evaluate(str(authored))
    number = to_float(value)
    return int(number) if number.is_integer() and "." not in str(authored) else number


def input_hints(spec: ProgramSpec, lang: str) -> tuple[TextOrInlines, ...]:
    """Return the sentence on what to write."""
    head = f"def {spec.function}({spec.parameters}):"
    return (sentence_with_code(lang, "ask.program", head=head),)


def explain_key(spec: ProgramSpec, _lang: str) -> TextOrInlines:
    """Return the solution as program text."""
    from quizgen.typeset.prose import InlineCode

    return (InlineCode(spec.solution.strip("\n")),)


def count_lines(answer: Mapping[str, Any], _points: Fraction, _words: int) -> Work:
    """Return the lines of the solution."""
    return {"line of code": len(answer["solution"].strip().splitlines())}


KIND = AnswerKind(
    AuthoredProgram, ProgramSpec, ask, input_hints, explain_key, verb="program", work=count_lines
)

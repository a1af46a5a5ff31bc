"""Kind ``code``: what a program prints, after folding blanks."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

import msgspec

from quizgen.grading.echo import safe_echo
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.normalise import (
    REWRITES,
    refuse_invisible,
    refuse_long_prose,
    strip_code_fence,
)
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import HALF, Verdict, correct, partial, wrong
from quizgen.kinds.asking import explain_as_code, hint, make_spec, misconception_specs, say_on_paper
from quizgen.kinds.contract import AnswerKind, AskedPart, AuthoredAnswer, InputControl, PartContext
from quizgen.kinds.work import count_once
from quizgen.locale.word_patterns import WordPattern
from quizgen.maths.notation import FormulaReadError


class AuthoredCode(AuthoredAnswer, kw_only=True, tag="code", frozen=True):
    """What a program prints."""

    output: str
    also: tuple[str, ...] = ()
    traps: dict[str, str] = msgspec.field(default_factory=dict)


class CodeSpec(WordSpec, kw_only=True, frozen=True):
    """Code: ``output``; ``also`` = other outputs that count (another library version)."""

    output: str
    also: list[str] = msgspec.field(default_factory=list)
    traps: dict[str, str] = msgspec.field(default_factory=dict)

    def judge(self, typed: str, _options: GradingOptions, /) -> Verdict:
        """Return the verdict on typed program output; values set otherwise earn half.

        Raises
        ------
        FormulaReadError
            If it is empty, too long, or holds invisible characters.
        """
        refuse_long_prose(typed)
        source = SourceText.of(typed)
        for name in ("direction marks around", "blanks", "digits", "minus and dashes"):
            source = source.substitute(*REWRITES[name])
        source = source.substitute(_QUOTES, lambda quote: _STRAIGHT[quote[0]])
        refuse_invisible(source, "\r\n")
        given = fold_blanks(strip_code_fence(source).text.strip("` \r\n"))
        if not given:
            raise FormulaReadError("no-answer", 1)
        for output in (self.output, *self.also):
            if unify_quotes(given) == unify_quotes(fold_blanks(output)):
                return correct(safe_echo(given))
        given = _drop_surroundings(given)
        if any(
            unify_quotes(given) == unify_quotes(fold_blanks(o)) for o in (self.output, *self.also)
        ):
            return correct(safe_echo(given))
        outputs = {unify_quotes(fold_blanks(o)) for o in (self.output, *self.also)}
        for text in _list_barer_texts(given):
            if unify_quotes(fold_blanks(text)) in outputs:
                return correct(safe_echo(text))
        unclear = _EITHER.search(given) or (given.endswith("?") and given.count("[") > 1)
        if unclear and not _EITHER.search(self.output):
            raise FormulaReadError("two-readings", 1, safe_echo(given))
        given = _TAIL.sub("", given)
        note = _note(self, given)
        if note in SET_OTHERWISE:
            return partial(HALF, safe_echo(given), note)
        return wrong(safe_echo(given), note)

    def show(self) -> str:
        """Return the output."""
        return self.output


SET_OTHERWISE = frozenset({"output-brackets", "output-separators", "output-type"})
"""Notes on output whose values are right: it earns half."""

_BRACKETS = re.compile(r"[\[\](){}]")
_SEPARATORS = re.compile(r"[\[\](){},;\s]+")
_PROMPT = WordPattern(
    r"^(?:>>> ?|out(?:put)?(?: ?\[\d+\])? ?:|«choices.output» ?:|«choices.prints»(?!\w))\s*"
    r"(?:«choices.output-things»(?!\w)\s*)?",
    re.IGNORECASE,
)
"""What stands before an output that is copied or told."""
_ALL_QUOTED = re.compile(r"(?:\"|')(.+)(?:\"|')", re.DOTALL)
_ASSIGNED = re.compile(
    r"^(?:-+>|=>|→|⇒|\$|print:|\([^\W\d][\w, ]*\)=(?!=)|[^\W\d][\w.]*(?:\[[\d,: ]*\])?=(?!=)|=)\s*"
)
"""What an output is called, or an arrow to it."""
_TAIL = WordPattern(
    r"\s*(?:\((?=[^\W\d])[^()\d]*\)|\(=[^()]*\)|«choices.printed»|#.*"
    r"|(?:,\s*)?(?<!\w)«choices.because»(?!\w).*|\s[-–—]\s.*)$",
    re.DOTALL | re.IGNORECASE,
)
"""A remark behind an output."""
_CONCLUDED = WordPattern(
    r".+(?:[,;.] ?| )(?:«so»|«choices.final»|«choices.rounded»|->|=>|→|⇒):? ?(?P<rest>.+)",
    re.IGNORECASE | re.DOTALL,
)
"""An output behind how it comes about."""
_CORRECTED = WordPattern(
    r".+[,;.…] ?(?!\d)(?:«choices.correcting»|«choices.false»)[,:]? ?(?P<rest>[(\[{\d'\"-].*)",
    re.IGNORECASE | re.DOTALL,
)
"""An output in place of one that is taken back: ``(1, 2), no (2, 1)``."""
_AND = WordPattern(r"(?<!\w)«and»(?!\w)")
_EITHER = WordPattern(r"(?<!\w)«choices.or»(?!\w)", re.IGNORECASE)
_STRAIGHT = {**dict.fromkeys("“”„‟«»", '"'), **dict.fromkeys("‘’‚‛", "'")}
"""Quotation marks that an editor puts in place of those of a program."""
_QUOTES = re.compile(f"[{''.join(_STRAIGHT)}]")
_INSIDE = re.compile(r"\s*([\[\](){},:=])\s*")


def fold_blanks(text: str) -> str:
    """Return a text with line ends and runs of blanks folded, none next to brackets and commas."""
    lines = [" ".join(line.split()) for line in text.replace("\r", "").split("\n")]
    joined = "\n".join(line for line in lines if line)
    return "\n".join(_INSIDE.sub(r"\1", line) for line in joined.split("\n"))


def _drop_surroundings(given: str) -> str:
    """Return it without a prompt or ``Output:`` in front, and a sentence's full stop."""
    folded = re.sub("[！-～]", lambda m: chr(ord(m[0]) - 0xFEE0), given)
    bare = re.sub(r"(?<=[\])}\w'\"]) ?[.!,]$", "", _PROMPT.sub("", folded))
    return fold_blanks(bare)


def _list_barer_texts(given: str) -> Iterator[str]:
    """Yield an output without quotation marks, without what it is called, and without a remark.

    Each is only compared with what is right: a remark makes no other output of it.
    """
    quoted = _ALL_QUOTED.fullmatch(given)
    if quoted and any(map(str.isdigit, quoted[1])):
        yield quoted[1]
    bare = _ASSIGNED.sub("", given)
    yield bare
    short = _TAIL.sub("", bare)
    yield short
    yield _TAIL.sub("", short)
    yield fold_blanks(_AND.sub(" ", short))
    concluded = _CONCLUDED.fullmatch(bare) or _CORRECTED.fullmatch(bare)
    if concluded:
        yield _TAIL.sub("", _drop_surroundings(concluded["rest"]))


def unify_quotes(text: str) -> str:
    """Return a text with one kind of quotation marks, as Python reads both alike.

    How many there are counts.
    """
    return text.replace('"', "'")


def _note(spec: CodeSpec, given: str) -> str:
    """Return what is wrong with an output, empty if nothing explains it.

    A mistake as it is printed comes first, then the way of writing, then a mistake by its values.
    """
    wanted = fold_blanks(spec.output)
    return (
        _mistake(spec, given, str)
        or _written_otherwise(given, wanted)
        or _mistake(spec, given, _values)
        or ("output-type" if _same_numbers(given, wanted) else "")
    )


def _mistake(spec: CodeSpec, given: str, reduced: Callable[[str], str]) -> str:
    """Return the note of the mistake whose output is the given one after ``reduced``, or empty."""
    for name, output in spec.traps.items():
        if reduced(given) == reduced(fold_blanks(output)):
            return f"trap:{name}"
    return ""


def _written_otherwise(given: str, wanted: str) -> str:
    """Return the note on what alone differs: case, lines, quotes, brackets; empty if more does."""
    if given.casefold() == wanted.casefold():
        return "output-case"
    if re.sub(r"\s", "", given) == re.sub(r"\s", "", wanted):
        return "output-lines"
    if re.sub(r"['\"]", "", given) == re.sub(r"['\"]", "", wanted):
        return "output-quotes"
    if _values(given) != _values(wanted):
        return ""
    missing = _BRACKETS.search(wanted) and not _BRACKETS.search(given)
    return "output-brackets" if missing else "output-separators"


def _values(text: str) -> str:
    """Return what is printed, without brackets and commas."""
    return _SEPARATORS.sub(" ", text).strip()


def _same_numbers(given: str, wanted: str) -> bool:
    """Return whether the numbers are right and their type is not: ``4`` for ``4.0``."""
    numbers = [re.findall(r"-?\d+(?:\.\d*)?", text) for text in (given, wanted)]
    if not numbers[0] or len(numbers[0]) != len(numbers[1]) or len(given) > 400:
        return False
    around = [
        _SEPARATORS.sub("", re.sub(r"-?\d+(?:\.\d*)?", " ", text)) for text in (given, wanted)
    ]
    if around[0] != around[1]:
        return False
    return all(float(a) == float(b) for a, b in zip(*numbers, strict=True))


def ask(part: PartContext) -> AskedPart[CodeSpec]:
    """Return printed output and wrong outputs, with the drawn values in place."""
    output = part.fill_program(str(part.answer["output"]))
    traps = part.answer.get("traps", {})
    wrong = {trap: part.fill_program(str(text)) for trap, text in traps.items()}
    usable = {trap: text for trap, text in wrong.items() if text != output}
    notes = part.misconception_notes(usable)
    spec = make_spec(CodeSpec, part, output=output, traps=usable, notes=notes)
    control = InputControl("lines", lines=3)
    return AskedPart(spec, control, mistakes=misconception_specs(spec, "output"))


KIND = AnswerKind(
    AuthoredCode,
    CodeSpec,
    ask,
    hint("ask.code"),
    explain_as_code,
    say_on_paper("ask.code"),
    work=count_once("step", 2),
)

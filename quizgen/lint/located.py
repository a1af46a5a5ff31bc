"""Where a problem of a template stands, and what mends it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

from quizgen.bank.bank import LOCALE, SOLVERS, Bank
from quizgen.cards.checks import check_cards
from quizgen.core.errors import QuizgenError
from quizgen.core.untrusted import read_text
from quizgen.lint.bank_checks import find_missing_files
from quizgen.lint.leaks import QuestionContent, find_bank_leaks
from quizgen.locale import check_translations
from quizgen.locale.custom import TAG

ADVICE = {
    r"^no \w+\.md": "write it, or leave the language out of languages in bank.toml",
    r"section .* is missing": "write it",
    r"section .* lacks": "write a line '- NAME: sentence' for it",
    r"section .* explains": "rename or delete the line",
    "do not show the same values": "fill in the same {{ names }} in every language",
    "differs by": "give the entries the same names in every language",
    "never gives a usable wrong answer": "widen [draw], or leave it out with drop",
    "a placeholder is left": "name a drawn or solved quantity",
    r"part \w+: printed answer": "let the answer kind, its unit and rounding fit what is printed",
    r"trap .* typed as": "widen the distance to the key: another rounding, or [keep]",
    "cannot be told from": "give the mistake another result: other numbers in [draw], or drop it",
    "bits, at least": "let other options, statements or pairs be right in turn",
    "clearly the longest": "make wrong ones as long",
    "no reason for": "write a line '- NAME: sentence' for it in section reasons",
    "no trap names": "add traps to the answer, each with its sentence in section traps",
    r"claims for \d+ parts": "write more of them",
    "share names": "rename them in one of the two",
    "both have letters": "give the figure other letters, or show fewer options",
    "tells what": "say it in other words, or name the other template in apart",
    "no admissible draw": "widen [draw], or relax [keep] and where",
    "is of another kind than": "give it a unit of the kind that the solver works with",
    "is asked in .* its step is in": "ask in a unit of the same kind",
    "cannot be put together by": "check the formula, or the units of its quantities",
    "and the step says": "mend the formula, or the unit of its Step",
    "where a plain number is needed": "divide by a quantity of the same kind",
    "the same in all": "let it depend on what is drawn",
    "figure: shows": "leave it out of draw and alt where quiz is true",
    "labels .* overlap by": "move one of them, or leave it out where there is no room",
    "letters of .* are .* less than": "write them larger, and no index of an index",
    "pt wide, more than": "draw it narrower: it is as wide as what is drawn",
    "outside the axes are clipped": "widen set_xlim and set_ylim",
    "has numbers and no name": 'name it with its unit: ax.set_xlabel("$x$ / mm")',
    "can hardly be seen on white": "take an ink of the house (docs/figures.md) or a darker colour",
    "look alike on grey paper": "give one of them dashes, or say COLOUR = True",
    "cannot be seen in grey": "draw values that make it larger, or say COLOUR = True",
    "cannot be seen: ": "draw values that make it larger",
    "there is no picture": "put the file there, or mend its name",
    "picture .* cannot be read as": "save it anew as PNG, JPEG or plain SVG",
    "says is read in it": "show it in draw and alt where quiz is true, or leave it out of reads",
    "has no such word": "mend its name, or delete the line",
    "nothing to fill": "use these blanks, or none",
    "is to be a": "write it so",
    "is none of language.toml": "rename the file, or delete it",
    r"U\+\S+ .*\] in a text": "take it out",
    "unknown figure": "use one of these, or write templates/figures/NAME.py in the bank",
    "has no name, and there is no": "write it, or name a figure",
    "missing parameter": "give it in values of [figure]",
    "unknown parameter": "leave it out of values, or mend its name",
    "unknown unit": "use a listed one, or define it in units of bank.toml",
    "is not in bank.toml": "write it under [topics] there, or use one of these",
    "is of no template": "run python -m quizgen.cards.update_versions, with the folder of the bank",
    r"the key .* is missing|entry '.* is missing": "write it",
    "is not a drawn quantity": "use a name of [draw] or of the solver's steps",
    "draw lacks": "write a line for it under [draw]",
    "unknown to the solver": "use the name of one of its steps",
    "no MODEL": "end the solver with MODEL = Model(given=..., steps=...)",
    r"templates/cards/formulas\.toml lacks$": "write it there, or mend its name in the solver",
    r"and names no formula$": "name it in formulas of the solver's MODEL",
    "give exactly one of": "keep one way of drawing it",
    r"is \[first, last, step\]": "write three numbers",
    "is not more than 0": "write how much it is worth",
    "keep names unknown": "use the names of the solver's steps",
    "there is a unit": "leave it out, or give yours another name and symbol",
    "requires: .* is not like": "write a sign before the version",
    "requires: ": "install such a version, or widen it if the bank works with this one",
    "at most the number of": "write more of them, or take fewer",
    "right and .* wrong options are too few": "say of each option whether it is true or false",
    r"step .* is unknown": "use the names of steps of the answer",
    "does not lead from": "write [first, last, step] so that the steps lead there",
    "uses unknown": "use names of [draw] or of the solver's steps",
    "not drawn before it": "move its line up, above those that use it",
    "not defined before it": "put its step first, or among given",
    "which is not a step": "name one of the steps of the solver",
    "no such solver": "mend the name, or write the file",
    "may stand in double braces": "close it as {{ name }}",
    "brings its own Python": "run it with --trust if you know who wrote it",
    "ModuleNotFoundError": "mend the name of the import",
    "NameError": "declare it with symbols(...) above, or mend its name",
    "SyntaxError": "mend the line",
    "AttributeError": "mend the name behind the dot",
    "RecursionError": "let the function end, or write the formula without it",
    "SystemExit": "leave out what ends the program",
    r"\w+(?:Error|Exception): ": "mend the line; what is imported there must not fail",
    r"step .*: no formula for": "use +, -, *, /, powers and functions that students can type",
    "not done after": "let every loop end, or give it more time with --limit",
    "share the name": "rename the folder of one of them",
    r"topic .* has no template": "write one, or delete the line",
    "there is no template.toml": "write it, or mend the name of the file",
    "the bank has no template": "write one with quizgen new template TOPIC/NAME",
    "Cannot overwrite a value|Cannot declare .* twice": "it stands there twice; keep one of them",
    "is not valid TOML|not valid TOML": "mend the line; texts stand in quotes, lists in brackets",
    r"mathematics \$|formula ": "write it as students type it: 2*f*X/Z, x^2, sqrt(x)",
    "interval expected": "write it as [0, 1] or (0, inf)",
    r"column \d+: unknown name .*, expected ": "name it in symbols, or mend the formula",
    "symbols: .* is not allowed": 'write "real", "positive" or [low, high]',
    "and this kind asks for": "name so many, or choose another kind",
    r"column \d+: ": 'write a number, such as 0.01 or "1/200"',
    "must not be negative": "write how far an answer may be off",
    "is too large or too small": "write it in another unit",
    "only one of decimals": "keep one of them",
}
"""Pattern of a problem to what an author can do about it; the first that fits is said."""

QUOTED = 30
"""Letters of a sentence by which its line is found."""
_KEY = re.compile(r"([\w.'-]+?)(?:\.(?:range|pick|skip|unit|min|max|multiple|decimals))?: ")
_SPOKEN = re.compile(r"; did you mean|allowed: |--trust|is expected$|see docs|--debug")
"""A problem that names its mend itself."""


class Problem(NamedTuple):
    """What is wrong, where, and what mends it."""

    template: str
    file: Path
    line: int | None
    what: str
    mend: str

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}" if self.line else f"{self.file}"
        return "; ".join(filter(None, (f"{place}: {self.what}", self.mend)))

    def as_json(self) -> dict[str, object]:
        """Plain values, for editors."""
        return {**self._asdict(), "file": str(self.file)}


def located(bank: Bank, name: str, said: str) -> Problem:
    """A problem with its file and line, and what mends it.

    Parameters
    ----------
    bank : Bank
    name : str
        The template it was met in; empty for what belongs to the whole bank.
    said : str
        What was found, as an error or a report says it.
    """
    file, line, what = _place(bank, name, said)
    return Problem(name, file, line or _line(file, what), what, _mend(what))


def _mend(what: str) -> str:
    if _SPOKEN.search(what):
        return ""
    return next((advice for words, advice in ADVICE.items() if re.search(words, what)), "")


def _place(bank: Bank, name: str, said: str) -> tuple[Path, int | None, str]:
    """The innermost file that a text begins with, its line, and the rest of the text."""
    folder = bank.template_paths[name] if name else bank.folder
    file, line = (folder / "template.toml") if name else bank.folder / "bank.toml", None
    prefix = re.compile(rf"({_within(bank.root)})(?::(\d+))?: ")
    while match := prefix.match(said):
        if Path(match[1]).suffix:
            file, line = Path(match[1]), int(match[2]) if match[2] else None
        said = said[match.end() :]
    own = re.match(rf"(?:no )?({TAG}\.md)\b(?!.* and )(: )?", said)
    if own:
        file, said = folder / own[1], said[own.end() :] if own[2] else said
    if said.startswith("solver: "):
        file, said = _solver(bank, name), said.removeprefix("solver: ")
    return file, line, said


def _within(root: Path) -> str:
    """Pattern of a place in a bank, as errors write it, also for who stands in the bank."""
    if root == Path():
        return rf"\.|(?:templates|{SOLVERS})(?:/[^:]*?)?"
    return rf"{re.escape(str(root))}(?:/[^:]*?)?"


def _solver(bank: Bank, name: str) -> Path:
    return bank.root / "solvers" / f"{bank.rules(name).solver}.py"


def _line(file: Path, what: str) -> int | None:
    """The line that a text speaks of, counted from 1."""
    try:
        lines = read_text(file, QuizgenError).splitlines()
    except QuizgenError:
        return None
    kinds: dict[str, Callable[[str], Iterator[str]]] = {
        ".toml": _in_toml,
        ".md": _in_words,
        ".py": _in_python,
    }
    if "not valid TOML" in what and (at := re.search(r"at line (\d+)", what)):
        return int(at[1])
    for pattern in kinds[file.suffix](what) if file.suffix in kinds else ():
        for number, text in enumerate(lines, 1):
            if re.search(pattern, text):
                return number
    return _of_part(lines, what)


def _of_part(lines: list[str], what: str) -> int | None:
    """Where the part begins that a text speaks of, by its number or its letter."""
    part = re.match(r"(?:seed .*?)?part (\d+|[a-j])\b", what)
    if part is None:
        return None
    place = int(part[1]) if part[1].isdigit() else ord(part[1]) - ord("a") + 1
    found = [number for number, text in enumerate(lines, 1) if text.startswith("[[part]]")]
    return found[place - 1] if place <= len(found) else None


def _in_toml(what: str) -> Iterator[str]:
    if entry := re.match(r"entry '([^']+)'", what):
        yield rf"""^id\s*=\s*["']{re.escape(entry[1])}["']"""
    if key := re.search(r"unknown key '([^']+)'", what):
        yield rf"""(?:^|[{{,\s])"?{re.escape(key[1])}"?\s*="""
    if place := _KEY.match(what):
        *tables, last = place[1].split(".")
        yield rf"^\s*{re.escape(place[1])}\s*="
        yield rf"""^\s*"?{re.escape(last)}"?\s*="""
        yield rf"^\[+{re.escape('.'.join([*tables, last]))}\]"
    for named in re.findall(r"'([^']+)'", what) if not what.startswith("part ") else ():
        yield rf"(?<![\w-]){re.escape(named)}(?![\w-])"
    if "figure" in what:
        yield r"^\[?figure\b"
    if "draw" in what or "never gives" in what:
        yield r"^\[draw\]"


def _in_words(what: str) -> Iterator[str]:
    if entry := re.search(r"explains '([^']+)'", what):
        yield rf"^- {re.escape(entry[1])}:"
    if section := re.search(r"section '([^']+)'", what):
        yield rf"^#+ {re.escape(section[1])}$"
    if shown := re.search(r"(\{\{ .*? \}\}|\$.+?\$)", what):
        yield re.escape(shown[1])
    if quoted := re.search(r" in '(.+)'$", what):
        yield re.escape(quoted[1][:QUOTED])
    if what.startswith("the first line"):
        yield ""
    if "double braces" in what:
        yield r"\{\{(?!\s*[^{}]*\}\})"


def _in_python(what: str) -> Iterator[str]:
    for named in re.findall(r"(?:step|trap|formula) '([^']+)'", what):
        yield rf"Step\({re.escape(named)}\b|[\"']{re.escape(named)}[\"']"


def told_problems(bank: Bank, questions: Sequence[QuestionContent]) -> Iterator[Problem]:
    """Which questions tell what another one of the bank asks."""
    for leak, lang in find_bank_leaks(bank, questions).items():
        part = f" in part {leak.label}" if leak.label else ""
        said = f"{lang}.md: tells what {leak.asker!r} asks{part}: {leak.what}"
        yield located(bank, leak.teller, said)


def bank_problems(bank: Bank) -> Iterator[Problem]:
    """What is wrong with the files that belong to no template."""
    from quizgen.paper.blueprint import load_blueprint

    looks: list[Callable[[], object]] = [
        lambda: (bank.metadata, bank.template_paths),
        lambda: bank.curriculum.inventory,
        lambda: bank.quantities,
        *(partial(load_blueprint, name, bank) for name in bank.blueprints),
    ]
    for look in looks:
        try:
            look()
        except QuizgenError as error:
            yield located(bank, "", str(error))
    yield from (located(bank, "", said) for said in check_translations(bank.folder / LOCALE))
    try:
        yield from (
            located(bank, "", said) for said in (*find_missing_files(bank), *check_cards(bank))
        )
    except QuizgenError as error:
        yield located(bank, "", str(error))

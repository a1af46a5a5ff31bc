"""A template as authored: ``template.toml`` checked against its solver.

The file says what to draw, which draws to keep, what is asked and how it is marked. Formulas in it
are written in the grammar that students type, over quantities in the units they are shown in.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import Any

import msgspec
from flint import fmpq

from quizgen.bank.about import About
from quizgen.bank.compiled import Compiled
from quizgen.bank.complaints import in_words
from quizgen.bank.limits import misshapen, problems
from quizgen.bank.pictures import PictureFile
from quizgen.bank.quantities import Quantities
from quizgen.bank.rules import Rules, minutes_of
from quizgen.bank.solvers import module_of
from quizgen.errors import BankError, FormulaError
from quizgen.maths.chain import Chain
from quizgen.maths.notation import parse
from quizgen.maths.tree import Expr, names
from quizgen.outside import parse_toml, read_text
from quizgen.shapes import converted

PART_LABELS = "abcdefghij"
QUOTED = 60
"""Letters of a formula by which an author knows it."""
_WHOLE = re.compile(r"[+-]?[0-9]{1,18}\.0")
_RULES = Compiled("rules", Rules)


@dataclass(frozen=True)
class Template:
    """A template: its rules, its chain and the sentences of each language.

    Parameters
    ----------
    id : str
        Name of the folder.
    rules : Rules
        The checked content of ``template.toml``.
    chain : Chain
        Steps and traps of the solver; empty for questions without a computation.
    texts : mapping of str to quizgen.bank.prose.Text
        Language to its parsed prose.
    digest : str
        Changes whenever any file behind the template changes.
    path : pathlib.Path
    about : About
        What its bank says about itself.
    quantities : Quantities
        What the letters of its solver mean; only forms made from the chain say so, which is why
        ``digest`` leaves it out.
    figure_file : pathlib.Path, optional
        What draws its figure.
    pictures : mapping of str to PictureFile
        The files that its words show, by their names.
    """

    id: str
    rules: Rules
    chain: Chain
    texts: Mapping[str, Any]
    digest: str
    path: Path = field(default=Path())
    about: About = field(default=About())
    quantities: Quantities = field(default=Quantities())
    figure_file: Path | None = None
    pictures: Mapping[str, PictureFile] = field(default_factory=dict)

    def __getstate__(self) -> dict[str, object]:
        """What another process is told: nothing that it can work out again."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    def __repr__(self) -> str:
        return f"<Template {self.id}, in {', '.join(self.texts)}>"

    @property
    def origin(self) -> str:
        """The name that numbers are drawn under: its first one, so that a rename changes none."""
        return self.rules.formerly or self.id

    @property
    def figure(self) -> ModuleType | None:
        """What draws its figure, imported when it is needed: an author's may load much.

        Raises
        ------
        BankError
            Naming the place, if its import fails.
        """
        file = self.figure_file
        return module_of(file.parent, file.stem) if file else None

    @cached_property
    def file(self) -> Path:
        """What the rules were read from."""
        return self.path / "template.toml"

    @property
    def languages(self) -> tuple[str, ...]:
        """Languages the template is written in."""
        return tuple(self.texts)

    @property
    def minutes(self) -> int:
        """Suggested working time."""
        return minutes_of(self.rules)

    @cached_property
    def units(self) -> dict[str, str]:
        """Quantity to the unit it is shown in: drawn ones first, then steps."""
        drawn = {name: rule.unit for name, rule in self.rules.draw.items() if not rule.words}
        given = dict(self.chain.given)
        steps = {step.name: step.unit for step in self.chain.steps}
        return {**given, **{k: v for k, v in drawn.items() if v or k not in given}, **steps}

    def factor(self, unit: str) -> fmpq:
        """Exact factor from a unit, listed or of the bank, to base units."""
        return self.about.system.factor(unit)

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """Part labels: ``a``, ``b``, ...; a single part has none."""
        count = len(self.rules.part)
        return tuple(PART_LABELS[:count]) if count > 1 else ("",)

    @cached_property
    def _formulas(self) -> dict[str, Expr]:
        return {}

    def formula(self, text: str) -> Expr:
        """Read a formula of ``template.toml`` over the template's quantities, once.

        Raises
        ------
        BankError
            Naming file and column if it cannot be read.
        """
        if text not in self._formulas:
            self._formulas[text] = self._parsed(text)
        return self._formulas[text]

    def _parsed(self, text: str) -> Expr:
        try:
            expr = parse(text, symbols=tuple(self.units))
        except FormulaError as error:
            raise BankError(f"{self.file}: formula {_quoted(text)}: {error}") from error
        unknown = names(expr) - set(self.units)
        if unknown:
            raise BankError(f"{self.file}: formula {_quoted(text)} uses unknown {sorted(unknown)}")
        return expr


def _quoted(formula: str) -> str:
    """A formula for a message, as much of it as tells which one it is."""
    return repr(formula if len(formula) <= QUOTED else f"{formula[:QUOTED]}...")


def read_rules(path: Path) -> Rules:
    """Read and check ``template.toml``.

    Raises
    ------
    BankError
        Naming the file, the key and what is allowed.
    """
    source = read_text(path, BankError)
    found = _RULES.find(source.encode())
    return found or _RULES.keep(_read(path, source), source.encode())


def _read(path: Path, source: str) -> Rules:
    try:
        shape = converted(parse_toml(source, path, BankError, _whole_or(float)), Rules)
        for place, problem in misshapen(shape):
            raise BankError(f"{path}: {place}: {problem}")
        exact = parse_toml(source, path, BankError, _whole_or(str))
        rules = converted(exact, Rules)
    except msgspec.ValidationError as error:
        raise BankError(f"{path}: {in_words(error, Rules)}") from error
    _check_draws(path, rules)
    return rules


def _whole_or(kind: type) -> Callable[[str], object]:
    """Reads a number with a point: 3.0 as 3, as editors do that know no other whole numbers."""
    return lambda text: int(text[:-2]) if _WHOLE.fullmatch(text) else kind(text)


def _check_draws(path: Path, rules: Rules) -> None:
    for place, problem in problems(rules):
        raise BankError(f"{path}: {place}: {problem}")
    for name, rule in rules.draw.items():
        ways = [w for w in ("pick", "range", "words", "formula") if getattr(rule, w)]
        if len(ways) != 1:
            raise BankError(f"{path}: draw.{name}: give exactly one of pick, range, words, is")


def check_against_chain(template: Template) -> None:
    """Check that rules, chain and quantities fit together.

    Raises
    ------
    BankError
        If a drawn or kept quantity is unknown, or a given one is not drawn.
    """
    path, rules = template.file, template.rules
    for name, unit in template.units.items():
        try:
            template.factor(unit)
        except FormulaError as error:
            place = f"draw.{name}" if name in rules.draw else f"solver {rules.solver!r}: {name}"
            raise BankError(f"{path}: {place}: {error}") from error
    missing = set(template.chain.given) - set(rules.draw)
    if missing:
        raise BankError(f"{path}: draw lacks {sorted(missing)}, given in solver {rules.solver!r}")
    unknown = set(rules.keep) - set(template.units)
    if unknown:
        raise BankError(f"{path}: keep names unknown {sorted(unknown)}")
    for listed in (rules.may_vanish, rules.drop):
        strangers = set(listed) - set(template.chain.traps)
        if strangers:
            raise BankError(f"{path}: {sorted(strangers)} is not a trap of {rules.solver!r}")
    strangers = set(rules.precision) - set(template.chain.by_name)
    if strangers:
        raise BankError(f"{path}: precision names {sorted(strangers)}, which are not steps")
    for name in rules.reference or {}:
        if name not in rules.draw:
            raise BankError(f"{path}: reference names {name!r}, which is not drawn")

"""A template as authored: ``template.toml`` checked against its solver.

The file says what to draw, which draws to keep, what is asked and how it is marked. Formulas in it
are written in the grammar that students type, over quantities in the units they are shown in.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import Any

import msgspec
from flint import fmpq

from quizgen.bank.compile_cache import CompileCache
from quizgen.bank.markdown import FIELD_MARK, slot_names
from quizgen.bank.metadata import BankMetadata
from quizgen.bank.pictures import PictureFile
from quizgen.bank.quantities import QuantityNames
from quizgen.bank.rules import PART_LABELS, WAYS, Rules, get_draw_way
from quizgen.bank.solvers import import_module_file
from quizgen.bank.validation import find_malformed_answers, find_problems
from quizgen.core.complaints import complaint_of, written_place
from quizgen.core.decoding import convert
from quizgen.core.errors import BankError, FormulaError
from quizgen.core.positions import TEXT
from quizgen.core.untrusted import error_context, parse_toml, read_text
from quizgen.kinds.contract import asked_quantities
from quizgen.maths.chain import Chain
from quizgen.maths.notation import parse_formula
from quizgen.maths.tree import Expr, names_in

QUOTED = 60
"""Letters of a formula by which an author knows it."""
_WHOLE = re.compile(r"[+-]?[0-9]{1,18}\.0")
_RULES = CompileCache("rules", Rules)


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
    texts : mapping of str to quizgen.bank.markdown.Text
        Language to its parsed prose.
    digest : str
        Changes whenever any file behind the template changes.
    path : pathlib.Path
    about : BankMetadata
        What its bank says about itself.
    quantities : QuantityNames
        What the letters of its solver mean; only forms made from the chain say so, which is why
        ``digest`` leaves it out.
    figure_file, solver_file, data_file : pathlib.Path, optional
        What draws its figure, what its chain was read from, and what draws its data.
    check_digest : str
        Of its ``check.py``; empty without one.
    pictures : mapping of str to PictureFile
        The files that its words show, by their names.
    minutes : Fraction
        Its working time.
    """

    id: str
    rules: Rules
    chain: Chain
    texts: Mapping[str, Any]
    digest: str
    path: Path = field(default=Path())
    about: BankMetadata = field(default=BankMetadata())
    quantities: QuantityNames = field(default=QuantityNames())
    figure_file: Path | None = None
    solver_file: Path | None = None
    data_file: Path | None = None
    check_digest: str = ""
    pictures: Mapping[str, PictureFile] = field(default_factory=dict)
    minutes: Fraction = Fraction(1)

    def __getstate__(self) -> dict[str, object]:
        """Return what another process is sent: nothing that it can work out again."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    def __repr__(self) -> str:
        """Return its name and languages, not its whole content."""
        return f"<Template {self.id}, in {', '.join(self.texts)}>"

    @property
    def origin(self) -> str:
        """Return the first name, which numbers are drawn under: a rename changes none of them."""
        return self.rules.formerly or self.id

    @property
    def figure(self) -> ModuleType | None:
        """Return the module of its figure, imported on use: an author's may load much.

        Raises
        ------
        BankError
            Naming the place, if its import fails.
        """
        file = self.figure_file
        return import_module_file(file.parent, file.stem) if file else None

    @property
    def data_module(self) -> ModuleType | None:
        """What draws its data, imported when it is needed; errors as ``figure``."""
        file = self.data_file
        return import_module_file(file.parent, file.stem) if file else None

    @cached_property
    def file(self) -> Path:
        """Return the path of ``template.toml``."""
        return self.path / "template.toml"

    @property
    def languages(self) -> tuple[str, ...]:
        """Return the languages that the template is written in."""
        return tuple(self.texts)

    @cached_property
    def exact_steps(self) -> frozenset[str]:
        """Names of the steps asked with ``exact = true``, and of all that those rest on."""
        asked = (asked_quantities(p.answer) for p in self.rules.part if p.answer.get("exact"))
        names = {name for quantities in asked for name in quantities} & self.chain.by_name.keys()
        return frozenset().union(*map(self.chain.required_steps, names), names)

    @cached_property
    def estimated_steps(self) -> frozenset[str]:
        """Names of the steps asked with ``rel`` on which no exact answer rests.

        Texts may show them rounded where they have many figures.
        """
        asked = (asked_quantities(p.answer) for p in self.rules.part if "rel" in p.answer)
        names = frozenset(name for quantities in asked for name in quantities)
        return names & self.chain.by_name.keys() - self.exact_steps

    @cached_property
    def units(self) -> dict[str, str]:
        """Return the unit that each quantity is shown in: drawn ones first, then steps."""
        drawn = {name: rule.unit for name, rule in self.rules.data.items()}
        drawn |= {name: rule.unit for name, rule in self.rules.draw.items() if not rule.words}
        given = dict(self.chain.given)
        steps = {step.name: step.unit for step in self.chain.steps}
        return {**given, **{k: v for k, v in drawn.items() if v or k not in given}, **steps}

    def unit_factor(self, unit: str) -> fmpq:
        """Return the exact factor from a unit, listed or of the bank, to base units."""
        return self.about.system.factor(unit)

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """Return the labels of the parts: ``a``, ``b``, ...; a single part has an empty one."""
        count = len(self.rules.part)
        return tuple(PART_LABELS[:count]) if count > 1 else ("",)

    @cached_property
    def places_fields(self) -> bool:
        """Return whether fields of parts stand inside the words of a section."""
        return any(
            name.startswith(FIELD_MARK)
            for text in self.texts.values()
            for section in text.sections.values()
            for name in slot_names(section)
        )

    @cached_property
    def _parsed_formulas(self) -> dict[str, Expr]:
        """Return the cache of parsed formulas, by their text."""
        return {}

    def parse_formula(self, text: str) -> Expr:
        """Return a formula over the template's quantities as a tree, parsed once.

        Raises
        ------
        BankError
            Naming file and column if it cannot be read.
        """
        if text not in self._parsed_formulas:
            self._parsed_formulas[text] = self._parse_template_formula(text)
        return self._parsed_formulas[text]

    def _parse_template_formula(self, text: str) -> Expr:
        """Return a formula as a tree.

        Raises ``BankError`` if it cannot be read, or uses what is neither drawn nor solved.
        """
        try:
            expr = parse_formula(text, symbols=tuple(self.units))
        except FormulaError as error:
            raise self._unreadable(text, f": {error}") from error
        unknown = names_in(expr) - set(self.units)
        if unknown:
            raise self._unreadable(text, f" uses unknown {sorted(unknown)}")
        return expr

    def _unreadable(self, formula: str, what: str) -> BankError:
        """Return an error at a formula of ``template.toml``.

        ``(TEXT, formula)`` as its place has the line looked for: a formula is passed on as text.
        """
        said = f"formula {_quote_formula(formula)}{what}"
        return BankError(said, rule="QG121", file=self.file, place=(TEXT, formula))


def _quote_formula(formula: str) -> str:
    """Return a formula for a message, cut to what shows which one it is."""
    return repr(formula if len(formula) <= QUOTED else f"{formula[:QUOTED]}...")


def read_rules(path: Path) -> Rules:
    """Return the checked content of ``template.toml``.

    Raises
    ------
    BankError
        Naming the file, the key and what is allowed.
    """
    source = read_text(path, BankError)
    found = _RULES.get(source.encode())
    if found:
        return found
    with error_context(path, BankError):
        return _RULES.store_compiled(_read_rules(path, source), source.encode())


def _read_rules(path: Path, source: str) -> Rules:
    """Return the checked content of ``template.toml``.

    It is parsed twice: with floats, to check the types in answers, and then with numbers as they
    are written, so that 0.1 stays exact.
    """
    try:
        table = parse_toml(source, path, BankError, _whole_or(float))
        for fault in find_malformed_answers(convert(table, Rules)):
            raise fault
        table = parse_toml(source, path, BankError, _whole_or(str))
        rules = convert(table, Rules)
    except msgspec.ValidationError as error:
        raise complaint_of(error, Rules, table) from error
    _check_draws(rules)
    return rules


def _whole_or(kind: type) -> Callable[[str], object]:
    """Return a reader of numbers with a point that gives 3.0 as the integer 3.

    Some editors write integers that way and know no other.
    """
    return lambda text: int(text[:-2]) if _WHOLE.fullmatch(text) else kind(text)


def _check_draws(rules: Rules) -> None:
    """Raise ``BankError`` at the first problem of the rules, or at a draw not of one kind."""
    for place, code, what in find_problems(rules):
        raise BankError(f"{written_place(place)}: {what}", rule=code, place=place)
    for name, rule in rules.draw.items():
        if not get_draw_way(rule):
            listed = ", ".join(WAYS).replace("formula", "is")
            what = f"draw.{name}: give exactly one of {listed}"
            raise BankError(what, rule="QG118", place=("draw", name))


def check_against_chain(template: Template) -> None:
    """Raise ``BankError`` unless rules, chain and quantities fit together.

    Raises
    ------
    BankError
        If a drawn or kept quantity is unknown, or a given one is not drawn.
    """
    with error_context(template.file, BankError):
        _check_units(template)
        _check_names(template)


def _check_units(template: Template) -> None:
    """Raise ``BankError`` if a quantity is in a unit that nobody defines."""
    rules = template.rules
    for name, unit in template.units.items():
        try:
            template.unit_factor(unit)
        except FormulaError as error:
            drawn = name in rules.draw
            said = f"draw.{name}" if drawn else f"solver {rules.solver!r}: {name}"
            place = ("draw", name) if drawn else ("solver",)
            raise BankError(f"{said}: {error}", rule="QG122", place=place) from error


def _check_names(template: Template) -> None:
    """Raise ``BankError`` if the rules name what the solver lacks, or lack what it needs."""
    rules = template.rules
    missing = set(template.chain.given) - set(rules.draw) - set(rules.data)
    if missing:
        what = f"draw lacks {sorted(missing)}, given in solver {rules.solver!r}"
        raise BankError(what, rule="QG123", place=("draw",))
    unknown = set(rules.keep) - set(template.units)
    if unknown:
        place = ("keep", min(unknown))
        raise BankError(f"keep names unknown {sorted(unknown)}", rule="QG116", place=place)
    for key, listed in (("may_vanish", rules.may_vanish), ("drop", rules.drop)):
        strangers = set(listed) - {*template.chain.traps, *template.chain.form_traps}
        if strangers:
            what = f"{sorted(strangers)} is not a trap of {rules.solver!r}"
            raise BankError(what, rule="QG116", place=(key,))
    for part, one in enumerate(rules.part):
        strangers = {*one.answer.get("worth", ())} - {*template.chain.traps}
        if strangers:
            what = f"worth: {sorted(strangers)} is not a trap of {rules.solver!r}"
            raise BankError(what, rule="QG116", place=("part", str(part), "answer", "worth"))
    strangers = set(rules.precision) - set(template.chain.by_name)
    if strangers:
        what = f"precision names {sorted(strangers)}, which are not steps"
        raise BankError(what, rule="QG116", place=("precision",))
    for name in rules.reference or {}:
        if name not in rules.draw:
            what = f"reference names {name!r}, which is not drawn"
            raise BankError(what, rule="QG116", place=("reference", name))

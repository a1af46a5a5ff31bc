"""The closed list of units: SI lengths and times, light, and the units of imaging.

A unit is a product of powers of base units times an exact factor, so ``um/px``, ``lx*s`` and
``mm^2`` work without a units library. Names that are not listed are refused, never guessed
(a units library reads ``6 EV`` as exavolt and ``5.6 MP`` as megapoise).

A bank may define further ones (``unit_definitions``). They belong to its own questions alone: a
``System`` holds the listed units and those of one bank; ``unit`` and ``factor`` look names up in
the system in use, which is the list itself unless somebody says ``with system.in_use()``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

import msgspec
from flint import fmpq

from quizgen.core.errors import FormulaError
from quizgen.maths.numbers import to_rational

SYNTAX = "expected 'name = [kind] = symbol' or 'name = 1000 * kg * m / s**2 = symbol'"

_NAME = re.compile(r"[^\W\d_]+(?:_[^\W\d_]+)*")
_SYMBOL = re.compile(r"[^\W\d_]+")
_KIND = re.compile(r"\[[a-z_]*\]")
_NUMBER = re.compile(r"\d+(?:\.\d+)?(?:[eE][+-]?\d{1,2})?")
_FACTOR = re.compile(r"([*/]?)\s*([^\s*/^]+)\s*(?:(?:\*\*|\^)\s*(-?\d))?\s*")
_FEWEST = 2


class UnitDefinition(NamedTuple):
    """A unit as it was defined: ``size`` times ``made_of``, which is None for a new kind."""

    text: str
    symbol: str
    words: tuple[str, ...]
    size: Fraction
    made_of: str | None


def parse_unit_definition(text: str) -> UnitDefinition:
    """Read a definition.

    Raises
    ------
    FormulaError
        If it is not of this form.
    """
    fields = [field.strip() for field in text.split("=")]
    if len(fields) < _FEWEST or not all(fields) or ";" in text:
        raise FormulaError(f"unit {text!r}: {SYNTAX}")
    name, made_of, *further = fields
    symbol = further[0] if further and further[0] != "_" else name
    words = tuple(word.replace("_", " ") for word in (name, f"{name}s", *further[1:]))
    for word in (name, *further[1:]):
        _check_unit_word(_NAME, word, text, "name")
    _check_unit_word(_SYMBOL, symbol, text, "symbol")
    spelt = tuple(word for word in dict.fromkeys(words) if word != symbol)
    if _KIND.fullmatch(made_of):
        return UnitDefinition(text, symbol, spelt, Fraction(1), None)
    return UnitDefinition(text, symbol, spelt, *_parse_unit_product(made_of, text))


def _check_unit_word(pattern: re.Pattern[str], word: str, text: str, what: str) -> None:
    if not pattern.fullmatch(word):
        raise FormulaError(f"unit {text!r}: {word!r} is no {what} (letters alone)")


def _parse_unit_product(made_of: str, text: str) -> tuple[Fraction, str]:
    """A product's number, and its units as they are written elsewhere."""
    size, units, position = Fraction(1), "", 0
    while position < len(made_of):
        match = _FACTOR.match(made_of, position)
        if match is None or bool(match[1]) != bool(position):
            raise FormulaError(f"unit {text!r}: {made_of!r} is no product; {SYNTAX}")
        sign, name, power = match.groups()
        if _NUMBER.fullmatch(name):
            size *= _raise_unit_number(
                Fraction(name), int(power or 1) * (-1 if sign == "/" else 1), text
            )
        else:
            units += f"{sign or '*'}{name}" + (f"^{power}" if power else "")
        position = match.end()
    return size, units.removeprefix("*")


def _raise_unit_number(number: Fraction, power: int, text: str) -> Fraction:
    if not number:
        raise FormulaError(f"unit {text!r}: 0 is no size")
    return number**power


Dimension = tuple[tuple[str, int], ...]


class Unit(msgspec.Struct, frozen=True):
    """A unit: how it is written, its exact factor to base units, and its dimension."""

    text: str
    factor: Fraction
    dimension: Dimension


PREFIXES = {
    "n": Fraction(1, 10**9),
    "u": Fraction(1, 10**6),
    "µ": Fraction(1, 10**6),
    "μ": Fraction(1, 10**6),
    "m": Fraction(1, 10**3),
    "c": Fraction(1, 10**2),
    "d": Fraction(1, 10),
    "k": Fraction(10**3),
    "M": Fraction(10**6),
    "G": Fraction(10**9),
}

_PREFIXED = {
    # unit: (base, factor, prefixes allowed)
    "m": ("m", 1, "nuµμmcdkM"),
    "s": ("s", 1, "nuµμm"),
    "Hz": ("Hz", 1, "kMG"),
    "W": ("W", 1, "uµμmk"),
    "eV": ("eV", 1, "mkM"),
    "lm": ("lm", 1, "mk"),
    "lx": ("lx", 1, "mk"),
    "px": ("px", 1, "kM"),
    "bit": ("bit", 1, "kMG"),
    "B": ("bit", 8, "kMG"),
}

_PLAIN = {
    "": ("", Fraction(1)),
    "1": ("", Fraction(1)),
    "%": ("", Fraction(1, 100)),
    "deg": ("deg", Fraction(1)),
    "°": ("deg", Fraction(1)),
    "stop": ("stop", Fraction(1)),
    "EV": ("stop", Fraction(1)),
    "dB": ("dB", Fraction(1)),
    "DN": ("DN", Fraction(1)),
    "e-": ("e-", Fraction(1)),
    "photon": ("photon", Fraction(1)),
    "row": ("row", Fraction(1)),
    "frame": ("frame", Fraction(1)),
    "lp": ("lp", Fraction(1)),
    "KiB": ("bit", Fraction(8 * 2**10)),
    "MiB": ("bit", Fraction(8 * 2**20)),
    "GiB": ("bit", Fraction(8 * 2**30)),
}


_MADE_OF = {"lx": (("lm", 1), ("m", -2)), "Hz": (("s", -1),)}
"""Units with a name of their own for a product of others."""


def _simple_units() -> dict[str, tuple[str, Fraction]]:
    table = dict(_PLAIN)
    for name, (base, factor, prefixes) in _PREFIXED.items():
        table[name] = (base, Fraction(factor))
        table.update({p + name: (base, factor * PREFIXES[p]) for p in prefixes})
    return table


SIMPLE = _simple_units()
"""Every listed simple unit: written name to (base unit, exact factor)."""

_PART = re.compile(r"(?P<op>[*/·]?)(?P<name>e-|[^*/·^]+)(?:\^(?P<power>-?\d))?")


class UnitRegistry:
    """The listed units and those that one bank defines.

    Parameters
    ----------
    definitions : tuple of str
        Lines such as ``"newton = kg * m / s**2 = N"``, each over units listed or defined before.

    Raises
    ------
    FormulaError
        If a line cannot be read, or gives a name that there is already.
    """

    def __init__(self, definitions: tuple[str, ...] = ()) -> None:
        self.definitions = definitions
        self.simple = dict(SIMPLE)
        self.words: dict[str, tuple[str, ...]] = {}
        self._made_of: dict[str, Dimension] = dict(_MADE_OF)
        self._known: dict[str, Unit] = {}
        self._factors: dict[str, fmpq] = {}
        for line in definitions:
            self._define_unit(parse_unit_definition(line))

    def _define_unit(self, new: UnitDefinition) -> None:
        spelt = {word for words in self.words.values() for word in words}
        taken = {new.symbol, *new.words} & {*self.simple, *spelt}
        if taken:
            raise FormulaError(f"unit {new.text!r}: there is a unit {min(taken)!r} already")
        size = Fraction(1)
        if new.made_of is not None:
            try:
                whole = self.unit(new.made_of)
            except FormulaError as error:
                raise FormulaError(f"unit {new.text!r}: {error}") from error
            size = new.size * whole.factor
            self._made_of[new.symbol] = whole.dimension
        prefixed = {p + new.symbol: (new.symbol, size * f) for p, f in PREFIXES.items()}
        self.simple = {**prefixed, **self.simple, new.symbol: (new.symbol, size)}
        self.words[new.symbol] = new.words
        self._known.clear()

    def unit(self, text: str) -> Unit:
        """Look a unit up: a name, or a product such as ``um/px`` or ``lx*s``.

        Raises
        ------
        FormulaError
            If a name is not known.
        """
        if text not in self._known:
            self._known[text] = self._look_up(text)
        return self._known[text]

    def _look_up(self, text: str) -> Unit:
        compact = text.replace(" ", "")
        factor, powers = Fraction(1), dict[str, int]()
        position = 0
        while position < len(compact):
            match = _PART.match(compact, position)
            if match is None or match["name"] not in self.simple:
                raise FormulaError(f"unknown unit {text!r}", position + 1)
            name, size = self.simple[match["name"]]
            power = int(match["power"] or 1) * (-1 if match["op"] == "/" else 1)
            factor *= size**power
            for base, times in self._made_of.get(name, ((name, 1),)):
                powers[base] = powers.get(base, 0) + power * times
            position = match.end()
        powers.pop("", None)
        return Unit(text, factor, tuple(sorted((b, p) for b, p in powers.items() if p)))

    def factor(self, text: str) -> fmpq:
        """Exact factor from a unit to base units: 1/1000 for ``mm``.

        Raises
        ------
        FormulaError
            If a name is not known.
        """
        if text not in self._factors:
            self._factors[text] = to_rational(self.unit(text).factor)
        return self._factors[text]

    @contextmanager
    def activate(self) -> Iterator[None]:
        """Look units up here until the end of the block."""
        before = _IN_USE.set(self)
        try:
            yield
        finally:
            _IN_USE.reset(before)


LISTED = UnitRegistry()


@lru_cache(maxsize=256)
def build_unit_registry(definitions: tuple[str, ...] = ()) -> UnitRegistry:
    """The units of a bank, by its definitions."""
    return UnitRegistry(definitions) if definitions else LISTED


_IN_USE: ContextVar[UnitRegistry] = ContextVar("units", default=LISTED)


def active_units() -> UnitRegistry:
    """The units of the question at hand."""
    return _IN_USE.get()


def get_unit(text: str) -> Unit:
    """Look a unit up among those in use.

    Raises
    ------
    FormulaError
        If a name is not known.
    """
    return active_units().unit(text)


def unit_factor(text: str) -> fmpq:
    """Exact factor from a unit in use to base units: 1/1000 for ``mm``.

    Raises
    ------
    FormulaError
        If a name is not known.
    """
    return active_units().factor(text)


SHOWN = {"um": "µm", "deg": "°", "us": "µs", "uW": "µW", "e-": "e⁻"}


@lru_cache(maxsize=1024)
def format_unit(text: str) -> str:
    """How a unit is printed: ``um/px`` becomes ``µm/px``, ``1/mm`` becomes ``mm⁻¹``.

    The unit of a pure number prints as nothing.
    """
    if text == "1":
        return ""
    if text.startswith("1/") and text.count("/") == 1:
        return f"{format_unit(text[2:])}⁻¹"
    return "/".join(SHOWN.get(part, part) for part in text.split("/"))

"""The closed list of units: SI and what is used with it, information, money, and imaging.

A unit is a product of powers of base units times an exact factor, so ``um/px``, ``lx*s`` and
``mm^2`` work without a units library. Names that are not listed are refused, never guessed
(a units library reads ``6 EV`` as exavolt and ``5.6 MP`` as megapoise).

A bank may define further ones (``UnitDefinition``). They belong to its own questions alone: a
``UnitRegistry`` holds the listed units and those of one bank; ``get_unit`` and ``unit_factor`` look
names up in the registry in use, which is the list itself outside ``with registry.activate()``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
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
    """Return a definition that was read.

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
    """Check one name or symbol of a definition.

    Raises
    ------
    FormulaError
        If it is not of the form that ``pattern`` gives.
    """
    if not pattern.fullmatch(word):
        raise FormulaError(f"unit {text!r}: {word!r} is no {what} (letters alone)")


def _parse_unit_product(made_of: str, text: str) -> tuple[Fraction, str]:
    """Return a product's number, and its units as they are written elsewhere.

    Raises
    ------
    FormulaError
        If it is no product.
    """
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
    """Return a power of a number in a definition.

    Raises
    ------
    FormulaError
        If the number is 0.
    """
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
    "p": Fraction(1, 10**12),
    "n": Fraction(1, 10**9),
    "u": Fraction(1, 10**6),
    "µ": Fraction(1, 10**6),
    "μ": Fraction(1, 10**6),
    "m": Fraction(1, 10**3),
    "c": Fraction(1, 10**2),
    "d": Fraction(1, 10),
    "h": Fraction(10**2),
    "k": Fraction(10**3),
    "M": Fraction(10**6),
    "G": Fraction(10**9),
    "T": Fraction(10**12),
}

_SMALL, _LARGE = "pnuµμm", "kMGT"
_ALL = _SMALL + _LARGE

BASE_UNITS = {
    # unit: prefixes that are in use with it
    "m": "pnuµμmcdkM",
    "g": "nuµμmkM",
    "s": f"{_SMALL}k",
    "A": _ALL,
    "K": "uµμmk",
    "mol": "nuµμmk",
    "lm": "uµμmk",
    "eV": "mkMG",
    "rad": "uµμm",
    "px": "kMG",
    "bit": _LARGE,
    "deg": "",
    "°C": "",
    "°F": "",
    "stop": "",
    "dB": "",
    "DN": "",
    "e-": "k",
    "photon": "",
    "row": "",
    "frame": "",
    "lp": "",
    "€": "",
    "$": "",
    "£": "",
    "৳": "",
    "CHF": "",
}
"""Units of a kind of their own: those of SI, and what is counted. Nobody can add 3 °C to 3 K or
3 € to 3 $ without knowing a zero or a rate, so these are kinds as well, and the electronvolt, whose
joules are too small for tolerances that were chosen for whole numbers of them."""

DERIVED_UNITS = {
    # unit: (its size, the units it is made of, prefixes that are in use with it)
    "Hz": ("1", "1/s", f"m{_LARGE}"),
    "N": ("1", "kg*m/s^2", _ALL),
    "Pa": ("1", "N/m^2", f"{_ALL}h"),
    "bar": ("100000", "Pa", "m"),
    "J": ("1", "N*m", _ALL),
    "W": ("1", "J/s", _ALL),
    "Wh": ("3600", "J", "mkMGT"),
    "C": ("1", "A*s", _SMALL),
    "Ah": ("3600", "C", "mk"),
    "V": ("1", "W/A", _ALL),
    "ohm": ("1", "V/A", "uµμmkMG"),
    "Ω": ("1", "V/A", "uµμmkMG"),
    "S": ("1", "A/V", "nuµμm"),
    "F": ("1", "C/V", _SMALL),
    "H": ("1", "V*s/A", "nuµμm"),
    "Wb": ("1", "V*s", "nuµμm"),
    "T": ("1", "Wb/m^2", "pnuµμm"),
    "lx": ("1", "lm/m^2", "uµμmk"),
    "cd": ("1", "lm", "mk"),
    "Bq": ("1", "1/s", _LARGE),
    "Gy": ("1", "J/kg", "uµμm"),
    "Sv": ("1", "J/kg", "uµμm"),
    "kat": ("1", "mol/s", "nuµμm"),
    "l": ("0.001", "m^3", "uµμmcdh"),
    "L": ("0.001", "m^3", "uµμmcdh"),
    "ha": ("10000", "m^2", ""),
    "t": ("1000", "kg", "kM"),
    "min": ("60", "s", ""),
    "h": ("3600", "s", ""),
    "d": ("86400", "s", ""),
    "in": ("0.0254", "m", ""),
    "ft": ("0.3048", "m", ""),
    "mi": ("1609.344", "m", ""),
    "lb": ("0.45359237", "kg", ""),
    "B": ("8", "bit", _LARGE),
    "KiB": ("1024", "B", ""),
    "MiB": ("1048576", "B", ""),
    "GiB": ("1073741824", "B", ""),
    "TiB": ("1099511627776", "B", ""),
    "%": ("0.01", "", ""),
    "‰": ("0.001", "", ""),
    "ppm": ("0.000001", "", ""),
    "°": ("1", "deg", ""),
    "arcmin": ("1/60", "deg", ""),
    "arcsec": ("1/3600", "deg", "m"),
    "EV": ("1", "stop", ""),
    "EUR": ("1", "€", ""),
    "ct": ("0.01", "€", ""),
    "USD": ("1", "$", ""),
    "GBP": ("1", "£", ""),
    "BDT": ("1", "৳", ""),
}
"""Units that are others times a number, each over those above it: the factors of the SI brochure
(9th edition, tables 4 and 8), of the international yard and pound, and of IEC 80000-13."""

_KILOGRAM = Fraction(1, 1000)
"""The gram in base units: SI is coherent with the kilogram (1 W is 1 kg·m²/s³)."""


class _SimpleUnit(NamedTuple):
    """A unit of one name: its exact factor to base units, and its powers of base units."""

    factor: Fraction
    dimension: Dimension


def _list_simple_units() -> dict[str, _SimpleUnit]:
    """Return every listed unit with every prefix in use, by the name as it is written."""
    table = {"": _SimpleUnit(Fraction(1), ()), "1": _SimpleUnit(Fraction(1), ())}
    for name, prefixes in BASE_UNITS.items():
        size = _KILOGRAM if name == "g" else Fraction(1)
        base = "kg" if name == "g" else name
        _add_prefixed(table, name, prefixes, _SimpleUnit(size, ((base, 1),)))
    for name, (times, made_of, prefixes) in DERIVED_UNITS.items():
        unit = _multiply_out(made_of, table)
        if unit is None:
            raise AssertionError(f"{name} is made of what is not above it")
        _add_prefixed(table, name, prefixes, unit._replace(factor=unit.factor * Fraction(times)))
    return table


def _add_prefixed(
    table: dict[str, _SimpleUnit], name: str, prefixes: str, unit: _SimpleUnit
) -> None:
    """Add a unit to a table, without and with each of its prefixes."""
    table[name] = unit
    for prefix in prefixes:
        table[prefix + name] = unit._replace(factor=unit.factor * PREFIXES[prefix])


_PART = re.compile(r"(?P<op>[*/·]?)(?P<name>e-|[^*/·^]+)(?:\^(?P<power>-?\d))?")
_BELOW = re.compile(r"/\(([^()]*)\)")


def _multiply_out(text: str, table: Mapping[str, _SimpleUnit]) -> _SimpleUnit | None:
    """Return ``um/px`` or ``J/(kg*K)`` multiplied out; None if a name is not in the table."""
    compact = _BELOW.sub(_write_without_brackets, text.replace(" ", ""))
    factor, powers = Fraction(1), dict[str, int]()
    position = 0
    while position < len(compact):
        match = _PART.match(compact, position)
        if match is None or match["name"] not in table:
            return None
        size, dimension = table[match["name"]]
        power = int(match["power"] or 1) * (-1 if match["op"] == "/" else 1)
        factor *= size**power
        for base, times in dimension:
            powers[base] = powers.get(base, 0) + power * times
        position = match.end()
    return _SimpleUnit(factor, tuple(sorted((b, p) for b, p in powers.items() if p)))


def _write_without_brackets(match: re.Match[str]) -> str:
    """Return ``/kg/K`` for ``/(kg*K)``: a stroke divides by the one unit behind it, as in SI."""
    swapped = match[1].translate(str.maketrans("*·/", "//*"))
    return f"/{swapped}"


SIMPLE = _list_simple_units()
"""Every listed simple unit by its written name."""


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
        """Define the units in order; errors as above."""
        self.definitions = definitions
        self.simple = dict(SIMPLE)
        self.words: dict[str, tuple[str, ...]] = {}
        self._known: dict[str, Unit] = {}
        self._factors: dict[str, fmpq] = {}
        for line in definitions:
            self._define_unit(parse_unit_definition(line))

    def _define_unit(self, new: UnitDefinition) -> None:
        """Add a unit with all prefixes.

        Raises
        ------
        FormulaError
            If a name is taken, or a unit that it is made of does not exist.
        """
        spelt = {word for words in self.words.values() for word in words}
        taken = {new.symbol, *new.words} & {*self.simple, *spelt}
        if taken:
            raise FormulaError(f"unit {new.text!r}: there is a unit {min(taken)!r} already")
        unit = _SimpleUnit(Fraction(1), ((new.symbol, 1),))
        if new.made_of is not None:
            try:
                whole = self.unit(new.made_of)
            except FormulaError as error:
                raise FormulaError(f"unit {new.text!r}: {error}") from error
            unit = _SimpleUnit(new.size * whole.factor, whole.dimension)
        prefixed = {
            prefix + new.symbol: unit._replace(factor=unit.factor * size)
            for prefix, size in PREFIXES.items()
        }
        self.simple = {**prefixed, **self.simple, new.symbol: unit}
        self.words[new.symbol] = new.words
        self._known.clear()

    def unit(self, text: str) -> Unit:
        """Return a unit by its name, or a product such as ``um/px`` or ``lx*s``.

        Raises
        ------
        FormulaError
            If a name is not listed.
        """
        if text not in self._known:
            product = _multiply_out(text, self.simple)
            if product is None:
                raise FormulaError(f"unknown unit {text!r}", 1)
            self._known[text] = Unit(text, *product)
        return self._known[text]

    def factor(self, text: str) -> fmpq:
        """Return the exact factor from a unit to base units: 1/1000 for ``mm``.

        Raises
        ------
        FormulaError
            If a name is not listed.
        """
        if text not in self._factors:
            self._factors[text] = to_rational(self.unit(text).factor)
        return self._factors[text]

    @contextmanager
    def activate(self) -> Iterator[None]:
        """Make these the units in use until the end of the block."""
        before = _IN_USE.set(self)
        try:
            yield
        finally:
            _IN_USE.reset(before)


LISTED = UnitRegistry()


@lru_cache(maxsize=256)
def build_unit_registry(definitions: tuple[str, ...] = ()) -> UnitRegistry:
    """Return the units of a bank, by its definitions; cached.

    Raises
    ------
    FormulaError
        If a definition is wrong.
    """
    return UnitRegistry(definitions) if definitions else LISTED


_IN_USE: ContextVar[UnitRegistry] = ContextVar("units", default=LISTED)


def active_units() -> UnitRegistry:
    """Return the units of the question at hand."""
    return _IN_USE.get()


def get_unit(text: str) -> Unit:
    """Return a unit of those in use.

    Raises
    ------
    FormulaError
        If a name is not listed.
    """
    return active_units().unit(text)


def unit_factor(text: str) -> fmpq:
    """Return the exact factor from a unit in use to base units: 1/1000 for ``mm``.

    Raises
    ------
    FormulaError
        If a name is not listed.
    """
    return active_units().factor(text)


SHOWN = {
    **{name: f"µ{name[1:]}" for name in SIMPLE if name[:1] == "u" and f"µ{name[1:]}" in SIMPLE},
    **{f"{prefix}ohm": f"{prefix}Ω" for prefix in ("", "m", "k", "M", "G")},
    **dict.fromkeys(("uohm", "µohm", "μohm"), "µΩ"),
    "deg": "°",
    "e-": "e⁻",
    "*": "·",
}
"""Names that are typed on any keyboard, and how they are printed."""


_SHOWN_PARTS = re.compile(r"([/*·^()⁻⁰¹²³⁴-⁹])")
_POWER = re.compile(r"\^(-?\d+)")
_ABOVE = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@lru_cache(maxsize=1024)
def format_unit(text: str) -> str:
    """Return a unit as printed: ``um/px`` becomes ``µm/px``, ``m/s^2`` ``m/s²``, ``1/mm`` ``mm⁻¹``.

    The unit of a pure number prints as nothing.
    """
    if text == "1":
        return ""
    if below := re.fullmatch(r"1/([^/*·^()]+)\^(\d+)", text):
        text = f"{below[1]}^-{below[2]}"
    elif text.startswith("1/") and text.count("/") == 1:
        return f"{format_unit(text[2:])}⁻¹"
    text = _POWER.sub(lambda match: match[1].translate(_ABOVE), text)
    return "".join(SHOWN.get(part, part) for part in _SHOWN_PARTS.split(text))

"""Layout nodes: what a formula looks like, before it is LaTeX, MathML, Typst or speech.

Every node has a ``level``, the strength with which it holds together; a weaker node inside a
stronger place gets brackets. Nodes carry no language: words such as *otherwise* are keys. They are
structs because every command loads them: a dataclass takes ten times as long to define. Their tags
let the formulas of a template's words stay in the cache as they are laid out.
"""

from __future__ import annotations

from typing import ClassVar

from msgspec import Struct
from msgspec.structs import replace

WORDS, RELATION, SUM, MODULO, NEGATIVE, PRODUCT, FRACTION, QUANTITY, POWER, ATOM = range(10)
"""Levels, weakest first."""


class Digits(Struct, frozen=True, tag=True):
    """Digits without a sign, for example ``2.5`` or ``200 000``."""

    text: str
    level: ClassVar[int] = ATOM


class Leaf(Struct, frozen=True, tag=True):
    """The place of a value of the draw; ``typeset.leaves`` fills it before anything is printed."""

    name: str
    level: ClassVar[int] = ATOM


class Ident(Struct, frozen=True, tag=True):
    """A one-letter quantity, in italics (capital Greek upright); ``bold`` for vectors.

    ``style`` is another alphabet: ``bb`` (as in ℝ), ``cal``, ``frak``, ``sans`` or ``mono``.
    """

    text: str
    bold: bool = False
    style: str = ""
    level: ClassVar[int] = ATOM


class Word(Struct, frozen=True, tag=True):
    """An upright name of several letters: ``SNR``, the ``max`` in a subscript, ``erfc``."""

    text: str
    level: ClassVar[int] = ATOM


class Phrase(Struct, frozen=True, tag=True):
    """Words in a formula as an author wrote them, with the blanks around them."""

    text: str
    level: ClassVar[int] = ATOM


class FunctionName(Struct, frozen=True, tag=True):
    """An upright function name without brackets after it, as in ``sin x``."""

    text: str
    level: ClassVar[int] = ATOM


class Gap(Struct, frozen=True, tag=True):
    """A blank: ``thin``, ``medium``, ``thick``, ``quad`` or ``qquad``, as LaTeX has them."""

    width: str
    level: ClassVar[int] = ATOM


class ReaderWord(Struct, frozen=True, tag=True):
    """A word of the reader's language, by key: ``if otherwise and or not``."""

    key: str
    level: ClassVar[int] = WORDS


class UnitText(Struct, frozen=True, tag=True):
    """A unit as written in the closed list, for example ``um/px``."""

    text: str
    level: ClassVar[int] = ATOM


class OperatorSign(Struct, frozen=True, tag=True):
    """An operator, relation or separator by its character.

    ``neg`` is the sign, an empty name an unwritten product, a blank a small gap.
    """

    name: str
    level: ClassVar[int] = ATOM


class MathRow(Struct, frozen=True, tag=True):
    """Nodes side by side."""

    items: tuple[Node, ...]
    level: int = ATOM


class NumberWithUnit(Struct, frozen=True, tag=True):
    """A number with its unit."""

    value: Node
    unit: UnitText

    @property
    def level(self) -> int:
        """Return that of a quantity; if its number is negative, of a negative number."""
        return min(self.value.level, QUANTITY)


class Frac(Struct, frozen=True, tag=True):
    """A fraction, with a bar or (``inline``) with a slash."""

    top: Node
    bottom: Node
    inline: bool = False

    @property
    def level(self) -> int:
        """Return that of a fraction under a bar; with a slash it is a product."""
        return PRODUCT if self.inline else FRACTION


class Root(Struct, frozen=True, tag=True):
    """A root; ``index`` is left out for the square root."""

    body: Node
    index: Node | None = None
    level: ClassVar[int] = ATOM


class Scripts(Struct, frozen=True, tag=True):
    """A base with primes, a subscript and a superscript."""

    base: Node
    sub: Node | None = None
    sup: Node | None = None
    primes: int = 0

    @property
    def level(self) -> int:
        """Return that of a power if there is a superscript, else that of an atom."""
        return ATOM if self.sup is None else POWER

    @property
    def alone(self) -> Scripts:
        """The primes, sub- and superscript without their base."""
        return replace(self, base=OperatorSign(""))


class Accent(Struct, frozen=True, tag=True):
    """A mark above or below, by its name in ``typeset.signs.ACCENTS``."""

    kind: str
    base: Node
    level: ClassVar[int] = ATOM


class Fenced(Struct, frozen=True, tag=True):
    """Brackets around a node, any of ``()[]{}|‖⌊⌋⌈⌉⟨⟩`` on either side; a point is none."""

    kind: str
    body: Node
    level: ClassVar[int] = ATOM


class Func(Struct, frozen=True, tag=True):
    """A named function (an upright word, maybe with scripts) of its arguments."""

    head: Node
    args: tuple[Node, ...]
    level: ClassVar[int] = ATOM


class Binomial(Struct, frozen=True, tag=True):
    """A binomial coefficient."""

    top: Node
    bottom: Node
    level: ClassVar[int] = ATOM


class LargeOperator(Struct, frozen=True, tag=True):
    """A sum, product, integral or union sign with its bounds."""

    sign: str
    lower: Node | None = None
    upper: Node | None = None
    level: ClassVar[int] = ATOM

    @property
    def bounds(self) -> Scripts:
        """The bounds as scripts of the sign."""
        return Scripts(OperatorSign(""), self.lower, self.upper)


class Under(Struct, frozen=True, tag=True):
    """A node with another one centred below it, as in limits."""

    base: Node
    below: Node
    level: ClassVar[int] = ATOM


class Over(Struct, frozen=True, tag=True):
    """A node with a small one centred above it: an equals sign with a reason, a named arrow."""

    base: Node
    above: Node
    level: ClassVar[int] = ATOM


class Brace(Struct, frozen=True, tag=True):
    """A node over (or, ``upside``, under) a horizontal brace, with a note at the brace."""

    body: Node
    note: Node | None = None
    upside: bool = False
    level: ClassVar[int] = ATOM


class Display(Struct, frozen=True, tag=True):
    """A node set as large as in a line of its own."""

    body: Node

    @property
    def level(self) -> int:
        """Return that of what is set."""
        return self.body.level


class Cases(Struct, frozen=True, tag=True):
    """Values with their conditions; the last condition ``None`` means otherwise."""

    rows: tuple[tuple[Node, Node | None], ...]
    level: ClassVar[int] = WORDS


class Matrix(Struct, frozen=True, tag=True):
    """A matrix or, with one column, a vector; ``kind`` has its brackets and may be empty."""

    rows: tuple[tuple[Node, ...], ...]
    kind: str = "()"
    level: ClassVar[int] = ATOM


class AlignedRows(Struct, frozen=True, tag=True):
    """Lines whose cells stand below each other; after a ``brace``, values with their conditions."""

    rows: tuple[tuple[Node, ...], ...]
    brace: bool = False
    level: ClassVar[int] = WORDS


Node = (
    Digits
    | Leaf
    | Ident
    | Word
    | Phrase
    | FunctionName
    | Gap
    | ReaderWord
    | UnitText
    | OperatorSign
    | MathRow
    | NumberWithUnit
    | Frac
    | Root
    | Scripts
    | Accent
    | Fenced
    | Func
    | Binomial
    | LargeOperator
    | Under
    | Over
    | Brace
    | Display
    | Cases
    | Matrix
    | AlignedRows
)

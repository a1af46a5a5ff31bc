r"""LaTeX formulas to layout nodes, by way of MathML from ``math-core``.

MathML says what belongs together and not what it means: which bracket closes which, where a minus
is a sign, whether a bar is a condition. That is found here once, so that all outputs agree on it.
``{{ name }}`` becomes a leaf. Its place is held by a character of Unicode's private area while
LaTeX is read, so that nothing that is drawn is ever read as LaTeX.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from difflib import get_close_matches
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, Any, TypeGuard
from unicodedata import name as unicode_name
from unicodedata import normalize
from xml.etree import ElementTree as ET

from msgspec import Struct
from msgspec.structs import replace

from quizgen.core.errors import FormulaError
from quizgen.maths.notation import pretty
from quizgen.typeset.builders import RELATIONS as KNOWN_RELATIONS
from quizgen.typeset.latex_commands import ADVICE, COMMANDS, ENVIRONMENTS
from quizgen.typeset.names import GREEK, GREEK_LETTERS
from quizgen.typeset.nodes import (
    ATOM,
    NEGATIVE,
    PRODUCT,
    RELATION,
    SUM,
    Accent,
    AlignedRows,
    Binomial,
    Brace,
    Digits,
    Display,
    Fenced,
    Frac,
    Func,
    FunctionName,
    Gap,
    Ident,
    LargeOperator,
    Leaf,
    MathRow,
    Matrix,
    Node,
    OperatorSign,
    Over,
    Phrase,
    Root,
    Scripts,
    Under,
    Word,
)
from quizgen.typeset.signs import (
    ALPHABETS,
    ARROWS,
    FENCES,
    GAPS,
    LARGE,
    LETTERLIKE,
    PLAIN,
    SIGN_COMMANDS,
    has_styled_letter,
)
from quizgen.typeset.signs import RELATIONS as MORE_RELATIONS

if TYPE_CHECKING:
    from math_core import LatexToMathML

SLOT = re.compile(r"\{\{\s*([A-Za-z_][\w']*(?:\[[0-9]{1,4}\])?)\s*\}\}")
LONGEST = 4000
"""Most characters of a formula."""
DEEPEST = 60
"""Most levels of groups in each other: far above any formula, far below Python's stack."""

_FIRST_SLOT, _LAST_SLOT = 0xE000, 0xF8FF  # Unicode's private area
_PRIVATE = re.compile("[\ue000-\uf8ff]")
_COMMENT = re.compile(r"(?<!\\)%")
_NUMBER = re.compile(r"\d+(?:\.\d+)?|\.\d+")
_DECIMAL_COMMA = re.compile(r"\d\{,\}\d")
_AT = re.compile(r"(\d+): (.*)", re.DOTALL)
_COMMAND = re.compile(r"\\([A-Za-z]+\*?|.)")
_LETTER_COMMAND = re.compile(r"\\([A-Za-z]+)")
_ENVIRONMENT = re.compile(r"\\begin\s*\{([^}]*)\}")
_APPLY, _ABSENT = "\u2061", "\u2063"
_OPENING, _CLOSING, _BARS = "([{⌊⌈⟨", ")]}⌋⌉⟩", "|‖"
_PRIMES = {"′": 1, "″": 2, "‴": 3, "⁗": 4}
_MARKS = {
    "¯": "bar", "ˆ": "hat", "˜": "tilde", "\u20d7": "vec", "˙": "dot", "¨": "ddot",
    "ˇ": "check", "˘": "breve", "˚": "ring", "\u0302": "widehat", "̲": "overline",
    "→": "arrow",
}  # fmt: skip
_TAKES_LIMITS = frozenset(
    {"lim", "max", "min", "sup", "inf", "lim sup", "lim inf", "arg max", "arg min", "Pr", "gcd"}
)
_NAMES = _TAKES_LIMITS | {
    "sin", "cos", "tan", "cot", "sec", "csc", "sinh", "cosh", "tanh", "arcsin", "arccos", "arctan",
    "ln", "log", "lg", "exp", "det", "dim", "ker", "deg", "arg", "hom",
}  # fmt: skip
_SIGNS = frozenset(
    {*SIGN_COMMANDS, *KNOWN_RELATIONS, "+", "-", "·", "×", "/", ",", ";", ":", "!", "?", ".", "…",
     "′", "°", "%", "ᵀ"}
)  # fmt: skip
_SAME_SIGN = {"−": "-", "⋅": "·", "∼": "~", "∣": "|", "⊤": "ᵀ", "*": "∗"}
_RELATIONS = frozenset(
    {*KNOWN_RELATIONS, *MORE_RELATIONS, *ARROWS, ",", ";", ":", "colon", "|", "such that",
     "divides", "∴", "∵"}
)  # fmt: skip
_CALLED = frozenset("fghPVEFGLNφψΦΓΨ")
"""Letters that are functions where a bracket follows."""
_WORD_TEXT = re.compile(r"[\w .'-]+")
_WIDTH = re.compile(r"(-?[\d.]+)(?:em|rem)")


class LatexError(FormulaError):
    """LaTeX that cannot be read, or something in it that not every output can express.

    Parameters
    ----------
    message : str
        What it is, and what to write.
    column : int
        Where it stands in the formula, counted from 1.
    """


class _Bracket(Struct, frozen=True):
    """A bracket that may open or close, with what is raised or lowered after it."""

    sign: str
    sub: Node | None = None
    sup: Node | None = None
    primes: int = 0
    separates: bool = False


class _RefusalError(Exception):
    """Something that has no node: what it is, and the commands that make it."""

    def __init__(self, what: str, *commands: str) -> None:
        super().__init__(what)
        self.what, self.commands = what, commands


_Piece = Node | _Bracket


def lay_out_latex(source: str) -> Node:
    r"""Return the layout of a LaTeX formula.

    Parameters
    ----------
    source : str
        Without the dollar signs. ``{{ name }}`` is the place of a value.

    Raises
    ------
    LatexError
        With the column, the construct and what there is instead.

    Examples
    --------
    >>> from quizgen.typeset import to_speech
    >>> to_speech(lay_out_latex(r"\bar x = \frac{1}{n}"))
    'x bar equals 1 over n'
    """
    if len(source) > LONGEST:
        raise LatexError(f"is longer than {LONGEST} characters", LONGEST + 1)
    if found := _PRIVATE.search(source):
        raise LatexError("has a character that no font has", found.start() + 1)
    if found := _DECIMAL_COMMA.search(source):
        what = "{,}: write a decimal point, it is printed as the language has it"
        raise LatexError(what, found.start() + 2)
    if found := _COMMENT.search(source):
        what = r"% begins a comment in LaTeX: write \% for a percent sign"
        raise LatexError(what, found.start() + 1)
    _check_depth(source)
    held, names, starts = _hold_slots(source)
    try:
        made = _Reader(names).read(_parse_mathml(held, starts))
    except _RefusalError as error:
        raise _locate_refusal(source, error) from None
    except RecursionError:
        raise LatexError("has too many levels in each other", 1) from None
    if made == MathRow(()):
        raise LatexError("is empty", 1)
    return made


def _check_depth(source: str) -> None:
    """Raise ``LatexError`` if groups are nested too deeply, or if there are too many commands.

    The converter and this module recurse, so an author's slip must not exhaust the stack.
    """
    depth = 0
    for at, sign in enumerate(source):
        depth += (sign == "{") - (sign == "}")
        if depth > DEEPEST:
            raise LatexError(f"has more than {DEEPEST} groups in each other", at + 1)
    if source.count("\\") > 10 * DEEPEST:
        raise LatexError(f"has more than {10 * DEEPEST} commands", 1)


def _hold_slots(source: str) -> tuple[str, tuple[str, ...], list[tuple[int, int]]]:
    """Return the source with a sign for each slot, their names, and where text got shorter."""
    names: list[str] = []
    starts: list[tuple[int, int]] = []
    held, last = "", 0
    for found in SLOT.finditer(source):
        held += source[last : found.start()] + chr(_FIRST_SLOT + len(names))
        names.append(found[1])
        last = found.end()
        starts.append((len(held), last))
    held += source[last:]
    if (at := held.find("{{")) >= 0:
        what = "only {{ name }} may stand in double braces; write two braces of LaTeX apart: { {"
        raise LatexError(what, _find_column(at, starts))
    return held, tuple(names), starts


def _find_column(at: int, starts: Sequence[tuple[int, int]]) -> int:
    """Return the column in the source, from 1, of a place in the held text."""
    shift = max((ours - held for held, ours in starts if held <= at), default=0)
    return at + shift + 1


@cache
def _make_converter() -> LatexToMathML:
    """Return the converter from LaTeX to MathML, made once."""
    from math_core import LatexToMathML

    return LatexToMathML(fancy_error=False)


def _parse_mathml(held: str, starts: Sequence[tuple[int, int]]) -> ET.Element:
    """Return the MathML of a formula whose slots are held by stand-ins.

    What the converter would refuse vaguely, or take in a way of its own, is refused here first,
    with
    advice. ``starts`` leads from a place to the column of the source. Raises ``LatexError``.
    """
    from math_core import LatexError as ConverterError

    for found in _ENVIRONMENT.finditer(held):
        if found[1] not in ENVIRONMENTS:
            there = ", ".join(ENVIRONMENTS)
            what = f"\\begin{{{found[1]}}} is no environment there is (there are {there})"
            raise LatexError(what, _find_column(found.start(), starts))
    if "\\\\" in held and "\\begin" not in held:
        what = r"\\ ends a line in an environment alone, such as aligned"
        raise LatexError(what, _find_column(held.index("\\\\"), starts))
    for found in _LETTER_COMMAND.finditer(held):
        if found[1] in ADVICE:
            what = f"\\{found[1]}: {ADVICE[found[1]]}"
            raise LatexError(what, _find_column(found.start(), starts))
    try:
        text = _make_converter().convert_with_local_state(held, displaystyle=False)
    except ConverterError as error:
        raise _explain_converter(held, str(error), starts) from None
    return ET.fromstring(text.replace("&ApplyFunction;", _APPLY))  # noqa: S314 - no entities


def _explain_converter(held: str, message: str, starts: Sequence[tuple[int, int]]) -> LatexError:
    """Return what is wrong in an author's words; columns count bytes there, characters here."""
    found = _AT.match(message)
    at = len(held.encode()[: int(found[1])].decode(errors="ignore")) if found else 0
    what = found[2] if found else message
    command = _COMMAND.match(held, at)
    if "Unknown command" in what and command:
        near = get_close_matches(command[1], COMMANDS, n=3)
        like = ", ".join(f"\\{name}" for name in near)
        what = f"\\{command[1]} is not among the commands there are"
        what += f" (near it: {like})" if like else ""
    return LatexError(what[:1].lower() + what[1:].rstrip("."), _find_column(at, starts))


def _locate_refusal(source: str, error: _RefusalError) -> LatexError:
    """Return a refusal as an error at the first command in the source that may be meant."""
    places = [source.find(f"\\{command}") for command in error.commands]
    at = min((place for place in places if place >= 0), default=0)
    found = _COMMAND.match(source, at) if error.commands else None
    what = f"{found[0]} " if found else ""
    return LatexError(f"{what}{error.what}", at + 1)


class _Reader:
    """One formula: elements of MathML to nodes."""

    def __init__(self, names: tuple[str, ...]) -> None:
        self.names = names

    def read(self, root: ET.Element) -> Node:
        """Return the whole formula."""
        return self.row(list(root), root=True)

    def row(self, elements: Sequence[ET.Element], opening: str = "", *, root: bool = False) -> Node:
        """Return elements next to each other as one node."""
        pieces = self.pieces(elements)
        return _RowBuilder(pieces, opening, root=root).build()

    def node(self, element: ET.Element) -> Node:
        """Return one element as a node."""
        return self.row([element])

    def pieces(self, elements: Iterable[ET.Element]) -> list[_Piece]:
        """Return what elements hold, one after the other."""
        found: list[_Piece] = []
        for element in elements:
            found += self.convert(element)
        return _join_signs(found)

    def convert(self, element: ET.Element) -> Sequence[_Piece]:
        """Return one element as pieces of a row."""
        rule = _RULES.get(element.tag)
        if rule is None or element.get("style", "").startswith(("color", "background")):
            what, commands = _REFUSED.get(element.tag, ("it cannot be said in every output", ()))
            raise _RefusalError(what, *commands)
        return rule(self, element)

    # Leaves

    def identifier(self, element: ET.Element) -> Sequence[_Piece]:
        """Return letters: a quantity, an upright name, a slot, or a sign used like a letter."""
        text = (element.text or "").replace("\ufe00", "").replace("\ufe01", "")
        found: list[_Piece] = []
        for part in re.split("([\ue000-\uf8ff])", text):
            if _PRIVATE.fullmatch(part):
                found.append(Leaf(self.names[ord(part) - _FIRST_SLOT]))
            elif part:
                found.append(_read_name(part, upright=element.get("mathvariant") == "normal"))
        return found

    def number(self, element: ET.Element) -> Sequence[_Piece]:
        """Return digits, grouped as everywhere; zeros in front remain."""
        text = element.text or ""
        if not _NUMBER.fullmatch(text):
            raise _RefusalError(f"{text!r} is no number")
        return [Digits(text if text.startswith("0") else pretty.group_digits(text))]

    def operator(self, element: ET.Element) -> Sequence[_Piece]:
        """Return a sign, a bracket, or a large operator."""
        text = element.text or ""
        text = _SAME_SIGN.get(text, text)
        if text in LARGE:
            return [LargeOperator(text)]
        if text in _OPENING + _CLOSING:
            return [_Bracket(text)]
        if text in _BARS:
            between = element.get("stretchy") == "true" and element.get("minsize") is None
            return [_Bracket(text, separates=between or element.text == "∣")]
        if text == _APPLY:
            return [OperatorSign("apply")]
        if text in _PRIMES:
            return [OperatorSign("′")] * _PRIMES[text]
        if text not in _SIGNS and text != "ᵀ":
            raise _RefusalError(f"the sign {text!r} cannot be said in every output")
        return [OperatorSign(text)]

    def text(self, element: ET.Element) -> Sequence[_Piece]:
        """Return words; a blank that must not break is a gap."""
        if len(element):
            raise _RefusalError(
                "sets words in another shape; there are \\text and \\mathrm", "textbf", "textit",
                "texttt", "emph",
            )  # fmt: skip
        text = element.text or ""
        if text == "\u00a0":
            return [Gap("medium")]
        text = text.replace("\u00a0", " ")
        found: list[_Piece] = []
        for part in re.split("([\ue000-\uf8ff])", text):
            if _PRIVATE.fullmatch(part):
                found.append(Leaf(self.names[ord(part) - _FIRST_SLOT]))
            elif part:
                found.append(Phrase(part))
        return found

    def space(self, element: ET.Element) -> Sequence[_Piece]:
        """Return a blank of the nearest width; one that moves things together is left out."""
        found = _WIDTH.fullmatch(element.get("width", ""))
        if found is None or float(found[1]) <= 0:
            return []
        width = float(found[1])
        return [Gap(min(GAPS, key=lambda name: abs(GAPS[name] - width)))]

    # What holds other things

    def group(self, element: ET.Element) -> Sequence[_Piece]:
        """Return a group in braces, or brackets that LaTeX has paired."""
        children = list(element)
        if len(children) > 1 and _is_paired(children[0]) and _is_paired(children[-1]):
            return [self.fence(children)]
        inner = self.pieces(children)
        if element.get("displaystyle") == "true":
            return [Display(_RowBuilder(inner, "").build())]
        return inner

    def fence(self, children: list[ET.Element]) -> Node:
        r"""Return what ``\left`` and ``\right`` or an environment hold."""
        left, right = (_find_fence_sign(children[end]) for end in (0, -1))
        body = children[1:-1]
        if len(body) == 1 and body[0].tag == "mtable":
            rows = self.table(body[0])
            return AlignedRows(rows, brace=True) if right == "." else Matrix(rows, left + right)
        if len(body) == 1 and body[0].tag == "mfrac" and body[0].get("linethickness") == "0":
            binomial = Binomial(self.node(body[0][0]), self.node(body[0][1]))
            return Display(binomial) if body[0].get("displaystyle") == "true" else binomial
        return Fenced(left + right, self.row(body, left))

    def fraction(self, element: ET.Element) -> Sequence[_Piece]:
        """Return a fraction, large where it was asked to be."""
        made = Frac(self.node(element[0]), self.node(element[1]))
        return [Display(made) if element.get("displaystyle") == "true" else made]

    def root(self, element: ET.Element) -> Sequence[_Piece]:
        """Return a root with its index, or a square root."""
        if element.tag == "msqrt":
            return [Root(self.row(list(element)))]
        return [Root(self.node(element[0]), self.node(element[1]))]

    def scripts(self, element: ET.Element) -> Sequence[_Piece]:
        """Return a base with what stands below and above it on its right."""
        base, *rest = element
        sub = self.node(rest[0]) if element.tag != "msup" else None
        sup = self.node(rest[-1]) if element.tag != "msub" else None
        return self.attach(base, sub, sup)

    def attach(self, base: ET.Element, sub: Node | None, sup: Node | None) -> Sequence[_Piece]:
        """Return scripts of what stands in front; bounds of a sum, limits of a limit."""
        primes, sup = _take_primes(sup)
        before = self.pieces([base])
        if sup == OperatorSign("∘") and sub is None:
            return [*before, OperatorSign("°")]
        sup = OperatorSign("ᵀ") if sup in _TRANSPOSED else sup
        if len(before) == 1:
            (piece,) = before
            if isinstance(piece, _Bracket):
                return [replace(piece, sub=sub, sup=sup, primes=primes)]
            if isinstance(piece, LargeOperator):
                return [replace(piece, lower=sub, upper=sup)]
            if sub is not None and sup is None and _takes_limits(piece):
                return [Under(piece, sub)]
            if isinstance(piece, Brace) and piece.note is None:
                return [replace(piece, note=sub or sup)]
        made = _RowBuilder(before, "").build() if before else Phrase("")
        return [Scripts(made, sub, sup, primes)]

    def above(self, element: ET.Element) -> Sequence[_Piece]:
        """Return an accent, a brace, bounds of a large operator, or a node above."""
        base, mark = element[0], element[-1]
        sign = (mark.text or "") if mark.tag == "mo" else ""
        if element.tag == "mover" and sign == "⏞":
            return [Brace(self.node(base), upside=True)]
        if element.get("accent") == "true":
            if sign not in _MARKS:
                raise _RefusalError(f"the accent {sign!r} cannot be said in every output")
            return [Accent(_MARKS[sign], self.node(base))]
        if _find_operator(base) in LARGE or _is_brace(base):
            return self.attach(base, None, self.node(mark))
        return [Over(self.node(base), self.arrow_note(mark))]

    def below(self, element: ET.Element) -> Sequence[_Piece]:
        """Return an underline, a brace, bounds of a large operator, or a node below."""
        base, mark = element[0], element[-1]
        if (mark.text or "") == "⏟":
            return [Brace(self.node(base))]
        if element.get("accentunder") == "true":
            return [Accent("underline", self.node(base))]
        if _find_operator(base) in LARGE or _is_brace(base):
            return self.attach(base, self.node(mark), None)
        return [Under(self.node(base), self.arrow_note(mark))]

    def between(self, element: ET.Element) -> Sequence[_Piece]:
        """Return both bounds of a large operator, or a node below and one above."""
        base, low, high = element
        if _find_operator(base) in LARGE:
            return self.attach(base, self.node(low), self.node(high))
        return [Over(Under(self.node(base), self.arrow_note(low)), self.arrow_note(high))]

    def arrow_note(self, element: ET.Element) -> Node:
        """Return what stands above or below; at an arrow it is wrapped, to make the arrow wide."""
        if element.tag in {"mover", "munder"} and element[-1].tag == "mspace":
            return self.row([one for one in element[0] if one.tag != "mspace"])
        return self.node(element)

    def standing_table(self, element: ET.Element) -> Sequence[_Piece]:
        """Return lines below each other, or a matrix without brackets."""
        rows = self.table(element)
        if element.get("displaystyle") == "true":
            return [AlignedRows(rows)]
        return [Matrix(rows, "")]

    def table(self, element: ET.Element) -> tuple[tuple[Node, ...], ...]:
        """Return the cells of a table."""
        if any("border" in cell.get("style", "") for cell in element.iter("mtd")):
            raise _RefusalError("draws lines, which cannot be said in every output", "begin{array}")
        return tuple(tuple(self.row(list(cell)) for cell in row) for row in element)

    def inside(self, element: ET.Element) -> Sequence[_Piece]:
        """Return what a wrapper holds."""
        return self.pieces(list(element))


_RULES: dict[str, Callable[[_Reader, Any], Sequence[_Piece]]] = {
    "mi": _Reader.identifier,
    "mn": _Reader.number,
    "mo": _Reader.operator,
    "mtext": _Reader.text,
    "mspace": _Reader.space,
    "mrow": _Reader.group,
    "mpadded": _Reader.inside,
    "mfrac": _Reader.fraction,
    "msqrt": _Reader.root,
    "mroot": _Reader.root,
    "msub": _Reader.scripts,
    "msup": _Reader.scripts,
    "msubsup": _Reader.scripts,
    "mover": _Reader.above,
    "munder": _Reader.below,
    "munderover": _Reader.between,
    "mtable": _Reader.standing_table,
}
_REFUSED: dict[str, tuple[str, tuple[str, ...]]] = {
    "menclose": (
        "strikes out or frames, which is lost in speech",
        ("boxed", "cancel", "bcancel", "xcancel", "fbox"),
    ),
    "mphantom": (
        "takes the room of what nobody sees; leave it out",
        ("phantom", "hphantom", "vphantom"),
    ),
    "mmultiscripts": (
        "is not there; write the index before as {}^{14}_{6}",
        ("sideset", "prescript"),
    ),
}
_TRANSPOSED = frozenset({Word("T"), Ident("T", style="sans"), OperatorSign("ᵀ"), Ident("⊤")})


def _is_paired(element: ET.Element) -> bool:
    r"""Whether an element is a bracket that LaTeX has paired: by ``\left``, or an environment."""
    text = element.text or ""
    single = len(text) == 1 and text in _OPENING + _CLOSING + _BARS + _ABSENT
    return element.tag == "mo" and single and element.get("stretchy") is None


def _find_fence_sign(element: ET.Element) -> str:
    """Return the sign of a stretching bracket, "." for none; refuse one no output can read."""
    sign = (element.text or "").replace(_ABSENT, ".")
    if sign not in FENCES:
        raise _RefusalError(f"the bracket {sign!r} cannot be said in every output", "left", "right")
    return sign


def _find_operator(element: ET.Element) -> str:
    """Return the sign of an operator; empty for anything else."""
    return (element.text or "") if element.tag == "mo" else ""


def _is_brace(element: ET.Element) -> bool:
    """Return whether an element is a curly brace above or below something."""
    return element.tag in {"mover", "munder"} and (element[-1].text or "") in {"⏞", "⏟"}


def _takes_limits(piece: _Piece) -> TypeGuard[FunctionName]:
    """Return whether a piece is a function such as lim, with its condition set below it."""
    return isinstance(piece, FunctionName) and piece.text in _TAKES_LIMITS


def _take_primes(sup: Node | None) -> tuple[int, Node | None]:
    """Return the primes at the beginning of a superscript, and what is left of it."""
    items = list(sup.items) if isinstance(sup, MathRow) else [sup] if sup else []
    count = 0
    while items and items[0] == OperatorSign("′"):
        count += 1
        items.pop(0)
    if not count or not items:
        return count, None if count else sup
    return count, items[0] if len(items) == 1 else MathRow(tuple(items))


def _read_name(text: str, *, upright: bool) -> Node:
    """Return one letter in its alphabet, a letter-like sign, or an upright word."""
    text = _SAME_SIGN.get(text, text)
    if text in _SIGNS:
        return OperatorSign("colon" if text == ":" else text)
    if text == "⊤":
        return OperatorSign("ᵀ")
    if len(text) == 1:
        return _read_letter(text, upright=upright)
    plain = normalize("NFKC", text)
    if not _WORD_TEXT.fullmatch(plain):
        raise _RefusalError(f"the sign {text!r} cannot be said in every output")
    if plain in _NAMES:
        return FunctionName(plain)
    if plain != text:
        letters = [_read_letter(letter, upright=upright) for letter in text]
        return MathRow(tuple(letters))
    return Word(text)


def _read_letter(text: str, *, upright: bool) -> Node:
    """Return the letter that a styled sign of Unicode stands for, with its style.

    Raises a refusal for a letter that some output has no word or no glyph for.
    """
    if text in LETTERLIKE:
        return Ident(text)
    plain, shape = normalize("NFKC", text), unicode_name(text, "")
    if plain == text or len(plain) != 1:
        if not (text.isascii() and text.isalpha()) and text not in GREEK_LETTERS:
            raise _RefusalError(f"the letter {text!r} cannot be said in every output")
        own = not upright or text in GREEK_LETTERS
        return Ident(text) if own else Word(text)
    for style, row in ALPHABETS.items():
        if any(name in shape for name in row.unicode) and has_styled_letter(plain, style):
            return Ident(plain, style=style)
    return Ident(plain, bold="BOLD" in shape)


def _join_signs(pieces: list[_Piece]) -> list[_Piece]:
    """Return signs that LaTeX sets as several as one: three points, a colon with an equals sign."""
    found: list[_Piece] = []
    dots, equals = (OperatorSign("."), OperatorSign("·")), OperatorSign("=")
    for piece in pieces:
        if piece in dots and found[-2:] == [piece, piece]:
            found[-2:] = [OperatorSign("…" if piece == dots[0] else "⋯")]
        elif piece == OperatorSign("!") and found[-1:] == [OperatorSign("∃")]:
            found[-1] = OperatorSign("∃!")
        elif piece == equals and found[-1:] in ([OperatorSign(":")], [OperatorSign("colon")]):
            found[-1] = OperatorSign("≔")
        elif isinstance(piece, OperatorSign) and piece.name in {"⟹", "⟸", "⟺"}:
            # LaTeX sets these with room around, and so does every output
            if found[-1:] == [Gap("thick")]:
                found.pop()
            found.append(piece)
        elif piece == Gap("thick") and found and _is_long_arrow(found[-1]):
            continue
        else:
            found.append(piece)
    return found


def _is_long_arrow(piece: _Piece) -> bool:
    """Return whether a piece is one of the double arrows between statements."""
    return isinstance(piece, OperatorSign) and piece.name in {"⟹", "⟸", "⟺"}


class _Frame(Struct):
    """A bracket that is open, and what stands in it so far."""

    opening: str
    items: list[Node]


class _RowBuilder:
    """Pieces of a row to one node: pairs brackets, tells bars, signs and functions apart.

    Parameters
    ----------
    pieces : list of Node or _Bracket
    opening : str
        The bracket around the row, if there is one.
    root : bool
        Whether the row is the whole formula.
    """

    def __init__(self, pieces: list[_Piece], opening: str, *, root: bool = False) -> None:
        self.pieces, self.root = _join_double_bars(pieces), root
        self.frames = [_Frame(opening, [])]

    def build(self) -> Node:
        """Return the row as one node."""
        for index, piece in enumerate(self.pieces):
            if isinstance(piece, _Bracket):
                self.take(piece, index)
            else:
                self.frames[-1].items.append(piece)
        if len(self.frames) > 1:
            raise _RefusalError(f"the bracket {self.frames[-1].opening!r} is not closed")
        return _make_row(self.frames[0].items, root=self.root)

    def take(self, piece: _Bracket, index: int) -> None:
        """Open or close a bracket, or tell that a bar is neither."""
        if piece.sign in _OPENING:
            self.open(piece)
        elif piece.sign in _CLOSING:
            self.close(piece)
        elif piece.separates:
            self.frames[-1].items.append(self.separator())
        else:
            self.take_bar(piece, index)

    def take_bar(self, piece: _Bracket, index: int) -> None:
        """Decide what a single bar is, by the bars and the pieces around it.

        It closes an open one, opens one, ends what is evaluated (with an index), or separates.
        """
        top = self.frames[-1]
        if top.items and top.opening == piece.sign and not _waits(top.items):
            self.close(piece)
        elif _waits(top.items) or self.count_bars(index) % 2 == 0:
            self.open(piece)
        elif piece.sub or piece.sup:
            self.evaluate(piece)
        else:
            top.items.append(self.separator())

    def evaluate(self, piece: _Bracket) -> None:
        """End what is evaluated: all after the last relation."""
        items = self.frames[-1].items
        begin = max((at + 1 for at, item in enumerate(items) if _is_relation(item)), default=0)
        body = _make_row(items[begin:])
        items[begin:] = [Scripts(Fenced(f".{piece.sign}", body), piece.sub, piece.sup)]

    def count_bars(self, index: int) -> int:
        """Return the number of bars from a place to the end of the brackets around it."""
        depth = count = 0
        for piece in self.pieces[index:]:
            if isinstance(piece, _Bracket):
                depth += (piece.sign in _OPENING) - (piece.sign in _CLOSING)
                if depth < 0:
                    break
                count += depth == 0 and piece.sign in _BARS and not piece.separates
        return count

    def separator(self) -> OperatorSign:
        """Return what a bar between two things says."""
        inside = next((one.opening for one in reversed(self.frames) if one.opening), "")
        if inside == "{":
            return OperatorSign("such that")
        return OperatorSign("divides" if self.root and len(self.frames) == 1 else "|")

    def open(self, piece: _Bracket) -> None:
        """Begin what stands in a bracket."""
        if piece.sub or piece.sup or piece.primes:
            raise _RefusalError(f"an index stands on the opening bracket {piece.sign!r}")
        self.frames.append(_Frame(piece.sign, []))

    def close(self, piece: _Bracket) -> None:
        """End what stands in a bracket."""
        frame = self.frames.pop()
        if not self.frames or not frame.opening:
            raise _RefusalError(f"the bracket {piece.sign!r} closes nothing")
        made: Node = Fenced(frame.opening + piece.sign, _make_row(frame.items))
        if piece.sub or piece.sup or piece.primes:
            made = Scripts(made, piece.sub, piece.sup, piece.primes)
        self.frames[-1].items.append(made)


def _join_double_bars(pieces: list[_Piece]) -> list[_Piece]:
    """Return bars in pairs as bars of a norm, where a pair can open and another one close."""
    found = list(pieces)
    at = 0
    while at + 1 < len(found):
        if _is_double_bar(found, at) and _waits([one for one in found[:at][-1:] if _is_node(one)]):
            later = (end for end in range(at + 3, len(found) - 1) if _is_double_bar(found, end))
            end = next(later, None)
            if end is not None:
                found[end : end + 2] = [replace(found[end + 1], sign="‖")]
                found[at : at + 2] = [_Bracket("‖")]
        at += 1
    return found


def _is_double_bar(pieces: list[_Piece], at: int) -> bool:
    """Return whether two bars stand at a place, without indices between them."""
    plain = _Bracket("|")
    following = pieces[at + 1]
    return pieces[at] == plain and isinstance(following, _Bracket) and following.sign == "|"


def _is_node(piece: _Piece) -> TypeGuard[Node]:
    """Return whether a piece is a node, not a bracket that waits to be paired."""
    return not isinstance(piece, _Bracket)


def _is_relation(item: Node) -> bool:
    """Return whether a node is a sign of relation, as = or <."""
    return isinstance(item, OperatorSign) and item.name in _RELATIONS


_AS_OPERANDS = frozenset({"!", "°", "%", "′", "…", "⋯", "⋮", "⋱"})


def _waits(items: list[Node]) -> bool:
    """Whether an operand must come next."""
    return not items or (isinstance(items[-1], OperatorSign) and items[-1].name not in _AS_OPERANDS)


def _make_row(items: list[Node], *, root: bool = False) -> Node:
    """Return one node of a row whose brackets are paired."""
    _check_decimal_comma(items, root=root)
    if len(items) > 1 and OperatorSign("ᵀ") in items:
        raise _RefusalError("stands raised alone, as in A^\\top", "top")
    if any(isinstance(one, Digits) and isinstance(two, Digits) for one, two in pairwise(items)):
        raise _RefusalError("two numbers stand beside each other: write a sign between them")
    items = _apply_functions(_find_signs(items))
    if len(items) == 1:
        return items[0]
    return MathRow(tuple(items), _find_level(items))


def _check_decimal_comma(items: list[Node], *, root: bool) -> None:
    """Raise a refusal for a comma right between digits in the row of the whole formula."""
    digits = [isinstance(item, Digits) for item in items]
    for at, item in enumerate(items[1:-1], 1) if root else ():
        if item == OperatorSign(",") and digits[at - 1] and digits[at + 1]:
            raise _RefusalError(
                "a comma between digits: write a decimal point, it is printed as the language has"
                r" it; a list of numbers stands in brackets or has a gap, 1,\ 5"
            )


_PREFIXES: dict[Node, OperatorSign] = {
    OperatorSign("-"): OperatorSign("neg"), OperatorSign("+"): OperatorSign("pos")
}  # fmt: skip


def _find_signs(items: list[Node]) -> list[Node]:
    """Return minus signs that are no differences, colons that are no ratios, a remainder."""
    found: list[Node] = []
    for at, item in enumerate(items):
        after = items[at + 1] if at + 1 < len(items) else None
        if item in _PREFIXES and _waits(found) and after is not None:
            found.append(_PREFIXES[item])
        elif item == Gap("thin") and found[-1:] and found[-1] in _PREFIXES.values():
            continue
        elif item == OperatorSign(":") and not (
            found and isinstance(found[-1], Digits | Leaf) and isinstance(after, Digits | Leaf)
        ):
            found.append(OperatorSign("colon"))
        elif item == Word("mod") and found and found[-1] == Gap("medium"):
            found[-1] = OperatorSign("mod")
        elif item == Gap("medium") and found and found[-1] == OperatorSign("mod"):
            continue
        else:
            found.append(item)
    return found


def _apply_functions(items: list[Node]) -> list[Node]:
    """Return functions with the brackets after them as one node."""
    found: list[Node] = []
    for item in items:
        applied = bool(found) and found[-1] == OperatorSign("apply")
        if applied:
            found.pop()
        before = found[-1] if found else None
        done = isinstance(before, Under | Over | OperatorSign)
        if applied and (done or _holds_nothing(item)):
            found.append(item)
        elif isinstance(item, Fenced) and item.kind == "()" and _is_called(before, applied=applied):
            found[-1] = Func(_as_head(found[-1]), _split_arguments(item.body))
        elif applied and before is not None:
            tight = isinstance(item, Fenced | Matrix)
            found[-1] = _as_function(before)
            found += [OperatorSign("apply tight" if tight else "apply"), item]
        else:
            found.append(item)
    if found and found[-1] == OperatorSign("apply"):
        found.pop()
    return found


def _holds_nothing(item: Node) -> bool:
    """Whether nothing is applied to: a sign between two operands comes, or a blank."""
    return isinstance(item, Gap) or (
        isinstance(item, OperatorSign) and item.name not in {"neg", "¬", "∂", "∀", "∃"}
    )


_INVERSE = MathRow((OperatorSign("neg"), Digits("1")), NEGATIVE)


def _is_called(node: Node | None, *, applied: bool) -> bool:
    """Whether a node with brackets after it is a function."""
    while isinstance(node, Scripts | Accent):
        if isinstance(node, Scripts) and node.sup not in {None, _INVERSE} and not applied:
            return False
        node = node.base
    if isinstance(node, Ident):
        return node.text in _CALLED and not node.bold and node.style in {"", "cal"}
    return applied or isinstance(node, FunctionName | Word)


def _as_head(node: Node) -> Node:
    """Return a function's name as the head of what it is applied to."""
    if isinstance(node, Scripts):
        return replace(node, base=_as_head(node.base))
    return Word(node.text) if isinstance(node, FunctionName) else node


def _as_function(node: Node) -> Node:
    """Return a word in front of an argument as a function's name."""
    if isinstance(node, Scripts):
        return replace(node, base=_as_function(node.base))
    return FunctionName(node.text) if isinstance(node, Word) else node


def _split_arguments(body: Node) -> tuple[Node, ...]:
    """Return arguments between commas."""
    if not isinstance(body, MathRow) or OperatorSign(",") not in body.items:
        return (body,)
    parts: list[list[Node]] = [[]]
    for item in body.items:
        if item == OperatorSign(","):
            parts.append([])
        else:
            parts[-1].append(item)
    return tuple(_make_row(part) for part in parts)


def _find_level(items: Sequence[Node]) -> int:
    """Return how strongly a row holds together: as its weakest sign."""
    signs = {item.name for item in items if isinstance(item, OperatorSign)}
    if signs & _RELATIONS or any(isinstance(item, Phrase) for item in items):
        return RELATION
    if signs & {"+", "-", "±", "∓", "∪", "∩", "∖", "∧", "∨", "⊕"}:
        return SUM
    if items and items[0] == OperatorSign("neg"):
        return NEGATIVE
    operands = [item for item in items if not isinstance(item, OperatorSign | Gap)]
    return PRODUCT if len(operands) > 1 or signs & (set(PLAIN) | {"!", "%"}) else ATOM


# Formulas without commands

_ARGUMENT = re.compile(r"(?<![A-Za-z])(sqrt|bar|hat|tilde|vec)\(([^()]*)\)")
_WORDS = sorted({*GREEK, *(name for name in _NAMES if " " not in name)}, reverse=True)
_WORD = re.compile(rf"(?<![A-Za-z])(?:{'|'.join(_WORDS)})(?![A-Za-z])")
_LONG_WORD = re.compile(r"(?<![A-Za-z])(?!(?:sqrt|bar|hat|tilde|vec)\()[A-Za-z]{3,}(?![A-Za-z])")
_SCRIPT = re.compile(r"([_^])(?:(-?\w{2,}|-\w)|\(([^()]*)\))")
_APART = re.compile(r"\d +\d")
_SPELLED = {
    "<=": r"\le ", ">=": r"\ge ", "->": r"\to ", "=>": r"\Rightarrow ", "||": r"\parallel ",
    "~": r"\sim ", "*": r"\cdot ", "...": r"\dots ",
}  # fmt: skip


def _spell_word(found: re.Match[str]) -> str:
    """Return a name of several letters as an upright word; one with its own command stays."""
    return found[0] if _WORD.fullmatch(found[0]) else f"\\mathrm{{{found[0]}}}"


def spell_as_latex(text: str) -> str:
    r"""Return as LaTeX what people type; a formula that has commands stays as it is.

    Raises
    ------
    LatexError
        If LaTeX would run two numbers together.

    Examples
    --------
    >>> print(spell_as_latex("H_0: mu_1 <= bar(x)"))
    H_0: \mu _1 \le  \bar{x}
    """
    if "\\" in text:
        return text
    if found := _APART.search(text):
        raise LatexError("two numbers stand beside each other: write a sign between them",
                         found.start() + 1)  # fmt: skip
    parts = SLOT.split(text)
    for at in range(0, len(parts), 2):  # names of slots stand between
        part = _SCRIPT.sub(lambda found: f"{found[1]}{{{found[2] or found[3]}}}", parts[at])
        part = _LONG_WORD.sub(_spell_word, part)
        part = _ARGUMENT.sub(r"\\\1{\2}", _WORD.sub(lambda found: f"\\{found[0]} ", part))
        for typed, command in _SPELLED.items():
            part = part.replace(typed, command)
        parts[at] = part
    parts[1::2] = [f"{{{{ {name} }}}}" for name in parts[1::2]]
    return "".join(parts)

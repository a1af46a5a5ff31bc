"""Formula text to tokens: numbers, names, operators, and the products written by juxtaposition."""

from __future__ import annotations

import re
from collections.abc import Iterable
from fractions import Fraction
from itertools import pairwise

import msgspec

from quizgen.core.errors import FormulaError
from quizgen.maths.notation.names import (
    CONSTANTS,
    FUNCTIONS,
    KEYWORDS,
    LIST_FUNCTIONS,
    fold_name,
    spellings,
    split_product,
)
from quizgen.maths.operators import OperatorSyntax, operators_with_syntax
from quizgen.maths.tree import Num

LARGEST_EXPONENT = 250
"""Largest decimal exponent read: beyond anything measurable, and every unit keeps it a float."""

SMALLEST_EXPONENT = -300

LONGEST_NUMBER = 60
"""Most digits read in one number."""


class FormulaReadError(FormulaError):
    """Typed mathematics cannot be read; says why in a form that can be put into any language.

    Parameters
    ----------
    code : str
        Stable language-free reason, for example ``unexpected`` or ``unknown-name``.
    column : int
        Position in the typed text, counted from 1.
    found : str
        The piece of text in question.
    expected : tuple of str
        What could have stood there (token kinds, or names).
    """

    def __init__(
        self, code: str, column: int = 1, found: str = "", expected: Iterable[str] = ()
    ) -> None:
        """Build the English sentence from the language-free reason."""
        self.code = code
        self.found = found
        self.expected = tuple(expected)
        wanted = f", expected {_in_words(self.expected)}" if self.expected else ""
        what = f" {found!r}" if found else ""
        super().__init__(f"column {column}: {code.replace('-', ' ')}{what}{wanted}", column)


def _in_words(expected: Iterable[str]) -> str:
    """Return kinds of tokens as people call them; what a formula can begin with is one."""
    kinds = set(expected)
    if "NUMBER" in kinds:
        return "a number, a name or a bracket"
    words = {"RPAR": "')'", "RBAR": "'|'", "COMMA": "','", "$END": "the end"}
    signs = ["an operator"] if kinds & {"PLUS", "OPERATOR"} else []
    return " or ".join([*signs, *sorted(words[kind] for kind in kinds & words.keys())]) or " ".join(
        sorted(kinds)
    )


class Token(msgspec.Struct, frozen=True):
    """One token: its kind in the grammar, its value, the text and the column it came from."""

    kind: str
    value: object
    text: str
    column: int

    def __str__(self) -> str:
        """Return the text that the token came from."""
        return self.text


OPERATORS = {
    sign: row.token for row in operators_with_syntax(OperatorSyntax.SIGN) for sign in row.signs
} | {
    "(": "LPAR",
    ")": "RPAR",
    ",": "COMMA",
    "√": "ROOT",
    "|": "BAR",
}
"""Spelling to the kind of token."""

RELATIONS = {
    sign: row.name for row in operators_with_syntax(OperatorSyntax.RELATION) for sign in row.signs
}
"""Spelling of a relation to its name."""

_SIGNS = "|".join(map(re.escape, sorted({*OPERATORS, *RELATIONS}, key=len, reverse=True)))

TOKEN = re.compile(
    r"(?P<space>\s+)"
    r"|(?P<number>(?:\d+\.\d*|\.\d+|\d+)(?:[eE][+-]?\d+)?)"
    r"|(?P<literal>\{[^{}]*\})"
    r"|(?P<quoted>`[^`]+`)"
    r"|(?P<name>[^\W\d_][^\W_]*'*(?:_[^\W_]+'*)*)"
    rf"|(?P<op>{_SIGNS})"
)

_LITERAL = re.compile(r"\{(-?)(\d+)(?:\.(\d*))?(?:/(\d+)(\.?))?\}")
_ENDS = frozenset({"NUMBER", "NAME", "RPAR", "RBAR", "CONSTANT"})
_STARTS = frozenset({"NUMBER", "NAME", "LPAR", "LBAR", "CONSTANT", "FUNCTION", "ROOT"})
_BREAKS = frozenset({"PLUS", "MINUS", "TIMES", "RELATION", "COMMA", "AND", "OR", "NOT"})


def tokenize(text: str, symbols: frozenset[str] | None, *, loose: bool = False) -> list[Token]:
    """Return the tokens of a formula, with ``JOIN`` where juxtaposition is a product.

    Parameters
    ----------
    text : str
        Decimal point, ASCII digits.
    symbols : frozenset of str or None
        Declared names; None takes any name and allows no juxtaposition of names.
    loose : bool
        A student's spelling: ``k1`` for ``k_1``, Greek letters, ``R`` for ``r`` stays an error.

    Raises
    ------
    FormulaReadError
        If a character or a name is not part of the grammar.
    """
    pieces = _split_tokens(text, symbols, loose=loose)
    if "|" in text:
        pieces = _direct_bars(pieces)
    return _insert_implied_products(pieces, named=symbols is not None)


def _split_tokens(text: str, symbols: frozenset[str] | None, *, loose: bool) -> list[Token]:
    """Return the tokens without implied products.

    Raises
    ------
    FormulaReadError
        At the first character or name that is not part of the grammar.
    """
    found: list[Token] = []
    position = 0
    for match in TOKEN.finditer(text):
        if match.start() != position:
            break
        position = match.end()
        if match.lastgroup == "name":
            found += _split_name_tokens(match, symbols, loose=loose)
        elif match.lastgroup == "quoted":
            found.append(_make_quoted_name(match, symbols))
        elif match.lastgroup != "space":
            found.append(_make_token(match))
    if position < len(text):
        raise FormulaReadError("bad-character", position + 1, text[position])
    return found


def _make_token(match: re.Match[str]) -> Token:
    """Return the token of a number, relation or sign."""
    word, column, kind = match[0], match.start() + 1, match.lastgroup
    if kind == "number":
        return Token("NUMBER", parse_number_literal(word, column), word, column)
    if kind == "literal":
        return Token("NUMBER", _parse_braced_literal(word, column), word, column)
    if word in RELATIONS:
        return Token("RELATION", RELATIONS[word], word, column)
    return Token(OPERATORS[word], word, word, column)


def _make_quoted_name(match: re.Match[str], symbols: frozenset[str] | None) -> Token:
    """Return the token of a name in back quotes.

    Raises
    ------
    FormulaReadError
        If it is not declared.
    """
    word, column = match[0], match.start() + 1
    name = word[1:-1]
    if symbols is not None and name not in symbols:
        raise FormulaReadError("unknown-name", column, name, sorted(symbols))
    return Token("NAME", name, word, column)


def _split_name_tokens(
    match: re.Match[str], symbols: frozenset[str] | None, *, loose: bool
) -> list[Token]:
    """Return the tokens of a word: a name, keyword, constant, function, or several names.

    Raises
    ------
    FormulaReadError
        If it is none of them, or can be split in two ways.
    """
    word, column = match[0], match.start() + 1
    if symbols is not None and word in symbols:
        return [Token("NAME", word, word, column)]
    if word in KEYWORDS:
        return [Token(word.upper(), word, word, column)]
    if word in CONSTANTS:
        return [Token("CONSTANT", CONSTANTS[word], word, column)]
    known = FUNCTIONS if loose else FUNCTIONS | LIST_FUNCTIONS
    if word in known and match.string[match.end() :].lstrip().startswith("("):
        return [Token("FUNCTION", word, word, column)]
    if symbols is None:
        return [Token("NAME", word, word, column)]
    return _split_declared_names(word, column, symbols, loose=loose)


def _split_declared_names(
    word: str, column: int, symbols: frozenset[str], *, loose: bool
) -> list[Token]:
    """Return the tokens of a word that is one loosely spelt name, or a product of names.

    Raises
    ------
    FormulaReadError
        If it is neither, or can be split in two ways.
    """
    table = spellings(symbols)
    single = table.get(word, table.get(fold_name(word))) if loose else None
    ways = [[single]] if single else split_product(word, symbols)
    if not ways:
        raise FormulaReadError("unknown-name", column, word, sorted(symbols))
    if len(ways) > 1:
        raise FormulaReadError("two-readings", column, word, ["·".join(way) for way in ways])
    return [Token("NAME", name, word, column) for name in ways[0]]


def parse_number_literal(word: str, column: int = 1) -> Num:
    """Return an unsigned decimal literal such as ``2``, ``2.50`` or ``1e-3`` exactly.

    Raises
    ------
    FormulaReadError
        If it has too many digits or too large an exponent.
    """
    mantissa, _, exponent = word.lower().partition("e")
    if len(mantissa) > LONGEST_NUMBER or len(exponent) > 5:
        raise FormulaReadError("number-too-long", column, word)
    if exponent and not SMALLEST_EXPONENT <= int(exponent) <= LARGEST_EXPONENT:
        raise FormulaReadError("number-too-large", column, word)
    value = Fraction(f"{mantissa or 0}e{exponent or 0}")
    return Num(value, "." in mantissa or value.denominator != 1)


def _parse_braced_literal(word: str, column: int) -> Num:
    """Return the number of ``{-1/3}`` or ``{-0.5}``, as the printer writes them.

    Raises
    ------
    FormulaReadError
        If it is none, too long, or divides by 0.
    """
    match = _LITERAL.fullmatch(word)
    if match is None or len(word) > 2 * LONGEST_NUMBER or (match[4] and not int(match[4])):
        raise FormulaReadError("bad-number", column, word)
    sign, whole, decimals, below, flag = match.groups()
    value = Fraction(f"{sign}{whole}.{decimals or 0}") / int(below or 1)
    return Num(value, decimals is not None or bool(flag))


def _direct_bars(pieces: list[Token]) -> list[Token]:
    """Return the tokens with each ``|`` as the one that opens or closes an absolute value."""
    result: list[Token] = []
    for piece in pieces:
        if piece.kind == "BAR":
            closes = bool(result) and result[-1].kind in _ENDS
            kind = "RBAR" if closes else "LBAR"
            result.append(Token(kind, piece.value, piece.text, piece.column))
        else:
            result.append(piece)
    return result


def _insert_implied_products(pieces: list[Token], *, named: bool) -> list[Token]:
    """Return the tokens with ``JOIN`` between operands that stand side by side.

    Raises
    ------
    FormulaReadError
        Where that cannot be meant.
    """
    result: list[Token] = []
    for piece in pieces:
        if result and result[-1].kind in _ENDS and piece.kind in _STARTS:
            _allow_join(result[-1], piece, named=named)
            result.append(Token("JOIN", "*", piece.text, piece.column))
        result.append(piece)
    return result


def _allow_join(left: Token, right: Token, *, named: bool) -> None:
    """Check that two operands side by side can be a product.

    Raises
    ------
    FormulaReadError
        For a number behind another, which is a slip, and for a name that is not declared, which
        could be a misspelt function.
    """
    if right.kind == "NUMBER":
        raise FormulaReadError("unexpected", right.column, right.text, ["OPERATOR"])
    if not named and left.kind == "NAME":
        code = "unknown-function" if right.kind == "LPAR" else "unexpected"
        raise FormulaReadError(code, left.column, left.text, ["OPERATOR"])


def find_ambiguous_division(pieces: list[Token]) -> Token | None:
    """Return the token where ``a/b c`` could mean ``(a/b) c`` or ``a/(b c)``, else None.

    A denominator in brackets is complete: ``1/(2 b) c`` is a product.
    """
    after_slash = [False]
    for piece, following in pairwise([*pieces, Token("END", "", "", 0)]):
        if piece.kind == "SLASH":
            after_slash[-1] = following.kind != "LPAR"
        elif piece.kind in _BREAKS:
            after_slash[-1] = False
        elif piece.kind in {"LPAR", "LBAR"}:
            after_slash.append(False)
        elif piece.kind in {"RPAR", "RBAR"} and len(after_slash) > 1:
            after_slash.pop()
        elif piece.kind == "JOIN" and after_slash[-1]:
            return piece
    return None

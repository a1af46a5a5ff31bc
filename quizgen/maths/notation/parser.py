"""The formula grammar and its parser.

::

    either:   both (OR both)*
    both:     truth (AND truth)*
    truth:    NOT truth | relation
    relation: sum (RELATION sum)*
    sum:      signed ((PLUS | MINUS) signed)*
    signed:   (PLUS | MINUS) signed | product
    product:  joined ((TIMES | SLASH) factor)*
    factor:   (PLUS | MINUS) factor | joined
    joined:   power (JOIN power)*
    power:    atom (POWER exponent)?
    exponent: (PLUS | MINUS) exponent | power
    atom:     NUMBER | NAME | CONSTANT | ROOT atom | LPAR either RPAR | LBAR either RBAR
              | FUNCTION LPAR either (COMMA either)* RPAR

Rules that are begun stand in a list and not on Python's stack, so nesting cannot overflow it. A
sign ends every rule that binds tighter than the one it belongs to.
"""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Set as AbstractSet
from itertools import pairwise
from typing import Any

import msgspec

from quizgen.maths.notation.lexer import FormulaReadError, Token
from quizgen.maths.notation.names import FUNCTIONS, LIST_FUNCTIONS
from quizgen.maths.operators import BINDERS, OperatorSyntax, operators_with_syntax
from quizgen.maths.tree import Call, Expr, Sym

BRACKET, EITHER, BOTH, NEGATED, RELATION, SUM, SIGNED, PRODUCT = range(8)
FACTOR, JOINED, EXPONENT, POWER, ROOT = range(8, 13)


class _Begun(msgspec.Struct):
    """A rule that is begun: its bracket, sign in front or signs between, and operands so far."""

    rule: int
    signs: list[Token]
    operands: list[Expr]


_BETWEEN = {
    "OR": EITHER,
    "AND": BOTH,
    "RELATION": RELATION,
    "PLUS": SUM,
    "MINUS": SUM,
    "TIMES": PRODUCT,
    "SLASH": PRODUCT,
    "JOIN": JOINED,
    "POWER": POWER,
}
"""A sign between two operands, to the rule that it belongs to."""

_PREFIXES = {"NOT": NEGATED, "ROOT": ROOT}
_IN_FRONT = {PRODUCT: FACTOR, FACTOR: FACTOR, POWER: EXPONENT, EXPONENT: EXPONENT}
"""A rule that waits for an operand, to the rule of a sign in front of that; else ``SIGNED``."""

_LEAVES: dict[str, Callable[[Any], Expr]] = {
    "NUMBER": lambda number: number,
    "NAME": Sym,
    "CONSTANT": lambda name: Call(name, ()),
}
_ATOMS = _LEAVES.keys() | {"FUNCTION", "LPAR", "LBAR", "ROOT"}
_TERMS = _ATOMS | {"PLUS", "MINUS"}
_TRUTHS = _TERMS | {"NOT"}
_STARTS = {
    **dict.fromkeys((BRACKET, EITHER, BOTH, NEGATED), _TRUTHS),
    **dict.fromkeys((RELATION, SUM, SIGNED, PRODUCT, FACTOR, EXPONENT, POWER), _TERMS),
    **dict.fromkeys((JOINED, ROOT), _ATOMS),
}
"""A rule that waits for an operand, to the tokens that can begin one."""

_CLOSING = {
    "": frozenset({"$END"}),
    "LPAR": frozenset({"RPAR"}),
    "LBAR": frozenset({"RBAR"}),
    "FUNCTION": frozenset({"COMMA", "RPAR"}),
}
"""What opened a bracket, to the tokens that end a part of it."""

_FOLDED = frozenset({"min", "max"})
"""Functions of one list or of many numbers: what they are given is only known when they run."""

_SIGNS = {row.token: row for row in operators_with_syntax(OperatorSyntax.SIGN)}


def _fold_operands(begun: _Begun) -> Expr:
    """Return operands folded from the left; a run of ``+`` (or of ``*``) becomes one node."""
    result, *rest = begun.operands
    run = ""
    for sign, term in zip(begun.signs, rest, strict=True):
        row = _SIGNS[sign.kind]
        if row.name == run and row.folds and isinstance(result, Call):
            result = Call(row.name, (*result.args, term))
        else:
            result = Call(row.name, (result, term))
        run = row.name
    return result


def _build_relation_chain(begun: _Begun) -> Expr:
    """Return a relation; ``a < b < c`` becomes two, joined by "and"."""
    pairs = zip(begun.signs, begun.operands, begun.operands[1:], strict=False)
    calls = tuple(Call(str(sign.value), (first, second)) for sign, first, second in pairs)
    return calls[0] if len(calls) == 1 else Call("and", calls)


def _build_signed(begun: _Begun) -> Expr:
    """Return the operand of a sign, negated if that is a minus."""
    (operand,) = begun.operands
    return operand if begun.signs[0].kind == "PLUS" else Call("neg", (operand,))


def _make_call_builder(name: str) -> Callable[[_Begun], Expr]:
    """Return a function that makes a call of a rule's operands."""
    return lambda begun: Call(name, tuple(begun.operands))


_ENDED: dict[int, Callable[[_Begun], Expr]] = {
    EITHER: _make_call_builder("or"),
    BOTH: _make_call_builder("and"),
    NEGATED: _make_call_builder("not"),
    RELATION: _build_relation_chain,
    SUM: _fold_operands,
    SIGNED: _build_signed,
    PRODUCT: _fold_operands,
    FACTOR: _build_signed,
    JOINED: _make_call_builder("mul"),
    EXPONENT: _build_signed,
    POWER: _make_call_builder("pow"),
    ROOT: _make_call_builder("sqrt"),
}
"""What becomes of a rule that ends."""


class _Parser:
    """One parse: the rules begun, outermost first, and the operand that was completed last."""

    def __init__(self) -> None:
        """Begin outside of all brackets, before the first operand."""
        self.begun = [_Begun(BRACKET, [], [])]
        self.last: Expr | None = None
        self.function: Token | None = None

    def start(self, piece: Token) -> None:
        """Take the first token of an operand.

        Raises
        ------
        FormulaReadError
            If no operand begins with it.
        """
        kind, rule = piece.kind, self.begun[-1].rule
        if kind not in _STARTS[rule]:
            raise self._make_unexpected_error(piece)
        if kind in _LEAVES:
            self.last = _LEAVES[kind](piece.value)
        elif kind == "FUNCTION":  # the lexer calls a name so only in front of a bracket
            self.function = piece
        elif kind in {"LPAR", "LBAR"}:
            self.begun.append(_Begun(BRACKET, [self.function or piece], []))
            self.function = None
        else:
            begun = _PREFIXES.get(kind) or _IN_FRONT.get(rule, SIGNED)
            self.begun.append(_Begun(begun, [piece], []))

    def go_on(self, piece: Token, last: Expr) -> None:
        """Take a sign between two operands."""
        rule = _BETWEEN[piece.kind]
        last = self._end_tighter_rules(rule, last)
        begun = self.begun[-1]
        if begun.rule == rule != POWER:
            begun.signs.append(piece)
            begun.operands.append(last)
        else:
            self.begun.append(_Begun(rule, [piece], [last]))
        self.last = None

    def close(self, piece: Token, last: Expr, following: str) -> None:
        """Take a token that ends a bracket or an argument.

        Raises
        ------
        FormulaReadError
            If it does not close what is open.
        """
        last = self._end_tighter_rules(BRACKET, last)
        begun = self.begun[-1]
        if piece.kind not in _CLOSING[_opened_by(begun)]:
            raise self._make_unexpected_error(piece)
        begun.operands.append(last)
        self.last = None
        if piece.kind != "COMMA":
            self.begun.pop()
            self.last = _build_bracketed(begun, following)

    def finish(self, end: Token) -> Expr:
        """Return the tree of the complete formula.

        Raises
        ------
        FormulaReadError
            If an operand or a closing bracket is missing.
        """
        if self.last is None:
            raise self._make_unexpected_error(end)
        tree = self._end_tighter_rules(BRACKET, self.last)
        if len(self.begun) > 1:
            raise self._make_unexpected_error(end)
        return tree

    def _end_tighter_rules(self, rule: int, last: Expr) -> Expr:
        """Return the operand after every rule that binds tighter has ended with it."""
        while self.begun[-1].rule > rule:
            begun = self.begun.pop()
            begun.operands.append(last)
            last = _ENDED[begun.rule](begun)
        return last

    def _make_unexpected_error(self, piece: Token) -> FormulaReadError:
        """Return the error for a token that cannot stand here, with what could."""
        code = "unfinished" if piece.kind == "$END" else "unexpected"
        return FormulaReadError(
            code, piece.column, piece.text, sorted(self._list_expected_kinds(piece.kind))
        )

    def _list_expected_kinds(self, kind: str) -> AbstractSet[str]:
        """Return what could have stood there: for a closing token another one, else anything."""
        if self.last is None:
            return _STARTS[self.begun[-1].rule]
        bracket = next(begun for begun in reversed(self.begun) if begun.rule == BRACKET)
        closing = _CLOSING[_opened_by(bracket)]
        return closing | _BETWEEN.keys() if kind in _TRUTHS else closing


def _opened_by(bracket: _Begun) -> str:
    """Return the kind of token that opened a bracket; empty for the formula itself."""
    return bracket.signs[0].kind if bracket.signs else ""


def _build_bracketed(begun: _Begun, following: str) -> Expr:
    """Return the tree of what stood in brackets: itself, a call or an absolute value.

    Raises
    ------
    FormulaReadError
        If a function has too many or too few arguments.
    """
    opened = _opened_by(begun)
    if opened == "LBAR":
        return Call("abs", tuple(begun.operands))
    if opened != "FUNCTION":
        return begun.operands[0]
    piece, count = begun.signs[0], len(begun.operands)
    name = str(piece.value)
    listed = LIST_FUNCTIONS.get(name)
    if listed and listed.least == count and name not in _FOLDED:
        return Call(listed.name, tuple(begun.operands))
    least, most = FUNCTIONS.get(name, (0, 0))
    odd = name == "piecewise" and count % 2 == 0
    if (odd or not least <= count <= most) and following != "NOT":  # that is the first slip
        raise FormulaReadError("argument-count", piece.column, piece.text)
    if name in BINDERS and not isinstance(begun.operands[0], Sym):
        raise FormulaReadError("unexpected", piece.column, piece.text, ["NAME"])
    return Call(name, tuple(begun.operands))


def build_tree(pieces: list[Token], end: int) -> Expr:
    """Return the tree of some tokens.

    Parameters
    ----------
    pieces : list of Token
        From ``lexer.tokenize``.
    end : int
        Length of the text, to point behind it when something is missing.

    Raises
    ------
    FormulaReadError
        With the column and the token kinds that could have stood there.
    """
    parser = _Parser()
    last = Token("$END", "", "", end + 1)
    for piece, following in pairwise([*pieces, last]):
        if parser.last is None:
            parser.start(piece)
        elif piece.kind in _BETWEEN:
            parser.go_on(piece, parser.last)
        else:
            parser.close(piece, parser.last, following.kind)
    return parser.finish(last)

"""The formula grammar (LALR, so nesting cannot overflow the parser's stack) and its actions."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING, Any

from quizgen.maths.notation.lexer import Piece, ReadError
from quizgen.maths.notation.names import FUNCTIONS
from quizgen.maths.operators import Typed, typed_as
from quizgen.maths.tree import Call, Expr, Num, Sym

if TYPE_CHECKING:
    from lark.exceptions import UnexpectedToken

GRAMMAR = r"""
%declare PLUS MINUS TIMES SLASH JOIN POWER LPAR RPAR COMMA RELATION AND OR NOT
%declare NUMBER NAME CONSTANT FUNCTION ROOT LBAR RBAR
?start: either
?either: both | both (OR both)+ -> either
?both: truth | truth (AND truth)+ -> both
?truth: relation | NOT truth -> negated
?relation: sum | sum (RELATION sum)+ -> relation
?sum: signed | signed ((PLUS|MINUS) signed)+ -> chain
?signed: product | MINUS signed -> minus | PLUS signed -> plus
?product: joined | joined ((TIMES|SLASH) factor)+ -> chain
?factor: joined | MINUS factor -> minus | PLUS factor -> plus
?joined: power | power (JOIN power)+ -> joined
?power: atom | atom POWER exponent -> power
?exponent: power | MINUS exponent -> minus | PLUS exponent -> plus
?atom: NUMBER -> number
     | NAME -> name
     | CONSTANT -> constant
     | FUNCTION LPAR either (COMMA either)* RPAR -> function
     | ROOT atom -> root
     | LPAR either RPAR -> group
     | LBAR either RBAR -> bars
"""

_SIGNS = {row.token: row for row in typed_as(Typed.SIGN)}


class _Actions:
    """One method per rule; ``lark`` calls them while parsing, so no parse tree is built."""

    def number(self, args: list[Any]) -> Expr:
        value: Num = args[0].value.value
        return value

    def name(self, args: list[Any]) -> Expr:
        return Sym(args[0].value.value)

    def constant(self, args: list[Any]) -> Expr:
        return Call(args[0].value.value, ())

    def function(self, args: list[Any]) -> Expr:
        piece = args[0].value
        values = tuple(args[2:-1:2])
        least, most = FUNCTIONS[piece.value]
        odd = piece.value == "piecewise" and len(values) % 2 == 0
        if odd or not least <= len(values) <= most:
            raise ReadError("argument-count", piece.column, piece.text)
        return Call(piece.value, values)

    def root(self, args: list[Any]) -> Expr:
        return Call("sqrt", (args[1],))

    def group(self, args: list[Any]) -> Expr:
        inner: Expr = args[1]
        return inner

    def bars(self, args: list[Any]) -> Expr:
        return Call("abs", (args[1],))

    def power(self, args: list[Any]) -> Expr:
        return Call("pow", (args[0], args[2]))

    def minus(self, args: list[Any]) -> Expr:
        return Call("neg", (args[1],))

    def plus(self, args: list[Any]) -> Expr:
        inner: Expr = args[1]
        return inner

    def joined(self, args: list[Any]) -> Expr:
        return Call("mul", tuple(args[::2]))

    def chain(self, args: list[Any]) -> Expr:
        """Fold from the left; a run of ``+`` (or of ``*``) becomes one node."""
        result: Expr = args[0]
        run = ""
        for sign, term in zip(args[1::2], args[2::2], strict=True):
            row = _SIGNS[sign.type]
            if row.name == run and row.folds and isinstance(result, Call):
                result = Call(row.name, (*result.args, term))
            else:
                result = Call(row.name, (result, term))
            run = row.name
        return result

    def relation(self, args: list[Any]) -> Expr:
        pairs = [
            Call(args[i].value.value, (args[i - 1], args[i + 1])) for i in range(1, len(args), 2)
        ]
        return pairs[0] if len(pairs) == 1 else Call("and", tuple(pairs))

    def negated(self, args: list[Any]) -> Expr:
        return Call("not", (args[1],))

    def both(self, args: list[Any]) -> Expr:
        return Call("and", tuple(args[::2]))

    def either(self, args: list[Any]) -> Expr:
        return Call("or", tuple(args[::2]))


@cache
def _parser() -> Any:
    from lark import Lark, Token
    from lark.lexer import Lexer

    class Pieces(Lexer):
        """Hands our tokens over to the parser."""

        def __init__(self, _conf: object) -> None:
            """Nothing to configure: the tokens are made beforehand."""

        def lex(self, lexer_state: Any, _parser_state: Any = None) -> Iterator[Token]:
            for piece in lexer_state:
                yield Token(piece.kind, piece)

    return Lark(
        GRAMMAR, parser="lalr", lexer=Pieces, transformer=_Actions(), maybe_placeholders=False
    )


def build(pieces: list[Piece], end: int) -> Expr:
    """Parse tokens into a tree.

    Parameters
    ----------
    pieces : list of Piece
        From ``lexer.tokens``.
    end : int
        Length of the text, to point behind it when something is missing.

    Raises
    ------
    ReadError
        With the column and the token kinds that could have stood there.
    """
    from lark.exceptions import UnexpectedToken, VisitError

    try:
        tree: Expr = _parser().parse(pieces)
    except UnexpectedToken as error:
        raise _unexpected(error, end) from None
    except VisitError as error:
        raise error.orig_exc from None
    return tree


def _unexpected(error: UnexpectedToken, end: int) -> ReadError:
    expected = sorted(error.accepts or error.expected)
    if isinstance(error.token.value, Piece):
        piece = error.token.value
        return ReadError("unexpected", piece.column, piece.text, expected)
    return ReadError("unfinished", end + 1, "", expected)

"""Formula lines of the content: a chain of sides, each in the grammar that students type.

The grammar has no integrals, no probability of an event and no vectors. Such a piece gets a letter
in the line and is described under ``with``::

    lines = ["B = K_m*I"]
    with.I = { integral = "L*R*V", over = "lambda" }

====================  ==========================================================================
``integral, over``    integral of a product over a variable; ``low``, ``high`` are its bounds
``apply, to``         a named function of one or more formulas: ``{ apply = "P", to = ["s*p"] }``
``tuple``             a point: ``{ tuple = ["C", "X", "0"] }``
``interval, ends``    ``{ interval = ["0", "360"], ends = "[)" }``
``bold``              a vector's letter
``quadratic``         ``{ quadratic = ["v", "Sigma"] }``: v transposed, inverse of Sigma, v
``accent, on``        ``bar``, ``hat`` or ``tilde`` on a letter that already has an index
``letter``            another spelling: ``{ letter = "𝒩" }``
====================  ==========================================================================
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import pairwise

from quizgen import typeset
from quizgen.bank.formulas import Piece, cut
from quizgen.errors import BankError, FormulaError, RenderError
from quizgen.maths.notation import parse, to_text
from quizgen.maths.tree import Call, Expr, names
from quizgen.question.shown import Maths
from quizgen.typeset.layout import SIGNS
from quizgen.typeset.nodes import ATOM, PRODUCT, Big, Func, Ident, Number, Op, Row, Scripts

Inside = Mapping[str, Piece]
"""Letter in a line to the piece it stands for."""

_SPELLED = {"!=": "≠", "<=": "≤", ">=": "≥"}
_SYMBOL = re.compile(r"\w[\w']*")
_ENDS = ("()", "(]", "[)", "[]")
_NAME = re.compile(r"[^\W\d_][^\W_]*'*(?:_[^\W_]+'*)*")


def sides(line: str, inside: Inside, where: str) -> tuple[list[str], list[Maths]]:
    """Take a line apart into relation signs and printed sides.

    Parameters
    ----------
    line : str
        Sides with relation signs between blanks, for example ``E ∝ D^2 ∝ 1/N_f^2``.
    inside : mapping
        Pieces that the grammar does not have.
    where : str
        For errors.

    Returns
    -------
    (list of str, list of Maths)
        One sign fewer than sides.

    Raises
    ------
    BankError
        Naming the place and the column.
    """
    signs, texts = cut(line)
    printed = [_SPELLED.get(sign, sign) for sign in signs]
    return printed, [side(text, inside, where) for text in texts]


def side(text: str, inside: Inside, where: str) -> Maths:
    """Print one side.

    Raises
    ------
    BankError
        Naming the place and the column.
    """
    try:
        expr = parse(text)
        leaves = {name: piece(inside[name], inside) for name in names(expr) & set(inside)}
        node = typeset.layout(expr, leaves={name: made.node for name, made in leaves.items()})
    except (FormulaError, RenderError) as error:
        raise BankError(f"{where}: {text!r}: {error}") from error
    typed = _NAME.sub(lambda m: leaves[m[0]].typed if m[0] in leaves else m[0], text)
    return Maths(node, typed)


def inline(expr: Expr) -> Maths:
    """Print a formula in a sentence; ``a = b = c`` stays one chain."""
    links = expr.args if isinstance(expr, Call) and expr.op == "and" else (expr,)
    pairs = [link for link in links if isinstance(link, Call) and link.op in SIGNS]
    joined = all(one.args[1] == other.args[0] for one, other in pairwise(pairs))
    if len(pairs) != len(links) or not joined:
        return Maths(typeset.layout(expr, inline=True), to_text(expr))
    signs = [SIGNS[link.op] for link in pairs]
    ends = [pairs[0].args[0], *(link.args[1] for link in pairs)]
    node = typeset.relation(signs, [typeset.layout(end, inline=True) for end in ends])
    return Maths(node, " ".join(_woven([to_text(end) for end in ends], signs)))


def piece(table: Piece, inside: Inside) -> Maths:
    """Print a piece that the grammar does not have.

    Raises
    ------
    RenderError
        If nothing is known by this description.
    """
    for name, make in _PIECES.items():
        if name in table:
            return make(table, {k: v for k, v in inside.items() if v is not table})
    raise RenderError(f"unknown piece {dict(table)!r} (there are {', '.join(_PIECES)})")


def _text(table: Piece, name: str) -> str:
    """One text of a description."""
    texts = _texts(table, name)
    if len(texts) != 1:
        raise RenderError(f"{name!r} is one text")
    return texts[0]


def _symbol(table: Piece, name: str) -> str:
    """One letter or name of a description: nothing that MathJax could read as a command."""
    text = _text(table, name)
    if not _SYMBOL.fullmatch(text):
        raise RenderError(f"{name} = {text!r} is no letter or name")
    return text


def _texts(table: Piece, name: str) -> Sequence[str]:
    """Texts of a description, of which there may be one."""
    if name not in table:
        raise RenderError(f"{name!r} is missing in {dict(table)!r}")
    given = table[name]
    return [given] if isinstance(given, str) else given


def _part(text: str, inside: Inside) -> Maths:
    signs, parts = sides(text, inside, "with")
    if not signs:
        return parts[0]
    node = typeset.relation(signs, [part.node for part in parts])
    return Maths(node, " ".join(_woven([part.typed for part in parts], signs)))


def _woven(parts: list[str], signs: list[str]) -> Iterator[str]:
    yield parts[0]
    for sign, part in zip(signs, parts[1:], strict=True):
        yield from (sign, part)


def _integral(table: Piece, inside: Inside) -> Maths:
    body, over = _part(_text(table, "integral"), inside), _symbol(table, "over")
    bounds = [_part(_text(table, end), inside) for end in ("low", "high") if end in table]
    sign = Big("∫", *[bound.node for bound in bounds])
    factors = body.node.items if isinstance(body.node, Row) else (body.node,)
    small = Row((Op(" "), Ident("d"), typeset.name(over)))
    ends = f"[{bounds[0].typed}, {bounds[1].typed}] " if bounds else ""
    return Maths(Row((sign, *factors, small), PRODUCT), f"∫ {ends}{body.typed} d{over}")


def _apply(table: Piece, inside: Inside) -> Maths:
    parts = [_part(text, inside) for text in _texts(table, "to")]
    head = _symbol(table, "apply")
    node = Func(_letter({"letter": head}, inside).node, tuple(part.node for part in parts))
    return Maths(node, f"{head}({', '.join(part.typed for part in parts)})")


def _tuple(table: Piece, inside: Inside) -> Maths:
    parts = [_part(text, inside) for text in _texts(table, "tuple")]
    typed = ", ".join(part.typed for part in parts)
    return Maths(typeset.fenced([part.node for part in parts]), f"({typed})")


def _interval(table: Piece, inside: Inside) -> Maths:
    parts = [_part(text, inside) for text in _texts(table, "interval")]
    ends = _text(table, "ends")
    if ends not in _ENDS:
        raise RenderError(f"ends {ends!r} (allowed: {', '.join(_ENDS)})")
    typed = f"{ends[0]}{', '.join(part.typed for part in parts)}{ends[1]}"
    return Maths(typeset.fenced([part.node for part in parts], ends), typed)


def _bold(table: Piece, inside: Inside) -> Maths:
    del inside
    text = _symbol(table, "bold")
    return Maths(Ident(text, bold=True), text)


def _quadratic(table: Piece, inside: Inside) -> Maths:
    texts = _texts(table, "quadratic")
    if len(texts) != len(("vector", "matrix")):
        raise RenderError("'quadratic' is a vector and a matrix")
    vector, matrix = (_part(text, inside) for text in texts)
    held = typeset.bracketed(vector.node, ATOM)
    inverse = Scripts(matrix.node, None, typeset.negative(Number("1")))
    turned = typeset.power(held, Op("ᵀ"))
    node = Row((turned, Op(""), inverse, Op(""), held), PRODUCT)
    return Maths(node, f"({vector.typed})^T {matrix.typed}^-1 ({vector.typed})")


def _accent(table: Piece, inside: Inside) -> Maths:
    del inside
    name = f"{_symbol(table, 'on')}_{_symbol(table, 'accent')}"
    return Maths(typeset.name(name), name)


def _letter(table: Piece, inside: Inside) -> Maths:
    del inside
    text = _symbol(table, "letter")
    return Maths(Ident(text) if len(text) == 1 else typeset.name(text), text)


_PIECES: dict[str, Callable[[Piece, Inside], Maths]] = {
    "integral": _integral,
    "apply": _apply,
    "tuple": _tuple,
    "interval": _interval,
    "bold": _bold,
    "quadratic": _quadratic,
    "accent": _accent,
    "letter": _letter,
}

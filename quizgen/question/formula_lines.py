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
from quizgen.bank.formulas import Piece, split_relations
from quizgen.core.errors import BankError, FormulaError, RenderError
from quizgen.maths.notation import format_tree, parse_formula
from quizgen.maths.tree import Call, Expr, names_in
from quizgen.typeset.layout import SIGNS
from quizgen.typeset.nodes import (
    ATOM,
    PRODUCT,
    Digits,
    Func,
    Ident,
    LargeOperator,
    MathRow,
    OperatorSign,
    Scripts,
)
from quizgen.typeset.prose import TypesetMaths

Inside = Mapping[str, Piece]
"""Letter in a line to the piece it stands for."""

_SPELLED = {"!=": "≠", "<=": "≤", ">=": "≥"}
_SYMBOL = re.compile(r"\w[\w']*")
_ENDS = ("()", "(]", "[)", "[]")
_NAME = re.compile(r"[^\W\d_][^\W_]*'*(?:_[^\W_]+'*)*")


def parse_formula_line(line: str, inside: Inside) -> tuple[list[str], list[TypesetMaths]]:
    """Return the relation signs and the typeset sides of a line.

    Parameters
    ----------
    line : str
        Sides with relation signs between blanks, for example ``E ∝ D^2 ∝ 1/N_f^2``.
    inside : mapping
        Pieces that the grammar does not have.

    Returns
    -------
    (list of str, list of TypesetMaths)
        One sign fewer than sides.

    Raises
    ------
    BankError
        Naming the side and the column.
    """
    signs, texts = split_relations(line)
    printed = [_SPELLED.get(sign, sign) for sign in signs]
    return printed, [typeset_side(text, inside) for text in texts]


def typeset_side(text: str, inside: Inside) -> TypesetMaths:
    """Return one side, typeset, with its pieces in place of their letters.

    Raises
    ------
    BankError
        Naming the side and the column.
    """
    try:
        expr = parse_formula(text)
        leaves = {
            name: typeset_piece(inside[name], inside) for name in names_in(expr) & set(inside)
        }
        node = typeset.lay_out(expr, leaves={name: made.node for name, made in leaves.items()})
    except (FormulaError, RenderError) as error:
        raise BankError(f"{text!r}: {error}", rule="QG155") from error
    typed = _NAME.sub(lambda m: leaves[m[0]].typed_text if m[0] in leaves else m[0], text)
    return TypesetMaths(node, typed)


def typeset_inline(expr: Expr) -> TypesetMaths:
    """Return a formula typeset for a sentence; ``a = b = c`` stays one chain.

    The grammar reads such a chain as ``a = b and b = c``; only where each link begins with what
    the one before it ends with is it printed as one.
    """
    links = expr.args if isinstance(expr, Call) and expr.op == "and" else (expr,)
    pairs = [link for link in links if isinstance(link, Call) and link.op in SIGNS]
    joined = all(one.args[1] == other.args[0] for one, other in pairwise(pairs))
    if len(pairs) != len(links) or not joined:
        return TypesetMaths(typeset.lay_out(expr, inline=True), format_tree(expr))
    signs = [SIGNS[link.op] for link in pairs]
    ends = [pairs[0].args[0], *(link.args[1] for link in pairs)]
    node = typeset.relation_chain(signs, [typeset.lay_out(end, inline=True) for end in ends])
    return TypesetMaths(
        node, " ".join(_interleave_signs([format_tree(end) for end in ends], signs))
    )


def typeset_piece(table: Piece, inside: Inside) -> TypesetMaths:
    """Return a piece that the grammar does not have, typeset.

    Raises
    ------
    RenderError
        If no kind of piece has this description.
    """
    for name, make in _PIECES.items():
        if name in table:
            return make(table, {k: v for k, v in inside.items() if v is not table})
    raise RenderError(f"unknown piece {dict(table)!r} (there are {', '.join(_PIECES)})")


def _require_text(table: Piece, name: str) -> str:
    """Return the one text that a description gives for ``name``.

    Raises ``RenderError`` if there is none, or a list of several.
    """
    texts = _require_texts(table, name)
    if len(texts) != 1:
        raise RenderError(f"{name!r} is one text")
    return texts[0]


def _require_symbol(table: Piece, name: str) -> str:
    """Return the letter or name that a description gives for ``name``.

    Raises ``RenderError`` for anything else: MathJax could read it as a command.
    """
    text = _require_text(table, name)
    if not _SYMBOL.fullmatch(text):
        raise RenderError(f"{name} = {text!r} is no letter or name")
    return text


def _require_texts(table: Piece, name: str) -> Sequence[str]:
    """Return the texts that a description gives for ``name``; a lone one becomes a list.

    Raises ``RenderError`` if the description has no such key.
    """
    if name not in table:
        raise RenderError(f"{name!r} is missing in {dict(table)!r}")
    given = table[name]
    return [given] if isinstance(given, str) else given


def _typeset_relation(text: str, inside: Inside) -> TypesetMaths:
    """Return a formula, or a chain of relations, typeset as one piece."""
    signs, parts = parse_formula_line(text, inside)
    if not signs:
        return parts[0]
    node = typeset.relation_chain(signs, [part.node for part in parts])
    return TypesetMaths(
        node, " ".join(_interleave_signs([part.typed_text for part in parts], signs))
    )


def _interleave_signs(parts: list[str], signs: list[str]) -> Iterator[str]:
    """Yield sides and the signs between them in turn, as they are read."""
    yield parts[0]
    for sign, part in zip(signs, parts[1:], strict=True):
        yield from (sign, part)


def _typeset_integral(table: Piece, inside: Inside) -> TypesetMaths:
    """Return ``∫ body d over``, with its bounds if the description has some."""
    body, over = (
        _typeset_relation(_require_text(table, "integral"), inside),
        _require_symbol(table, "over"),
    )
    bounds = [
        _typeset_relation(_require_text(table, end), inside)
        for end in ("low", "high")
        if end in table
    ]
    sign = LargeOperator("∫", *[bound.node for bound in bounds])
    factors = body.node.items if isinstance(body.node, MathRow) else (body.node,)
    small = MathRow((OperatorSign(" "), Ident("d"), typeset.lay_out_name(over)))
    ends = f"[{bounds[0].typed_text}, {bounds[1].typed_text}] " if bounds else ""
    return TypesetMaths(
        MathRow((sign, *factors, small), PRODUCT), f"∫ {ends}{body.typed_text} d{over}"
    )


def _typeset_application(table: Piece, inside: Inside) -> TypesetMaths:
    """Return a named function of one or more formulas."""
    parts = [_typeset_relation(text, inside) for text in _require_texts(table, "to")]
    head = _require_symbol(table, "apply")
    node = Func(_typeset_letter({"letter": head}, inside).node, tuple(part.node for part in parts))
    return TypesetMaths(node, f"{head}({', '.join(part.typed_text for part in parts)})")


def _typeset_tuple(table: Piece, inside: Inside) -> TypesetMaths:
    """Return formulas in parentheses: a point."""
    parts = [_typeset_relation(text, inside) for text in _require_texts(table, "tuple")]
    typed = ", ".join(part.typed_text for part in parts)
    return TypesetMaths(typeset.fence([part.node for part in parts]), f"({typed})")


def _typeset_interval(table: Piece, inside: Inside) -> TypesetMaths:
    """Return two bounds in the brackets that ``ends`` gives, open or closed.

    Raises ``RenderError`` for other brackets.
    """
    parts = [_typeset_relation(text, inside) for text in _require_texts(table, "interval")]
    ends = _require_text(table, "ends")
    if ends not in _ENDS:
        raise RenderError(f"ends {ends!r} (allowed: {', '.join(_ENDS)})")
    typed = f"{ends[0]}{', '.join(part.typed_text for part in parts)}{ends[1]}"
    return TypesetMaths(typeset.fence([part.node for part in parts], ends), typed)


def _typeset_bold(table: Piece, inside: Inside) -> TypesetMaths:
    """Return a letter in bold: a vector or a matrix."""
    del inside
    text = _require_symbol(table, "bold")
    return TypesetMaths(Ident(text, bold=True), text)


def _typeset_quadratic_form(table: Piece, inside: Inside) -> TypesetMaths:
    """Return ``vᵀ M⁻¹ v`` of a vector and a matrix.

    Raises ``RenderError`` unless there are two texts.
    """
    texts = _require_texts(table, "quadratic")
    if len(texts) != len(("vector", "matrix")):
        raise RenderError("'quadratic' is a vector and a matrix")
    vector, matrix = (_typeset_relation(text, inside) for text in texts)
    held = typeset.add_brackets(vector.node, ATOM)
    inverse = Scripts(matrix.node, None, typeset.negative(Digits("1")))
    turned = typeset.lay_out_power(held, OperatorSign("ᵀ"))
    node = MathRow((turned, OperatorSign(""), inverse, OperatorSign(""), held), PRODUCT)
    return TypesetMaths(
        node, f"({vector.typed_text})^T {matrix.typed_text}^-1 ({vector.typed_text})"
    )


def _typeset_accent(table: Piece, inside: Inside) -> TypesetMaths:
    """Return a letter under an accent; as typed, the accent is an index of the letter."""
    del inside
    name = f"{_require_symbol(table, 'on')}_{_require_symbol(table, 'accent')}"
    return TypesetMaths(typeset.lay_out_name(name), name)


def _typeset_letter(table: Piece, inside: Inside) -> TypesetMaths:
    """Return an upright or italic letter that the grammar would take for something else."""
    del inside
    text = _require_symbol(table, "letter")
    return TypesetMaths(Ident(text) if len(text) == 1 else typeset.lay_out_name(text), text)


_PIECES: dict[str, Callable[[Piece, Inside], TypesetMaths]] = {
    "integral": _typeset_integral,
    "apply": _typeset_application,
    "tuple": _typeset_tuple,
    "interval": _typeset_interval,
    "bold": _typeset_bold,
    "quadratic": _typeset_quadratic_form,
    "accent": _typeset_accent,
    "letter": _typeset_letter,
}

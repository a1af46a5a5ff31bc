"""Reading typed formulas: students' spelling to the author's grammar."""

from __future__ import annotations

import re
from collections.abc import Iterable
from fractions import Fraction
from functools import lru_cache

import msgspec

from quizgen.grading.reading.literals import Ambiguity, join_digit_groups, with_decimal_points
from quizgen.grading.reading.normalise import normalise_typed
from quizgen.grading.reading.numbers import relocate_error
from quizgen.grading.reading.source_map import Rewrite, SourceText
from quizgen.grading.reading.written_functions import (
    find_closing_bracket,
    write_factorials,
    write_roots_and_logs,
)
from quizgen.locale.word_patterns import WordPattern, list_tables
from quizgen.maths.notation import (
    FormulaReadError,
    find_ambiguous_division,
    format_tree,
    parse_formula,
    parse_tokens,
    pretty,
    tokenize,
)
from quizgen.maths.notation.names import FUNCTIONS, GREEK, fold_name
from quizgen.maths.operators import CONDITIONS
from quizgen.maths.tree import Call, Expr, Num

_SEVERAL = (n for n, (_, most) in FUNCTIONS.items() if most > 1 and n not in GREEK.values())
MULTI_ARGUMENT = rf"(?:{'|'.join(_SEVERAL)})"
_SYNONYMS = {
    "arctan2": "atan2",
    "arctan": "atan",
    "arctg": "atan",
    "arcsin": "asin",
    "arccos": "acos",
    "tg": "tan",
    "lg": "log10",
    "ld": "log2",
    "lb": "log2",
    "log_10": "log10",
    "log_2": "log2",
    "log_e": "ln",
    "loge": "ln",
    "Sqrt": "sqrt",
    "Abs": "abs",
    "sgn": "sign",
    "signum": "sign",
    "cosec": "csc",
    "Log": "log",
    "LN": "ln",
    "Ln": "ln",
    "Exp": "exp",
    "EXP": "exp",
    "arsinh": "asinh",
    "arcosh": "acosh",
    "artanh": "atanh",
    "arcsinh": "asinh",
    "arccosh": "acosh",
    "arctanh": "atanh",
    "Sin": "sin",
    "Cos": "cos",
    "Tan": "tan",
    "Max": "max",
    "Min": "min",
}


def _find_function(word: str) -> str:
    """Return the function that a word of some language stands for."""
    return str(next(table[word] for table in list_tables("functions") if word in table))


_WORD = re.compile(r"[^\W\d_]{2}")
"""A text without one of these names no function."""

_MARKED = re.compile(r"[°%;\[\].,π:]")
"""A text without one of these needs none of the rewrites but the first."""

FORMULA_REWRITES: dict[str, Rewrite] = {
    "function synonyms": (
        WordPattern(
            r"(?<![^\W\d_])(?:"
            + "|".join(sorted(_SYNONYMS, key=len, reverse=True))
            + r"|«functions.»)(?= ?(?:\(|\^|\*\*| [\w(]))"
        ),
        lambda m: _SYNONYMS.get(m[0]) or _find_function(m[0]),
    ),
    "degrees": (re.compile(r"(\d+(?:[.,]\d+)?) ?°"), lambda m: f"({m[1]}*pi/180)"),
    "percent": (re.compile(r"(\d+(?:[.,]\d+)?) ?%"), lambda m: f"({m[1]}/100)"),
    "semicolon arguments": (re.compile(r";"), lambda _m: ", "),
    "square brackets": (re.compile(r"[\[\]]"), lambda m: "(" if m[0] == "[" else ")"),
    "leading point": (re.compile(r"(?<![\w.,)\]'])[.,](?=\d)"), lambda _m: "0."),
    "pi": (re.compile(r"π"), lambda _m: " pi "),
    "colon": (re.compile(r"(?<=[\w)']) ?: ?(?=[\w(√])"), lambda _m: "/"),
}
"""Rewrites that only formulas need, in order."""

_NAMES, *_MARKS = FORMULA_REWRITES.values()

_EULER = re.compile(r"(?:(?<![\w'])(\d{1,60})|(?<![^\W_]))e ?(?:\^|\*\*) ?(?=[(\w-])")
"""Not behind a letter, where ``e`` belongs to a name; digits before it are a factor."""
_BARE_LOG = re.compile(r"(?<![^\W_])log(?![\w'])")
_BASELESS = re.compile(rf"{_BARE_LOG.pattern}(?! ?\([^()]*,)")
_ARGUMENTS = re.compile(rf"{MULTI_ARGUMENT} ?\([^()]*\d,\d")
_POINTED = re.compile(r"\d\.\d+,(?!\d*\.\d*,)|,\d+\.\d|,\d*\.\d")
"""A comma beside a number with a decimal point: it can only stand between arguments."""
_GROUPED = re.compile(r"\d[. ]\d{3}(?!\d)")


class TypedFormula(msgspec.Struct, frozen=True):
    """A formula as read, and the other reading if there are two."""

    tree: Expr
    other: Expr | None = None
    doubt: Ambiguity | None = None

    @property
    def read_as(self) -> str:
        """The formula as people write it, to echo."""
        return pretty.format_formula(format_tree(self.tree))


def read_formula(
    typed: str,
    symbols: Iterable[str],
    decimal: str = "auto",
    *,
    emphatic: bool = True,
    log: str = "",
) -> TypedFormula:
    """Return a typed formula over declared names, with its other reading if it has two.

    Parameters
    ----------
    typed : str
        For example ``fX/Z``, ``x' = f·X / Z``, ``r(1+k1 r²)``, ``20·log10(A/B)``.
    symbols : iterable of str
        Declared names.
    decimal : str
        The learner's decimal sign.
    emphatic : bool
        Whether a ``!`` at the end is no factorial.
    log : str
        What ``log`` without a base means, such as ``ln``; without it, it is asked back.

    Raises
    ------
    FormulaReadError
        With the column and what was expected.
    """
    declared = frozenset(symbols)
    source = normalise_typed(typed, keep_x=bool(declared & {"x", "X"}))
    source = join_digit_groups(_right_side(source))
    if log:
        source = source.substitute(_BASELESS, lambda _: log)
    source = _write_greek_names(source, declared)
    if _WORD.search(source.text):
        source = add_call_brackets(source.substitute(*_NAMES), declared)
    if _MARKED.search(source.text):
        for pattern, new in _MARKS:
            source = source.substitute(pattern, new)
    if "!" in source.text:
        source = write_factorials(source, declared, emphatic=emphatic)
    if "e" not in declared:
        source = _rewrite_euler_powers(source)
    if _WORD.search(source.text):
        source = write_roots_and_logs(source, declared, decimal)
    _refuse_bare_log(source, declared)
    return _read_number_literals(source, declared, decimal)


def _write_greek_names(source: SourceText, declared: frozenset[str]) -> SourceText:
    """Return ``s1`` as ``sigma_1``, where no declared name begins with this Latin letter."""
    aliases = _list_latin_aliases(declared)
    if not aliases:
        return source
    return source.substitute(_INDEXED, lambda m: aliases.get(f"{m[1]}_{m[2]}", m[0]))


@lru_cache(maxsize=256)
def _list_latin_aliases(declared: frozenset[str]) -> dict[str, str]:
    """Return each Latin letter with an index that can only mean one declared Greek name."""
    letters = {name[:1] for name in declared if name.partition("_")[0] not in GREEK.values()}
    indexed = [(*name.split("_", 1), name) for name in declared if name.count("_") == 1]
    found = [
        (f"{greek[0]}_{index}", name)
        for greek, index, name in indexed
        if greek in GREEK.values() and index.isdigit() and greek[0] not in letters
    ]
    meant = [alias for alias, _ in found]
    return {alias: name for alias, name in found if meant.count(alias) == 1}


_INDEXED = re.compile(r"(?<![^\W_])([a-z])_?(\d)(?![\w.,])")


def _right_side(source: SourceText) -> SourceText:
    """Return what stands behind ``u =``, where that is the only equals sign."""
    match = re.match(r"([^\W\d_][\w']*(?:\([^()]*\))?) ?(?:=|:=|≈) ?(?=\S)", source.text)
    if match is None or "=" in source.text[match.end() :]:
        return source
    return source.slice(match.end())


def _rewrite_euler_powers(source: SourceText) -> SourceText:
    """Return ``e^x`` and ``2e^(…)`` as ``exp(1)^…``, for formulas in which e is no quantity."""
    return source.substitute(_EULER, lambda m: f"{m[1] or ''}exp(1)^")


def _refuse_bare_log(source: SourceText, declared: frozenset[str]) -> None:
    """Raise if ``log`` stands without a base: fields disagree on which one is meant.

    Raises
    ------
    FormulaReadError
        ``which-base``.
    """
    match = _BARE_LOG.search(source.text)
    if match and "log" not in declared:
        raise FormulaReadError("which-base", source.column(match.start()), "log")


def _read_number_literals(
    source: SourceText, declared: frozenset[str], decimal: str
) -> TypedFormula:
    """Return the formula with its numbers read by the decimal sign, both readings if there are two.

    Raises
    ------
    FormulaReadError
        If a comma may separate arguments or mark a decimal, or the formula cannot be read.
    """
    if "," not in source.text and not _GROUPED.search(source.text):
        return TypedFormula(_parse_loose_and_tight(source, declared))
    if _ARGUMENTS.search(source.text) and decimal != "comma":
        if decimal == "auto" and not _POINTED.search(source.text):
            raise FormulaReadError(
                "two-readings", source.column(source.text.index(",")), source.text
            )
        return TypedFormula(_parse_loose_and_tight(source, declared))
    main, other, doubt = with_decimal_points(source, decimal)
    if other is None or doubt is None or (doubt.native and doubt.mark == "."):
        return TypedFormula(_parse_loose_and_tight(main, declared))
    return TypedFormula(
        _parse_loose_and_tight(main, declared), _parse_loose_and_tight(other, declared), doubt
    )


def _parse_loose_and_tight(source: SourceText, declared: frozenset[str]) -> Expr:
    """Return the tree of a formula in which ``a/b c`` has one meaning.

    Raises
    ------
    FormulaReadError
        ``two-readings`` if a product behind a division sign may belong to the denominator, or
        whatever keeps it from being read.
    """
    try:
        pieces = tokenize(source.text, declared, loose=True)
        loose = _require_formula(parse_tokens(pieces, len(source.text), tight=False))
        if find_ambiguous_division(pieces) is None:
            return loose
        tight = _require_formula(parse_tokens(pieces, len(source.text), tight=True))
    except FormulaReadError as error:
        raise _suggest_declared_name(relocate_error(error, source), declared) from None
    if tight == loose:
        return loose
    raise FormulaReadError(
        "two-readings", source.column(0), "", [format_tree(loose), format_tree(tight)]
    )


_E = Call("exp", (Num(Fraction(1)),))


def _require_formula(tree: Expr) -> Expr:
    """Return the tree with exponentials in one form.

    Raises
    ------
    FormulaReadError
        If it is a condition.
    """
    if isinstance(tree, Call) and tree.op in CONDITIONS:
        raise FormulaReadError("not-a-formula", 1)
    return _rewrite_exponentials(tree)


def _rewrite_exponentials(tree: Expr) -> Expr:
    """Return the tree with ``exp(x)`` for ``exp(1)^x``."""
    if not isinstance(tree, Call):
        return tree
    args = tuple(map(_rewrite_exponentials, tree.args))
    if tree.op == "pow" and args[0] == _E:
        return Call("exp", args[1:])
    return Call(tree.op, args)


def _suggest_declared_name(error: FormulaReadError, declared: frozenset[str]) -> FormulaReadError:
    """Return the error, with the declared name that differs from an unknown one in case only.

    Without such a name it lists all of them; a function without bracket has an error of its own.
    """
    if error.code != "unknown-name":
        return error
    same = [n for n in declared if fold_name(n).lower() == fold_name(error.found).lower()]
    if error.found in FUNCTIONS:
        return FormulaReadError("bracket-missing", error.column or 1, error.found)
    return FormulaReadError(error.code, error.column or 1, error.found, same or sorted(declared))


@lru_cache(maxsize=2048)
def parse_authored(text: str, symbols: tuple[str, ...]) -> Expr:
    """Return the tree of an author's formula, cached since a bank repeats it."""
    return parse_formula(text, symbols=symbols)


MOST = 40
"""Most functions read in one formula."""

_GREEK = "".join(GREEK)
_PLAIN = "|".join(
    sorted(
        (n for n, (_, most) in FUNCTIONS.items() if most == 1 and n not in GREEK.values()),
        key=len,
        reverse=True,
    )
)
_CALL = re.compile(
    rf"(?<![^\W\d_])(?P<name>{_PLAIN})(?![^\W\d_{_GREEK}]) ?"
    r"(?:(?:\^|\*\*) ?(?:(?P<power>\d+)|\((?P<signed>-?\d+)\)|(?P<minus>-\d+)) ?)?"
    rf"(?P<bare>(?<= )(?:\d+(?:[.,]\d+)? ?)?[^\W\d]\w*'*|(?<= )\d+(?:[.,]\d+)?|\d*[{_GREEK}]\w*'*"
    r"|(?<![\d ])\d+[a-z](?![\w(]))?"
)
_GOES_ON = re.compile(r" ?(?:[\w({\[√|/:^°']|\*\*)")
_DEGREES = re.compile(r" ?°")


def add_call_brackets(source: SourceText, declared: frozenset[str]) -> SourceText:
    """Return the text with brackets around bare arguments where only one reading exists.

    Raises
    ------
    FormulaReadError
        If there are two.
    """
    start = 0
    for _ in range(MOST):
        match = _CALL.search(source.text, start)
        if match is None:
            break
        start = match.end("name")
        if match["name"] not in declared:
            source = _rewrite_call(source, match)
    return source


def _rewrite_call(source: SourceText, match: re.Match[str]) -> SourceText:
    """Return the text with one call in brackets, a power of the function behind them.

    Raises
    ------
    FormulaReadError
        For ``sin^-1``, which is the inverse to some and the reciprocal to others.
    """
    power = match["power"] or match["signed"] or match["minus"]
    if power == "-1":
        raise FormulaReadError("two-readings", source.column(match.start()), match[0])
    if match["bare"]:
        return _bracket_bare_argument(source, match, power)
    if power and source.text[match.end() : match.end() + 1] == "(":
        end = find_closing_bracket(source.text, match.end())
        if end:
            return _write_call(source, match, source.slice(match.end() + 1, end - 1), end, power)
    return source


def _bracket_bare_argument(
    source: SourceText, match: re.Match[str], power: str | None
) -> SourceText:
    """Return the text with ``sin x`` as ``sin(x)``.

    Raises
    ------
    FormulaReadError
        If more follows that may belong to the argument: ``sin x y``.
    """
    end = match.end()
    degrees = _DEGREES.match(source.text, end)
    end = degrees.end() if degrees else end
    if match["bare"] in FUNCTIONS:
        return source
    if _GOES_ON.match(source.text, end):
        raise FormulaReadError("two-readings", source.column(match.start()), match[0])
    return _write_call(source, match, source.slice(match.start("bare"), end), end, power)


def _write_call(
    source: SourceText, match: re.Match[str], argument: SourceText, end: int, power: str | None
) -> SourceText:
    """Return the text with a call written out: ``cos^4 θ`` becomes ``cos(θ)^(4)``."""
    behind = f")^({power})" if power else ")"
    at = source.column(match.start())
    text = f"{match['name']}({argument.text}{behind}"
    columns = (at,) * (len(match["name"]) + 1) + argument.columns + (at,) * len(behind)
    return SourceText(
        source.text[: match.start()] + text + source.text[end:],
        source.columns[: match.start()] + columns + source.columns[end:],
    )

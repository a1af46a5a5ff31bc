"""Reading a derivation: lines of equations, with arrows, continued sides, and words among them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import pairwise

import msgspec

from quizgen.core.errors import FormulaError
from quizgen.grading.judging.relations import Relation
from quizgen.grading.reading.formulas import TypedFormula, read_formula
from quizgen.grading.reading.normalise import refuse_invisible, refuse_long_prose
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.reading.units import listed_unit, read_unit
from quizgen.locale.word_patterns import WordPattern
from quizgen.maths.notation import FormulaReadError, format_tree, pretty
from quizgen.maths.notation.names import CONSTANTS, FUNCTIONS, GREEK, NAME, fold_name, split_product
from quizgen.maths.numbers import to_fraction
from quizgen.maths.tree import Call, Expr, Num, Sym
from quizgen.maths.units import format_unit

MOST_LINES = 40
"""Most lines of a derivation."""
MOST_RELATIONS = 60
"""Most equations in them."""

SIGNS = {
    "=": "eq", "==": "eq", ":=": "eq", "≈": "eq", "≃": "eq", "≅": "eq", "~=": "eq",
    "≠": "ne", "!=": "ne", "<": "lt", "<=": "le", "≤": "le", "≦": "le",
    ">": "gt", ">=": "ge", "≥": "ge", "≧": "ge",
}  # fmt: skip
NEAR = frozenset("≈≃≅") | {"~="}
_SIGN = re.compile("|".join(map(re.escape, sorted(SIGNS, key=len, reverse=True))))

_LATEX = (
    (re.compile(r"\\\\(?:\[[^\]]*\])?|\\newline\b"), "\n"),
    (re.compile(r"\\(?:begin|end)\{[^}]*\}|\\(?:left|right)(?=[()\[\]|.])\.?|\$+|&|\\[,;!:]"), " "),
    (re.compile(r"\\q?quad\b|\\displaystyle\b"), " "),
    (re.compile(r"\\(?:Longr|R)ightarrow\b|\\implies\b"), "⇒"),
    (re.compile(r"\\(?:Longl|L)eftrightarrow\b|\\iff\b"), "⇔"),
    (re.compile(r"\\approx\b"), "≈"),
    (re.compile(r"\\leq?\b"), "≤"),
    (re.compile(r"\\geq?\b"), "≥"),
    (re.compile(r"\\therefore\b"), "∴"),
)
"""What stands between formulas in LaTeX; what stands in them is read with them."""

_ARROW = WordPattern(
    r"<=+>|<-+>|⇔|⟺|↔|⟷|=+>|⇒|⟹|(?<=\S)[ ,]+(?:«so»|«then»)[ ,:]+(?=\S)", re.IGNORECASE
)
_TENDS = re.compile(r"\S\s*(?:->|→|⟶|\\to\b)")
_BOTH_WAYS = re.compile(r"<=+>|<-+>|⇔|⟺|↔|⟷")
_START = WordPattern(
    r"(?:\(?\d{1,2}[.)](?=\s)|[•*∴→⟶]|-{1,2}>|L\d{1,2}:)\s*"
    r"|(?:«so»|«then»)"
    r"(?![^\W\d_]|[\u0980-\u09ff])[,:]?\s*",
    re.IGNORECASE,
)
_OPERATION = WordPattern(
    r"\s(?:\|\||\|)\s*(?=[-+*/:·×÷^√(]|sqrt|ln|log|«operations»)[^|]*$", re.IGNORECASE
)
"""What is done next, as it is noted behind a line: ``| · x``."""
_CORRECTED = WordPattern(
    r"^.*[=<>].*[,.…] ?(?:«choices.correcting»),? (?=[^=<>]*[=<>])", re.IGNORECASE
)
"""A line and the word that takes it back, before the one that is meant: ``n = 5, no, n = 25``."""
_ALTERNATIVE = WordPattern(r"[\d)\w] (?:«choices.or»)(?![^\W\d_]) [\d(\w]", re.IGNORECASE)
"""Two values of which one is meant."""
_TAKEN_BACK = WordPattern(
    r"^(?:«choices.not»|«choices.never») |"
    r"\d\S* (?:(?:«choices.is») )?(?:«choices.wrong»|«choices.isnt»)\W*$",
    re.IGNORECASE,
)
"""An equation that is denied as a whole."""
_COMMENT = re.compile(r"\s(?://|#).*$")
_WORD = re.compile(r"(?<![\\\w'])[^\W\d_]{2,}(?!\w*\()|[\u0980-\u09e5\u09f0-\u09ff]{2,}")
_SEVERAL = WordPattern(r",\s+(?=\S)|\s+«and»\s+")
_APPLIED = re.compile(r"(?<![\w'])([^\W\d]\w*'*)\(\s*-?\s*[^\W\d]\w*'*\s*\)")
"""A name before one name in brackets: a function of it, or a product."""
_NEW_LETTER = frozenset(GREEK.values()) | frozenset(GREEK)
_OPERATOR = re.compile(r"[-+*/^()·×\d√]")


class DerivedLine(msgspec.Struct, frozen=True):
    """One line as it was read.

    Parameters
    ----------
    number : int
        From 1, among the lines that are not blank.
    relations : tuple of Relation
        What it states; empty if it is words.
    others : tuple of Relation
        The same by the other reading of a comma or point, if it has two.
    words : str
        The words in it.
    both_ways : bool
        Whether an arrow before it says that it is equivalent to the line before.
    defines : tuple of (str, int)
        Names that nobody declared, and the place of the relation that says what each is.
    """

    number: int
    relations: tuple[Relation, ...] = ()
    others: tuple[Relation, ...] = ()
    words: str = ""
    both_ways: bool = False
    defines: tuple[tuple[str, int], ...] = ()

    @property
    def display_text(self) -> str:
        """The line as it is shown back."""
        if not self.relations:
            return self.words
        return "; ".join(map(_show_relation, self.relations))


def _show_relation(relation: Relation) -> str:
    """Return a relation as it is shown back, about equal sides with their sign."""
    shown = pretty.format_formula(format_tree(relation.tree))
    return shown.replace(" = ", " ≈ ", 1) if relation.near else shown


class LineReadError(Exception):
    """Raised for a line that cannot be read: which one, and why."""

    def __init__(self, number: int, why: FormulaReadError) -> None:
        """Take the line's number and what is wrong in it."""
        super().__init__(number, why)
        self.number, self.why = number, why


class DerivationReader:
    """Reads the lines of one derivation in order, remembering what may be left out or is new.

    Parameters
    ----------
    symbols : mapping of str to object
        Declared names.
    decimal : str
        The learner's decimal sign.
    first : Expr
        The left side of a line that is a formula alone, where no line before it has one.
    unit : str
        In which numbers stand; one that is typed behind a number is converted to it.
    """

    def __init__(
        self, symbols: Mapping[str, object], decimal: str, first: Expr, unit: str = ""
    ) -> None:
        """Start with the names of the question."""
        self.symbols, self.decimal, self.unit = list(symbols), decimal, unit
        self._left, self._side, self._typed = first, "", ""

    def read(self, typed: str) -> list[DerivedLine]:
        """Return the lines of a text.

        Raises
        ------
        FormulaReadError
            If there is nothing, or too much, or an invisible character.
        LineReadError
            If an equation among them cannot be read.
        """
        refuse_long_prose(typed)
        refuse_invisible(SourceText.of(typed.strip("\u200e\u200f\ufeff")), "\r\n\t\u200c\u200d")
        self._typed, pieces = typed, [*_split_lines(typed)]
        if not pieces:
            raise FormulaReadError("no-answer", 1)
        if len(pieces) > MOST_LINES:
            raise FormulaReadError("lines-many", 1, str(MOST_LINES))
        found = []
        for number, (text, both_ways, raw) in enumerate(pieces, 1):
            try:
                line = self._read_line(number, text)
            except FormulaReadError as error:
                begin = max(raw.find(self._side.strip()), 0)
                moved = FormulaReadError(
                    error.code, (error.column or 1) + begin, error.found, error.expected
                )
                raise LineReadError(number, moved) from None
            found.append(msgspec.structs.replace(line, both_ways=both_ways))
            if sum(len(one.relations) for one in found) > MOST_RELATIONS:
                raise FormulaReadError("lines-many", 1, str(MOST_LINES))
        return found

    def _read_line(self, number: int, text: str) -> DerivedLine:
        """Return one line: as it stands, else without the words around it, else as words alone.

        Raises
        ------
        FormulaReadError
            If it has a sign between two sides and cannot be read.
        """
        before = [*self.symbols]
        if _SIGN.search(text) and (_ALTERNATIVE.search(text) or _TAKEN_BACK.search(text)):
            raise FormulaReadError("two-readings", 1, text[:60])
        stated = _SIGN.search(text) and not _TENDS.search(text)
        if not stated and not self._is_formula(text):
            return DerivedLine(number, words=text)
        try:
            return self._read_with_new_letter(number, text)
        except FormulaReadError as error:
            self.symbols = before
            if error.code == "unit-other":
                raise
            words = [*self._iter_words(text)]
            inner = self._cut_words(text, words)
            if inner and inner != text:
                try:
                    line = self._read_relations(number, inner)
                    return msgspec.structs.replace(line, words=text)
                except FormulaReadError:
                    self.symbols = before
            if len(words) > 1:
                return DerivedLine(number, words=text)
            raise error from None

    def _read_with_new_letter(self, number: int, text: str) -> DerivedLine:
        """Return what a text states; a Greek letter that is new in it gets its meaning from it.

        Raises
        ------
        FormulaReadError
            If a side cannot be read.
        """
        try:
            return self._read_relations(number, text)
        except FormulaReadError as error:
            if error.code != "unknown-name" or error.found not in _NEW_LETTER:
                raise
            letter = GREEK.get(error.found, error.found)
            self.symbols.append(letter)
            try:
                line = self._read_relations(number, text)
            except FormulaReadError:
                self.symbols.remove(letter)
                raise
            return msgspec.structs.replace(line, defines=((letter, 0), *line.defines))

    def _is_formula(self, text: str) -> bool:
        """Return whether a text without a relation may be a formula, and is no words."""
        if any(True for _ in self._iter_words(text)) or not _OPERATOR.search(text):
            return text.strip() in self.symbols
        try:
            read_formula(text, self.symbols, self.decimal)
        except FormulaReadError:
            return False
        return True

    def _iter_words(self, text: str) -> Iterator[re.Match[str]]:
        """Yield words of a language: no names, products of names, functions or Greek letters."""
        names = frozenset(self.symbols)
        folded = {fold_name(name) for name in names}
        known = {*FUNCTIONS, *CONSTANTS, *GREEK.values(), "ln", "lg", "log", "ld", "arctan", "e"}
        for match in _WORD.finditer(text):
            word = match[0]
            if word in known or fold_name(word) in folded or split_product(word, names):
                continue
            yield match

    def _cut_words(self, text: str, words: list[re.Match[str]]) -> str:
        """Return what stands between the last word before a relation and the first behind it."""
        sign = _SIGN.search(text)
        if sign is None:
            return ""
        before = [word.end() for word in words if word.end() <= sign.start()]
        behind = [word.start() for word in words if word.start() >= sign.end()]
        cut = text[max(before, default=0) : min(behind, default=len(text))]
        cut = cut.strip(" \t,.:–-") if before or behind else cut
        return cut[:-1].rstrip(" ,") if cut.endswith("(") else cut

    def _read_relations(self, number: int, text: str) -> DerivedLine:
        """Return what a text states: one relation, a chain, or several side by side.

        Raises
        ------
        FormulaReadError
            If a side cannot be read.
        """
        found: list[tuple[Relation, Relation]] = []
        defines: list[tuple[str, int]] = []
        for piece in _split_side_by_side(text):
            sides, signs = _split_sides(piece)
            trees = [TypedFormula(self._left)] if not sides[0].strip() else []
            new = ""
            if not trees and len(sides) > 1 and self._is_new_name(sides[0]):
                new = sides[0].strip()
                trees = [TypedFormula(Sym(new))]
            trees += [self._read_side(side) for side in (sides[1:] if trees else sides)]
            if len(trees) == 1:
                trees, signs = [TypedFormula(self._left), *trees], ["="]
            self._left = trees[0].tree
            if new:
                self.symbols.append(new)
                defines.append((new, len(found)))
            found += _pair_sides(trees, signs)
        mains, others = zip(*found, strict=True)
        seconds = others if mains != others else ()
        return DerivedLine(number, mains, seconds, defines=tuple(defines))

    def _read_side(self, side: str) -> TypedFormula:
        """Return one side; it is known afterwards which one could not be read.

        Raises
        ------
        FormulaReadError
            If it cannot be read.
        """
        self._side = side
        applied = _APPLIED.search(side)
        if applied is not None and applied[1] in self.symbols:
            raise FormulaReadError("two-readings", applied.start() + 1, applied[0])
        measured = _MEASURED.fullmatch(side.strip()) if self.unit else None
        if measured is None or measured["unit"] in self.symbols:
            return read_formula(side, self.symbols, self.decimal)
        found = read_formula(measured["number"], self.symbols, self.decimal)
        return _convert(found, _compute_factor(measured["unit"], self.unit))

    def _is_new_name(self, side: str) -> bool:
        """Return whether a side is one name that nobody has declared, and no product of such."""
        name, names = side.strip(), frozenset(self.symbols)
        if not NAME.fullmatch(name) or name in FUNCTIONS or name in CONSTANTS:
            return False
        try:
            read_formula(name, names, self.decimal)
        except FormulaReadError:
            twins = [one for one in names if fold_name(one).lower() == fold_name(name).lower()]
            # ``d`` beside a declared ``D`` is another letter where both of them are used.
            return all(re.search(rf"(?<!\w){re.escape(one)}(?!\w)", self._typed) for one in twins)
        return False


_MEASURED = re.compile(r"(?P<number>.*[\d)]) ?(?P<unit>[^\W\d_][^\s\d()]*|[%°])")
"""A number, or what is worked out, with a unit behind it."""


def _compute_factor(typed: str, asked: str) -> Fraction:
    """Return how many of the asked units a typed one is.

    Raises
    ------
    FormulaReadError
        If it is none, or one of another kind.
    """
    try:
        unit = read_unit(typed)
    except FormulaError as error:
        raise FormulaReadError("unknown-unit", 1, typed) from error
    wanted = listed_unit(asked)
    if unit.dimension != wanted.dimension:
        raise FormulaReadError("unit-other", 1, format_unit(unit.text), [format_unit(asked)])
    return to_fraction(unit.factor / wanted.factor)


def _convert(found: TypedFormula, factor: Fraction) -> TypedFormula:
    """Return a formula in other units; a decimal stays one, which may be rounded."""
    if factor == 1:
        return found

    def scale(tree: Expr) -> Expr:
        """Return a number times the factor."""
        if isinstance(tree, Num):
            return Num(tree.value * factor, decimal=tree.decimal)
        return Call("mul", (tree, Num(factor)))

    other = found.other and scale(found.other)
    return msgspec.structs.replace(found, tree=scale(found.tree), other=other)


def _split_lines(typed: str) -> Iterator[tuple[str, bool, str]]:
    """Yield each line without marks in front, whether an arrow makes it equivalent, and all of it.

    Where an arrow, *so* or a semicolon stands inside a line, another one begins.
    """
    for pattern, plain in _LATEX:
        typed = pattern.sub(plain, typed)
    for raw in typed.replace("\r", "\n").replace("\t", " ").split("\n"):
        pieces = _ARROW.split(raw)
        arrows = ["", *_ARROW.findall(raw)]
        for arrow, piece in zip(arrows, pieces, strict=True):
            for place, part in enumerate(piece.split(";")):
                text = _strip_marks(_CORRECTED.sub("", part))
                if text:
                    yield text, place == 0 and bool(_BOTH_WAYS.fullmatch(arrow)), raw


def _strip_marks(piece: str) -> str:
    """Return a line without a number, bullet or *so* in front, or a note behind."""
    text = piece.strip()
    for _ in range(3):
        start = _START.match(text)
        if start is None:
            break
        text = text[start.end() :].strip()
    text = _COMMENT.sub("", f" {text}").strip()
    return _OPERATION.sub("", text).strip().rstrip(",;।").strip()


def _split_side_by_side(text: str) -> list[str]:
    """Return the relations that stand side by side in a line: ``x = 1, y = 2``."""
    pieces = [piece for piece in _SEVERAL.split(text) if piece.strip()]
    return pieces if len(pieces) > 1 and all(map(_SIGN.search, pieces)) else [text]


def _split_sides(text: str) -> tuple[list[str], list[str]]:
    """Return the sides of a chain and the signs between them.

    Raises
    ------
    FormulaReadError
        If a side is missing, other than the first.
    """
    sides, signs = _SIGN.split(text), _SIGN.findall(text)
    if any(not side.strip() for side in sides[1:]):
        raise FormulaReadError("equation-expected", 1, text[:60])
    return sides, signs


def _pair_sides(trees: list[TypedFormula], signs: list[str]) -> Iterator[tuple[Relation, Relation]]:
    """Yield the relations of a chain, each with its other reading.

    Equal things are each set equal to the first one; where other signs stand, to their neighbour.
    """
    equal = all(SIGNS[sign] == "eq" for sign in signs)
    pairs = [(trees[0], tree) for tree in trees[1:]] if equal else [*pairwise(trees)]
    for sign, (left, right) in zip(signs, pairs, strict=True):
        op, near = SIGNS[sign], sign in NEAR
        yield (
            Relation(op, left.tree, right.tree, near),
            Relation(op, left.other or left.tree, right.other or right.tree, near),
        )

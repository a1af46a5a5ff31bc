"""Named rewrites from what people type or paste to the characters of the formula grammar.

Each rewrite does one thing and can be tested alone (``rewrite(name, text)``). The text keeps, for
every character, the column it came from, so that errors point into what was typed.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable
from functools import lru_cache

from quizgen.grading.reading.source_map import Rewrite, SourceText
from quizgen.locale import cache_words
from quizgen.locale.word_patterns import WordPattern, list_rows
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.notation.pretty import BELOW, FROM_BELOW, LOWERED

LONGEST = 200
"""Most characters in one typed formula, number or list."""

LONGEST_PROSE = 4000
"""Most characters in free text and program output."""

_DIRECTION = "\u200e\u200f\u061c\u202a-\u202e\u2066-\u2069\ufeff"
_BLANKS = "\t \u00a0\u2000-\u200a\u202f\u205f\u3000"


BANGLA_LETTERS = str.maketrans("কখগঘঙচছজঝঞ", "ABCDEFGHIJ")
BANGLA_DIGITS = str.maketrans("০১২৩৪৫৬৭৮৯", "0123456789")
"""Letters that count options in Bangla, and the Latin ones in the same places."""

LONE_LETTER = re.compile("(?<![\u0980-\u09ff])[ক-ঞ](?![\u0980-\u09ff])")
"""A Bangla letter that is no part of a word."""

PICTURES = WordPattern(r"(?:(?<=[\s,;])|(?<=[:=()→–-])|^)«pictures»(?=\s|$)", re.IGNORECASE)
"""Words before the number of a picture, which is its place or its label."""

_ABOUT = WordPattern(r"^ *(?:≈|~|∼|=|«about»(?![^\W\d_])) *", re.IGNORECASE)

_IS = r"(?: *«is»(?![^\W_]) *[:=]? *| *(?:[:=]|«colon») *)"
ANSWER = WordPattern(
    r"^ *(?:«the-or-my» )?"
    rf"(?:«answer»(?![^\W_])\.?(?:{_IS}| +)|«result»(?![^\W_]){_IS})(?=\S)",
    re.IGNORECASE,
)
"""What stands before an answer that is a sentence."""

_X = re.compile(r"(?<=[\d)])(?<!^0)(?<![^\d.,]0) *[xXхХ] *(?=\d)")


@cache_words
def _list_exponents() -> dict[str, int]:
    """Return the words that are a power of ten behind a number, with its exponent: ``lakh``."""
    return {word.lower(): len(size) - 1 for size, word in list_rows("numbers.multiples")}


def _make_character_replacer(pairs: dict[str, str]) -> Callable[[re.Match[str]], str]:
    """Return a replacement for single characters."""
    return lambda match: pairs[match[0]]


def _rewrite_vulgar_fraction(match: re.Match[str]) -> str:
    """Return ``½`` as ``(1/2)``, and ``1½`` as ``(1+1/2)``."""
    digits = unicodedata.normalize("NFKC", match[2]).replace("⁄", "/")
    return f"({match[1]}+{digits})" if match[1] else f"({digits})"


def _on_line(match: re.Match[str]) -> str:
    """Return a subscript on the line; behind a prime it needs an underscore to stay one name."""
    below = match[0].translate(FROM_BELOW)
    return f"_{below}" if match.string[match.start() - 1 : match.start()] == "'" else below


_RAISED_MINUS = LOWERED | str.maketrans("−–", "--")
"""Raised signs on the line, and the minus that no keyboard raises: ``10-²``."""

REWRITES: dict[str, Rewrite] = {
    "direction marks around": (re.compile(f"^[{_DIRECTION}]+|[{_DIRECTION}]+$"), lambda _m: ""),
    "blanks": (re.compile(f"[{_BLANKS}]"), lambda _m: " "),
    "letters with a dot": (
        re.compile("[\u09dc\u09dd\u09df]"),
        lambda m: unicodedata.normalize("NFC", m[0]),
    ),
    "digits": (
        re.compile(r"[^\W0-9A-Za-z_²³¹]"),
        lambda m: str(unicodedata.decimal(m[0], m[0])),
    ),
    "full-width forms": (re.compile(r"[！-～]"), lambda m: chr(ord(m[0]) - 0xFEE0)),
    "minus and dashes": (re.compile(r"[−‐‑‒–—﹣⁻](?![⁰¹²³⁴⁵⁶⁷⁸⁹])"), lambda _m: "-"),
    "degrees": (re.compile(r"[º˚]"), lambda _m: "°"),
    "times": (re.compile(r"[×·∙⋅∗✕✖•⨯]"), lambda _m: "*"),
    "division": (re.compile(r"[÷∕∶⁄]"), lambda _m: "/"),
    "decimal marks": (re.compile(r"[٫˙]"), lambda _m: "."),
    "quotes and primes": (re.compile(r"[′’‘ʹ`´]"), lambda _m: "'"),
    "double primes": (re.compile(r"[″]"), lambda _m: "''"),
    "semicolons": (re.compile(r"[；؛]"), lambda _m: ";"),
    "angle brackets": (
        re.compile(r"[⟨⟩〈〉]"),
        _make_character_replacer(dict(zip("⟨⟩〈〉", "()()", strict=True))),
    ),
    "superscripts": (
        re.compile(r"(?:[⁺⁻−]|(?<=10)[-–])?[⁰¹²³⁴⁵⁶⁷⁸⁹]+"),
        lambda m: "^" + (f"({t})" if len(t := m[0].translate(_RAISED_MINUS)) > 1 else t),
    ),
    "subscripts": (re.compile(f"[{BELOW}]+"), _on_line),
    "vulgar fractions": (re.compile(r"(\d*) ?([¼-¾⅐-⅞])"), _rewrite_vulgar_fraction),
    "classifiers": (WordPattern(r"(?<=\d) ?-?«classifiers»(?=[ ;,।.]|$)"), lambda _m: ""),
    "answer": (ANSWER, lambda _m: ""),
    "about": (_ABOUT, lambda _m: ""),
    "x between numbers": (_X, lambda _m: "*"),
    "ties": (re.compile(r"(?<=\d)~(?=[^\W\d_]|[%°])"), lambda _m: " "),
    "blank before a power of ten": (
        re.compile(r"(?<![\d.,])(\d[.,]\d+) +(?=10 ?(?:\^|\*\*))"),
        lambda m: f"{m[1]}*",
    ),
    "powers of ten in words": (
        WordPattern(r"(?<=\d) ?(«numbers.multiples»)(?![^\W\d_])\.?", re.IGNORECASE),
        lambda m: f"*10^{_list_exponents()[m[1].lower()]}",
    ),
}
"""Name to pattern and replacement, in the order they are applied."""

_ALWAYS = (
    "answer",
    "about",
    "classifiers",
    "x between numbers",
    "ties",
    "powers of ten in words",
    "blank before a power of ten",
)
_RAISED = re.compile(r"[-+−–]?\d+·(?!10)\d{2,}")
_STOPS = ".;।॥"
_UNFINISHED = re.compile(r"[-+]?(?:\d+;|\d{1,3}(?:\.\d{3}){2,}\.)")
_FENCED = re.compile(r"\s*(?:```[^\W\d]\w*\n(?!\s*`)|`{1,3})([^`]*)`{1,3}\s*")
"""Marks of code in notes and chats, maybe with the name of its language in a line of its own."""
_EXOTIC = re.compile(r"[^ -~]")
_LATEX = re.compile(r"[\\${]")
"""A text without one of these holds no LaTeX."""

_CONTROL = frozenset({"Cc", "Cf", "Co", "Cs", "Cn", "Zl", "Zp"})


def apply_rewrite(name: str, text: str) -> str:
    """Return a text after one named rewrite."""
    pattern, new = REWRITES[name]
    return SourceText.of(text).substitute(pattern, new).text


def normalise_typed(typed: str, *, keep_x: bool = False, longest: int = LONGEST) -> SourceText:
    """Return a typed text after all rewrites, with the columns that it came from.

    Parameters
    ----------
    typed : str
        As the learner typed it.
    keep_x : bool
        Do not read ``3x10`` as a product (``x`` is a declared name).
    longest : int
        Cap on the length, applied before anything else looks at the text.

    Raises
    ------
    FormulaReadError
        If the text is empty, too long, or has an invisible or control character inside.
    """
    if len(typed) > longest:
        raise FormulaReadError("too-long", longest + 1, str(longest))
    source = strip_code_fence(SourceText.of(typed))
    if _EXOTIC.search(typed):
        source = _fold_characters(source)
    if _LATEX.search(source.text):
        from quizgen.grading.reading.latex import rewrite_latex

        source = rewrite_latex(source)
    if not source.text[:1].isdigit():
        source = source.substitute(*REWRITES["answer"]).substitute(*REWRITES["about"])
    if not keep_x:
        source = source.substitute(*REWRITES["x between numbers"])
        source = source.substitute(*REWRITES["ties"]).substitute(
            *REWRITES["powers of ten in words"]
        )
        source = source.substitute(*REWRITES["blank before a power of ten"])
    source = source.strip()
    if not source.text:
        raise FormulaReadError("no-answer", 1)
    return _drop_final_full_stop(source) if source.text[-1] in _STOPS else source


def strip_code_fence(source: SourceText) -> SourceText:
    """Return a text without marks of code around all of it."""
    fence = _FENCED.fullmatch(source.text) if "`" in source.text else None
    return source.slice(*fence.span(1)) if fence else source


def _drop_final_full_stop(source: SourceText) -> SourceText:
    """Return a text without the full stop of a sentence.

    ``1.000.000.`` and ``3;`` keep theirs: they may not be written out yet.
    """
    if _UNFINISHED.fullmatch(source.text):
        return source
    kept = source.slice(0, len(source.text) - 1).strip()
    return kept if kept.text else source


def _fold_characters(source: SourceText) -> SourceText:
    """Return a text with special characters in their plain spelling.

    Raises
    ------
    FormulaReadError
        If a raised point may be a decimal sign or a product, or a character is invisible.
    """
    source = source.strip(" \t\r\n\u00a0")
    if "·" in source.text and _RAISED.fullmatch(source.text):
        raise FormulaReadError("two-readings", source.column(0), source.text)
    concerned = frozenset().union(*map(_list_rewrites_for, set(source.text)))
    if "full-width forms" in concerned:  # they become characters that others are about
        concerned |= REWRITES.keys()
    for name, (pattern, new) in REWRITES.items():
        if name in concerned and name not in _ALWAYS:
            source = source.substitute(pattern, new)
    source = source.substitute(*REWRITES["classifiers"])
    refuse_invisible(source)
    return source


@lru_cache(maxsize=4096)
def _list_rewrites_for(character: str) -> frozenset[str]:
    """Return the names of the rewrites that a character needs: each looks for single ones."""
    return frozenset(name for name, (pattern, _) in REWRITES.items() if pattern.search(character))


def refuse_long_prose(typed: str) -> None:
    """Refuse sentences or program text of more than ``LONGEST_PROSE`` characters.

    Raises
    ------
    FormulaReadError
        If it is longer.
    """
    if len(typed) > LONGEST_PROSE:
        raise FormulaReadError("too-long", LONGEST_PROSE + 1, str(LONGEST_PROSE))


def refuse_invisible(source: SourceText, allowed: str = "") -> None:
    """Raise for the first control or invisible character, instead of dropping it.

    Raises
    ------
    FormulaReadError
        With the character and its column.
    """
    if source.text.isprintable():
        return
    for position, character in enumerate(source.text):
        if unicodedata.category(character) in _CONTROL and character not in allowed:
            raise FormulaReadError("bad-character", source.column(position), character)

r"""Signs, accents and alphabets of formulas in LaTeX: what each is called in LaTeX and Typst.

MathML and Typst take a sign itself; how it is read aloud stands in ``speech.toml`` of each
language, under the same character. The list in docs/formulas.md is made of these tables.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from functools import lru_cache
from itertools import product
from string import ascii_letters, digits

from msgspec import Struct

from quizgen.core.errors import RenderError

RELATIONS = {
    "≡": "equiv", "≅": "cong", "≃": "simeq", "≐": "doteq", "≔": ":=", "⪯": "preceq",
    "≺": "prec", "≻": "succ", "⪰": "succeq", "∥": "parallel", "⟂": "perp",
    "∉": "notin", "∋": "ni", "⊂": "subset", "⊃": "supset", "⊆": "subseteq", "⊇": "supseteq",
    "⊄": "not\\subset", "⊊": "subsetneq", "⊨": "models", "⊢": "vdash", "∼": "sim",
}  # fmt: skip
"""Signs between two sides to their LaTeX commands; those of ``builders.RELATIONS`` aside."""

ARROWS = {
    "←": "leftarrow", "↔": "leftrightarrow", "⇐": "Leftarrow", "⇔": "Leftrightarrow",
    "⟶": "longrightarrow", "⟵": "longleftarrow", "⟹": "implies", "⟸": "impliedby", "⟺": "iff",
    "↦": "mapsto", "⟼": "longmapsto", "↑": "uparrow", "↓": "downarrow", "⇌": "rightleftharpoons",
    "↗": "nearrow", "↘": "searrow",
}  # fmt: skip

BINARY = {
    "∩": "cap", "∪": "cup", "∖": "setminus", "∧": "land", "∨": "lor", "∘": "circ", "⊕": "oplus",
    "⊗": "otimes", "⊙": "odot", "÷": "div", "∓": "mp", "∗": "ast", "⋆": "star", "∙": "bullet",
    "△": "triangle",
}  # fmt: skip
"""Signs between two operands."""

PLAIN = {
    "¬": "neg", "∀": "forall", "∃": "exists", "∃!": "exists!", "∄": "nexists", "†": "dagger",
    "∴": "therefore", "∵": "because", "⋯": "cdots", "⋮": "vdots", "⋱": "ddots",
}  # fmt: skip
"""Signs that stand before, behind or instead of an operand."""

LETTERLIKE = {
    "∞": "infty", "∂": "partial", "∇": "nabla", "∅": "emptyset", "ℏ": "hbar", "ℓ": "ell",
    "ℜ": "Re", "ℑ": "Im", "ℵ": "aleph", "∠": "angle", "ϑ": "vartheta", "ϕ": "phi",
    "ϵ": "epsilon", "ϱ": "varrho", "ς": "varsigma", "□": "square",
}  # fmt: skip
"""What stands like a letter and is no letter of an alphabet."""

SIGN_COMMANDS = {
    sign: f"\\{command}" if command[0].isalpha() else command
    for table in (RELATIONS, ARROWS, BINARY, PLAIN)
    for sign, command in table.items()
}

LARGE = {
    "∑": "sum", "∏": "prod", "∫": "int", "∬": "iint", "∭": "iiint", "∮": "oint", "⋃": "bigcup",
    "⋂": "bigcap", "⋁": "bigvee", "⋀": "bigwedge", "∐": "coprod", "⨁": "bigoplus",
    "⨂": "bigotimes",
}  # fmt: skip
"""Signs that have bounds; those of integrals stand beside them."""
INTEGRALS = frozenset("∫∬∭∮")

FENCES = {
    "(": "(", ")": ")", "[": "[", "]": "]", "{": r"\{", "}": r"\}", "|": "|", "‖": r"\|",
    "⌊": r"\lfloor", "⌋": r"\rfloor", "⌈": r"\lceil", "⌉": r"\rceil", "⟨": r"\langle",
    "⟩": r"\rangle", ".": ".",
}  # fmt: skip
"""Brackets to how LaTeX writes them; a point is an absent one."""

GAPS = {"thin": 1 / 6, "medium": 2 / 9, "thick": 5 / 18, "quad": 1.0, "qquad": 2.0}
"""Blanks and how wide they are in em."""


class AccentSign(Struct, frozen=True):
    """A mark above or below in MathML, LaTeX, Typst, and as Unicode adds it to a letter.

    ``stretches`` is whether it is as wide as what it marks, ``below`` whether it stands below.
    """

    mark: str
    latex: str
    typst: str
    combining: str
    stretches: bool = False
    below: bool = False


ACCENTS = {
    "bar": AccentSign("¯", r"\bar", "macron", "\u0304"),
    "hat": AccentSign("ˆ", r"\hat", "hat", "\u0302"),
    "tilde": AccentSign("˜", r"\tilde", "tilde", "\u0303"),
    "vec": AccentSign("→", r"\vec", "arrow", "\u20d7"),
    "dot": AccentSign("˙", r"\dot", "dot", "\u0307"),
    "ddot": AccentSign("¨", r"\ddot", "dot.double", "\u0308"),
    "check": AccentSign("ˇ", r"\check", "caron", "\u030c"),
    "breve": AccentSign("˘", r"\breve", "breve", "\u0306"),
    "ring": AccentSign("˚", r"\mathring", "circle", "\u030a"),
    "widehat": AccentSign("ˆ", r"\widehat", "hat", "\u0302", stretches=True),
    "overline": AccentSign("¯", r"\overline", "overline", "\u0305", stretches=True),
    "underline": AccentSign("_", r"\underline", "underline", "\u0332", stretches=True, below=True),
    "arrow": AccentSign("→", r"\overrightarrow", "arrow", "\u20d7", stretches=True),
}
"""Accents by name."""


class Alphabet(Struct, frozen=True):
    """Another shape of letters: in LaTeX, in Typst, and as Unicode calls its letters."""

    latex: str
    typst: str
    unicode: tuple[str, ...]


ALPHABETS = {
    "bb": Alphabet(r"\mathbb", "bb", ("DOUBLE-STRUCK",)),
    "cal": Alphabet(r"\mathcal", "cal", ("SCRIPT",)),
    "frak": Alphabet(r"\mathfrak", "frak", ("FRAKTUR", "BLACK-LETTER")),
    "sans": Alphabet(r"\mathsf", "sans", ("SANS-SERIF",)),
    "mono": Alphabet(r"\mathtt", "mono", ("MONOSPACE",)),
}
"""Alphabets by the name that ``Ident`` has for them."""


@lru_cache(maxsize=512)
def find_styled_letter(letter: str, style: str) -> str:
    """Return the character of a letter in another alphabet.

    Examples
    --------
    >>> find_styled_letter("R", "bb"), find_styled_letter("L", "cal")
    ('ℝ', 'ℒ')

    Raises
    ------
    RenderError
        If Unicode has none.
    """
    own = re.sub("LATIN |GREEK |LETTER ", "", unicodedata.name(letter))
    for shape in ALPHABETS[style].unicode:
        for begin in ("MATHEMATICAL ", ""):
            try:
                return unicodedata.lookup(f"{begin}{shape} {own}")
            except KeyError:
                continue
    raise RenderError(f"no letter {letter!r} in the alphabet {style!r}")


def has_styled_letter(letter: str, style: str) -> bool:
    """Whether Unicode has a letter in another alphabet."""
    try:
        return bool(find_styled_letter(letter, style))
    except RenderError:
        return False


def list_formula_characters() -> frozenset[str]:
    """Return the characters that formulas can hold: signs, brackets, marks, letters."""
    tables = (SIGN_COMMANDS, LARGE, FENCES, LETTERLIKE)
    signs = {char for table in tables for sign in table for char in sign}
    marks = {accent.mark for accent in ACCENTS.values()}
    return frozenset({*signs, *marks, *_OTHER_SIGNS, *_iter_styled_letters()})


_IN_ALPHABETS = ascii_letters + digits
_OTHER_SIGNS = "⏞⏟∣°%!?≔"


def _iter_styled_letters() -> Iterator[str]:
    """Yield letters and digits in every alphabet that has them."""
    for style, letter in product(ALPHABETS, _IN_ALPHABETS):
        if has_styled_letter(letter, style):
            yield find_styled_letter(letter, style)

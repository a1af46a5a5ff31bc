"""Fonts: Source Sans 3 for words, Hind Siliguri for Bangla, STIX Two Math for formulas on pages.

The PDF takes Hind Siliguri from a pinned package; its formulas are in a font of the typesetter, its
other words in two weights of Source Sans 3, packed in ``printfonts``.
Pages embed the characters they need as WOFF2, packed in ``webfonts`` by ``tools/pack_fonts.py``
(under the licence there).
"""

from __future__ import annotations

import base64
import importlib.util
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from quizgen.core.errors import RenderError
from quizgen.core.untrusted import read_bytes
from quizgen.locale import languages_in_script
from quizgen.typeset.signs import list_formula_characters

WEB = Path(__file__).parent / "webfonts"
PRINT = Path(__file__).parent / "printfonts"
PRINT_WEIGHTS = (400, 600)
"""Regular and semibold."""
TEXT = "source-sans-3"
"""The packed font of words in Latin letters."""
MATHS, ALL_MATHS = "stix-two-math", "stix-two-math-all"
"""The packed font of formulas, and the one with all signs that LaTeX can put into them."""
MATHS_RANGE = [
    *range(0x20, 0x7F), 0xA0, 0xAC, 0xAF, 0xB0, 0xB1, 0xB5, 0xB7, 0xD7, 0xF7,
    *range(0x391, 0x3CA), 0x3D1, 0x3D5, 0x3F1, 0x3F5, 0x302, 0x303, 0x304, 0x305, 0x307,
    0x2C6, 0x2DC, 0x202F, 0x2243, 0x223C, *range(0x1D400, 0x1D434), *range(0x1D6A8, 0x1D6E2),
    0x2009, 0x200A, 0x2010, 0x2013, 0x2026, 0x2032, 0x2033, 0x203E, 0x207B,
    0x2061, 0x2062, 0x2063, 0x2064, 0x2070, *range(0x2074, 0x208F), 0xB2, 0xB3, 0xB9,
    0x210E, 0x2113, 0x2190, 0x2192, 0x2194, 0x21A6, 0x21D2, 0x2200, 0x2202, 0x2203, 0x2205, 0x2207,
    0x2208, 0x2209, 0x220F, 0x2211, 0x2212, 0x2213, 0x2217, 0x2218, 0x221A, 0x221D, 0x221E, 0x2225,
    0x2227, 0x2228, 0x2229, 0x222A, 0x222B, 0x2248, 0x2260, 0x2261, 0x2264, 0x2265, 0x226A, 0x226B,
    0x2282, 0x2286, 0x22A4, 0x22C5, 0x22EF, 0x2308, 0x2309, 0x230A, 0x230B, 0x239B, 0x239C, 0x239D,
    0x239E, 0x239F, 0x23A0, 0x23A7, 0x23A8, 0x23A9, 0x23AA, 0x23B4, 0x23B5, 0x27E8, 0x27E9,
    *range(0x1D434, 0x1D468), *range(0x1D6E2, 0x1D71C), 0x1D4A9, 0x1D6A4, 0x1D6A5,
]  # fmt: skip
"""Characters of the formulas that most pages have; the others make the font twice as large."""
ALL_MATHS_RANGE = sorted({*MATHS_RANGE, *map(ord, list_formula_characters())})
_RARE = frozenset(map(chr, {*ALL_MATHS_RANGE} - {*MATHS_RANGE}))
BANGLA = {"Regular": "hind-siliguri-400", "Bold": "hind-siliguri-700"}
"""Weight to the name of the packed font."""


def package_folder(package: str) -> Path:
    """Return the folder of an installed package, without importing it.

    Raises
    ------
    RenderError
        If the package is missing.
    """
    spec = importlib.util.find_spec(package)
    if spec is None or not spec.submodule_search_locations:
        raise RenderError(f"font package {package!r} is not installed; reinstall quizgen")
    return Path(next(iter(spec.submodule_search_locations)))


@cache
def bangla_folder() -> Path:
    """Return the folder with the Hind Siliguri fonts."""
    return next(package_folder("fontpkg_hind_siliguri").rglob("*Regular*.ttf")).parent


def bangla_file(weight: str = "Regular") -> Path:
    """Return the font file of Hind Siliguri in one weight."""
    return next(bangla_folder().glob(f"*{weight}.ttf"))


@cache
def bangla_uri(weight: str = "Regular") -> str:
    """Return the Bangla font in one weight as a data address for a page."""
    return _build_font_uri(BANGLA[weight])


def bangla_faces(langs: Iterable[str], text: str = "") -> dict[int, str]:
    """Return the Bangla fonts that a page needs for its languages or its text, by weight."""
    if not (set(langs) & set(languages_in_script("Beng")) or any(map(_is_bangla, set(text)))):
        return {}
    return {400: bangla_uri(), 700: bangla_uri("Bold")}


@cache
def text_uri() -> str:
    """Return the font of words, of all weights, as a data address for a page."""
    return _build_font_uri(TEXT)


@cache
def maths_uri() -> str:
    """Return the font of formulas as a data address for a page."""
    return _build_font_uri(MATHS)


@cache
def all_maths_uri() -> str:
    """Return the maths font with every sign for a page, as a data address."""
    return _build_font_uri(ALL_MATHS)


def has_rare_signs(page: str) -> bool:
    """Whether a page has a sign that only the larger maths font has."""
    return not _RARE.isdisjoint(page)  # a pattern of so many signs takes 20 times as long


def _build_font_uri(name: str) -> str:
    """Return a packed font as a data address."""
    return f"data:font/woff2;base64,{base64.b64encode(read_web_font(name)).decode()}"


def packed_font_path(name: str) -> Path:
    """Return the file of a packed font, which may be missing."""
    return WEB / f"{name}.woff2"


def read_web_font(name: str) -> bytes:
    """Return the bytes of a packed font.

    Raises
    ------
    RenderError
        If it is missing, or not whole: a page would show other letters without a word.
    """
    data = read_bytes(packed_font_path(name), RenderError)
    if not data.startswith(b"wOF2") or int.from_bytes(data[8:12], "big") != len(data):
        raise RenderError(f"{packed_font_path(name)}: damaged font; reinstall quizgen")
    return data


def missing_characters(text: str) -> set[str]:
    """Return the Bangla characters of a text that the font cannot show."""
    from fontTools.ttLib import TTFont

    with TTFont(bangla_file(), lazy=True) as font:
        known = font.getBestCmap()
    return {c for c in text if _is_bangla(c) and ord(c) not in known}


def _is_bangla(character: str) -> bool:
    """Return whether a character is in Unicode's block of Bangla letters."""
    return 0x0980 <= ord(character) < 0x0A00

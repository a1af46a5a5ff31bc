"""Fonts: Hind Siliguri for Bangla, and STIX Two Math for formulas on pages.

The PDF takes Hind Siliguri from a pinned package; its formulas are in a font of the typesetter.
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

WEB = Path(__file__).parent / "webfonts"
MATHS = "stix-two-math"
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
    if not (set(langs) & set(languages_in_script("Beng")) or any(map(_is_bangla, text))):
        return {}
    return {400: bangla_uri(), 700: bangla_uri("Bold")}


@cache
def maths_uri() -> str:
    """Return the font of formulas as a data address for a page."""
    return _build_font_uri(MATHS)


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

"""Fonts: Hind Siliguri for Bangla and a subset of STIX Two Math for formulas in pages.

Both come from pinned packages. Pages embed them as WOFF2; since packing takes about a second, the
result is kept in the user's cache folder under a name that changes with font and character set.
"""

from __future__ import annotations

import base64
import contextlib
import hashlib
import importlib.util
import io
import os
import sys
from functools import cache
from pathlib import Path

from quizgen.errors import RenderError
from quizgen.outside import read_bytes

BANGLA_RANGE = [*range(0x0964, 0x0966), *range(0x0980, 0x0A00), 0x200C, 0x200D, 0x25CC]
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
"""Every character that the formula printer can put into a page."""


def folder(package: str) -> Path:
    """Folder of an installed package, without importing it.

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
    """Folder with the Hind Siliguri fonts."""
    return next(folder("fontpkg_hind_siliguri").rglob("*Regular*.ttf")).parent


@cache
def maths_file() -> Path:
    """STIX Two Math."""
    return next(folder("ziamath").rglob("STIXTwoMath-Regular.ttf"))


def bangla_file(weight: str = "Regular") -> Path:
    """Hind Siliguri in one weight."""
    return next(bangla_folder().glob(f"*{weight}.ttf"))


@cache
def bangla_uri(weight: str = "Regular") -> str:
    """Bangla font for a page, as a data address."""
    return _uri(bangla_file(weight), tuple(BANGLA_RANGE))


@cache
def maths_uri() -> str:
    """Maths font for a page, as a data address."""
    return _uri(maths_file(), tuple(MATHS_RANGE))


def _uri(path: Path, characters: tuple[int, ...]) -> str:
    data = base64.b64encode(_subset_cached(path, characters)).decode()
    return f"data:font/woff2;base64,{data}"


def cache_folder() -> Path:
    """Where derived fonts are kept."""
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "quizgen"


def _subset_cached(path: Path, characters: tuple[int, ...]) -> bytes:
    source = path.read_bytes()
    name = hashlib.sha256(source + repr(characters).encode() + b"3").hexdigest()[:20]
    kept = cache_folder() / f"{name}.font"
    data = _kept(kept)
    if data is None:
        data = _subset(source, characters)
        with contextlib.suppress(OSError):  # a read-only home only costs the time again
            kept.parent.mkdir(parents=True, exist_ok=True)
            temporary = kept.with_suffix(f".{os.getpid()}")
            temporary.write_bytes(hashlib.sha256(data).digest() + data)
            temporary.replace(kept)
    return data


def _kept(path: Path) -> bytes | None:
    """A font from the cache; None if there is none, or it is not the one that was put there.

    The digest before it tells: a file cut short would change pages without a word.
    """
    try:
        content = read_bytes(path, RenderError)
    except RenderError:
        return None
    length = hashlib.sha256().digest_size
    digest, data = content[:length], content[length:]
    return data if hashlib.sha256(data).digest() == digest else None


def _subset(source: bytes, characters: tuple[int, ...]) -> bytes:
    from fontTools import subset
    from fontTools.ttLib import TTFont

    options = subset.Options()
    options.flavor = "woff2"
    options.layout_features = ["*"]
    options.recalc_timestamp = False
    font = TTFont(io.BytesIO(source), recalcTimestamp=False)
    worker = subset.Subsetter(options)
    worker.populate(unicodes=characters)
    worker.subset(font)
    font.flavor = "woff2"
    target = io.BytesIO()
    font.save(target)
    return target.getvalue()


def missing_characters(text: str) -> set[str]:
    """Bangla characters of a text that the font cannot show."""
    from fontTools.ttLib import TTFont

    with TTFont(bangla_file(), lazy=True) as font:
        known = font.getBestCmap()
    return {c for c in text if 0x0980 <= ord(c) < 0x0A00 and ord(c) not in known}

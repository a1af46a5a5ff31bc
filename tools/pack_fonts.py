"""Pack the fonts that pages embed: ``uv run python tools/do.py fonts``.

Writes into ``quizgen/render/webfonts`` the characters that pages need of Hind Siliguri and STIX Two
Math, as WOFF2. The files are kept with the package, so that no first run waits for them and no
page depends on the version of the packer.
"""

from __future__ import annotations

import io
from pathlib import Path

from fontTools import subset
from fontTools.ttLib import TTFont

from quizgen.render import fonts

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


def find_maths_font() -> Path:
    """Return the full STIX Two Math font, as a package of the dev group brings it."""
    return next(fonts.package_folder("ziamath").rglob("STIXTwoMath-Regular.ttf"))


def list_sources() -> dict[Path, tuple[Path, list[int]]]:
    """Return for each packed file the font it is made from, and its characters (code points)."""
    return {
        fonts.packed_font_path(fonts.MATHS): (find_maths_font(), MATHS_RANGE),
        **{
            fonts.packed_font_path(fonts.BANGLA[weight]): (fonts.bangla_file(weight), BANGLA_RANGE)
            for weight in fonts.BANGLA
        },
    }


def pack_font(source: Path, characters: list[int]) -> bytes:
    """Return a font as WOFF2 with only these characters and the rules that shape them.

    ``characters`` are code points. A whole font would make each page megabytes larger.
    """
    options = subset.Options()
    options.flavor = "woff2"
    options.layout_features = ["*"]
    options.recalc_timestamp = False
    font = TTFont(io.BytesIO(source.read_bytes()), recalcTimestamp=False)
    worker = subset.Subsetter(options)
    worker.populate(unicodes=characters)
    worker.subset(font)
    font.flavor = "woff2"
    target = io.BytesIO()
    font.save(target)
    return target.getvalue()


def main() -> None:
    """Write every packed font."""
    for target, (source, characters) in list_sources().items():
        target.write_bytes(pack_font(source, characters))
        print(f"{target.name}: {target.stat().st_size} bytes")


if __name__ == "__main__":
    main()

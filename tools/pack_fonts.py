"""Pack the fonts that pages and papers embed: ``uv run python tools/do.py fonts``.

Writes into ``quizgen/render/webfonts`` the characters that pages need of Hind Siliguri and STIX Two
Math, as WOFF2, and into ``quizgen/render/printfonts`` two weights of Source Sans 3 for papers. The
files are kept with the package, so that no first run waits for them and no
page depends on the version of the packer.
"""

from __future__ import annotations

import io
import re
from pathlib import Path

from fontTools import subset
from fontTools.ttLib import TTFont
from fontTools.varLib import instancer

from quizgen.render import fonts

BANGLA_RANGE = [*range(0x0964, 0x0966), *range(0x0980, 0x0A00), 0x200C, 0x200D, 0x25CC]

PRINT_RANGE = [
    *range(0x20, 0x7F), *range(0xA0, 0x180), 0x2C6, 0x2DC, *range(0x391, 0x3A2),
    *range(0x3A3, 0x3CA), 0x2009, *range(0x2010, 0x201F), *range(0x2020, 0x2023), 0x2026, 0x202F,
    0x2030, 0x2032, 0x2033, 0x2044, 0x2070, 0x2071, *range(0x2074, 0x208F), 0x20AC, 0x2116, 0x2122,
    0x2126, *range(0x2190, 0x2194), 0x2202, 0x2206, 0x220F, 0x2211, 0x2212, 0x221A, 0x221E, 0x2248,
    0x2260, 0x2264, 0x2265, 0x2713, 0x2717,
]  # fmt: skip
"""Letters of European languages and signs of sentences; formulas have a font of their own."""
PRINT_FEATURES = ["kern", "mark", "mkmk", "ccmp", "liga", "locl", "lnum"]


def find_maths_font() -> Path:
    """Return the full STIX Two Math font, as a package of the dev group brings it."""
    return next(fonts.package_folder("ziamath").rglob("STIXTwoMath-Regular.ttf"))


def list_sources() -> dict[Path, tuple[Path, list[int]]]:
    """Return for each packed file the font it is made from, and its characters (code points)."""
    return {
        fonts.packed_font_path(fonts.MATHS): (find_maths_font(), fonts.MATHS_RANGE),
        fonts.packed_font_path(fonts.ALL_MATHS): (find_maths_font(), fonts.ALL_MATHS_RANGE),
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


def pack_print_font(weight: int) -> bytes:
    """Return Source Sans 3 in one weight, as the typesetter reads it: a variable one it cannot."""
    source = next(fonts.package_folder("fontpkg_source_sans_3").rglob("SourceSans3[[]wght].ttf"))
    font = TTFont(source, recalcTimestamp=False)
    font = instancer.instantiateVariableFont(font, {"wght": weight}, updateFontNames=True)
    options = subset.Options()
    options.recalc_timestamp, options.hinting = False, False
    options.layout_features = PRINT_FEATURES
    worker = subset.Subsetter(options)
    worker.populate(unicodes=PRINT_RANGE)
    worker.subset(font)
    for record in font["name"].names:  # "Source" is reserved for the unchanged font
        text = record.toUnicode().replace("Source Sans 3", "Quizgen Sans")
        record.string = re.sub(r"SourceSans3?", "QuizgenSans", text)
    target = io.BytesIO()
    font.save(target)
    return target.getvalue()


def main() -> None:
    """Write every packed font."""
    for weight in fonts.PRINT_WEIGHTS:
        target = fonts.PRINT / f"source-sans-3-{weight}.ttf"
        target.write_bytes(pack_print_font(weight))
        print(f"{target.name}: {target.stat().st_size} bytes")
    for target, (source, characters) in list_sources().items():
        target.write_bytes(pack_font(source, characters))
        print(f"{target.name}: {target.stat().st_size} bytes")


if __name__ == "__main__":
    main()

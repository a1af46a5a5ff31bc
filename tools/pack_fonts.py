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


def main() -> None:
    """Write every packed font."""
    for target, (source, characters) in list_sources().items():
        target.write_bytes(pack_font(source, characters))
        print(f"{target.name}: {target.stat().st_size} bytes")


if __name__ == "__main__":
    main()

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


def maths_file() -> Path:
    """STIX Two Math, whole, as a package of the dev group brings it."""
    return next(fonts.package_folder("ziamath").rglob("STIXTwoMath-Regular.ttf"))


def sources() -> dict[Path, tuple[Path, list[int]]]:
    """Packed file to the font that it is made from, and the characters in it."""
    return {
        fonts.packed_font_path(fonts.MATHS): (maths_file(), fonts.MATHS_RANGE),
        fonts.packed_font_path(fonts.ALL_MATHS): (maths_file(), fonts.ALL_MATHS_RANGE),
        **{
            fonts.packed_font_path(fonts.BANGLA[weight]): (fonts.bangla_file(weight), BANGLA_RANGE)
            for weight in fonts.BANGLA
        },
    }


def pack(source: Path, characters: list[int]) -> bytes:
    """A font as WOFF2, with some of its characters and all that shapes them."""
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
    for target, (source, characters) in sources().items():
        target.write_bytes(pack(source, characters))
        print(f"{target.name}: {target.stat().st_size} bytes")


if __name__ == "__main__":
    main()

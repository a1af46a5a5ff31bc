"""Pack the letters that figures are labelled with: ``uv run python tools/do.py fonts``.

Writes into ``quizgen/figures`` the outlines that FreeType gives of the STIX fonts that ship with
matplotlib, unhinted, so that no figure waits for matplotlib and none depends on its version.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.ft2font import FT2Font, LoadFlags
from msgspec import msgpack

from quizgen.figures._letters import PACKED, UNITS, Packed

RANGES = (
    range(0x20, 0x180),  # Latin
    range(0x370, 0x400),  # Greek
    range(0x2000, 0x2150),  # punctuation, signs beside numbers, letters as signs
    range(0x2190, 0x2300),  # arrows, operators
)
SIZE = 100
FONTS = Path(mpl.get_data_path()) / "fonts" / "ttf"


def packed(name: str) -> dict[str, Packed]:
    """Every wanted letter that a font has."""
    font = FT2Font(str(FONTS / name))
    font.set_size(SIZE, 72)
    present = font.get_charmap()
    return {chr(code): letter(font, code) for span in RANGES for code in span if code in present}


def letter(font: FT2Font, code: int) -> Packed:
    """One letter, in the steps that FreeType rounds to."""
    glyph = font.load_char(code, flags=LoadFlags.NO_HINTING)
    points, codes = font.get_path()
    steps = np.round(points * (UNITS / SIZE)).astype("<i2")
    return Packed(
        glyph.linearHoriAdvance / 65536 / SIZE, steps.tobytes(), codes.astype(np.uint8).tobytes()
    )


def main() -> None:
    """Write the file."""
    fonts = ("STIXGeneral.ttf", "STIXGeneralItalic.ttf")
    PACKED.write_bytes(msgpack.encode([packed(name) for name in fonts]))
    print(f"{PACKED.name}: {PACKED.stat().st_size} bytes")


if __name__ == "__main__":
    main()

"""Draw the pictures of ``docs/figures.md`` again."""

from __future__ import annotations

import io
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import typst
from PIL import Image

from quizgen.figures import Figure, draw_figure

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "tests" / "figures"))

from documented import VALUES, load_examples  # noqa: E402
from figure_cases import FIGURES, REFERENCE, draw  # noqa: E402

SHEETS = ROOT / "docs" / "figures"
COLUMNS, A_SHEET = 3, 15
WIDTH, GAP = 330, 14
"""Points of a column and between rows."""
PPI = 96
COLOURS = 160
"""Of a sheet, which is then a fifth as large."""

Named = Sequence[tuple[str, Figure]]


def write_sheet(figures: Named, file: Path) -> None:
    """Write one PNG with all figures, each below its name."""
    cells = []
    with tempfile.TemporaryDirectory() as folder:
        for name, figure in figures:
            (Path(folder) / f"{name}.svg").write_bytes(figure.standalone_svg)
            shown = f'image("{name}.svg", width: {min(figure.width_pt, WIDTH)}pt)'
            cells.append(f"block(breakable: false)[`{name}`\\ #{shown}]")
        page = (
            "#set page(width: auto, height: auto, margin: 8pt)\n#set text(9pt)\n"
            f"#grid(columns: {COLUMNS}, gutter: {GAP}pt, {', '.join(cells)})"
        )
        (Path(folder) / "sheet.typ").write_text(page, encoding="utf-8")
        png = typst.compile(Path(folder) / "sheet.typ", format="png", ppi=PPI)
    sheet = Image.open(io.BytesIO(png)).convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
    sheet.save(file, optimize=True)
    print(f"{file.relative_to(ROOT)}: {file.stat().st_size / 1000:.0f} kB")


def main() -> None:
    """Write the sheet of documented figures and those of all built-in ones."""
    SHEETS.mkdir(exist_ok=True)
    for old in SHEETS.glob("*.png"):
        old.unlink()
    with tempfile.TemporaryDirectory() as folder:
        examples = [
            (name, draw_figure(module, VALUES.get(name, {}), quiz=False, lang="en"))
            for name, module in load_examples(Path(folder)).items()
        ]
    write_sheet(examples, SHEETS / "examples.png")
    drawn = [(name, draw(name, REFERENCE[name])) for name in FIGURES]
    for number, start in enumerate(range(0, len(drawn), A_SHEET), 1):
        write_sheet(drawn[start : start + A_SHEET], SHEETS / f"built-in-{number}.png")


if __name__ == "__main__":
    main()

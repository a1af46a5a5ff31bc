"""Write docs/units.md: the units that are built in, from the table."""

from __future__ import annotations

from pathlib import Path

from quizgen.maths.units import BASE_UNITS, DERIVED_UNITS, format_unit

PAGE = Path(__file__).parent.parent / "docs" / "units.md"

HEAD = """# Units

*For authors of questions. To look things up.*

This page is made from `quizgen/maths/units.py` by `uv run python tools/list_units.py`. Products
are written `J/(kg*K)`, `m/s^2`; a prefix is written with the unit: `mm`, `kΩ`, `µs` (or `us`). What
a bank needs beyond these it [defines](banks.md#units-of-a-bank).

| typed | printed | is | prefixes in use |
|---|---|---|---|
"""
TAIL = """
°C, °F, currencies and what is counted (pixels, electrons, stops, ...) are kinds of their own:
nobody adds them to others without knowing a zero or a rate. What is said in °C and computed in K
is drawn twice: `t = { range = [20, 80, 5], unit = "°C" }`, then
`T = { is = "t + 273.15", unit = "K" }`.

Next: [Figures](figures.md)
"""


def build_page() -> str:
    """Return the page with a row for each unit, the base units first."""
    base = [(name, "a base unit", prefixes) for name, prefixes in BASE_UNITS.items()]
    derived = [
        (name, f"{times} {format_unit(made_of)}".strip() if times != "1" else format_unit(made_of),
         prefixes)
        for name, (times, made_of, prefixes) in DERIVED_UNITS.items()
    ]  # fmt: skip
    rows = [
        f"| `{name}` | {format_unit(name)} | {said} | {_list_prefixes(prefixes)} |"
        for name, said, prefixes in (*base, *derived)
    ]
    return HEAD + "\n".join(rows) + "\n" + TAIL


def _list_prefixes(prefixes: str) -> str:
    """Return prefixes once each, micro as it is printed."""
    return " ".join(dict.fromkeys(prefixes.replace("u", "µ").replace("μ", "µ")))


def main() -> None:
    """Write the page."""
    PAGE.write_text(build_page(), "utf-8")


if __name__ == "__main__":
    main()

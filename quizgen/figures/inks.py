"""Inks of the house: names of colours, what they are on light and on dark pages."""

from __future__ import annotations

INKS: dict[str, tuple[str, str]] = {
    "ink": ("#000000", "#e9ecef"),
    "grey": ("#59626c", "#a3adb8"),
    "rule": ("#c3c9d0", "#4a535e"),
    "shade": ("#e6e9ed", "#2b323b"),
    "paper": ("#ffffff", "#15181c"),
    "blue": ("#1b4b8f", "#8fbaf5"),
    "red": ("#b8371f", "#ff9c80"),
    "teal": ("#23877b", "#6fd6c6"),
    "gold": ("#b98514", "#f0c767"),
    "pale-blue": ("#cddbee", "#21385a"),
    "pale-red": ("#f4d3ca", "#5b2b20"),
    "pale-teal": ("#c9e6e2", "#1d4a45"),
    "pale-gold": ("#f3e2b8", "#544016"),
}
"""Colour name to what it is on white paper and on a dark page.

The accents also differ in a grey print: their lightness L* is 31, 42, 51 and 59. Contrast with
white is 8.6, 5.8, 4.4 and 3.3, with the dark page at least 8.7.
"""


def _format_css_paint(name: str, light: str) -> str:
    """Return the CSS paint of an ink: a variable with its light colour, or ``currentColor``."""
    return "currentColor" if name == "ink" else f"var(--fig-{name},{light})"


PAINTS = {light: _format_css_paint(name, light) for name, (light, _) in INKS.items()}
"""Hex colour to what an SVG inside a page is painted with."""


def write_theme_css() -> str:
    """Return CSS that gives figures the colours of a dark page; black follows the text's colour.

    Paper is light even where the screen is dark: the rule is for screens alone.
    """
    rules = "; ".join(f"--fig-{name}: {dark}" for name, (_, dark) in INKS.items() if name != "ink")
    return f"@media screen and (prefers-color-scheme: dark) {{ :root {{ {rules}; }} }}\n"

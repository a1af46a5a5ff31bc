"""What a reader sees of a printed page: text, formulas on one line, tables, figures in words.

Built from the bytes of the HTML file alone. A formula becomes text as one would type it (``D_1``,
``a/b``, ``x^2``), a row of a table a line with bars, a figure its words.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from xml.etree.ElementTree import Element

import html5lib
from printed_numbers import APERTURE, named, numbers, point, quantities

DIGIT_GAP = re.compile(r"(?<=\d)\u202f(?=\d)")
SEEN = str.maketrans("−′\u202f\u2009\u00a0", "-'   ", "\u2060\u2061\u2062\u2063")
HEAVY = re.compile(r"<(style|script)\b.*?</\1>", re.DOTALL)
BLOCKS = {"p", "div", "li", "tr", "ul", "ol", "table"}
UNSEEN = {"input", "select", "label", "legend"}


@dataclass(frozen=True)
class Part:
    """One part of a question: what is asked, how it is to be answered, what there is to choose."""

    text: str
    hint: str
    options: tuple[str, ...]
    targets: tuple[str, ...]

    def those(self, wanted: Callable[[str], bool]) -> set[int]:
        """Places of the options that are wanted, counted from 1."""
        return {place for place, text in enumerate(self.options, 1) if wanted(text)}

    def saying(self, *phrases: str) -> set[int]:
        """Places of the options in which one of the phrases stands, in any language."""
        return self.those(lambda text: any(phrase in text for phrase in phrases))


@dataclass(frozen=True)
class Page:
    """One question as printed in one language."""

    stem: str
    figure: str
    parts: dict[str, Part]
    drawing: Element
    programs: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    @property
    def text(self) -> str:
        """The question as it is read: stem, figure, parts."""
        return "\n".join([self.stem, self.figure, *(part.text for part in self.parts.values())])

    @property
    def everything(self) -> str:
        """The same with all there is to choose from."""
        offered = [one for part in self.parts.values() for one in (*part.options, *part.targets)]
        return "\n".join([self.text, *offered])

    def __getitem__(self, name: str) -> Fraction:
        """The value of a name, in base units: what stands behind ``f =``."""
        return named(self.text, name)

    def point(self, name: str) -> tuple[Fraction, ...]:
        """The numbers of ``p = (...)``, in base units."""
        return point(self.text, name)

    def amounts(self, unit: str, part: str = "") -> list[Fraction]:
        """All quantities of one unit in order, in base units; without a unit all bare numbers."""
        text = self.parts[part].text if part else self.stem
        return [value for value, found in quantities(text) if found == unit]

    def ranges(self, part: str = "") -> list[tuple[Fraction, Fraction]]:
        """The ranges in square brackets, in order."""
        text = self.parts[part].text if part else self.stem
        found = re.findall(r"\[([^\[\],]*),([^\[\],]*)\]", text)
        return [(numbers(low)[0], numbers(high)[0]) for low, high in found]

    def f_numbers(self) -> list[Fraction]:
        """The f-numbers written as ``f/8``."""
        return [Fraction(one) for one in APERTURE.findall(self.stem)]

    def says(self, *phrases: str) -> bool:
        """Whether one of the phrases stands in stem or parts, in any language."""
        return any(phrase in self.text for phrase in phrases)


def pages(html: bytes) -> list[Page]:
    """The questions of a page, in order."""
    tree = html5lib.parse(HEAVY.sub("", html.decode()), namespaceHTMLElements=False)
    return [_page(node) for node in tree.iter("section")]


def _page(node: Element) -> Page:
    stem, figure, parts, drawing = "", "", {}, Element("figure")
    for child in node:
        if child.get("class") == "part":
            parts.update([_part(child)])
        elif child.tag == "figure":
            figure, drawing = _figure(child), child
        elif child.get("lang"):
            stem += text_of(child)
    programs = tuple("".join(code.itertext()) for code in node.iter("pre"))
    rows = tuple(tuple(text_of(cell).rstrip(" |") for cell in row) for row in node.iter("tr"))
    return Page(stem, figure, parts, drawing, programs, rows)


def _part(node: Element) -> tuple[str, Part]:
    body = " ".join(text_of(child) for child in node if child.get("lang"))
    place = next((child for child in node if child.get("class") == "field"), node)
    hint = " ".join(text_of(one) for one in place.iter("p") if one.get("class") == "hint")
    options = tuple(_option(one) for one in place.iter("div") if one.get("class") == "option")
    targets = tuple(text_of(one) for one in place.iter("li"))
    field = next((one.get("name") for one in place.iter() if one.get("name")), "")
    return (field or "").lstrip("0123456789") or "a", Part(body, hint, options, targets)


def _option(node: Element) -> str:
    """The wording of an option, without its letter."""
    return next(text_of(one) for one in node.iter("span") if one.get("lang"))


def _figure(node: Element) -> str:
    """The words of a figure: its description, or the caption that stands beside it."""
    names = {"title", "desc", "figcaption"}
    words = [one for one in node.iter() if _name(one) in names]
    return _clean(" ".join("".join(one.itertext()) for one in words))


def text_of(node: Element) -> str:
    """What stands in an element, on lines."""
    lines = (re.sub(r"[ \t]+", " ", line).strip() for line in _text(node).split("\n"))
    return _clean("\n".join(filter(None, lines)))


def _clean(text: str) -> str:
    return DIGIT_GAP.sub("", text).translate(SEEN)


def _name(node: Element) -> str:
    return node.tag.rpartition("}")[2] if isinstance(node.tag, str) else ""


def _text(node: Element) -> str:
    tag, kind = _name(node), node.get("class")
    if tag in UNSEEN or not tag or (tag == "span" and kind in {"hidden", "worth"}):
        return ""
    if tag in FORMULAS:
        return FORMULAS[tag](*(_text(child) for child in node))
    inside = (node.text or "") + "".join(_text(child) + (child.tail or "") for child in node)
    if tag in {"td", "th"}:
        return f" {inside} |"
    return f"\n{inside}\n" if tag in BLOCKS else inside


def _short(text: str) -> str:
    text = text.strip()
    return text if re.fullmatch(r"[\w'.]+", text) else f"({text})"


def _both(base: str, below: str, above: str) -> str:
    return f"{base}'_{below}" if above in {"'", "′"} else f"{base}_{below}^{_short(above)}"


FORMULAS: dict[str, Callable[..., str]] = {
    "msub": lambda base, below: f"{base}_{below}",
    "msup": lambda base, above: base + (above if above in {"'", "′"} else f"^{_short(above)}"),
    "msubsup": _both,
    "mfrac": lambda top, bottom: f"{_short(top)}/{_short(bottom)}",
    "msqrt": lambda *inside: f"sqrt({''.join(inside)})",
}

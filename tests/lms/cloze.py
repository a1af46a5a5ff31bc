"""Reading Moodle's embedded fields sign by sign, as its documents describe them."""

from __future__ import annotations

import html
import re
from dataclasses import dataclass, field

KINDS = (
    "NUMERICAL", "SHORTANSWER", "SHORTANSWER_C", "MULTICHOICE", "MULTICHOICE_V", "MULTICHOICE_H",
    "MULTIRESPONSE",
)  # fmt: skip


@dataclass
class Alternative:
    percent: float
    typed: str
    said: str


@dataclass
class Embedded:
    weight: int
    kind: str
    alternatives: list[Alternative] = field(default_factory=list)


def fields(text: str) -> list[Embedded]:
    """The fields of a text in their order."""
    found = []
    for start in re.finditer(r"\{(\d+):([A-Z_]+):", text):
        assert start[2] in KINDS, start[2]
        embedded = Embedded(int(start[1]), start[2])
        end = text.index("}", start.end())
        for alternative in text[start.end() : end].split("~"):
            percent, rest = re.fullmatch(r"%(-?[\d.]+)%(.+)", alternative, re.DOTALL).groups()
            # The answer ends at a "#" that does not begin with "&": that would be an entity.
            cut = re.search(r"(?<!&)#", rest)
            typed, said = (rest[: cut.start()], rest[cut.end() :]) if cut else (rest, "")
            if embedded.kind != "NUMERICAL":
                typed = html.unescape(typed)
            embedded.alternatives.append(Alternative(float(percent), typed, html.unescape(said)))
        found.append(embedded)
    return found

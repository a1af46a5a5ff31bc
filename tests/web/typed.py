"""Printed answers, as a learner puts them into the fields of a page."""

from __future__ import annotations

import re
from html.parser import HTMLParser

from quizgen.question.compose import Question, QuestionKey


def typed(question: Question, key: QuestionKey) -> dict[str, list[str]]:
    """Part to a value for each of its fields."""
    parts = zip(question.parts, key.specs, key.solution.parts, strict=True)
    return {part.field.id: _values(part.field, spec, solved.answer) for part, spec, solved in parts}


def _values(field, spec, answer: str) -> list[str]:
    control = field.control
    if control.form == "pairs":
        return [spec.pairs[mark] for mark, _ in field.options]
    if control.form == "many":
        return re.findall(r"[A-Z]", answer)
    if control.form == "truth":
        return ["true" if spec.correct == [1] else "false"]
    if control.form == "order":
        marks = answer.split()
        return marks + [""] * (len(field.options) - len(marks))
    if not control.boxes:
        return [answer]
    bare = re.sub(r"[(){}]", "", answer.partition("≈")[0]).split(";")
    pieces = [piece.rpartition("=")[2] if control.named else piece for piece in bare]
    boxes = zip(control.boxes, pieces, strict=True)
    return [piece.strip().removesuffix(box.unit).strip() for box, piece in boxes]


class Fields(HTMLParser):
    """The fields of a page: name to what each field of it takes, None where that is any text."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.found: dict[str, list[set[str] | None]] = {}
        self.ticked: dict[str, set[str]] = {}
        self._options: set[str] | None = None
        self._told = False
        self.feed(page)

    def handle_starttag(self, tag, attributes) -> None:
        given = dict(attributes)
        name = given.get("name", "")
        if tag == "input" and given.get("type") in {"radio", "checkbox"}:
            self.ticked.setdefault(name, set()).add(given["value"])
        elif tag == "textarea" or (tag == "input" and given.get("type") == "text"):
            self.found.setdefault(name, []).append(None)
        elif tag == "select":
            self._options = set()
            self.found.setdefault(name, []).append(self._options)
        elif tag == "option":
            self._told = "value" not in given
            if not self._told:
                self._options.add(given["value"])

    def handle_data(self, data) -> None:
        if self._told:
            self._options.add(data)
            self._told = False

    def take(self, name: str, values: list[str]) -> bool:
        """Whether a hand can put these values into the fields of a name."""
        if name in self.ticked:
            return set(values) <= self.ticked[name]
        fields = self.found.get(name, [])
        return len(fields) == len(values) and all(
            taken is None or value in taken for taken, value in zip(fields, values, strict=True)
        )

"""Result reports of QTI 2.1 and 3.0: what each variable of an item was given.

Sources: 1EdTech, "QTI 2.1 Results Reporting" and "QTI 3.0 Results Reporting".
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from io import StringIO
from pathlib import Path
from xml.etree import ElementTree as ET

from quizgen.core.errors import KeyFileError
from quizgen.core.untrusted import DEEPEST, MOST_VALUES
from quizgen.grading.echo import safe_echo
from quizgen.maths.notation import FormulaReadError
from quizgen.responses.attempts import LONGEST, Attempt, Lost, Response
from quizgen.responses.keys import Asked, Entry
from quizgen.responses.summaries import Values, in_places, with_unit

LARGEST = 5_000_000
"""Characters of the largest report of one person: a reader of XML looks at all that it has of a
mark whenever it is given more of it, so that a long one takes time with its square."""


def from_xml(text: str, where: Path, _known: Collection[str], _lost: Lost) -> Iterator[Attempt]:
    """The attempt of a report.

    Parameters
    ----------
    text : str
    where : pathlib.Path
        The file, for messages; its name is that of somebody whom the report does not name.

    Raises
    ------
    KeyFileError
        Naming the file and the line.
    """
    root = _tree(text, where)
    if _name(root) != "assessmentResult":
        raise KeyFileError(f"{where}: not a result report of QTI (its first element is "
                           f"{safe_echo(_name(root))})")  # fmt: skip
    who = "".join(one.get("sourcedId", "") for one in root if _name(one) == "context")
    items = {one.get("identifier", ""): one for one in root if _name(one) == "itemResult"}
    given = {name: _given(one) for name, one in items.items()}
    if any(map(_too_long, given.values())):
        raise KeyFileError(f"{where}: a text of more than {LONGEST} characters")
    responses = tuple(Response("", name, values) for name, values in given.items())
    yield Attempt(str(where), "", who.strip() or where.stem, "", responses)


def _tree(text: str, where: Path) -> ET.Element:
    """The document; one that defines entities, or is too deep or too long, is refused."""
    if len(text) > LARGEST:
        raise KeyFileError(f"{where}: larger than {LARGEST // 10**6} MB")
    if "<!DOCTYPE" in text:
        raise KeyFileError(f"{where}: a document with a DOCTYPE is not read")
    depth = 0
    root = ET.Element("")
    try:
        reader = ET.iterparse(StringIO(text), ["start", "end"])
        for count, (event, element) in enumerate(reader):
            depth += 1 if event == "start" else -1
            if depth > DEEPEST or count > MOST_VALUES:
                raise KeyFileError(f"{where}: too many elements, or too deep")
            root = element
    except ET.ParseError as error:
        line, column = error.position
        raise KeyFileError(f"{where}: line {line}, column {column + 1}: not XML") from None
    return root


def _name(element: ET.Element) -> str:
    """The name of an element, whose namespace is that of a version."""
    return element.tag.rpartition("}")[2]


def _given(item: ET.Element) -> Mapping[str, list[str]]:
    """What each variable was given: not what would be right, which may stand there too."""
    return {
        variable.get("identifier", ""): [
            value.text or ""
            for given in variable
            if _name(given) == "candidateResponse"
            for value in given
        ]
        for variable in item
        if _name(variable) == "responseVariable"
    }


def _too_long(given: Mapping[str, list[str]]) -> bool:
    return any(len(value) > LONGEST for values in given.values() for value in values)


def variables(entry: Entry, given: Mapping[str, list[str]]) -> list[Values | FormulaReadError]:
    """What each field of an entry was answered with, as ``summaries.fields`` has it."""
    return [_tried(ask, given.get(ask.name, [])) for ask in entry.asks]


def _tried(ask: Asked, given: list[str]) -> Values | FormulaReadError:
    there = [value for value in given if value.strip()]
    try:
        return _values(ask, there) if there else []
    except FormulaReadError as error:
        return error


def _values(ask: Asked, given: list[str]) -> Values:
    before = ask.name.replace("RESPONSE", "C", 1) + "_"
    marks = [[name.removeprefix(before) for name in value.split()] for value in given]
    match ask.kind:
        case "truth":
            return [marks[0][0]]
        case "one" | "many":
            return [_known(one[0], ask.options) for one in marks]
        case "order" if all(len(one) == 1 for one in marks):
            return [_known(one[0], ask.options) for one in marks]
        case "pairs" | "order":
            chosen = dict(_pair(one, ask) for one in marks)
            places = [chosen.get(mark, "") for mark in ask.options]
            return in_places(places, ask) if ask.kind == "order" else places
        case _:
            return [with_unit(given[0], ask.unit)]


def _pair(marks: list[str], ask: Asked) -> tuple[str, str]:
    stem, target = (*marks, "")[:2]
    return _known(stem, ask.options), _known(target, ask.targets)


def _known(mark: str, marks: Collection[str]) -> str:
    if mark in marks:
        return mark
    raise FormulaReadError("option-unknown", 1, safe_echo(mark))

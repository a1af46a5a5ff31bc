"""Result reports of QTI 2.1 and 3.0: the response to each variable of an item.

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
from quizgen.lms.attempts import LONGEST_RESPONSE, QuizAttempt, ReportLoss, Response
from quizgen.lms.manifest import ManifestQuestion, ResponseField
from quizgen.lms.moodle_summaries import (
    FieldValues,
    append_unit,
    check_letter,
    steps_by_place,
    values_or_error,
)
from quizgen.maths.notation import FormulaReadError

# Characters of the largest report of one person. A parser of XML scans all that it has of a tag
# whenever it gets more of it, so that a long tag takes time with the square of its length.
LARGEST_XML = 5_000_000


def attempts_from_qti(
    text: str, where: Path, _known: Collection[str], _lost: ReportLoss
) -> Iterator[QuizAttempt]:
    """Yield the one attempt of a report.

    Parameters
    ----------
    text : str
    where : pathlib.Path
        The file, for messages; its name stands for a person whom the report does not name.

    Raises
    ------
    KeyFileError
        Naming the file and the line.
    """
    root = _parse_xml(text, where)
    if _local_name(root) != "assessmentResult":
        raise KeyFileError(f"{where}: not a result report of QTI (its first element is "
                           f"{safe_echo(_local_name(root))})")  # fmt: skip
    who = "".join(one.get("sourcedId", "") for one in root if _local_name(one) == "context")
    items = {one.get("identifier", ""): one for one in root if _local_name(one) == "itemResult"}
    given = {name: _candidate_responses(one) for name, one in items.items()}
    if any(map(_has_long_text, given.values())):
        raise KeyFileError(f"{where}: a text of more than {LONGEST_RESPONSE} characters")
    responses = tuple(Response("", name, values) for name, values in given.items())
    yield QuizAttempt(str(where), "", who.strip() or where.stem, "", responses)


def _parse_xml(text: str, where: Path) -> ET.Element:
    """Return the root element.

    ``KeyFileError`` for a document that defines entities, or is too deep or too long: such files
    are made to exhaust a parser.
    """
    if len(text) > LARGEST_XML:
        raise KeyFileError(f"{where}: larger than {LARGEST_XML // 10**6} MB")
    if "<!DOCTYPE" in text:
        raise KeyFileError(f"{where}: a document with a DOCTYPE is not read")
    depth = 0
    root = ET.Element("")
    try:
        reader = ET.iterparse(StringIO(text), ["start", "end"])  # noqa: S314 - no entities
        for count, (event, element) in enumerate(reader):
            depth += 1 if event == "start" else -1
            if depth > DEEPEST or count > MOST_VALUES:
                raise KeyFileError(f"{where}: too many elements, or too deep")
            root = element
    except ET.ParseError as error:
        line, column = error.position
        raise KeyFileError(f"{where}: line {line}, column {column + 1}: not XML") from None
    return root


def _local_name(element: ET.Element) -> str:
    """Return the name of an element without its namespace, which differs between versions."""
    return element.tag.rpartition("}")[2]


def _candidate_responses(item: ET.Element) -> Mapping[str, list[str]]:
    """Return the responses by variable; right answers, which may stand there too, are left out."""
    return {
        variable.get("identifier", ""): [
            value.text or ""
            for given in variable
            if _local_name(given) == "candidateResponse"
            for value in given
        ]
        for variable in item
        if _local_name(variable) == "responseVariable"
    }


def _has_long_text(given: Mapping[str, list[str]]) -> bool:
    """Return whether any response has more than ``LONGEST_RESPONSE`` characters."""
    return any(len(value) > LONGEST_RESPONSE for values in given.values() for value in values)


def qti_field_values(
    question: ManifestQuestion, given: Mapping[str, list[str]]
) -> list[FieldValues | FormulaReadError]:
    """Return the values of each field, as ``moodle_summaries.parse_summary`` does."""
    return [
        values_or_error(_variable_values, field, given.get(field.name, []))
        for field in question.asks
    ]


def _variable_values(field: ResponseField, given: list[str]) -> FieldValues:
    """Return the values of one field from those of its variable; empty without a response."""
    given = [value for value in given if value.strip()]
    if not given:
        return []
    prefix = field.name.replace("RESPONSE", "C", 1) + "_"
    letters = [[name.removeprefix(prefix) for name in value.split()] for value in given]
    match field.kind:
        case "truth":
            return [letters[0][0]]
        case "one" | "many":
            return [check_letter(one[0], field.options) for one in letters]
        case "order" if all(len(one) == 1 for one in letters):
            return [check_letter(one[0], field.options) for one in letters]
        case "pairs" | "order":
            chosen = dict(_read_pair(one, field) for one in letters)
            places = [chosen.get(letter, "") for letter in field.options]
            return steps_by_place(places, field) if field.kind == "order" else places
        case _:
            return [append_unit(given[0], field.unit)]


def _read_pair(letters: list[str], field: ResponseField) -> tuple[str, str]:
    """Return the letters of stem and target, after checking that the field has them."""
    stem, target = (*letters, "")[:2]
    return check_letter(stem, field.options), check_letter(target, field.targets)

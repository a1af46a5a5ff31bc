"""What an export leaves behind reads the responses that Moodle makes of its questions.

Right responses are taken from the file for Moodle by a reader of its own, and made into text as
Moodle's documents and code describe it.
"""

from __future__ import annotations

import html
import re
import zipfile
from io import BytesIO
from xml.etree import ElementTree as ET

import pytest
from cloze import fields

from quizgen.lms.attempts import QuizAttempt, Response
from quizgen.lms.grading import grade_attempts
from quizgen.lms.items import items_from_templates
from quizgen.lms.manifest import ExportManifest
from quizgen.lms.manifest_writer import manifest_entry
from quizgen.lms.moodle import moodle_manifest, write_moodle
from quizgen.lms.qti.item import qti_manifest as variables
from quizgen.lms.qti.package import write_qti3, write_qti21
from quizgen.lms.response_files import read_attempts


def plain(text) -> str:
    return html.unescape(re.sub(r"<[^>]+>", "", text)).upper()


def texts(elements, path="text"):
    return [plain(one.findtext(path)) for one in elements]


def right(question) -> str:
    """What Moodle would make of the right response."""
    answers = question.findall("answer")
    best = [one for one in answers if float(one.get("fraction")) > 0]
    match question.get("type"):
        case "cloze":
            pieces = [embedded(one) for one in fields(question.findtext("questiontext/text"))]
            return "; ".join(f"part {place}: {piece}" for place, piece in enumerate(pieces, 1))
        case "numerical" | "shortanswer":
            return best[0].findtext("text").replace("\\*", "*")
        case "multichoice" | "truefalse":
            return "; ".join(texts(best))
        case "ordering":
            return "; ".join(f"{text[:7]}..." for text in texts(answers))
        case "matching":
            pairs = [one for one in question.findall("subquestion") if one.findtext("text")]
            rows = zip(texts(pairs), texts(pairs, "answer/text"), strict=True)
            return "; ".join(f"{stem} -> {choice}" for stem, choice in rows)
    raise AssertionError(question.get("type"))


def embedded(field) -> str:
    best = [one.typed for one in field.alternatives if one.percent > 0]
    match field.kind:
        case "NUMERICAL":
            return best[0].partition(":")[0].replace(".", ",", 1)
        case "MULTIRESPONSE":
            return "; ".join(map(plain, best))
    return best[0].replace("\\*", "*") if field.kind.startswith("SHORT") else plain(best[0])


def missed(items) -> dict[str, list[str]]:
    """Parts of which the right response does not have all the marks."""
    found = {}
    keys = ExportManifest(manifest_entry(item, moodle_manifest(item)) for item in items)
    for question in ET.fromstring(write_moodle(items)).iter("question"):
        if question.get("type") in {"category", "essay"}:
            continue
        (mark,) = re.findall(
            r"\[([a-z2-9]{4}-[a-z2-9]{4})\]", question.findtext("questiontext/text")
        )
        name = question.findtext("idnumber")
        attempt = QuizAttempt("", "", name, "", (Response("1", mark, right(question)),))
        (one,) = grade_attempts(keys, [attempt])
        assert one.questions == {"1": name}
        wrong = [f"{p.typed!r} {p.verdict.note}" for p in one.result.parts if p.marks != p.points]
        found |= {name: wrong} if wrong or not one.result.parts else {}
    return found


def test_right_responses_come_back_right(items):
    assert missed(items) == {}


@pytest.mark.slow
@pytest.mark.parametrize("lang", ["en", "bn"])
def test_those_of_all_templates(bank, lang):
    assert missed(list(items_from_templates(bank, list(bank.template_paths), 7, 1, [lang]))) == {}


RESULT = """<?xml version="1.0" encoding="UTF-8"?>
<assessmentResult xmlns="http://www.imsglobal.org/xsd/imsqti_result_{version}">
<context sourcedId="ada"/>{items}</assessmentResult>"""
ITEM = """<itemResult identifier="{name}" datestamp="2026-11-22T09:00:00" sessionStatus="final">
{variables}</itemResult>"""
VARIABLE = """<responseVariable identifier="{name}" cardinality="multiple">
<correctResponse><value>0</value></correctResponse>
<candidateResponse>{values}</candidateResponse></responseVariable>"""


def files_of(package):
    with zipfile.ZipFile(BytesIO(package)) as archive:
        names = [name for name in archive.namelist() if name.startswith("items/")]
        return [ET.fromstring(archive.read(name)) for name in names if name.endswith(".xml")]


def declared(item) -> dict[str, list[str]]:
    """The key of each response of an item, empty if it has none."""
    found = {}
    for one in item:
        if one.tag.endswith(("}responseDeclaration", "}qti-response-declaration")):
            key = [value.text for inside in one for value in inside if value.text]
            found[one.get("identifier")] = key
    return found


def reported(package, version) -> str:
    """A result report of all items, as the specification has it, each given its key."""
    items = ""
    for item in files_of(package):
        variables = ""
        for name, key in declared(item).items():
            values = "".join(f"<value>{html.escape(value)}</value>" for value in key)
            variables += VARIABLE.format(name=name, values=values)
        items += ITEM.format(name=item.get("identifier"), variables=variables)
    return RESULT.format(version=version, items=items)


@pytest.mark.parametrize(
    ("write_package", "version"), [(write_qti21, "v2p1"), (write_qti3, "v3p0")]
)
def test_keys_of_a_package_come_back_right(items, write_package, version, tmp_path):
    keys = ExportManifest(manifest_entry(item, variables(item)) for item in items)
    package = write_package(items)
    path = tmp_path / "report.xml"
    path.write_text(reported(package, version), encoding="utf-8")
    lost = []
    (one,) = grade_attempts(keys, read_attempts([path], keys.found, lost.append))
    assert (lost, one.attempt.id, one.foreign) == ([], "ada", ())
    assert len(one.questions) == len(items)
    missed = [part for part in one.result.parts if part.marks != part.points]
    assert {part.status for part in missed} <= {"blank"}
    by_hand = {i.get("identifier") for i in files_of(package) if not all(declared(i).values())}
    assert {one.questions[part.number] for part in missed} == by_hand


def test_marks_are_apart(items):
    marks = [entry.mark for item in items for entry in moodle_manifest(item)]
    assert len(marks) == len({*marks})

"""Packages for Canvas read as its documents describe them, and played without our code."""

from __future__ import annotations

import io
import re
import zipfile
from html.parser import HTMLParser
from xml.etree import ElementTree as ET

import pytest
from msgspec.structs import replace

from quizgen.lms.canvas import canvas_files, canvas_questions, write_canvas
from quizgen.lms.interactions import (
    ChoiceInteraction,
    MatchInteraction,
    NumericInteraction,
    OrderInteraction,
    TextEntryInteraction,
    TrueFalseInteraction,
    order_as_match,
)
from quizgen.lms.items import ExportItem
from quizgen.lms.markup import to_course_html
from quizgen.typeset.prose import PlainText

Q = "{http://www.imsglobal.org/xsd/ims_qtiasiv1p2}"
CP = "{http://www.imsglobal.org/xsd/imsccv1p1/imscp_v1p1}"


def read(items: list[ExportItem]) -> dict[str, ET.Element]:
    files = canvas_files(items)
    roots = [ET.fromstring(data) for name, data in files.items()
             if re.fullmatch(r"quizgen-(en|bn)/quizgen-\1\.xml", name)]  # fmt: skip
    return {item.get("ident"): item for root in roots for item in root.iter(f"{Q}item")}


@pytest.fixture(scope="module")
def questions(items):
    return read(items)


def asked(item: ExportItem):
    """Each question that asks one thing, and what it asks."""
    return [
        (one.id, one.interactions[0])
        for one in canvas_questions(item)
        if len(one.interactions) == 1
    ]


def entry(item: ET.Element, label: str) -> str:
    (found,) = [one.findtext(f"{Q}fieldentry") for one in item.iter(f"{Q}qtimetadatafield")
                if one.findtext(f"{Q}fieldlabel") == label]  # fmt: skip
    return found


def holds(condition: ET.Element, typed: dict[str, set[str]]) -> bool:
    """Whether a condition of QTI 1.2 is met; several side by side are alternatives, as Canvas has
    them in short answers."""
    tag, text = condition.tag.removeprefix(Q), condition.text or ""
    given = typed.get(condition.get("respident"), set())
    match tag:
        case "varequal":
            return text in given
        case "vargte" | "varlte":
            way = 1 if tag == "vargte" else -1
            return any(way * (float(one) - float(text)) >= 0 for one in given)
        case "and":
            return all(holds(one, typed) for one in condition)
        case "or" | "conditionvar":
            return any(holds(one, typed) for one in condition)
        case "not":
            return not holds(condition[0], typed)
    return tag == "other"


def played(item: ET.Element, typed: dict[str, str | set[str]]) -> tuple[float, list[str]]:
    """Score in percent and what is said: the first rule that ends it ends it."""
    given = {key: {one} if isinstance(one, str) else one for key, one in typed.items()}
    score, said = 0.0, []
    told = {
        one.get("ident"): "".join(one.itertext()).strip() for one in item.iter(f"{Q}itemfeedback")
    }
    for rule in item.iter(f"{Q}respcondition"):
        if not holds(rule.find(f"{Q}conditionvar"), given):
            continue
        said += [told[one.get("linkrefid")] for one in rule.iter(f"{Q}displayfeedback")]
        for one in rule.iter(f"{Q}setvar"):
            score = float(one.text) + (score if one.get("action") == "Add" else 0)
        if rule.get("continue") == "No":
            break
    return round(score, 3), said


def labels(item: ET.Element, response: str = "response1") -> dict[str, str]:
    """What is shown of each option, to what it is called."""
    (found,) = [one for one in item.iter(f"{Q}response_lid") if one.get("ident") == response]
    return {
        one.findtext(f".//{Q}mattext"): one.get("ident") for one in found.iter(f"{Q}response_label")
    }


def tries(ask, item: ET.Element):
    """Answers with the share that they deserve."""
    match ask:
        case NumericInteraction():
            for one in ask.ranges:
                for place in (-0.98, 0, 0.98):
                    yield {"response1": repr(one.value + place * one.width)}, 100 * one.right
        case ChoiceInteraction():
            shown = {text.split(".")[0]: ident for text, ident in labels(item).items()}
            right = {shown[option.letter] for option in ask.right}
            yield {"response1": right}, 100
            for option in ask.options:
                chosen = {shown[option.letter]}
                yield {"response1": chosen}, 100 * (chosen == right)
        case TrueFalseInteraction():
            first, second = labels(item).values()
            yield {"response1": first}, 100 * ask.true
            yield {"response1": second}, 100 * (not ask.true)
        case TextEntryInteraction():
            yield from (({"response1": typed}, 100) for typed in ask.right)
            yield from (({"response1": typed}, 0) for typed, _ in ask.wrong)
        case MatchInteraction():
            stems = [f"response_{place}" for place, _ in enumerate(ask.stems, 1)]
            order = [mark for mark, _ in ask.targets]
            key = {name: str(order.index(ask.right[mark]) + 1)
                   for name, (mark, _) in zip(stems, ask.stems, strict=True)}  # fmt: skip
            yield key, 100
            missing = dict(list(key.items())[1:])
            yield missing, round(100 * (len(stems) - 1) / len(stems), 3)


def plain(page: str) -> str:
    """The text of a page."""
    found: list[str] = []
    parser = HTMLParser()
    parser.handle_data = found.append
    parser.feed(page)
    return "".join(found)


def test_every_key_is_right_and_every_mistake_wrong(items, questions):
    seen = set()
    for item in items:
        for name, ask in asked(item):
            question = questions[name]
            ask = order_as_match(ask, item.lang) if isinstance(ask, OrderInteraction) else ask  # noqa: PLW2901
            for typed, share in tries(ask, question):
                assert played(question, typed)[0] == pytest.approx(share, abs=0.01), (name, typed)
                seen.add(entry(question, "question_type"))
    assert seen >= {f"{kind}_question" for kind in (
        "numerical", "multiple_choice", "multiple_answers", "true_false", "matching", "short_answer",
    )}  # fmt: skip


def test_a_wrong_option_is_told_why_and_all_are_told_the_solution(reference):
    item = reference("imread-missing-file")
    ((_, ask),) = asked(item)
    (question,) = read([item]).values()
    for option in ask.options:
        shown = {text.split(".")[0]: ident for text, ident in labels(question).items()}
        _, said = played(question, {"response1": shown[option.letter]})
        assert "Answer:" in said[0]
        told = [] if option.right else [plain(to_course_html(option.feedback, "en"))]
        assert [plain(one) for one in said[1:]] == told


def test_the_manifest_names_every_file_and_pages_show_only_these(items):
    files = canvas_files(items)
    manifest = ET.fromstring(files["imsmanifest.xml"])
    named = {one.get("href") for one in manifest.iter(f"{CP}file")}
    assert named == files.keys() - {"imsmanifest.xml"}
    pages = b"".join(data for name, data in files.items() if name.endswith(".xml")).decode()
    shown = set(re.findall(r"%24IMS-CC-FILEBASE%24/([^&]+)&#34; alt=&#34;[^&]{20,}", pages))
    assert shown == {name for name in named if name.endswith(".svg")}
    assert len(shown) > 5


def test_each_value_of_a_point_is_a_question(reference):
    item = reference("point-to-image-plane-fractions")
    names = [name for name, _ in asked(item)]
    found = read([item])
    assert names == [*found] == [f"{item.id}.1", f"{item.id}.2"]
    texts = [plain(one.findtext(f".//{Q}mattext")) for one in found.values()]
    assert all("?" in text for text in texts)
    assert texts[0] != texts[1]
    for question, key, trap in zip(found.values(), ("6.67", "3.33"), ("20", "10"), strict=True):
        assert played(question, {"response1": key})[0] == 100
        assert played(question, {"response1": trap})[0] == 0
        assert "forgot to divide" in played(question, {"response1": trap})[1][0]


def test_braces_brackets_and_bangla_survive(reference):
    """Texts with every sign of the grammar, through the reader."""
    item = reference("imread-missing-file")
    awkward = "[blank1] ]]> {a} ~ # & &amp; <b> \"q\" 'x' ১,৫ ক্যামেরা"
    part, spec = item.question.parts[0], item.key.specs[0]
    first, *rest = part.field.options
    options = ((first[0], (PlainText(awkward),)), *rest)
    part = replace(part, field=replace(part.field, options=options))
    made = ExportItem(item.id, item.slot, replace(item.question, parts=(part,)), item.key)
    assert spec.kind == "choice"
    (question,) = read([made]).values()
    assert f"{first[0]}. {awkward}" in map(plain, labels(question))


def test_a_blank_is_where_we_set_one_and_nowhere_else(awkward):
    """Whatever the words of an own bank are."""
    found = read(awkward)
    blanks = {one.id: len(one.interactions) for item in awkward for one in canvas_questions(item)
              if len(one.interactions) > 1}  # fmt: skip
    assert len(blanks) > 2
    for name, count in blanks.items():
        text = found[name].findtext(f".//{Q}mattext")
        assert re.findall(r"\[(\w+)\]", text) == [f"blank{i}" for i in range(1, count + 1)]


def test_the_same_questions_are_the_same_bytes(items):
    data = write_canvas(items[:3])
    assert data == write_canvas(items[:3])
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert {one.date_time for one in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        assert archive.namelist()[0] == "imsmanifest.xml"


def test_each_blank_earns_its_share(reference):
    (question,) = [one for one in read([reference("edit-from-photo-and-histogram")]).values()
                   if entry(one, "question_type") == "fill_in_multiple_blanks_question"]  # fmt: skip
    blanks = re.findall(r"\[(blank\d)\]", question.findtext(f".//{Q}mattext"))
    rules = list(question.iter(f"{Q}varequal"))
    key = {one.get("respident"): one.text for one in reversed(rules)}
    assert [f"response_{blank}" for blank in blanks] == sorted(key)
    assert played(question, key)[0] == pytest.approx(100)
    key.popitem()
    assert played(question, key)[0] == pytest.approx(100 * (1 - 1 / len(blanks)), abs=0.01)

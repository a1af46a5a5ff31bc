"""QTI packages by the schemas of the standard, and items played by its rules."""

from __future__ import annotations

import io
import re
import zipfile
from xml.etree import ElementTree as ET

import pytest
from lxml import etree
from qti_cases import asked, cases
from qti_engine import QTI, disagreements
from qti_schemas import schema

from quizgen.lms import get_exporter
from quizgen.lms.interactions import ExtendedTextInteraction
from quizgen.lms.items import items_from_templates
from quizgen.lms.qti.dialect import QTI3, QTI21
from quizgen.lms.qti.item import item_identifier
from quizgen.lms.qti.package import package_files

CP = "{http://www.imsglobal.org/xsd/imscp_v1p1}"
LOM = "{http://ltsc.ieee.org/xsd/LOM}"


@pytest.fixture(scope="module")
def files(items):
    return package_files(items, QTI21)


def elements(files):
    """Items and tests of a package by their paths."""
    found = {path: data for path, data in files.items() if path.endswith(".xml")}
    del found["imsmanifest.xml"]
    return {path: etree.fromstring(data) for path, data in found.items()}


def invalid(files, of: etree.XMLSchema):
    for path, root in elements(files).items():
        if not of.validate(root):
            yield path, str(of.error_log[0])


def test_items_and_tests_are_valid(files):
    assert list(invalid(files, schema("qtiv2p1/imsqti_v2p1.xsd"))) == []


def test_the_manifest_is_valid_and_lists_every_file(files):
    root = etree.fromstring(files["imsmanifest.xml"])
    of = schema("imscp_v1p1.xsd")
    assert of.validate(root), of.error_log
    listed = {one.get("href") for one in root.iter(f"{CP}file")}
    assert listed == files.keys() - {"imsmanifest.xml"}
    names = [one.get("identifier") for one in root.iter(f"{CP}resource")]
    assert len({*names}) == len(names)
    assert {one.get("identifierref") for one in root.iter(f"{CP}dependency")} < {*names}


def test_the_manifest_has_the_tags_of_each_item(items, files):
    root = ET.fromstring(files["imsmanifest.xml"])
    found = {
        one.get("identifier"): one.find(f".//{LOM}general") for one in root.iter(f"{CP}resource")
    }
    for item in items:
        general = found[item_identifier(item)]
        assert [one.text for one in general.iterfind(f"{LOM}keyword/{LOM}string")] == [*item.tags]
        assert general.findtext(f"{LOM}title/{LOM}string") == item.title()
        assert general.findtext(f"{LOM}language") == item.lang


def test_fields_without_names_are_numbered(reference):
    """The image of a point has two values; each gap has the number of its sentence."""
    for name, count in (("point-to-image-plane-fractions", 2), ("mixing-kind-and-primaries", 4)):
        (path, root), _ = sorted(elements(package_files([reference(name)], QTI21)).items())
        assert path.startswith("items/")
        fields = list(root.iter(f"{QTI}textEntryInteraction"))
        before = [(one.getparent().text or "").strip() for one in fields]
        assert before == [f"{i}." for i in range(1, count + 1)]


def test_fields_stand_in_their_cells(bank):
    """A drop-down list or a line to type in, in the row that it completes."""
    (item,) = items_from_templates(bank, ["complete-table-of-ccd-and-cmos"], 1, 1, ["en"])
    (_, root), _ = sorted(elements(package_files([item], QTI21)).items())
    fields = list(root.iter(f"{QTI}inlineChoiceInteraction", f"{QTI}textEntryInteraction"))
    assert len(fields) == len(item.parts)
    assert {field.getparent().tag for field in fields} == {f"{QTI}td"}


def test_pictures_are_files_with_words(items, files):
    shown = 0
    for item in items:
        path = f"items/{item_identifier(item)}.xml"
        for one in ET.fromstring(files[path]).iter(f"{QTI}img"):
            assert files[one.get("src").removeprefix("../")].startswith(b"<svg")
            assert len(one.get("alt")) > 20
            shown += 1
    assert shown > 5


def test_keys_and_mistakes_earn_what_is_declared(items, files):
    found, tried = [], 0
    for item in items:
        path, tried_here = f"items/{item_identifier(item)}.xml", list(cases(item))
        found += disagreements(path, ET.fromstring(files[path]), tried_here)
        tried += len(tried_here)
    assert found == []
    assert tried > 500


def test_an_own_bank_may_hold_signs_of_markup(awkward):
    made = package_files(awkward, QTI21)
    assert list(invalid(made, schema("qtiv2p1/imsqti_v2p1.xsd"))) == []
    for item in awkward:
        path = f"items/{item_identifier(item)}.xml"
        assert list(disagreements(path, ET.fromstring(made[path]), list(cases(item)))) == []


def test_numbers_are_decimals_with_a_point(files):
    """Exponents are read by most engines, not by all; a comma by none."""
    found = set()
    for path, root in elements(files).items():
        if path.startswith("items/"):
            found |= {one.text for one in root.iterfind(f".//{QTI}baseValue[@baseType='float']")}
            found |= {one.get("mappedValue") for one in root.iter(f"{QTI}mapEntry")}
    assert len(found) > 100
    assert [text for text in found if not re.fullmatch(r"-?\d+(\.\d+)?", text)] == []


def test_what_a_person_marks_has_its_key_for_them_alone(items, files):
    seen = 0
    for item in items:
        root = ET.fromstring(files[f"items/{item_identifier(item)}.xml"])
        written = [
            one.suffix for one in asked(item) if isinstance(one.ask, ExtendedTextInteraction)
        ]
        fields = [
            one.get("responseIdentifier") for one in root.iter(f"{QTI}extendedTextInteraction")
        ]
        assert fields == [f"RESPONSE{suffix}" for suffix in written]
        rubrics = [one.get("view") for one in root.iter(f"{QTI}rubricBlock")]
        assert rubrics == ["scorer"] * len(written)
        seen += len(written)
    assert seen > 5


def camel(name: str) -> str:
    return (
        name
        if name.startswith("{")
        else re.sub("-([a-z])", lambda letter: letter[1].upper(), name.removeprefix("qti-"))
    )


def in_old_words(root: etree._Element) -> str:
    """An item of QTI 3.0 in the words of 2.1: what 1EdTech's migration guide says of names."""
    for one in list(root.iter("{*}qti-content-body")):
        one.tag = "gone"
    etree.strip_tags(root, "gone")
    for one in root.iter("{*}*"):
        name = etree.QName(one)
        if name.localname.startswith("qti-"):
            attributes = {camel(key): value for key, value in one.attrib.items()}
            one.attrib.clear()
            one.attrib.update(attributes)
            one.tag = f"{QTI}{camel(name.localname)}"
        elif name.namespace == "http://www.imsglobal.org/xsd/imsqtiasi_v3p0":
            one.tag = f"{QTI}{name.localname}"
    return plain(root)


def plain(root: etree._Element) -> str:
    for one in root.iter():
        one.attrib.pop("externalScored", None)
        one.attrib.pop("{http://www.w3.org/2001/XMLSchema-instance}schemaLocation", None)
    etree.cleanup_namespaces(root)
    written = etree.tostring(root, method="c14n").decode()
    return re.sub(r"<(/?)\w+:", r"<\1", re.sub(r' xmlns(:\w+)?="[^"]*"', "", written))


def test_both_versions_say_the_same(items, files):
    old, new = elements(files), elements(package_files(items, QTI3))
    assert old.keys() == new.keys()
    for path, root in new.items():
        assert in_old_words(root) == plain(old[path]), path


def test_the_same_call_gives_the_same_archive(items):
    made = get_exporter("qti3").write(items[:3])
    assert made == get_exporter("qti3").write(items[:3])
    with zipfile.ZipFile(io.BytesIO(made)) as archive:
        assert archive.testzip() is None
        assert archive.namelist()[0] == "imsmanifest.xml"
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}


def test_a_slot_is_a_section_from_which_one_is_drawn(items, files):
    for lang in ("en", "bn"):
        root = ET.fromstring(files[f"test-{lang}.xml"])
        sections = list(root.iter(f"{QTI}assessmentSection"))
        of_lang = [item for item in items if item.lang == lang]
        assert len(sections) == len({item.slot for item in of_lang})
        assert {one.find(f"{QTI}selection").get("select") for one in sections} == {"1"}
        refs = [one.get("href") for one in root.iter(f"{QTI}assessmentItemRef")]
        assert sorted(refs) == sorted(f"items/{item_identifier(item)}.xml" for item in of_lang)


@pytest.mark.slow
def test_the_whole_bank_is_valid_and_plays(everything):
    old = package_files(everything, QTI21)
    assert list(invalid(old, schema("qtiv2p1/imsqti_v2p1.xsd"))) == []
    test_keys_and_mistakes_earn_what_is_declared(everything[::5], old)
    new = package_files(everything, QTI3)
    assert list(invalid(new, schema("qtiv3p0/imsqti_asiv3p0_sbacv1p0_v1p0.xsd"))) == []
    of = schema("qtiv3p0/imsqtiv3p0_imscpv1p2_v1p0.xsd")
    manifest = etree.fromstring(new["imsmanifest.xml"])
    for one in list(manifest.iter(f"{LOM}lom")):  # a schema that is not there
        one.getparent().remove(one)
    assert of.validate(manifest), of.error_log

"""Items as a package: their files, figures shared by equal content, tests and a manifest."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import groupby
from pathlib import PurePosixPath

from markupsafe import Markup

from quizgen.core.files import build_zip
from quizgen.lms.items import ExportItem, group_by_slot
from quizgen.lms.markup import all_images
from quizgen.lms.qti.dialect import QTI3, QTI21, Dialect, xml_element, xml_file
from quizgen.lms.qti.item import item_identifier, write_item
from quizgen.locale import FIRST

# Learning object metadata (IEEE 1484.12.1), by which item banks search.
LOM = "http://ltsc.ieee.org/xsd/LOM"


@dataclass(frozen=True, slots=True)
class ManifestResource:
    """A file of a package, its type as the manifest names it, the files it needs, its metadata."""

    type: str
    path: str
    data: bytes
    needs: tuple[str, ...] = ()
    metadata: str = ""


def write_qti21(items: Iterable[ExportItem]) -> bytes:
    """Return the questions as a package of QTI 2.1, equal for equal questions."""
    return build_zip(package_files(items, QTI21))


def write_qti3(items: Iterable[ExportItem]) -> bytes:
    """Return the questions as a package of QTI 3.0, equal for equal questions."""
    return build_zip(package_files(items, QTI3))


def package_files(items: Iterable[ExportItem], dialect: Dialect) -> dict[str, bytes]:
    """Return the files of a package by their paths, the manifest first."""
    found = list(_iter_resources(items, dialect))
    manifest = _package_manifest(found, dialect)
    return {"imsmanifest.xml": manifest, **{one.path: one.data for one in found}}


def _iter_resources(items: Iterable[ExportItem], dialect: Dialect) -> Iterator[ManifestResource]:
    """Yield a test for each language, its items, and the figures of all of them."""
    figures: dict[str, bytes] = {}
    for lang, group in groupby(group_by_slot(items), key=lambda item: item.lang):
        of_lang = list(group)
        paths = {f"items/{item_identifier(item)}.xml": item for item in of_lang}
        test = write_assessment(lang, of_lang, dialect)
        test_type = f"imsqti_test_xml{dialect.version}"
        yield ManifestResource(test_type, f"test-{lang}.xml", test, (*paths,))
        for path, item in paths.items():
            shown = all_images(item)
            data = write_item(item, dialect)
            item_type = f"imsqti_item_xml{dialect.version}"
            yield ManifestResource(item_type, path, data, (*shown,), _item_metadata(item))
            figures |= shown
    yield from (ManifestResource("webcontent", path, data) for path, data in figures.items())


def _package_manifest(resources: list[ManifestResource], dialect: Dialect) -> bytes:
    """Return ``imsmanifest.xml``, which lists the files of a package."""
    schema, version = dialect.schema
    named = xml_element("schema", {}, schema) + xml_element("schemaversion", {}, version)
    return xml_file(
        "manifest",
        dialect.packages,
        {"identifier": "quizgen"},
        xml_element("metadata", {}, named),
        xml_element("organizations", {}),
        xml_element("resources", {}, *map(_resource_element, resources)),
    )


def _resource_element(one: ManifestResource) -> Markup:
    """Return a file as the manifest lists it."""
    named = {"identifier": _resource_identifier(one.path), "type": one.type, "href": one.path}
    file = xml_element("file", {"href": one.path})
    needs = [
        xml_element("dependency", {"identifierref": _resource_identifier(path)})
        for path in one.needs
    ]
    return xml_element("resource", named, one.metadata, file, *needs)


def _item_metadata(item: ExportItem) -> Markup:
    """Return title, language and tags of a question as learning object metadata."""
    title = xml_element("string", {"language": item.lang}, item.title())
    keywords = [
        xml_element("keyword", {}, xml_element("string", {"language": FIRST}, tag))
        for tag in item.tags
    ]
    general = xml_element(
        "general",
        {},
        xml_element("title", {}, title),
        xml_element("language", {}, item.lang),
        *keywords,
    )
    return xml_element("metadata", {}, xml_element("lom", {"xmlns": LOM}, general))


def _resource_identifier(path: str) -> str:
    """Return the identifier of a file; it must begin with a letter, as a hash may not."""
    pure = PurePosixPath(path)
    return f"figure-{pure.stem}" if pure.suffix != ".xml" else pure.stem


# Outcomes of items that are summed up over the test.
_SUMMED = ("SCORE", "MAXSCORE")


def write_assessment(lang: str, items: list[ExportItem], dialect: Dialect) -> bytes:
    """Return the test of the questions in one language, slot after slot."""
    tag = dialect.tag
    control = tag("itemSessionControl", {"showFeedback": "true", "allowReview": "true"})
    part = {
        "identifier": "part",
        "navigationMode": "nonlinear",
        "submissionMode": "simultaneous",
    }
    sections = Markup("").join(_write_sections(items, dialect))
    named = {"identifier": f"test-{lang}", "title": f"quizgen ({lang})", "toolName": "quizgen"}
    return dialect.file(
        "assessmentTest",
        named,
        *(dialect.outcome(name, "single float", {}) for name in _SUMMED),
        tag("testPart", part, control, sections),
        tag("outcomeProcessing", {}, *(_sum_outcome(name, dialect) for name in _SUMMED)),
    )


def _write_sections(items: list[ExportItem], dialect: Dialect) -> Iterator[Markup]:
    """Yield a section for each slot, from which one item is drawn."""
    slots = groupby(items, key=lambda item: item.slot)
    for number, (slot, found) in enumerate(slots, 1):
        named = {"identifier": f"slot-{number}", "title": slot, "visible": "false"}
        refs = (_item_reference(item, dialect) for item in found)
        yield dialect.tag(
            "assessmentSection", named, dialect.tag("selection", {"select": 1}), *refs
        )


def _item_reference(item: ExportItem, dialect: Dialect) -> Markup:
    """Return the reference of a section to an item."""
    name = item_identifier(item)
    named = {"identifier": name, "href": f"items/{name}.xml", "category": item.question.topic}
    return dialect.tag("assessmentItemRef", named)


def _sum_outcome(name: str, dialect: Dialect) -> Markup:
    """Return the rule that sums an outcome of all items."""
    values = dialect.tag("testVariables", {"variableIdentifier": name})
    total = dialect.tag("sum", {}, values)
    return dialect.tag("setOutcomeValue", {"identifier": name}, total)

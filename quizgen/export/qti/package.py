"""Items as a package: their files, figures shared by equal content, tests and a manifest."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby
from pathlib import PurePosixPath
from typing import NamedTuple

from markupsafe import Markup

from quizgen.core.files import build_zip
from quizgen.export import pictures
from quizgen.export.items import Item, by_slot
from quizgen.export.qti.assessment import assessment
from quizgen.export.qti.dialect import QTI3, QTI21, Dialect, element, file
from quizgen.export.qti.item import item_file, name_of
from quizgen.locale import FIRST

LOM = "http://ltsc.ieee.org/xsd/LOM"
"""Learning object metadata (IEEE 1484.12.1), by which item banks search."""


class Resource(NamedTuple):
    """A file of a package, its type as the manifest names it, the files it needs, its metadata."""

    kind: str
    path: str
    data: bytes
    needs: tuple[str, ...] = ()
    told: Markup = Markup("")


def write_qti21(items: Iterable[Item]) -> bytes:
    """The questions as a package of QTI 2.1: the same bytes for the same questions."""
    return build_zip(contents(items, QTI21))


def write_qti3(items: Iterable[Item]) -> bytes:
    """The questions as a package of QTI 3.0: the same bytes for the same questions."""
    return build_zip(contents(items, QTI3))


def contents(items: Iterable[Item], dialect: Dialect) -> dict[str, bytes]:
    """The files of a package by their paths, the manifest first."""
    found = list(_resources(items, dialect))
    manifest = _manifest(found, dialect)
    return {"imsmanifest.xml": manifest, **{one.path: one.data for one in found}}


def _resources(items: Iterable[Item], dialect: Dialect) -> Iterator[Resource]:
    """A test for each language, its items, and the figures of all of them."""
    figures: dict[str, bytes] = {}
    for lang, group in groupby(by_slot(items), key=lambda item: item.lang):
        of_lang = list(group)
        paths = {f"items/{name_of(item)}.xml": item for item in of_lang}
        test = assessment(lang, of_lang, dialect)
        yield Resource(f"imsqti_test_xml{dialect.version}", f"test-{lang}.xml", test, (*paths,))
        for path, item in paths.items():
            shown = pictures.shown(item)
            data = item_file(item, dialect)
            kind = f"imsqti_item_xml{dialect.version}"
            yield Resource(kind, path, data, (*shown,), _told(item))
            figures |= shown
    yield from (Resource("webcontent", path, data) for path, data in figures.items())


def _manifest(resources: list[Resource], dialect: Dialect) -> bytes:
    schema, version = dialect.schema
    named = element("schema", {}, schema) + element("schemaversion", {}, version)
    return file(
        "manifest",
        dialect.packages,
        {"identifier": "quizgen"},
        element("metadata", {}, named),
        element("organizations", {}),
        element("resources", {}, *map(_listed, resources)),
    )


def _listed(one: Resource) -> Markup:
    named = {"identifier": _named(one.path), "type": one.kind, "href": one.path}
    needs = [element("dependency", {"identifierref": _named(path)}) for path in one.needs]
    return element("resource", named, one.told, element("file", {"href": one.path}), *needs)


def _told(item: Item) -> Markup:
    """Title, language and tags of a question, as learning object metadata."""
    title = element("string", {"language": item.lang}, item.called())
    keywords = [
        element("keyword", {}, element("string", {"language": FIRST}, tag)) for tag in item.tags
    ]
    general = (element("title", {}, title), element("language", {}, item.lang), *keywords)
    return element("metadata", {}, element("lom", {"xmlns": LOM}, element("general", {}, *general)))


def _named(path: str) -> str:
    """What a file is called in the manifest; a figure has no letter in front."""
    pure = PurePosixPath(path)
    return f"figure-{pure.stem}" if pure.suffix != ".xml" else pure.stem

"""The schemas of QTI, which may not be handed on: they lie beside the project, or nowhere."""

from __future__ import annotations

from pathlib import Path

from lxml import etree
from needed import without

XS = "{http://www.w3.org/2001/XMLSchema}"
ROOT = Path(__file__).parents[2]


def schema(path: str) -> etree.XMLSchema:
    """A schema by its path, from `shared/qti-schemas` in a folder around the project."""
    tried = [folder / "shared" / "qti-schemas" / path for folder in ROOT.parents]
    found = next(filter(Path.is_file, tried), None)
    if found is None:
        without("no schemas of QTI in ../shared/qti-schemas, by which packages are valid or not")
    return etree.XMLSchema(complete(etree.parse(found), found.parent))


def complete(tree, folder: Path):
    """A schema without what others define that are absent, as of metadata, which we write none of."""
    root, lacking = tree.getroot(), []
    for one in root.findall(f"{XS}import"):
        if not (folder / one.get("schemaLocation")).exists():
            lacking.append(one.get("namespace"))
            root.remove(one)
    prefixes = {prefix for prefix, space in root.nsmap.items() if space in lacking}
    for one in tree.findall(f".//{XS}element[@ref]"):
        if one.get("ref").partition(":")[0] in prefixes:
            one.getparent().remove(one)
    return tree

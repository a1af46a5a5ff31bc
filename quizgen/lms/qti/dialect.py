"""The names of QTI 2.1 and of QTI 3.0 for the same things: ``itemBody``, ``qti-item-body``."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from functools import lru_cache

from markupsafe import Markup, escape

Attributes = Mapping[str, str | float]

_INSTANCE = "http://www.w3.org/2001/XMLSchema-instance"
_HUMP = re.compile(r"(?<=[a-z])(?=[A-Z])")


def format_number_plain(value: str | float) -> str:
    """Return a number without exponent, since engines read ``-1e-09`` as no number."""
    return value if isinstance(value, str) else f"{Decimal(repr(value)):f}"


@lru_cache(maxsize=10_000, typed=True)
def _attribute(key: str, value: str | float) -> str:
    """Return an attribute with its value escaped, after a blank."""
    return f' {key}="{escape(format_number_plain(value))}"'


def xml_element(name: str, attributes: Attributes, *inside: str) -> Markup:
    """Return an element of XML; texts that are not markup are escaped."""
    listed = "".join([_attribute(key, value) for key, value in attributes.items()])
    body = "".join([one if isinstance(one, Markup) else escape(one) for one in inside])
    end = f">{body}</{name}>" if body else "/>"
    return Markup(f"<{name}{listed}{end}")  # noqa: S704 - made of escaped pieces


def xml_file(name: str, space: str, attributes: Attributes, *inside: str) -> bytes:
    """Return a file with this element, in a namespace that has its schema after a blank."""
    spaces = {"xmlns": space.partition(" ")[0], "xmlns:xsi": _INSTANCE}
    made = xml_element(name, {**spaces, "xsi:schemaLocation": space, **attributes}, *inside)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{made}\n'.encode()


@dataclass(frozen=True)
class Dialect:
    """A version of QTI.

    Parameters
    ----------
    version : str
        In the types of resources.
    items, packages : str
        Namespaces of items and tests, and of manifests, each with its schema after a blank.
    schema : tuple of str
        Name and version of the schema of manifests.
    prefixed : bool
        Whether names begin with ``qti-`` and have hyphens.
    """

    version: str
    items: str
    packages: str
    schema: tuple[str, str]
    prefixed: bool

    def tag(self, name: str, attributes: Attributes, *inside: str) -> Markup:
        """Return an element by its name in QTI 2.1."""
        return xml_element(self._element(name), self._all(attributes), *inside)

    def file(self, name: str, attributes: Attributes, *inside: str) -> bytes:
        """Return an item or a test as a file."""
        return xml_file(self._element(name), self.items, self._all(attributes), *inside)

    def flow(self, name: str, attributes: Attributes, content: Markup) -> Markup:
        """Return feedback or a note; QTI 3.0 has one element more around its content."""
        inside = self.tag("contentBody", {}, content) if self.prefixed else content
        return self.tag(name, attributes, inside)

    def outcome(self, name: str, kind: str, more: Attributes, *inside: Markup) -> Markup:
        """Return the declaration of an outcome, of a kind as ``single float``."""
        cardinality, base = kind.split()
        named = {"identifier": name, "cardinality": cardinality, "baseType": base, **more}
        return self.tag("outcomeDeclaration", named, *inside)

    def _element(self, name: str) -> str:
        """Return the name of an element in this version, from that in QTI 2.1."""
        return f"qti-{_to_hyphens(name)}" if self.prefixed else name

    def _all(self, attributes: Attributes) -> Attributes:
        """Return attributes with their names in this version."""
        if not self.prefixed:
            return attributes
        return {_to_hyphens(name): value for name, value in attributes.items()}


@lru_cache
def _to_hyphens(name: str) -> str:
    """Return a name in camel case as one with hyphens: ``itemBody`` as ``item-body``."""
    return _HUMP.sub("-", name).lower()


_SCHEMAS = "http://www.imsglobal.org/xsd"
_SCHEMAS3 = "https://purl.imsglobal.org/spec/qti/v3p0/schema/xsd"

QTI21 = Dialect(
    "v2p1",
    f"{_SCHEMAS}/imsqti_v2p1 {_SCHEMAS}/qti/qtiv2p1/imsqti_v2p1.xsd",
    f"{_SCHEMAS}/imscp_v1p1 {_SCHEMAS}/qti/qtiv2p1/qtiv2p1_imscpv1p2_v1p0.xsd",
    ("QTIv2.1 Package", "1.0.0"),
    prefixed=False,
)
QTI3 = Dialect(
    "v3p0",
    f"{_SCHEMAS}/imsqtiasi_v3p0 {_SCHEMAS3}/imsqti_asiv3p0_v1p0.xsd",
    f"{_SCHEMAS}/qti/qtiv3p0/imscp_v1p1 {_SCHEMAS3}/imsqtiv3p0_imscpv1p2_v1p0.xsd",
    ("QTI Package", "3.0.0"),
    prefixed=True,
)

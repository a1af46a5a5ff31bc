"""The layouts of a package's pages: Jinja as all pages of ours use it."""

from __future__ import annotations

import jinja2


def environment(package: str) -> jinja2.Environment:
    """The layouts in the folder ``pages`` of a package: texts are escaped, unknown names fail."""
    return jinja2.Environment(
        loader=jinja2.PackageLoader(package, "pages"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )

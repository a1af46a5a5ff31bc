"""The layouts of a package's pages: Jinja as all pages of ours use it."""

from __future__ import annotations

import jinja2


def environment(*packages: str) -> jinja2.Environment:
    """The layouts in the folders ``pages`` of packages: texts are escaped, unknown names fail."""
    return jinja2.Environment(
        loader=jinja2.ChoiceLoader([jinja2.PackageLoader(name, "pages") for name in packages]),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )

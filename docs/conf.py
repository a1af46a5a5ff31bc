"""How the documents become a site: ``uv run python tools/do.py docs``, then ``site/index.html``.

Pages are Markdown that reads as well without being built. A link out of this folder, as to
``examples/``, leads nowhere on a site and becomes plain text there.
"""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes

import quizgen

LONGEST_NAME = 30
"""Characters of a name that stands on one line of a cell."""
project = "quizgen"
author = copyright = "quizgen contributors"
version = release = quizgen.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
html_theme = "furo"
html_title = f"quizgen {release}"
html_copy_source = False
html_show_sphinx = False
html_static_path = ["static"]
html_css_files = ["site.css"]
myst_heading_anchors = 4
myst_links_external_new_tab = False
suppress_warnings = ["myst.header"]  # the first heading of an included page is its title
exclude_patterns = ["accuracy/*", "figures/*"]
napoleon_google_docstring = False
autodoc_typehints = "description"
autodoc_member_order = "bysource"
nitpick_ignore_regex = [("py:.*", ".*")]
pygments_style = "default"


def _unlink_outside(_app: object, _page: str, source: list[str]) -> None:
    """Leave the words of links that lead out of the documents."""
    source[0] = re.sub(r"\[([^\]\n]+)\]\((?:\.\./)+[^)\s]*\)", r"\1", source[0])


def _link_pages(_app: object, _file: object, _page: str, source: list[str]) -> None:
    """Make links between files of the top folder lead to the pages that include them."""
    for name in ("ARCHITECTURE", "CONTRIBUTING"):
        source[0] = source[0].replace(f"]({name}.md", f"](docs/{name.lower()}.md")


def _mark_long_names(_app: object, doctree: nodes.document) -> None:
    """Let a line end in a long name in a table: it would leave its neighbours no room."""
    for entry in doctree.findall(nodes.entry):
        for name in entry.findall(nodes.literal):
            if max(map(len, name.astext().split()), default=0) > LONGEST_NAME:
                name["classes"].append("long")


def setup(app: Any) -> dict[str, bool]:
    """Connect what is done to each page before it is read."""
    app.connect("source-read", _unlink_outside)
    app.connect("include-read", _link_pages)
    app.connect("doctree-read", _mark_long_names)
    return {"parallel_read_safe": True}

"""A layout is compiled once; what is kept of it fills in as the layout does."""

from __future__ import annotations

import marshal
import sys

import jinja2
import pytest

from quizgen.core import cache
from quizgen.render import layouts


def compiled_again(*_arguments):
    raise AssertionError("compiled again")


@pytest.fixture
def page(empty_cache, tmp_path, monkeypatch):
    """A layout of a package of one's own."""
    folder = tmp_path / "quizgen_own_layouts" / "pages"
    folder.mkdir(parents=True)
    (folder.parent / "__init__.py").touch()
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "quizgen_own_layouts", raising=False)
    return folder / "greeting.j2"


def filled():
    return (
        layouts.jinja_environment("quizgen_own_layouts")
        .get_template("greeting.j2")
        .render(name="<A>")
    )


def test_a_layout_is_compiled_once(page, monkeypatch):
    page.write_text("{% if name %}\n  Dear {{ name }}\n{% endif %}\n")
    assert filled() == "  Dear &lt;A&gt;\n"
    monkeypatch.setattr(jinja2.Environment, "compile", compiled_again)
    assert filled() == "  Dear &lt;A&gt;\n"
    page.write_text("Hello {{ name }}")
    with pytest.raises(AssertionError, match="compiled again"):
        filled()


@pytest.mark.parametrize("found", [b"", b"no bytecode", marshal.dumps(5), marshal.dumps([1])])
def test_what_is_no_bytecode_is_not_run(page, empty_cache, found):
    page.write_text("Dear {{ name }}")
    filled()
    (file,) = (empty_cache / "layouts").iterdir()
    cache.write_entry(empty_cache, "layouts", file.name, found)
    assert filled() == "Dear &lt;A&gt;"


def test_a_page_is_filled_in_where_nothing_can_be_kept(page, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", "/dev/null/nowhere")
    page.write_text("Dear {{ name }}")
    assert filled() == "Dear &lt;A&gt;"


def test_bytecode_says_nothing_of_the_folder_it_was_made_in(page, empty_cache, tmp_path):
    page.write_text("Dear {{ name }}")
    filled()
    (file,) = (empty_cache / "layouts").iterdir()
    assert b"greeting.j2" in file.read_bytes()
    assert str(tmp_path).encode() not in file.read_bytes()


def test_all_layouts_of_a_package_can_be_compiled_beforehand(empty_cache, monkeypatch):
    layouts.precompile_layouts("quizgen.render")
    monkeypatch.setattr(jinja2.Environment, "compile", compiled_again)
    assert layouts.jinja_environment("quizgen.render").get_template("paper.html.j2")

"""Numbers have types, what nobody calls goes, and no program names what a bank or a language brings."""

from __future__ import annotations

import ast
import re
import sys
from pathlib import Path

import pytest
from sources import constants, nodes
from sweep import together

from quizgen.bank.bank import builtin_bank
from quizgen.locale import list_languages

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "tools"))

import measure  # noqa: E402

pytestmark = pytest.mark.slow  # all of the source is parsed
FILES = [
    p
    for folder in ("quizgen", "solvers", "templates")
    for p in sorted((ROOT / folder).rglob("*.py"))
    if p.name != "_build_hook.py"  # hatchling calls it
]


def functions(path):
    return [node for node in nodes(path) if isinstance(node, measure.Function)]


def test_few_parameters_are_typed_any():
    found = [a for path in FILES for f in functions(path) for a in measure.parameters(f)]
    assert sum(map(measure.is_any, found)) <= 0.03 * len(found)


CALLED_FROM_OUTSIDE = {"list_commands", "get_command", "format_commands", "get_code"} | {
    "get_source", "get_bucket", "load_bytecode", "dump_bytecode", "reset_ticks", "draw_markers",
    "get_canvas_width_height", "points_to_pixels", "option_image_nocomposite",
    "option_scale_image", "draw_gouraud_triangles", "is_defined", "precompile_layouts",
    "path_stats", "read_as_sympy", "read_matrix_as_sympy", "visit_Import", "visit_Expr", "visit_FunctionDef",
    "visit_AnnAssign", "visit_With", "visit_Call", "visit_Module", "visit_Compare", "visit_Attribute",
}  # fmt: skip
"""Methods that click looks for in a group, Python in a loader, Jinja in a loader or a cache, ``ast`` in a
transformer, and matplotlib in an axis or a renderer; ``is_defined`` is for those who compute with our arrays, ``precompile_layouts`` for building a wheel, ``read_as_sympy`` for authors of ``check.py``."""


def _names(node) -> list[str]:
    """The names that a piece of syntax uses: of things, of fields, or as a text (``getattr``)."""
    match node:
        case ast.Name(id=name) | ast.Attribute(attr=name) | ast.keyword(arg=str(name)):
            return [name]
        case ast.Constant(value=str(text)):
            return re.findall(r"\w+", text)
    return []


def used_in(path) -> set[str]:
    """All names of a module but those of its docstrings, which would hide what nobody calls."""
    docs = {id(n.value) for n in nodes(path) if isinstance(n, ast.Expr)}
    return {name for n in nodes(path) if id(n) not in docs for name in _names(n)}


def test_every_public_function_has_a_caller_in_the_product():
    product = [path for path in FILES if not path.is_relative_to(ROOT / "solvers")]
    used = set(CALLED_FROM_OUTSIDE).union(*map(used_in, product))
    for page in (ROOT / "quizgen").rglob("*.j2"):
        used |= set(re.findall(r"\w+", page.read_text(encoding="utf-8")))
    idle = [
        f"{path.relative_to(ROOT)}: {function.name}"
        for path in product
        for function in functions(path)
        if not function.name.startswith("_") and function.name not in used
    ]
    assert not idle


def test_no_two_test_files_have_one_name():
    """pytest collects only one of them."""
    names = [path.name for path in (ROOT / "tests").rglob("test_*.py")]
    assert sorted(names) == sorted(set(names))


def test_a_type_is_described_by_one_thread_at_a_time():
    """msgspec crashes where two begin together: whoever asks it has ``core.decoding`` prepare it."""
    asks = re.compile(
        r"msgspec\.convert\b|msgspec\.\w+\.Decoder\b|msgspec\.\w+\.decode\([^)]*type="
    )
    described = re.compile(r"^ +prepare_type\(", re.MULTILINE)
    sources = {path: path.read_text(encoding="utf-8") for path in FILES}
    asking = [path for path, source in sources.items() if asks.search(source)]
    assert [path for path in asking if not described.search(sources[path])] == []


def test_no_python_file_names_a_language_but_english():
    others = set(list_languages()) - {"en"}
    for path in (ROOT / "quizgen").rglob("*.py"):
        assert not constants(path) & others, path
    for path in (*(ROOT / "quizgen").rglob("*.css"), *(ROOT / "quizgen").rglob("*.j2")):
        assert not re.findall(rf"\b(?:{'|'.join(others)})\b", path.read_text("utf-8")), path


SUBJECT = {"numerics", "camera", "tradeoff"}
"""What pictures are made with: an effect or a formula may be called as a topic or a figure is."""
OTHERWISE = {"code", "camera", "colour", "eye", "image", "projection"}
"""An answer kind, a command's word, a spelling, a word of every dictionary, an element of SVG, and a
parameter of matplotlib."""


def test_the_engine_names_no_topic_and_no_title():
    about = builtin_bank().metadata
    titles = {text for topic in about.topics.values() for text in topic.values()}
    named = {*about.topics, *titles, *about.title.values()} - OTHERWISE - {"Code", "কোড"}
    for path in (ROOT / "quizgen").rglob("*"):
        if path.relative_to(ROOT / "quizgen").parts[0] in SUBJECT | {"builtin"}:
            continue
        if path.suffix == ".py":
            assert not constants(path) & named, path
        elif (
            path.suffix == ".toml" and path.name != "answers.toml"
        ):  # a dictionary for what is typed
            text = path.read_text(encoding="utf-8")
            assert not [name for name in named if f'"{name}"' in text], path


def _chapter() -> set[str]:
    """Names of the built-in bank's templates, present and former, and of its solvers."""
    bank = builtin_bank()
    solvers = {path.relative_to(bank.root / "solvers").with_suffix("").as_posix()
               for path in (bank.root / "solvers").rglob("[a-z]*.py")}  # fmt: skip
    return {
        *bank.template_paths,
        *(bank.rules(name).formerly for name in bank.template_paths),
        *solvers,
    } - {""}


EXAMPLE = {"point-to-image-plane"}
"""The question that the examples of the Python interface ask."""


SCENES = {"pinhole", "defocus"}
"""A scene and an effect of the camera's own page, which a figure and a solver are called as well."""


def test_the_engine_names_no_template_no_solver_and_no_figure():
    """A name of a single word (``noise``) may stand in a sentence, but is no text of a program."""
    figures = builtin_bank().figures
    word = re.compile(r"[\w/-]+")
    named = {name for name in {*_chapter(), *figures} - EXAMPLE if re.search("[-_/]", name)}
    single = {name.rpartition("/")[2] for name in {*_chapter(), *figures}} - SCENES
    for path in (ROOT / "quizgen").rglob("*"):
        if path.relative_to(ROOT / "quizgen").parts[0] in SUBJECT | {"builtin"}:
            continue
        if path.suffix in {".py", ".toml", ".j2", ".js"}:
            assert not {*word.findall(path.read_text("utf-8"))} & named, path
        if path.suffix == ".py":
            assert not constants(path) & single, path


def test_cases_that_are_checked_together_are_all_checked_and_all_failures_told():
    seen = []

    @together("n", [1, 2, pytest.param(3, marks=pytest.mark.slow), 4])
    def check(n):
        seen.append(n)
        assert n % 2, f"{n} is even"

    (mark,) = check.pytestmark
    usual, slow = mark.args[1]
    with pytest.raises(ExceptionGroup, match="2 cases fail") as told:
        check(cases_of_n=usual.values[0])
    assert ["with {'n': 2}"] in [one.__notes__ for one in told.value.exceptions]
    check(cases_of_n=slow.values[0])
    assert seen == [1, 2, 4, 3]
    assert (usual.marks, [one.name for one in slow.marks]) == ((), ["slow"])

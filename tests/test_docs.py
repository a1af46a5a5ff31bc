"""The documents are true: examples run, commands and keys are documented."""

from __future__ import annotations

import doctest
import importlib
import re
import subprocess
import tomllib
from pathlib import Path

import click
import consoles
import msgspec
import pytest
from sweep import together

import quizgen
from quizgen import typeset
from quizgen.bank.rules import Rules
from quizgen.cli.main import COMMANDS, root_group
from quizgen.locale import SHIPPED, list_languages
from quizgen.maths import model

ROOT = Path(__file__).parent.parent


def test_examples_of_the_python_interface_run():
    page = str(ROOT / "docs" / "api.md")
    result = doctest.testfile(page, module_relative=False, optionflags=doctest.ELLIPSIS)
    assert result.attempted >= 25
    assert result.failed == 0


@pytest.mark.parametrize("module", [quizgen, model, typeset], ids=lambda m: m.__name__)
def test_examples_in_docstrings_run(module):
    result = doctest.testmod(module)
    assert result.attempted
    assert result.failed == 0


@together("name", list(COMMANDS))
def test_every_command_loads_and_is_in_the_table(name):
    command = root_group.get_command(None, name)
    assert command is not None
    assert command.help
    text = (ROOT / "docs" / "commands.md").read_text("utf-8")
    assert f"quizgen {name}" in text or f"`{name}" in text


def test_every_key_of_a_template_is_documented():
    text = (ROOT / "docs" / "template.md").read_text(encoding="utf-8")
    for field in msgspec.structs.fields(Rules):
        name = field.encode_name
        assert f"`{name}`" in text or f"`[{name}]`" in text or f"`[[{name}]]`" in text, name


def words(entry, path=""):
    for key, value in entry.items():
        if isinstance(value, dict):
            yield from words(value, f"{path}{key}.")
        else:
            yield f"{path}{key}", value


def blanks(text):
    return {part.split("}")[0] for part in text.split("{")[1:]}


@together("lang", sorted({*list_languages()} - {"en"}))
@together("file", ["interface", "messages", "web", "classes", "cards"])
def test_every_word_has_the_same_blanks_in_every_language(file, lang):
    # From the files: a word that a language lacks is said in English.
    english, other = (
        dict(words(tomllib.loads((SHIPPED / one / f"{file}.toml").read_text("utf-8"))))
        for one in ("en", lang)
    )
    assert english.keys() == other.keys()
    for name, text in english.items():
        assert blanks(str(text)) == blanks(str(other[name])), name
        assert str(other[name]).strip(), name


def list_files():
    """Every file of the repository; of an unpacked sdist, which git does not know, what it has."""
    if (ROOT / ".git").exists():
        command = ["git", "ls-files"]
        done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
        return done.stdout.split("\n")
    found = [path for place in PLACES for path in (ROOT / place).rglob("*")]
    return [path.relative_to(ROOT).as_posix() for path in found if "node_modules" not in path.parts]


def test_nothing_in_the_repository_names_a_machine():
    marks = ["/" + a + b + "/" for a, b in (("ro", "ot"), ("ho", "me"), ("wo", "rk"))]
    for name in list_files():
        path = ROOT / name
        if (
            name
            and path.suffix in {".py", ".md", ".toml", ".j2", ".css", ".typ", ""}
            and path.is_file()
        ):
            text = path.read_text(encoding="utf-8", errors="replace")
            assert not [m for m in marks if m in text], name


def test_every_option_of_exam_and_key_of_blueprints_is_documented():
    from quizgen.paper.blueprint import Blueprint, SlotRule

    text = (ROOT / "docs" / "papers.md").read_text(encoding="utf-8")
    for option in root_group.get_command(None, "exam").params:
        assert any(name in text for name in option.opts), option.opts
    internal = {"name", "source", "topic", "budget"}
    for struct, hidden in ((Blueprint, internal), (SlotRule, set())):
        for field in msgspec.structs.fields(struct):
            assert field.name in hidden or field.name in text, field.name


def called(name, inner=""):
    """A command, or one of those that it holds."""
    command = root_group.get_command(None, name)
    return getattr(command, "commands", {}).get(inner, command)


PAIRS = [
    (name, inner)
    for name in COMMANDS
    for inner in getattr(root_group.get_command(None, name), "commands", [""])
]


@together(("name", "inner"), PAIRS)
def test_every_option_is_documented_and_explained(name, inner):
    pages = [*sorted((ROOT / "docs").glob("*.md")), ROOT / "README.md"]
    text = "".join(page.read_text(encoding="utf-8") for page in pages if page.stem != "api")
    for option in called(name, inner).params:
        for word in option.opts:
            assert not word.startswith("--") or word in text, word
        if isinstance(option, click.Option):
            assert option.help, option.opts


NOT_RUN = {
    "uv run quizgen check tests/lms/moodle/quiz.keys.jsonl "
    "tests/lms/moodle/responses.csv": "tests/cli/test_check_responses.py",
    "uv run python -m quizgen.cards.update_versions": "tests/cards/test_files.py",
    "uv run quizgen cards --lang both": "tests/stranger/test_day.py",
    "uv run quizgen cards --topic eye --jobs 4": "tests/cards/test_files.py",
    "uv run quizgen export moodle --topic optics --variants 5 --out week3/optics.xml": "tests/stranger/test_day.py",
}
"""What the commands of the documents do that another test does."""
TYPED = {page: {step.text for step in consoles.steps(page)} for page in consoles.PAGES}
FOLLOWED = [
    page
    for place, (page, typed) in enumerate(TYPED.items())
    if typed and not any(typed <= other for other in list(TYPED.values())[:place])
]
"""Pages with something to type; what stands whole on one before is typed there."""


@pytest.mark.slow
@pytest.mark.parametrize("page", FOLLOWED, ids=lambda page: page.stem)
def test_a_page_can_be_followed_from_top_to_bottom(page, tmp_path):
    folder = consoles.checkout(tmp_path)
    for step in consoles.steps(page):
        if step.file:
            consoles.save(step, folder)
            continue
        command = consoles.typed(step)
        if command in NOT_RUN:
            continue
        done = consoles.run(step.text, folder)
        place = f"{page.name}:{step.line}: {command}"
        assert done.returncode == 0, f"{place}\n{done.stderr}"
        assert not step.shown or consoles.agrees(step.shown, done.stdout), f"{place}\n{done.stdout}"


def test_commands_of_the_documents_begin_as_they_are_typed():
    found = [consoles.typed(step) for page in FOLLOWED for step in consoles.steps(page)
             if not step.file]  # fmt: skip
    assert len(found) >= 20
    assert not [command for command in found if not command.startswith("uv run ")]
    assert not {*NOT_RUN} - {*found}
    assert not [p.name for p in consoles.PAGES if {"sh", "bash", "shell"} & consoles.languages(p)]


INLINE = re.compile(r"`((?:uv run )?(?:quizgen|python|pytest)(?: [^`]*)?)`")


def test_commands_in_sentences_exist_with_their_options():
    count = 0
    for page in consoles.PAGES:
        for text in INLINE.findall(page.read_text("utf-8")):
            words = text.removeprefix("uv run ").split()
            assert words[0] == "quizgen" or text.startswith("uv run "), f"{page.name}: {text}"
            if words[0] == "quizgen" and len(words) > 1 and words[1] in COMMANDS:
                options = called(*words[1:3]).params
                known = {name for option in options for name in option.opts} | {"--help"}
                assert {w for w in words if w.startswith("--")} <= known, f"{page.name}: {text}"
                count += 1
    assert count >= 15


PAGES = [
    *consoles.PAGES,
    *(ROOT / name for name in ("ARCHITECTURE.md", "CHANGELOG.md", "benchmarks/README.md")),
]
PLACES = ("quizgen", "solvers", "templates", "tests", "tools", "benchmarks", "examples", "docs")
CODE_SPAN = re.compile(r"`([^`\n]+)`")
PYTHON_PATH = re.compile(r"[\w-]+(?:/[\w-]+)+\.py")
DOTTED_NAME = re.compile(r"quizgen(?:\.\w+)+")
INVENTED = {
    "banks.md": (
        "solvers/example/",
        "templates/example/",
        "templates/figures/block.py",
        "templates/locale/",
    ),
    "commands.md": ("templates/locale/",),
    "tutorial.md": ("starter/",),
    "mistakes.md": (
        "solvers/forces/",
        "templates/forces/",
        "templates/figures/",
        "templates/cards/",
    ),
    "diagnostics.md": ("solvers/forces/", "templates/forces/", "templates/figures/"),
    "extending.md": (
        "quizgen/kinds/hex_colour.py",
        "quizgen/camera/effects/veil.py",
        "quizgen/render/plain.py",
    ),
}
"""Files of the invented bank, kind, effect and output that a page builds."""
FILES_NAMED_QUIZGEN = {"quizgen.tsv", "quizgen.csv", "quizgen.apkg"}


def spans(page):
    """Code spans of a page; those with a blank to fill in, such as ``NAME``, name no file."""
    return [text for text in CODE_SPAN.findall(page.read_text("utf-8"))
            if not re.search(r"[<>*]|\bTOPIC\b|\bNAME\b|\bSUBJECT\b", text)]  # fmt: skip


@together("page", PAGES)
def test_every_path_in_a_page_exists(page):
    invented = INVENTED.get(page.name, ())
    paths = [
        text
        for text in spans(page)
        if PYTHON_PATH.fullmatch(text)
        or (re.fullmatch(r"[\w./-]+", text) and text.startswith(tuple(f"{p}/" for p in PLACES)))
    ]
    missing = [path for path in paths if not (ROOT / path).exists()]
    assert [path for path in missing if not path.startswith((*invented, "quizgen/en/"))] == []


def is_importable(name):
    module, _, attribute = name.rpartition(".")
    try:
        importlib.import_module(name)
    except ModuleNotFoundError:
        return hasattr(importlib.import_module(module), attribute)
    return True


@together("page", PAGES)
def test_every_dotted_name_in_a_page_can_be_imported(page):
    names = {match[0] for text in spans(page) if (match := DOTTED_NAME.match(text))}
    assert [name for name in sorted(names - FILES_NAMED_QUIZGEN) if not is_importable(name)] == []


ARCHAIC = re.compile(r"\bof which\b|\banew\b|\bwhoever\b|\bbesides\b", re.IGNORECASE)


@together("page", PAGES)
def test_pages_are_in_plain_modern_english(page):
    text = page.read_text("utf-8")
    if page.name == "glossary.md":  # lists the words that are not used
        text = text.partition("Words that name nothing, for no new name:")[0]
    assert ARCHAIC.findall(text) == []


def test_the_rooms_of_the_architecture_are_the_packages():
    text = (ROOT / "ARCHITECTURE.md").read_text("utf-8")
    rooms = set(re.findall(r"^\| \d+ \| `quizgen/(\w+)/`", text, re.MULTILINE))
    assert rooms == {path.parent.name for path in (ROOT / "quizgen").glob("*/__init__.py")}


def test_names_of_the_glossary_stand_in_the_code():
    text = (ROOT / "docs" / "glossary.md").read_text("utf-8")
    glossary = text.partition("Verbs mean")[0]
    names = set(re.findall(r"`([A-Z]\w+|\w+_\w+)`", glossary))
    code = "\n".join(path.read_text("utf-8") for path in (ROOT / "quizgen").rglob("*.py"))
    assert len(names) >= 35
    missing = [
        name
        for name in sorted(names)
        if not re.search(rf"^ *(?:class |def )?{name}\b", code, re.MULTILINE)
    ]
    assert missing == []


IMPORT = re.compile(r"^(?:>>> )?from (quizgen[\w.]*) import (\w+(?:, \w+)*)$", re.MULTILINE)


@together("page", PAGES)
def test_what_a_page_imports_exists(page):
    invented = {"veil", "plain", "hex_colour"}
    missing = [
        f"{module}.{name}"
        for module, names in IMPORT.findall(page.read_text("utf-8"))
        for name in names.split(", ")
        if name not in invented and not is_importable(f"{module}.{name}")
    ]
    assert missing == []

"""Questions to export: some of every kind by default, all of them in the slow tests."""

from __future__ import annotations

import shutil
from collections import defaultdict
from itertools import cycle

import pytest
from sweep import draws

from quizgen.bank.bank import Bank
from quizgen.lms.items import ExportItem, items_from_templates
from quizgen.question.compose import compose_question


def some(bank, count: slice) -> list[str]:
    """A few templates of every kind."""
    by_kind = defaultdict(list)
    for name in bank.template_paths:
        for part in bank.rules(name).part:
            by_kind[part.answer["kind"]].append(name)
    return list(dict.fromkeys(name for names in by_kind.values() for name in names[count]))


@pytest.fixture(scope="session")
def items(bank) -> list[ExportItem]:
    """The first templates of every kind in English, the last ones in Bangla."""
    single = ["imread-missing-file", "luminous-flux-over-bands", "demosaic-at-border"]
    names = dict.fromkeys([*some(bank, slice(2)), *single])
    english = items_from_templates(bank, list(names), 1, 1, ["en"])
    return [*english, *items_from_templates(bank, some(bank, slice(-1, None)), 2, 1, ["bn"])]


AWKWARD = (
    "[blank1] [[1]]", "{1:NUMERICAL:=3}", "]]> ]]]]>", "~%100%no#fb", "a=b ~ c # d } e {", "\"quoted\" 'it'",
    "`{1:SHORTANSWER:=x}~#=%`", "&amp; &#35; & <!-- -->", "[abcd-2345]", "a -> b -> c; d",
    "// [id:x] ::n:: %0%", "৩,১৪ and 3,14; -1234,5", "x* * y", "{=right ~wrong}",
)  # fmt: skip
"""Texts that mean something to a reader of one format or another."""
WORDS = ("a{b}c", "x~y", "p#q", "r=s", '"v"', "w'x", "%100%z", "ক,খ")
"""The same for words that are typed."""


@pytest.fixture(scope="session")
def awkward(bank, tmp_path_factory) -> list[ExportItem]:
    """Questions of an own bank, whose stories, options, reasons and words hold them."""
    root, texts, words = tmp_path_factory.mktemp("awkward"), cycle(AWKWARD), cycle(WORDS)
    for name in ("rods-cones-and-peaks", "imread-missing-file", "mixing-kind-and-primaries"):
        folder = root / "templates" / bank.rules(name).topic / name
        shutil.copytree(bank.template_paths[name], folder)
        for file in folder.glob("*.md"):
            section, lines = "", []
            for line in file.read_text("utf-8").splitlines():
                section = line.removeprefix("## ") if line.startswith("## ") else section
                named = line.startswith("- ") and "____" not in line
                story = not section and line.endswith((".", "।"))
                long = story or (named and section in {"options", "reasons"})
                short = named and section == "gaps"
                more = f" {next(texts)}" if long else f" | {next(words)}" if short else ""
                lines.append(line + more)
            file.write_text("\n".join(lines), "utf-8")
    own = Bank(root)
    return list(items_from_templates(own, list(own.template_paths), 0, 2, ["en", "bn"]))


@pytest.fixture(scope="session")
def everything(bank) -> list[ExportItem]:
    """The whole bank in two languages, in full five times."""
    return list(
        items_from_templates(bank, list(bank.template_paths), 0, draws(1, full=5), ["en", "bn"])
    )


@pytest.fixture(scope="session")
def reference(bank):
    """A question with the numbers of the notes."""

    def made(name: str, lang: str = "en") -> ExportItem:
        question, key = compose_question(bank.template(name), "reference", lang)
        return ExportItem(f"{name}.reference.{lang}", name, question, key)

    return made

"""The whole road of a paper: printed, filled in by hand, marked from its files.

What is typed is taken from what is printed, the solution and the hint beside the field, and never
from the key: so a key that lost something on its way through a file is found out.
"""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from click.testing import CliRunner

from quizgen.bank.bank import Bank
from quizgen.cli.check import check
from quizgen.paper.answer_form import write_blank_form
from quizgen.paper.answer_key import write_answer_key
from quizgen.paper.blueprint import Blueprint, SlotRule
from quizgen.paper.paper import Paper, build_paper

NAMED = re.compile(r"\s*(.+?) = (.+)", re.DOTALL)


@dataclass(frozen=True)
class Printed:
    """One field of a paper as a student sees it, with what the solutions page says of it."""

    id: str
    template: str
    form: str
    hint: str
    answer: str
    mistakes: tuple[tuple[str, str], ...]


def all_templates(
    bank: Bank, seed: int, lang: str = "both", level: str = "exam", each: int = 1
) -> Paper:
    """A paper in which each template of the bank stands once; one draw serves all languages."""
    slots = tuple(SlotRule(templates=(name,)) for name in [*bank.template_paths][::each])
    blueprint = Blueprint(
        {"en": "Everything"}, slots, name="everything", source="everything", level=level
    )
    return build_paper(bank, blueprint, seed, lang, figures=False)


IN_PROCESSES = {"program"}
"""Kinds whose answers take a process each: tests/templates/test_programs_run.py."""


def fields(paper: Paper, lang: str) -> Iterator[Printed]:
    """The fields that a machine marks; free text has no printed answer and is left out."""
    place = paper.langs.index(lang)
    for item in paper.items:
        question, key = item.questions[place], item.keys[place]
        for part, solved, spec in zip(question.parts, key.solution.parts, key.specs, strict=True):
            if (
                solved.answer and spec.kind not in IN_PROCESSES
            ):  # what is no trap is a reason for one option, pair or step
                mistakes = tuple(
                    # of a drawing no wrong points are printed: those of the key are typed
                    (m.name, m.value or "; ".join(spec.traps[m.name].values()))
                    for m in solved.mistakes if m.name in spec.traps
                )  # fmt: skip
                control = part.field.control
                form = "rows" if control.rows else control.form
                yield Printed(part.field.id, key.template, form,
                              " ".join(part.field.hints), solved.answer, mistakes)  # fmt: skip


def typed(field: Printed, printed: str, side: int = 0) -> str:
    """What a student types who reads the solution and does what the hint asks.

    ``side`` chooses between an exact value and its rounded one, where both are printed.
    """
    sides = printed.split(" ≈ ")
    text = sides[min(side, len(sides) - 1)]
    if field.form == "rows":
        return text
    if field.form == "pairs":
        return text.replace(":", "").replace(",", "")
    pairs = [NAMED.fullmatch(cell) for cell in text.split("; ")]
    if not all(pairs):
        return text
    values = {pair[1]: pair[2] for pair in pairs if pair}
    return "; ".join(values[name] for name in sorted(values, key=lambda n: _place(field, n)))


def _place(field: Printed, name: str) -> int:
    """Where a name stands in the hint, which shows how to type it where names are typed."""
    hint, name = _on_line(field.hint), _on_line(name)
    found = re.search(rf"(?<!\w){re.escape(name)}(?!\w)", hint)
    assert found, f"{field.template}: the hint does not name {name}: {field.hint}"
    return found.start()


def _on_line(text: str) -> str:
    """A text without subscripts, as a person at a keyboard reads it."""
    plain = text.translate(str.maketrans("₀₁₂₃₄₅₆₇₈₉ₓ′", "0123456789x'"))
    return plain.replace("_", "")


class Desk:
    """A folder with a paper's key and blank form, and what was filled in."""

    def __init__(self, folder: Path, paper: Paper) -> None:
        self.folder, self.paper = folder, paper
        self.key = folder / "key.json"
        self.key.write_bytes(write_answer_key(paper))
        self.blank = write_blank_form(paper).decode()
        self.sheet = write_blank_form(paper, "csv").decode("utf-8-sig")
        self.forms: list[Path] = []

    def toml(self, answers: dict[str, str]) -> None:
        """Fill in the printed form with an editor."""
        lines = []
        for line in self.blank.splitlines():
            name = re.match(r'"(.+?)" = ""', line)
            text = answers.get(name[1], "") if name else ""
            quoted = json.dumps(text, ensure_ascii=False)
            lines.append(line.replace('""', quoted, 1) if text else line)
        self._keep(f"{len(self.forms)}.toml", "\n".join(lines))

    def csv(self, answers: dict[str, str]) -> None:
        """Fill in the form with a spreadsheet, which writes semicolons where commas are decimal."""
        rows = list(csv.reader(io.StringIO(self.sheet)))
        cells = [[*row[:-1], answers.get(row[0], row[-1])] for row in rows]
        out = io.StringIO()
        csv.writer(out, delimiter=",;"[len(self.forms) % 2]).writerows(cells)
        self._keep(f"{len(self.forms)}.csv", out.getvalue())

    def json(self, answers: dict[str, str], lang: str) -> None:
        """Fill in the page, which saves this."""
        student = {"name": "", "lang": lang, "decimal": "auto"}
        data = {"code": self.paper.code, "student": student, "answers": answers}
        self._keep(f"{len(self.forms)}.json", json.dumps(data, ensure_ascii=False))

    def _keep(self, name: str, text: str) -> None:
        self.forms.append(self.folder / name)
        self.forms[-1].write_text(text, encoding="utf-8")

    def marks(self, key: Path | None = None) -> list[dict[str, dict]]:
        """Part to result, for each form, as ``quizgen check`` prints it."""
        files = [str(key or self.key), *map(str, self.forms)]
        done = CliRunner().invoke(check, [*files, "--json", "--no-settle"])
        assert done.exit_code == 0, done.output
        read = json.loads(done.stdout)
        papers = read if isinstance(read, list) else [read]
        return [{part["id"]: part for part in paper["parts"]} for paper in papers]

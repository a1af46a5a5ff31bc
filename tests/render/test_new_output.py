"""An output is one module and its place in the table: an invented one makes files."""

from __future__ import annotations

import pytest
from click.testing import CliRunner

from quizgen import render
from quizgen.cli.main import root_group
from quizgen.render.text import blocks_to_plain_text


def plain(paper, kind):
    lines = [paper.code, kind]
    for item in paper.items:
        lines += [
            f"{item.number}. {item.questions[0].title}",
            *blocks_to_plain_text(item.questions[0].stem),
        ]
    return "\n".join(lines).encode()


@pytest.fixture
def with_plain(monkeypatch):
    known = render.load_renderer
    monkeypatch.setattr(render, "RENDERERS", (*render.RENDERERS, "plain"))
    monkeypatch.setattr(
        render, "load_renderer", lambda name: plain if name == "plain" else known(name)
    )


@pytest.mark.usefixtures("with_plain")
def test_the_exam_command_writes_an_invented_format(tmp_path):
    options = ["--seed", "5", "--blueprint", "trial", "--format", "plain", "--out", str(tmp_path)]
    done = CliRunner().invoke(root_group, ["exam", *options])
    assert done.exit_code == 0, done.output
    exam = (tmp_path / "exam.plain").read_text(encoding="utf-8").splitlines()
    assert exam[1] == "exam"
    assert (tmp_path / "solutions.plain").read_text(encoding="utf-8").startswith(exam[0])
    assert len([line for line in exam if line[:2] in {f"{n}." for n in range(1, 6)}]) == 5

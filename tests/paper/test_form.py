"""Forms: when one holds something that must not be overwritten."""

from __future__ import annotations

import pytest
from small_bank import ONE

from quizgen.paper.form import form_bytes, holds_answers, read_answers
from quizgen.paper.paper import build


@pytest.fixture
def form(bank, tmp_path):
    path = tmp_path / "answers.toml"
    path.write_bytes(form_bytes(build(bank, ONE, 1, figures=False)))
    return path


def test_a_blank_form_and_no_form_hold_nothing(form):
    assert not holds_answers(form)
    assert not holds_answers(form.with_name("none.toml"))


@pytest.mark.parametrize(
    ("old", "new"),
    [('"1" = ""', '"1" = "(4; 6)"'), ('"1" = ""', '"1" = 0'), ('name = ""', 'name = "Rahim"'),
     ("[answers]", "[answers"), ('decimal = "auto"', 'decimal = "dot"')],
)  # fmt: skip
def test_an_answer_a_name_or_what_cannot_be_read_is_kept(form, old, new):
    text = form.read_text("utf-8")
    assert old in text
    form.write_text(text.replace(old, new, 1), "utf-8")
    assert holds_answers(form)


def test_blanks_are_no_answer_and_a_form_reads_back(form):
    text = form.read_text("utf-8").replace('"1" = ""', '"1" = "  "')
    form.write_text(text, "utf-8")
    assert not holds_answers(form)
    assert read_answers(form).typed() == {"1": "  "}

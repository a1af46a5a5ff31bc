"""Drawn numbers printed as Python's format does, in words, programs and outputs."""

from __future__ import annotations

import pytest

from quizgen.bank.bank import Bank
from quizgen.bank.variant import draw_variant
from quizgen.core.errors import BankError
from quizgen.question.compose import compose_variant
from quizgen.question.part_context import ask_part
from quizgen.render.text import blocks_to_plain_text

RULES = """topic = "t"
tier = "A"
[draw]
h = {{ range = [1, 9, 1] }}
n = {{ range = [3, 60, 1] }}
q = {{ is = "h/8" }}
[[part]]
answer = {{ kind = "code", output = "{output}" }}
"""
WORDS = (
    "# T\nAt {{ h:02 }}:00 the register holds `{{ n:08b }}`, {{ q:.2f }} of it.\n\n## why\nSo.\n"
)


def draw(root, output, words=WORDS):
    folder = root / "templates" / "t" / "mine"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(RULES.format(output=output))
    (folder / "en.md").write_text(words)
    return draw_variant(Bank(root).template("mine"), 1)


@pytest.mark.parametrize("spec", ["02", "b", "08b", "x", "X", "o", "04X", ".2f", "3d"])
def test_an_output_is_what_python_prints(tmp_path, spec):
    one = draw(tmp_path, f"<{{{{ n:{spec} }}}}>")
    n = int(one.shown["n"])
    assert ask_part(one, 0).spec.output == f"<{n:{spec}}>"


def test_words_and_programs_print_the_number_alone(tmp_path):
    one = draw(tmp_path, "{{ n }}")
    h, n = int(one.shown["h"]), int(one.shown["n"])
    (text,) = blocks_to_plain_text(compose_variant(one, "en")[0].stem)
    assert text == f"At {h:02}:00 the register holds {n:08b}, {h / 8:.2f} of it."


@pytest.mark.parametrize(
    ("output", "rule"), [("{{ q:b }}", "QG158"), ("{{ n:q }}", "QG154"), ("{{ n|b }}", "QG154")]
)
def test_a_format_that_there_is_not_is_an_error(tmp_path, output, rule):
    one = draw(tmp_path, output)
    if one.shown["q"].q == 1:
        pytest.skip("a whole number can be printed so")
    with pytest.raises(BankError) as found:
        ask_part(one, 0)
    assert found.value.rule == rule

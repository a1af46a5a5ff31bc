"""A paper's code: what it says, what it pins, and what is refused."""

from __future__ import annotations

import hashlib

import pytest
from small_bank import NAME, ONE, copied, fresh
from sweep import together

from quizgen.bank.variant import draw_variant
from quizgen.core.errors import InvalidChoiceError, PaperCodeError, QuizgenError
from quizgen.paper.answer_key import write_answer_key
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.code import PaperCode, check_seed, parse_code, source_digest
from quizgen.paper.paper import build_paper, rebuild_paper


def test_a_code_is_taken_apart_and_put_together():
    code = parse_code("  my-own-plan-12-both-0a1b2c\n")
    assert code == PaperCode("my-own-plan", "12", "both", "0a1b2c")
    assert str(code) == "my-own-plan-12-both-0a1b2c"
    assert not code.is_reference
    assert parse_code("mock-reference-en-0a1b2c").is_reference


@together(
    "text",
    ["", "hello", "mock-12-en", "mock-12-en-0a1b2", "mock-12-en-0a1b2C", "mock-x-en-0a1b2c",
     "mock--1-en-0a1b2c x", "mock-12345678901-en-0a1b2c", "-12-en-0a1b2c"],
)  # fmt: skip
def test_what_is_no_code_is_refused(text):
    with pytest.raises(PaperCodeError, match="not a paper's code"):
        parse_code(text)


@together("choice", ["en", "both", "fr", "pt-BR", "sr-Latn", "es-419"])
@together("level", ["", "-guided"])
def test_a_code_holds_any_language_and_its_bank_says_whether_it_has_it(bank, choice, level):
    code = parse_code(f"mock-12-{choice}{level}-0a1b2c")
    assert (code.blueprint, code.seed, code.choice) == ("mock", "12", choice)
    assert code.level == (level[1:] or "exam")
    if choice not in {"en", "both"}:
        with pytest.raises(InvalidChoiceError, match=r"\(allowed: en, bn, both\)"):
            rebuild_paper(bank, "mock-12-xx-0a1b2c")


def test_the_digest_is_of_engine_blueprint_and_template_files(bank):
    template = bank.template(NAME)
    text = f"1\nsource{NAME}:{template.digest}\n"
    assert (
        source_digest("source", [template], ["exam"])
        == hashlib.sha256(text.encode()).hexdigest()[:6]
    )


@pytest.mark.parametrize("file", ["template.toml", "en.md", "bn.md", "solver"])
def test_one_byte_in_a_file_behind_a_template_changes_the_code(tmp_path, file):
    folder = copied(tmp_path)
    code = build_paper(fresh(tmp_path), ONE, 7, figures=False).code
    assert rebuild_paper(fresh(tmp_path), code, ONE, figures=False).code == code
    solver = tmp_path / "solvers" / "projection" / "perspective.py"
    path = solver if file == "solver" else folder / file
    path.write_bytes(path.read_bytes() + b"\n")
    assert build_paper(fresh(tmp_path), ONE, 7, figures=False).code != code
    with pytest.raises(PaperCodeError, match="other templates or another version"):
        rebuild_paper(fresh(tmp_path), code, ONE, figures=False)


def test_a_file_beside_the_template_changes_nothing(tmp_path):
    folder = copied(tmp_path)
    code = build_paper(fresh(tmp_path), ONE, 7, figures=False).code
    (folder / "notes.md").write_text("not prose of any language")
    assert build_paper(fresh(tmp_path), ONE, 7, figures=False).code == code


def test_a_value_is_the_documented_hash(bank):
    """docs/papers.md: origin/version/seed/slot/variable/try, eight bytes, modulo the candidates."""
    template = bank.template(NAME)
    listed = {
        "f": range(2, 7),
        "p_x": [n for n in range(-15, 16) if n],
        "p_y": [n for n in range(-15, 16) if n],
        "p_z": range(2, 13),
    }
    for seed in (0, 9, 123456):
        one = draw_variant(template, seed, 3)
        for name, values in listed.items():
            key = f"A3/2/{seed}/3/{name}/{one.tries - 1}"
            first = int.from_bytes(hashlib.sha256(key.encode()).digest()[:8], "big")
            assert one.shown[name] == values[first % len(values)], (seed, name)


@together("seed", [-1, 10**9 + 1, "x", "5", 1.0, True, None])
def test_a_wrong_seed_is_named_with_what_is_allowed(bank, seed):
    with pytest.raises(InvalidChoiceError, match=r"seed: .*whole numbers from 0 to 1000000000"):
        build_paper(bank, load_blueprint("trial"), seed)


@pytest.mark.parametrize("choice", ["fr", "", 7, None, ["en"]])
def test_a_wrong_language_is_named_with_what_is_allowed(bank, choice):
    with pytest.raises(
        InvalidChoiceError, match=r"language: .*\(allowed: en, bn, both\)"
    ) as caught:
        build_paper(bank, load_blueprint("trial"), 1, choice)
    assert isinstance(caught.value, QuizgenError)
    assert isinstance(caught.value, ValueError)


def test_the_largest_seed_can_be_built_again(bank):
    paper = build_paper(bank, ONE, 10**9, figures=False)
    assert write_answer_key(
        rebuild_paper(bank, paper.code, ONE, figures=False)
    ) == write_answer_key(paper)


@pytest.mark.parametrize("seed", [0, 1, 10**9])
def test_a_seed_from_zero_to_a_billion_is_taken(seed):
    assert check_seed(seed) == seed

"""Drawn lists, tables and text: with data.py and without, in prose, keys, figures and files."""

from __future__ import annotations

import hashlib
import json
import statistics
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from flint import fmpq

from quizgen.bank.bank import Bank
from quizgen.bank.drawn_lists import round_float
from quizgen.bank.frozen_random import FrozenGenerator
from quizgen.bank.variant import draw_variant
from quizgen.core.decoding import convert
from quizgen.core.errors import BankError, SamplingError
from quizgen.kinds.grade import grade_answer
from quizgen.lint.item_quality import count_pool
from quizgen.lint.unused_draws import find_unused_draws
from quizgen.maths.numbers import to_fraction
from quizgen.paper.answer_key import KeyChain
from quizgen.question.compose import compose_question, compose_variant
from quizgen.question.data_files import iter_data_files
from quizgen.render.text import blocks_to_plain_text

PART = '[[part]]\npoints = 1\nanswer = { kind = "number", of = "m", decimals = 4 }\n'
HEAD = 'topic = "t"\ntier = "A"\nlevels = []\nsolver = "model"\n'
SOLVER = """
from sympy import evaluate, symbols
from quizgen.maths.lists import mean, var, median, sort
from quizgen.maths.model import Model, Step
x, m = symbols("x m")
with evaluate(False):
    MODEL = Model(given={x: ""}, steps=(Step(m, %s),), traps={"t": Step(m, %s)})
"""
WORDS = "# T\n{{ x }}\n\n## steps\n\n- m: so.\n\n## traps\n\n- t: no.\n"


def make_bank(
    root: Path, rules: str, data: str = "", *, trusted: bool = True, **texts: str
) -> Bank:
    """A bank of one question; ``words``, ``step`` and ``trap`` are texts, others are files."""
    folder = root / "templates" / "t" / "mine"
    folder.mkdir(parents=True)
    (root / "solvers").mkdir()
    steps = texts.pop("step", "mean(x)"), texts.pop("trap", "mean(x) + 1")
    (root / "solvers" / "model.py").write_text(SOLVER % steps)
    (folder / "template.toml").write_text(HEAD + rules + PART)
    (folder / "en.md").write_text(texts.pop("words", WORDS))
    for name, text in texts.items():
        (folder / name.replace("_", ".")).write_text(text)
    if data:
        (folder / "data.py").write_text(data)
    return Bank(root, trusted=trusted)


def draw(root: Path, rules: str, seed: int = 1, **how):
    return draw_variant(make_bank(root, rules, **how).template("mine"), seed)


NORMAL = (
    '[draw]\nn = { range = [8, 12, 1] }\nx = { normal = ["100", "15"], size = "n", decimals = 1 }\n'
)


def test_the_streams_of_the_generator_never_change():
    # printed once by numpy.random.RandomState seeded with the eight words of the digest
    words = np.frombuffer(hashlib.sha256(b"a key").digest(), dtype=">u4").astype(np.uint32)
    state, ours = np.random.RandomState(words), FrozenGenerator("a key")
    assert ours.normal(3, 2, 4).tolist() == state.normal(3, 2, 4).tolist()
    assert ours.integers(5, 9, 6).tolist() == state.randint(5, 9, 6).tolist()
    assert ours.permutation(7).tolist() == state.permutation(7).tolist()
    assert ours.poisson(4, 5).tolist() == state.poisson(4, 5).tolist()
    assert ours.binomial(9, 0.3, 5).tolist() == state.binomial(9, 0.3, 5).tolist()
    assert ours.multinomial(20, [0.5, 0.25, 0.25]).sum() == 20
    assert FrozenGenerator("another").random() != FrozenGenerator("a key").random()


@pytest.mark.parametrize(
    ("value", "decimals", "rounded"),
    [(0.25, 1, "0.3"), (-0.25, 1, "-0.3"), (2.675, 2, "2.67"), (1e-9, 3, "0"), (12.0, 0, "12")],
)
def test_a_float_is_rounded_once_half_away_from_zero(value, decimals, rounded):
    assert to_fraction(round_float(value, decimals)) == Fraction(rounded)


def test_a_normal_list_has_its_size_and_its_decimals(tmp_path):
    template = make_bank(tmp_path, NORMAL).template("mine")
    for seed in range(20):
        one = draw_variant(template, seed)
        values = [to_fraction(v) for v in one.lists["x"]]
        assert len(values) == int(one.shown["n"])
        assert all(v * 10 == int(v * 10) for v in values)
        assert to_fraction(one.values["m"]) == statistics.mean(values)
        assert draw_variant(template, seed).lists == one.lists
    everything = [
        float(v) for s in range(60) for v in map(to_fraction, draw_variant(template, s).lists["x"])
    ]
    assert abs(np.mean(everything) - 100) < 3
    assert abs(np.std(everything) - 15) < 2


def test_samples_and_permutations_take_each_value_once(tmp_path):
    rules = "[draw]\nx = { sample = [1, 2, 3, 4, 5, 6, 7, 8], size = 5 }\n"
    one = draw(tmp_path / "a", rules)
    assert len(set(one.lists["x"])) == 5
    other = draw(tmp_path / "b", "[draw]\nx = { permutation = [1, 2, 3, 4.5] }\n")
    assert sorted(other.lists["x"]) == [1, 2, 3, fmpq(9, 2)]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("rows_csv", "a,x\n1,10\n2,20\n3,30\n4,40\n"),
        ("rows_json", '{"a": [1, 2, 3, 4], "x": [10, 20, 30, 40]}'),
        (
            "rows_json",
            '[{"a": 1, "x": 10}, {"a": 2, "x": 20}, {"a": 3, "x": 30}, {"a": 4, "x": 40}]',
        ),
    ],
)
def test_columns_of_a_file_share_their_rows(tmp_path, name, text):
    file = name.replace("_", ".")
    rules = f'[draw]\nx = {{ table = "{file}", take = 3 }}\na = {{ table = "{file}", take = 3 }}\n'
    one = draw(tmp_path, rules, **{name: text})
    assert len(one.lists["x"]) == 3
    assert [10 * v for v in one.lists["a"]] == list(one.lists["x"])


def test_values_by_key_and_by_place(tmp_path):
    rules = (
        '[draw]\nx = { values = [1, 2, 6] }\nc = { words = ["eur", "usd"] }\nk = { pick = [2, 3] }\n'
        'r = { of = { eur = 1, usd = "1.3109" }, at = "c" }\nv = { of = "x", at = "k" }\n'
    )
    template = make_bank(tmp_path, rules).template("mine")
    for seed in range(12):
        one = draw_variant(template, seed)
        assert one.shown["r"] == (1 if one.words["c"] == "eur" else fmpq(13109, 10000))
        assert one.shown["v"] == (2 if one.shown["k"] == 2 else 6)


def test_conditions_hold_over_lists(tmp_path):
    rules = 'where = ["max(x) - min(x) > 20", "x[1] < x[2]", "sd(x) < 20"]\n' + NORMAL
    template = make_bank(tmp_path, rules).template("mine")
    for seed in range(10):
        x = [float(to_fraction(v)) for v in draw_variant(template, seed).lists["x"]]
        assert max(x) - min(x) > 20
        assert x[0] < x[1]
        assert statistics.stdev(x) < 20


DATA = """import numpy as np
def draw(rng):
    if rng.random() < 0.5:
        return None
    x = np.sort(rng.normal(50, 5, 6))
    return {"pairs": {"x": x, "y": 2 * x}, "n": np.int64(6), "who": "Ana", "r": "1.25"}
"""
DECLARED = "[data]\nx = { decimals = 1 }\ny = { decimals = 1 }\nn = {}\nwho = {}\nr = {}\n"


def test_data_gives_numbers_lists_tables_and_text(tmp_path):
    template = make_bank(tmp_path, DECLARED, DATA).template("mine")
    one = draw_variant(template, 3)
    assert len(one.lists["x"]) == len(one.lists["y"]) == 6
    assert (one.shown["n"], one.shown["r"], one.words["who"]) == (6, fmpq(5, 4), "Ana")
    assert any(draw_variant(template, seed).tries > 1 for seed in range(8))


def test_data_runs_in_a_trusted_bank_alone_and_counts_for_it(tmp_path):
    bank = make_bank(tmp_path, DECLARED, DATA, trusted=False)
    with pytest.raises(BankError, match="allow it with --trust"):
        bank.template("mine")
    trusted = Bank(tmp_path, trusted=True)
    before = trusted.template("mine").digest
    assert DATA.encode() in trusted.template_files("mine")
    draw_variant(trusted.template("mine"), 1)
    assert not list(tmp_path.rglob("__pycache__/data*"))
    (tmp_path / "templates/t/mine/data.py").write_text(DATA + "# more\n")
    assert Bank(tmp_path, trusted=True).template("mine").digest != before


@pytest.mark.parametrize(
    ("body", "line", "what"),
    [
        ('return {"x": [1 / 3]}', 1, "x: 0.3333333333333333 is not rounded"),
        ('return {"x": [1], "z": 2}', 1, "'z', which \\[data\\] does not list"),
        ("return {}", 1, "does not give \\['x'\\]"),
        ("return [1]", 1, "gives no dict"),
        ('return {"x": [True]}', 1, "True is no number"),
        ('return {"x": [float("nan")]}', 1, "nan is no number"),
        ('return {"x": []}', 1, "a list of 0 values"),
        ('return {"t": {"x": [1, 2], "y": [1]}}', 1, "no lists of one length"),
        ("return 1 / 0", 2, "ZeroDivisionError"),
        ("return rng.weibull(1)", 2, "AttributeError"),
        ("raise SystemExit(3)", 2, "SystemExit"),
    ],
)
def test_what_is_wrong_in_data_is_told_with_its_line(tmp_path, body, line, what):
    template = make_bank(tmp_path, "[data]\nx = {}\n", f"def draw(rng):\n    {body}\n").template(
        "mine"
    )
    with pytest.raises(BankError, match=what) as caught:
        draw_variant(template, 1)
    assert caught.value.file.name == "data.py"
    assert caught.value.line == line


def test_data_that_is_never_given_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr("quizgen.bank.variant.MAX_TRIES", 20)
    template = make_bank(tmp_path, "[data]\nx = {}\n", "def draw(rng):\n    pass\n").template(
        "mine"
    )
    with pytest.raises(SamplingError, match="gives None"):
        draw_variant(template, 1)


@pytest.mark.parametrize(
    ("rules", "what"),
    [
        ('[draw]\nx = { normal = ["1", "2"], size = 5 }\n', "normal needs decimals"),
        ('[draw]\nx = { normal = ["1", "2"], decimals = 1 }\n', "normal needs size"),
        ('[draw]\nx = { normal = ["1", "2"], size = 5, decimals = 99 }\n', "must be 0 to"),
        ("[draw]\nx = { sample = [1, 2], size = 3 }\n", "a sample of 3 out of 2"),
        ('[draw]\nx = { table = "no.csv" }\n', "no.csv"),
        ('[draw]\nx = { table = "../no.csv" }\n', "no .csv or .json beside"),
        ("[draw]\nx = { values = [1], pick = [2] }\n", "exactly one of"),
        ('[draw]\nx = { values = [1, 2] }\ny = { is = "x + 1" }\n', "a list stands where a number"),
        ('[draw]\nx = { values = [1, 2] }\ny = { is = "x" }\n', "a list, where a number"),
        ('[draw]\nx = { values = [1, 2] }\nk = { of = "x", at = "3" }\n', "no place 3"),
        ("[data]\nx = {}\n", "no data.py beside it"),
        ('[files]\n"../a.csv" = ["x"]\n[draw]\nx = { values = [1, 2] }\n', "is no file of letters"),
    ],
)  # fmt: skip
def test_a_wrong_rule_is_one_located_line(tmp_path, rules, what):
    with pytest.raises(BankError, match=what) as caught:
        draw(tmp_path, rules)
    assert caught.value.file is not None


def test_a_step_that_is_a_list_is_refused(tmp_path):
    with pytest.raises(BankError, match="step 'm' is a list"):
        draw(tmp_path, "[draw]\nx = { values = [1, 2] }\n", step="sort(x)")


PROSE = (
    "# T\n{{ x }} and {{ x[2] }}.\n\n{{ table: x y }}\n\n`a = [{{ x }}]`\n\n"
    "## steps\n\n- m: so.\n\n## traps\n\n- t: no.\n"
)
FIXED = (
    '[files]\n"d.csv" = ["x", "y"]\n[draw]\nx = { values = [3, "2.5", -1], unit = "" }\n'
    'y = { values = [1, 2, 3], unit = "cm" }\nz = { range = [1, 9, 1] }\n'
)


def test_lists_in_words_tables_code_and_files(tmp_path):
    template = make_bank(tmp_path, FIXED, words=PROSE, trap="median(x)").template("mine")
    question, key = compose_question(template, 1)
    text = "\n".join(blocks_to_plain_text(question.stem))
    assert "3.0; 2.5; −1.0 and 2.5." in text
    assert "x | y\xa0/\xa0cm\n3.0 | 1\n2.5 | 2\n−1.0 | 3" in text
    assert "a = [3.0, 2.5, -1.0]" in text
    assert "The data are in the file 1-d.csv." in text
    assert dict(iter_data_files(key.draw, "1")) == {"1-d.csv": b"x,y / cm\n3.0,1\n2.5,2\n-1.0,3\n"}
    assert key.chain["given"]["x"]["value"] == ["3", "5/2", "-1"]
    (line,) = key.solution.parts[0].lines
    assert line.maths.text == "m = mean(x) = (3.0 + 2.5 + (−1.0))/3 = 1.5"


def test_a_list_that_a_table_lacks_is_told(tmp_path):
    words = PROSE.replace("x y }}", "x q }}")
    template = make_bank(tmp_path, FIXED, words=words, trap="median(x)").template("mine")
    with pytest.raises(BankError, match="q is not a drawn list"):
        compose_variant(draw_variant(template, 1), "en")


def test_what_nothing_uses_is_found_and_not_counted(tmp_path):
    template = make_bank(tmp_path, FIXED, words=PROSE, trap="median(x)").template("mine")
    assert find_unused_draws(template) == ["z"]
    assert count_pool(template) == 0


def test_a_long_sum_is_shortened(tmp_path):
    rules = "[draw]\nx = { values = [1, 2, 3, 4, 5, 6, 7, 9] }\n"
    template = make_bank(tmp_path, rules).template("mine")
    _, key = compose_question(template, 1)
    assert "= (1 + 2 + … + 9)/8 = 4.625" in key.solution.parts[0].lines[0].maths.text


def test_a_key_with_lists_is_solved_without_drawing_again(tmp_path):
    template = make_bank(tmp_path, FIXED, words=PROSE, trap="median(x)").template("mine")
    _, key = compose_question(template, 1)
    chain = convert(json.loads(json.dumps(key.chain)), KeyChain)
    assert chain.context({}).solved_values["m"] == fmpq(3, 2)


@pytest.mark.parametrize(
    ("typed", "verdict", "note"),
    [("1.5", "correct", ""), ("2.5", "wrong", "trap:t"), ("77", "wrong", "")],
)
def test_answers_are_marked_by_a_key_with_lists(tmp_path, typed, verdict, note):
    template = make_bank(tmp_path, FIXED, words=PROSE, trap="median(x)").template("mine")
    _, key = compose_question(template, 1)
    context = convert(json.loads(json.dumps(key.chain)), KeyChain).context({})
    found = grade_answer(key.specs[0], typed, context=context)
    assert (found.verdict, found.note) == (verdict, note)

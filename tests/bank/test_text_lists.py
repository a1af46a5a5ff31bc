"""Lists and tables of text: drawn, said, in tables and files, in options, looked up by key."""

from __future__ import annotations

import pytest
from test_data import draw, make_bank

from quizgen.bank.variant import draw_variant
from quizgen.core.errors import BankError
from quizgen.question.compose import compose_variant
from quizgen.question.data_files import iter_data_files
from quizgen.render.text import blocks_to_plain_text

NUMBERS = "x = { values = [1, 2, 4] }\n"
METALS = "metal,sign,density\niron,Fe,7.87\ngold,Au,19.32\ntin,Sn,7.27\nlead,Pb,11.34\n"
TABLE = f"""[draw]
{NUMBERS}metal = {{ table = "metals.csv", take = 3 }}
density = {{ table = "metals.csv", take = 3 }}
second = {{ of = "metal", at = "2" }}
sign = {{ of = "metals.csv", at = "second", column = "sign" }}
first = {{ of = "metals.csv", at = "metal[1]", column = "sign" }}
heavy = {{ of = "metals.csv", at = "second", column = "density" }}

[files]
"metals.csv" = ["metal", "density"]

"""
WORDS = """# T
{{ x }} {{ metal }}; {{ metal[3] }}; {{ second }} is {{ sign }} of {{ heavy }}.

{{ table: metal density }}

## steps
- m: so.
## traps
- t: no.
"""
SIGNS = {"iron": "Fe", "gold": "Au", "tin": "Sn", "lead": "Pb"}
DENSITIES = {"iron": 7.87, "gold": 19.32, "tin": 7.27, "lead": 11.34}


@pytest.mark.parametrize("seed", range(4))
def test_rows_of_text_are_said_tabled_and_looked_up(tmp_path, seed):
    one = draw(tmp_path, TABLE, seed, words=WORDS, metals_csv=METALS)
    metals = one.text_list("metal")
    assert len(metals) == 3
    assert [float(v) for v in one.lists["density"]] == [DENSITIES[metal] for metal in metals]
    assert one.words["second"] == metals[1]
    assert one.words["sign"] == SIGNS[metals[1]]
    assert one.words["first"] == SIGNS[metals[0]]
    assert float(one.shown["heavy"]) == DENSITIES[metals[1]]
    question, _ = compose_variant(one, "en")
    text = list(blocks_to_plain_text(question.stem))
    assert f"{', '.join(metals)}; {metals[2]}; {metals[1]} is {SIGNS[metals[1]]} of" in text[0]
    assert text[2].startswith(f"{metals[0]} | {DENSITIES[metals[0]]}")
    ((_, content),) = iter_data_files(one, "1")
    assert content.decode().splitlines()[1] == f"{metals[0]},{DENSITIES[metals[0]]:.2f}"


def test_a_table_stands_inside_a_paragraph(tmp_path):
    words = WORDS.replace(
        "{{ table: metal density }}", "Weighed: {{ table: metal density }} by Ana."
    )
    one = draw(tmp_path, TABLE, 1, words=words, metals_csv=METALS)
    question, _ = compose_variant(one, "en")
    text = list(blocks_to_plain_text(question.stem))
    before, table, after = (
        text.index("Weighed: "),
        text.index("metal | density"),
        text.index(" by Ana."),
    )
    assert (table - before, after - table) == (1, 4)


def test_a_list_of_text_stands_in_draw_and_is_permuted(tmp_path):
    rules = f'[draw]\n{NUMBERS}c = {{ permutation = ["red", "green", "blue"] }}\n'
    found = {draw(tmp_path / str(s), rules, s).text_list("c") for s in range(6)}
    assert len(found) > 1
    assert all(sorted(one) == ["blue", "green", "red"] for one in found)


def test_data_py_gives_tables_with_columns_of_text(tmp_path):
    rules = "[data]\nx = { decimals = 0 }\nname = {}\n"
    data = "def draw(rng):\n    return {'t': {'name': ['Ana', 'Ben, jr.'], 'x': [1, 2]}}\n"
    words = (
        WORDS[: WORDS.index("{{ x")]
        + "{{ x }} {{ table: name x }}\n"
        + WORDS[WORDS.index("\n## steps") :]
    )
    words = words.replace("{{ x }} {{ table", "{{ x }}\n\n{{ table")
    files = '[files]\n"t.csv" = ["name", "x"]\n'
    one = draw(tmp_path, rules + files, 1, data=data, words=words)
    question, _ = compose_variant(one, "en")
    assert "Ben, jr. | 2" in list(blocks_to_plain_text(question.stem))
    ((_, content),) = iter_data_files(one, "1")
    assert content == b'name,x\nAna,1\n"Ben, jr.",2\n'


def test_a_text_of_a_list_that_a_spreadsheet_would_run_is_guarded(tmp_path):
    rules = f'[draw]\n{NUMBERS}c = {{ values = ["=SUM(A1)", "b"] }}\n[files]\n"c.csv" = ["c"]\n'
    ((_, content),) = iter_data_files(draw(tmp_path, rules), "1")
    assert b"\n=SUM" not in content


@pytest.mark.parametrize(
    ("rules", "said"),
    [
        ('c = { values = ["red", 3] }', "red"),
        ('c = { values = ["red", "blue"] }\nd = { of = "c", at = "3" }', "no place 3"),
        (
            'c = { values = ["red", "blue"] }\nd = { of = { green = "x" }, at = "c[1]" }',
            "no value for 'red'",
        ),
    ],
)
def test_mixed_lists_and_keys_that_there_are_not_are_errors(tmp_path, rules, said):
    with pytest.raises(BankError, match=said):
        draw(tmp_path, f"[draw]\n{NUMBERS}{rules}\n")


def test_a_list_of_text_is_no_number(tmp_path):
    rules = f'[draw]\n{NUMBERS}c = {{ values = ["red", "blue"] }}\nd = {{ is = "len(c)" }}\n'
    with pytest.raises(BankError) as found:
        draw_variant(make_bank(tmp_path, rules).template("mine"), 1)
    assert found.value.rule in {"QG120", "QG121"}

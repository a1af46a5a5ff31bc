"""What docs/figures.md shows, as an author would write it down: drawn in pages, PDF and on cards."""

from __future__ import annotations

import pickle
import re
import zipfile

import html5lib
import pikepdf
import pytest
from click.testing import CliRunner
from documented import PAGE, read_blocks
from figure_cases import FIGURES, module
from sweep import together

from quizgen.bank.bank import Bank
from quizgen.cli.main import root_group
from quizgen.core.errors import BankError
from quizgen.question.compose import draw_instance
from quizgen.question.figure import describe_question_figure, draw_question_figure

BLOCKS = read_blocks()
SHARED = [name for name in BLOCKS if name.startswith("templates/figures/")]
NEWCOMERS = ["figure.py", *SHARED[:5]]
"""The six that the issue of figures asked for."""
TEMPLATE = """
topic = "plots"
tier = "A"

[draw]
a = { range = [1, 9, 1] }

[figure]
name = "NAME"

[[part]]
answer = { kind = "tf", true = "a > 4", claim = "large" }
"""
WORDS = "# A plot\nLet $a$ = {{ a }}.\n\n**Is $a > 4$?**\n\n## reasons\n- large: It is {{ a }}.\n"


def write(root, files):
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text, encoding="utf-8")


@pytest.fixture
def root(tmp_path):
    """The bank that the page tells of: one figure beside its template, the others shared."""
    root = tmp_path / "bank"
    own = root / "templates/statistics/two-samples"
    write(own, {name: BLOCKS[name] for name in ("figure.py", "template.toml", "en.md")})
    write(root, {name: BLOCKS[name] for name in SHARED})
    for name in SHARED:
        figure = name.rpartition("/")[2].removesuffix(".py")
        folder = root / "templates/plots" / figure.replace("_", "-")
        write(folder, {"template.toml": TEMPLATE.replace("NAME", figure), "en.md": WORDS})
    return root


def run(root, *arguments):
    result = CliRunner().invoke(
        root_group, [arguments[0], "--bank", str(root), "--trust", *arguments[1:]],
        catch_exceptions=False,
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    return result.output


@together("name", [*NEWCOMERS, SHARED[5]])
def test_a_figure_of_the_page_is_short(name):
    lines = [line for line in BLOCKS[name].splitlines() if line.strip()]
    assert len(lines) <= 15


def test_the_figures_of_the_page_stand_on_paper_and_cards(root, tmp_path):
    out = tmp_path / "paper"
    run(root, "exam", "--topic", "all", "--seed", "1", "--out", str(out))
    count = 1 + len(SHARED)
    page = (out / "exam.html").read_text(encoding="utf-8")
    html5lib.HTMLParser(strict=True).parse(page)
    assert len(re.findall(r'<svg [^>]*role="img"', page)) == count
    assert page.count("<title>Box plots of two samples.</title>") == 1
    with pikepdf.open(out / "exam.pdf") as pdf:
        assert len(pdf.pages) >= 2
    run(root, "cards", "--out", str(tmp_path / "cards"))
    (deck,) = (tmp_path / "cards").glob("*.apkg")
    with zipfile.ZipFile(deck) as files:
        assert len(files.namelist()) >= 2 + count  # collection, list of media, the figures


def test_lint_finds_nothing_wrong_with_them(root):
    run(root, "lint", "--seeds", "20")  # fails if there is a problem


def test_a_list_of_formulas_becomes_a_list_of_numbers(root):
    drawn = draw_instance(Bank(root, trusted=True).template("two-samples"), 3)
    a = int(drawn.shown_values["a"])
    said = describe_question_figure(drawn, "en", quiz=True)
    assert f"A: {a - 6}, {a - 2}, {a}, {a + 1}, {a + 5} g" in said
    assert draw_question_figure(drawn, "en", quiz=True).alt == said


def test_a_table_of_formulas_becomes_a_table_of_numbers(root):
    own = root / "templates/statistics/two-samples"
    table = 'values.codes = [["a", 1], [2, "a + b"]]'
    rules = re.sub(r"values\.A.*\nvalues\.B.*", table, BLOCKS["template.toml"])
    figure = re.sub(r"PARAMETERS = .*", 'PARAMETERS = {"codes": Parameter("", "levels", kind="table")}',
                    BLOCKS["figure.py"])  # fmt: skip
    figure = re.sub(r"    a, b = .*\n.*", "    return str(values['codes'])", figure)
    write(own, {"template.toml": rules, "figure.py": figure})
    drawn = draw_instance(Bank(root, trusted=True).template("two-samples"), 3)
    a, b = (float(drawn.shown_values[name]) for name in "ab")
    assert describe_question_figure(drawn, "en", quiz=True) == str(((a, 1.0), (2.0, a + b)))


# A figure beside its template


def test_a_figure_is_python_and_needs_trust(root):
    with pytest.raises(BankError, match=r"two-samples.figure\.py: this bank brings its own Python"):
        Bank(root).template("two-samples")


def test_a_figure_that_is_not_there_is_told(root):
    (root / "templates/statistics/two-samples/figure.py").unlink()
    with pytest.raises(
        BankError,
        match=r"template\.toml:\d+: \[figure\] has no name, and there is no figure\.py beside it",
    ):
        Bank(root, trusted=True).template("two-samples")


def test_a_mistake_in_it_is_one_line_with_its_place(root):
    file = root / "templates/statistics/two-samples/figure.py"
    file.write_text(BLOCKS["figure.py"].replace("ax.boxplot", "ax.boxplots"), encoding="utf-8")
    drawn = draw_instance(Bank(root, trusted=True).template("two-samples"), 3)
    with pytest.raises(BankError, match=r"figure\.py:8: AttributeError: .*boxplots"):
        draw_question_figure(drawn, "en", quiz=True)


def test_the_digest_of_a_template_is_also_that_of_its_figure(root):
    before = {t.id: t.digest for t in Bank(root, trusted=True)}
    file = root / "templates/statistics/two-samples/figure.py"
    file.write_text(BLOCKS["figure.py"].replace("90", "95"), encoding="utf-8")
    after = {t.id: t.digest for t in Bank(root, trusted=True).reload()}
    assert [name for name in before if before[name] != after[name]] == ["two-samples"]
    assert file.read_bytes() in Bank(root, trusted=True).template_files("two-samples")


def test_a_changed_figure_is_read_again(root):
    bank = Bank(root, trusted=True)
    before = describe_question_figure(
        draw_instance(bank.template("two-samples"), 3), "en", quiz=True
    )
    file = root / "templates/statistics/two-samples/figure.py"
    file.write_text(BLOCKS["figure.py"].replace("Box plots", "Boxes"), encoding="utf-8")
    after = describe_question_figure(
        draw_instance(bank.reload().template("two-samples"), 3), "en", quiz=True
    )
    assert after == before.replace("Box plots", "Boxes")


def test_another_process_finds_it(root):
    template = Bank(root, trusted=True).template("two-samples")
    again = pickle.loads(pickle.dumps(template))
    assert draw_question_figure(draw_instance(again, 3), "en", quiz=True) == draw_question_figure(
        draw_instance(template, 3), "en", quiz=True
    )


def test_it_is_a_kind_of_figure_by_itself_in_a_paper(root):
    bank = Bank(root, trusted=True)
    kinds = [one.figure for one in bank.candidates(("two-samples", "bode"))]
    assert kinds == ["two-samples", "bode"]


# The table of the built-in ones


@together("name", FIGURES)
def test_every_parameter_of_a_built_in_figure_is_documented(name):
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    row = next(line for line in lines if line.startswith(f"| `{name}`"))
    for parameter in module(name).PARAMETERS:
        shown = parameter if not re.fullmatch(r"v\d\d", parameter) else "v00"
        assert f"`{shown}`" in row, parameter

"""LaTeX and drawn values in every place of a template where words stand."""

from __future__ import annotations

import msgspec
import pytest

from quizgen.bank import markdown
from quizgen.bank.bank import Bank
from quizgen.bank.markdown import LanguageFile, fill_inlines, leaves, parse_blocks, parse_inlines
from quizgen.bank.variant import draw_variant
from quizgen.core.errors import BankError
from quizgen.maths.notation import parse_formula
from quizgen.paper.paper import single_question_paper
from quizgen.question.compose import compose_variant
from quizgen.question.entry_prose import typeset_slot
from quizgen.question.interpolation import Interpolator, inlines_to_text
from quizgen.question.localise import localise
from quizgen.render import fonts, render_paper
from quizgen.render.text import blocks_to_plain_text
from quizgen.typeset.prose import InlineFormula, LaidOutFormula, typeset_layout

TEMPLATE = """topic = "example"
tier = "A"
levels = []
[draw]
k = { pick = [-3] }
m = { pick = [2], unit = "m" }
animal = { words = ["cat"] }
[[part]]
points = 1
answer = { kind = "choice", options = { mean = true, minus = false, root = false } }
"""
WORDS = r"""# Formulas
The curve is $f(x) = {{ k }}x^2$, and $x - {{ k }}$; length ${{ m }}$, $n_{\text{{{ animal }}}}$.

| $P(A|B)$ | sign |
|---|---|
| $\|x - {{ k }}\|$ | `a {{ k }}` |

```
print({{ k }})
```
$$\int_0^1 x\,\mathrm{d}x$$
## options
- mean: $\frac{1}{n}\sum_{i=1}^n x_i^{{ k }}$
- minus: $x - {{ k }}$
- root: $\sqrt{x}$
## words
- cat: cats
## reasons
- mean: Since $\bar x = {{ k }}$.
- minus: Since $2 {{ k }}$.
- root: Since $x_{{ k }}$.
"""


@pytest.fixture
def bank(tmp_path):
    folder = tmp_path / "templates" / "example" / "formulas"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(TEMPLATE, encoding="utf-8")
    (folder / "en.md").write_text(WORDS, encoding="utf-8")
    return Bank(tmp_path)


@pytest.fixture
def composed(bank):
    return compose_variant(draw_variant(bank.template("formulas"), 1), "en")


def only(text: str) -> InlineFormula | LaidOutFormula:
    (piece,) = parse_inlines(text)
    return piece


def test_stem_tables_and_code_show_the_drawn_value(composed):
    question, _ = composed
    text = "\n".join(blocks_to_plain_text(question.stem)).replace("\u00a0", " ")
    assert "f(x) = −3x², and x + 3; length 2 m, n_cats" in text
    assert "P(A | B)" in text
    assert "‖x + 3‖" in text
    assert "a -3" in text
    assert "print(-3)" in text
    assert "∫[0…1] x dx" in text
    assert "$" not in text


def test_options_show_it(composed):
    question, _ = composed
    options = {inlines_to_text(option) for _, option in question.parts[0].field.options}
    assert options == {"1/n ∑ᵢ₌₁ⁿ xᵢ⁻³", "x + 3", "√x"}


@pytest.mark.parametrize("kind", ["exam", "solutions"])
@pytest.mark.parametrize("form", ["html", "pdf"])
def test_every_format_can_be_made(bank, kind, form):
    paper = single_question_paper(bank.template("formulas"), 1, "en")
    data = render_paper(paper, kind, form)
    if form == "html":
        page = data.decode()
        assert "<mi>x</mi><mo>+</mo><mn>3</mn>" in page
        assert "\\frac" not in page
        assert fonts.all_maths_uri() in page  # a norm is in no other font
        if kind == "solutions":  # reasons stand there
            assert "<mn>2</mn><mo>⋅</mo>" in page
    assert data


def test_what_students_type_is_read_as_before():
    assert isinstance(only("$f*X/Z$"), InlineFormula)
    assert isinstance(only("$0 <= x < 1$"), InlineFormula)
    for latex in (r"$\frac{a}{b}$", "$P(A|B)$", "$x ~ N(0, 1)$", "$a -> b$", "$x - {{ a }}$"):
        assert isinstance(only(latex), LaidOutFormula)


def test_a_formula_may_go_over_several_lines():
    (block,) = parse_blocks("So $\\begin{aligned} a &= b \\\\\n &= c \\end{aligned}$ holds.")
    assert any(isinstance(leaf, LaidOutFormula) for leaf in leaves((block,)))


@pytest.mark.parametrize(
    ("formula", "column", "message"),
    [
        (r"\ce{H2O}", 9, r"chemical formulas are written as they look"),
        (r"x + \SI{3}{m}", 13, r"\\SI: write the number"),
        (r"\num{3}", 9, r"\\num: write the number alone"),
        (r"a \fraq{b}{c}", 11, r"\\fraq is not among the commands .*\\frac"),
        (r"\boxed{x}", 9, r"\\boxed strikes out or frames"),
        (r"\frac{a", 16, "closing token"),
        (r"x^{{2}}", 11, "double braces"),
        (r"\left( x", 17, "expected"),
        (r"1{,}5 \cdot 2", 10, "decimal point"),
        (r"\begin{align} a &= b \end{align}", 9, "no environment .*aligned"),
        (r"\href{http://a}{b}", 9, "pages are written"),
        (r"(x \cdot 2", 9, "is not closed"),
        (r"50 % \cdot 2", 12, r"write \\% for a percent sign"),
        (r"a \\ b", 11, "ends a line in an environment"),
    ],
)
def test_what_cannot_be_said_is_refused_with_its_place(tmp_path, formula, column, message):
    folder = tmp_path / "templates" / "example" / "formulas"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(TEMPLATE, encoding="utf-8")
    words = WORDS.replace("The curve is", f"Stem.\n\nNow it ${formula}$ is")
    (folder / "en.md").write_text(words, encoding="utf-8")
    with pytest.raises(BankError, match=message) as caught:
        Bank(tmp_path).template("formulas")
    found = caught.value.diagnostic(folder / "en.md")
    assert found.code == "QG159"
    assert (found.span.line, found.span.column) == (4, column)


@pytest.mark.parametrize(
    "text", ["See [here](https://example.org).", "See [a](b.html)", "[x](#top)", "[m](mailto:a@b)"]
)
def test_a_link_is_refused(text):
    with pytest.raises(BankError, match="a link"):
        parse_inlines(text)


def test_what_only_looks_like_a_link_stays():
    assert inlines_to_text(parse_inlines("in [0, 1] (closed), [a](b)")).startswith("in [0, 1]")


def test_a_name_that_nobody_draws_is_refused(tmp_path):
    folder = tmp_path / "templates" / "example" / "formulas"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(TEMPLATE, encoding="utf-8")
    (folder / "en.md").write_text(WORDS.replace("x - {{ k }}", "x - {{ q }}"), encoding="utf-8")
    template = Bank(tmp_path).template("formulas")
    with pytest.raises(BankError, match=r"\{\{ q \}\} is not a drawn quantity"):
        compose_variant(draw_variant(template, 1), "en")


def test_a_value_that_is_a_formula_is_laid_out(bank, monkeypatch):
    filler = Interpolator(draw_variant(bank.template("formulas"), 1), "en")
    forms = {"df": parse_formula("-2*x + 1")}
    monkeypatch.setattr(filler, "_find_formula", forms.get)
    sentence = r"$f'(x) = {{ df }}$, $y - {{ df }}$, $x {{ df }}$, {{ df }} and ${{ df }}^2$"
    (block,) = filler.blocks(parse_blocks(sentence))
    text = "".join(piece.text for piece in block.children)
    assert text == "f′(x) = −2·x + 1, y − (−2·x + 1), x(−2·x + 1), −2·x + 1 and (−2·x + 1)²"


def test_a_rounded_value_turns_the_equals_sign_in_front(tmp_path):
    folder = tmp_path / "templates" / "example" / "formulas"
    folder.mkdir(parents=True)
    rules = TEMPLATE.replace("[[part]]", 'r = { is = "sqrt(abs(k))" }\n[[part]]')
    (folder / "template.toml").write_text(rules, encoding="utf-8")
    (folder / "en.md").write_text(WORDS.replace("$x - {{ k }}$;", "$r = {{ r }}$;"), "utf-8")
    question, _ = compose_variant(draw_variant(Bank(tmp_path).template("formulas"), 1), "en")
    assert "r ≈ 1.732" in "\n".join(blocks_to_plain_text(question.stem))


def test_words_with_formulas_come_out_of_the_cache_as_they_were(bank):
    kept = msgspec.msgpack.encode(bank.template("formulas").texts["en"], enc_hook=str)
    decoder = msgspec.msgpack.Decoder(LanguageFile, dec_hook=lambda kind, text: kind(text))
    assert decoder.decode(kept) == bank.template("formulas").texts["en"]


def test_numbers_in_formulas_are_written_as_the_language_does():
    (formula,) = parse_inlines(r"$\bar x = 1.5$")
    shown = typeset_layout(formula.node)
    assert (shown.text, localise("de", shown).text) == ("x̄ = 1.5", "x̄ = 1,5")


def test_a_card_takes_latex_and_no_drawn_value():
    (piece,) = fill_inlines(parse_inlines(r"$\hat p = \frac{k}{n}$"), typeset_slot)
    assert piece.text == "p̂ = k/n"
    with pytest.raises(BankError, match=r"\{\{ k \}\} cannot be filled in here"):
        fill_inlines(parse_inlines(r"$\hat p = {{ k }}$"), typeset_slot)


def test_latex_is_read_once_and_not_for_each_variant(bank, monkeypatch):
    template = bank.template("formulas")
    assert template.texts["en"].stem  # read here

    def read_again(_source):
        raise AssertionError("LaTeX is read again")

    monkeypatch.setattr(markdown, "lay_out_latex", read_again)
    stems = [compose_variant(draw_variant(template, seed), "en")[0].stem for seed in range(3)]
    assert all("x + 3" in "\n".join(blocks_to_plain_text(stem)) for stem in stems)

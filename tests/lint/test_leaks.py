"""Questions that tell what another one asks, each in one place, and what is told of them."""

from __future__ import annotations

import pytest
from click.testing import CliRunner
from sweep import draws, together

from quizgen.bank.bank import Bank
from quizgen.cli.lint import lint
from quizgen.lint.leaks import find_paper_leaks, printed_content
from quizgen.maths.canonical import canonical_equation, canonical_forms
from quizgen.maths.notation import parse_formula
from quizgen.paper.blueprint import Blueprint, SlotRule, load_blueprint
from quizgen.paper.paper import build_paper

HEAD = 'topic = "light"\ntier = "A"\npool = 9\n[draw]\nn = { pick = [1, 2, 3] }\n'
ASK = "## options\n- a: The light is spread by diffraction at the narrow opening.\n- b: no\n- c: yes\n"
TEXT = '[[part]]\npoints = 3\nanswer = { kind = "rubric", criteria = { shift = 1, spill = 1, lamp = 1 } }\n'
ASKERS = {
    "formula": ('[[part]]\nanswer = { kind = "expression", value = "f*X/Z", symbols = { f = [1, 9], X = [1, 9], Z = [1, 9] } }\n',
                "Where is the image?\n"),
    "choice": ('[[part]]\nanswer = { kind = "choice", options = { a = true, b = false, c = false } }\n',
               f"Why is it blurred?\n{ASK}"),
    "code": ('[[part]]\nanswer = { kind = "code", output = "15367" }\n', "What is printed?\n"),
    "share": ('[[part]]\nanswer = { kind = "code", output = "0.8333" }\n', "What is printed?\n"),
    "third": ('[[part]]\nanswer = { kind = "code", output = "0.3333" }\n', "What is printed?\n"),
    "rubric": (TEXT, "Why?\n## points\n- shift: One.\n- spill: Two.\n- lamp: Three.\n## accept\n- shift: shift of charge\n- spill: it spills | it overflows\n- lamp: a lamp\n"),
    "order": ('[[part]]\nanswer = { kind = "order", steps = ["a", "b", "c"] }\n',
              "In order?\n## options\n- a: Load it.\n- b: Scale it.\n- c: Store it.\n"),
    "gap": ('[[part]]\nanswer = { kind = "gap", gaps = ["a"] }\n',
            "The narrow opening spreads the light of points by ____.\n## gaps\n- a: diffraction\n"),
    "match": ('[[part]]\nanswer = { kind = "match", pairs = { a = "b", c = "d" } }\n',
              "Match.\n## options\n- a: blooming\n- b: charge spills over into bright neighbours\n- c: skew\n- d: rows one by one\n"),
}  # fmt: skip
"""What is asked: the rules of the part, and the prose."""

CHOICE = '[[part]]\nanswer = { kind = "choice", options = { x = true, y = false } }\n'
TF = '[claims]\nx = true\n[[part]]\nanswer = { kind = "tf", from = "claims" }\n'
PAPERS = [
    range(3),
    pytest.param((145, 282), marks=pytest.mark.slow),  # 10.24 in prose, 11.1 as keys round it
    *(
        pytest.param(range(n, n + 6), marks=pytest.mark.slow)
        for n in range(3, draws(12, full=300), 6)
    ),
]
"""Seeds, in batches that several processes can share."""


def options(text):
    return CHOICE, f"Which?\n## options\n- x: {text}\n- y: none\n"


def stem(text):
    return options("one")[0], f"{text}\n\nWhich?\n## options\n- x: one\n- y: none\n"


def paper(folder, asker, teller):
    for name, (rules, prose) in {"asks": asker, "tells": teller}.items():
        home = folder / "templates" / "light" / name
        home.mkdir(parents=True)
        (home / "template.toml").write_text(HEAD + rules, "utf-8")
        (home / "en.md").write_text(f"# T\n{prose}", "utf-8")
    slots = (SlotRule(templates=("asks",)), SlotRule(templates=("tells",)))
    return build_paper(Bank(folder), Blueprint({"en": "x"}, slots, name="x"), 1, "en")


def told(folder, asker, teller):
    return {
        one.what
        for one in find_paper_leaks(paper(folder, ASKERS[asker], teller))
        if one.asker == "asks"
    }


@pytest.mark.parametrize(
    ("asker", "teller", "what"),
    [
        ("formula", stem("It lies at $x' = f*X/Z$."), "formula f*X/Z"),
        ("formula", stem("It lies at $X/Z*f$."), "formula f*X/Z"),
        ("formula", options("$f*X/Z + o$"), "formula f*X/Z"),
        ("formula", stem("```\ndef u(f, X, Z):\n    return f * X / Z + 3\n```"), "formula f*X/Z"),
        ("formula", (TF, "Is it so?\n## claims\n- x: The image is at $f*X/Z$.\n"),
         "formula f*X/Z"),
        ("choice", stem("At a narrow opening, light is spread by diffraction."), "diffraction"),
        ("choice", (TF, "Is it so?\n## claims\n- x: Diffraction at a narrow opening spreads the light.\n"),
         "diffraction"),
        ("code", stem("It has 15367 pixels."), "number 15367"),
        ("code", stem("It has 15 367 pixels."), "number 15367"),
        ("share", stem("It lets 0.8333 of it pass."), "number 0.8333"),
        ("rubric", options("a shift of charge, until a lamp makes it overflow"), "criteria"),
        ("order", stem("- Load it.\n- Scale it."), "order of 2 steps"),
        ("gap", stem("The light of points is spread by diffraction at the narrow opening."),
         "diffraction"),
        ("match", stem("Blooming: charge spills over into all bright neighbours."), "blooming"),
    ],
)  # fmt: skip
def test_what_is_told_is_found(tmp_path, asker, teller, what):
    (found,) = told(tmp_path, asker, teller)
    assert found.startswith(what) or what in found


@pytest.mark.parametrize(
    ("asker", "teller"),
    [
        ("formula", stem("It lies at $f*X$, or at $Z/f$, or at $f*X*Z$.")),
        ("formula", options("$X/(f*Z)$")),
        ("choice", stem("At a narrow opening the light is weak.")),
        ("code", stem("It has 15368 pixels, 115367 or 1.15367.")),
        ("third", stem("It lets 0.3333 of it pass.")),
        ("rubric", options("a shift to the left")),
        ("order", stem("- Scale it.\n- Load it.")),
        ("gap", stem("The narrow opening spreads the light of points by interference.")),
        ("match", stem("Smear: charge spills over into all bright neighbours.")),
    ],
)
def test_what_is_not_told_is_no_alarm(tmp_path, asker, teller):
    assert told(tmp_path, asker, teller) == set()


def test_the_words_of_a_figure_are_read_too(tmp_path):
    """The pinhole's words say that p = (p_y, p_z) = (3, 4) and f = 2.345."""
    figure = '[figure]\nname = "pinhole"\nvalues = { f = 2.345, p_z = 4, p_y = 3 }\n'
    rules, prose = stem("One.")
    asker = ('[[part]]\nanswer = { kind = "code", output = "2.345" }\n', "What is printed?\n")
    (found,) = find_paper_leaks(paper(tmp_path, asker, (figure + rules, prose)))
    assert (found.teller, found.asker, found.label, found.what) == (
        "tells",
        "asks",
        "",
        "number 2.345",
    )


def test_hints_are_read_too(tmp_path):
    item = paper(tmp_path, ASKERS["formula"], ASKERS["code"]).items[0]
    example = set(canonical_forms(parse_formula("(a+b)^2/2")))
    assert example
    assert example <= printed_content(item.questions[0], item.keys[0].draw).formulas.keys()


def test_what_a_question_prints_itself_is_no_secret(tmp_path):
    rules, prose = ASKERS["formula"]
    asker = rules, f"With $x = f*X/Z$. {prose}"
    assert find_paper_leaks(paper(tmp_path, asker, stem("Again $x = f*X/Z$."))) == []


@together(
    ("one", "other", "same"),
    [
        ("f*p_y/p_z", "f_x*x/z", True),
        ("(I - I_min)/(I_max - I_min)", "(I - I_min)/(I_max - I_min)", True),
        ("1/(sqrt(2*pi)*sigma)", "1/(sigma*sqrt(pi*2))", True),
        ("a*b/c", "c*b/a", False),
        ("(I - I_min)/(I_max - I_min)", "(I - I_min)/I_max", False),
        ("V*(1 - S)", "V*(S - 1)", False),
    ],
)
def test_formulas_are_the_same_in_another_order(one, other, same):
    assert (
        bool(set(canonical_forms(parse_formula(one))) & set(canonical_forms(parse_formula(other))))
        is same
    )


@together("plain", ["a + b", "2*x", "x^2 + y^2", "x/2", "max(R, G, B)", "f"])
def test_formulas_of_everybody_have_no_form(plain):
    assert list(canonical_forms(parse_formula(plain))) == []


@pytest.mark.parametrize("printed", ["N = f/D", "D = f/N_2", "f = D*N", "f/N = D"])
def test_an_equation_is_known_whichever_name_stands_alone(printed):
    assert canonical_equation("N", parse_formula("f/D")) & set(
        canonical_forms(parse_formula(printed))
    )


def test_an_equation_of_other_names_is_another():
    assert not canonical_equation("N", parse_formula("f/D")) & set(
        canonical_forms(parse_formula("N = D/f"))
    )


def test_lint_makes_papers_and_names_the_leak(tmp_path):
    paper(tmp_path, ASKERS["code"], stem("It has 15367 pixels."))
    home = tmp_path / "templates" / "blueprints"
    home.mkdir()
    slots = "".join(f'[[slot]]\ntemplates = ["{name}"]\n' for name in ("asks", "tells"))
    (home / "week.toml").write_text(f'[title]\nen = "x"\n{slots}')
    result = CliRunner().invoke(lint, [str(tmp_path), "--papers", "3"])
    assert result.exit_code == 1
    assert "week" in result.output
    assert (
        "tells: tells the answer of asks: number 15367 (3 of 3 papers, first seed 0)"
        in result.output
    )
    (home / "week.toml").write_text(f'[title]\nen = "x"\n{slots[: len(slots) // 2]}')
    assert CliRunner().invoke(lint, [str(tmp_path), "--papers", "3"]).exit_code == 0


@pytest.mark.parametrize("seeds", PAPERS)
@pytest.mark.parametrize("name", ["mock", "trial"])
def test_no_paper_of_the_bank_tells_an_answer(bank, name, seeds):
    blueprint = load_blueprint(name)
    for seed in seeds:
        assert find_paper_leaks(build_paper(bank, blueprint, seed, "both", figures=False)) == []

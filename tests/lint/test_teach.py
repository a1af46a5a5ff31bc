"""Templates that teach too little in one way each, and what is said about them."""

from __future__ import annotations

import math

from click.testing import CliRunner
from sweep import together

from quizgen.bank.bank import Bank
from quizgen.cli.lint import lint
from quizgen.lint.item_quality import count_pool, entropy_bits, review_template

HEAD = 'topic = "light"\ntier = "A"\n'
DRAWN = "pool = 36\n[draw]\nk = { pick = [0, 1, 2, 3] }\nn = { range = [1, 9, 1] }\n"
GOOD = '[[part]]\nanswer = { kind = "choice", options = { a = "k = 0", b = "k = 1", c = "k = 2", d = "k = 3" } }\n'
WORDS = "## options\n- a: one\n- b: two\n- c: three\n- d: four\n- e: five\n"
REASONS = "## reasons\n- a: one\n- b: two\n- c: three\n- d: four\n- e: five\n"


def template(folder, rules, prose=WORDS + REASONS):
    home = folder / "templates" / "light" / "one"
    home.mkdir(parents=True)
    (home / "template.toml").write_text(HEAD + rules, "utf-8")
    shown = " {{ n }}" if "\nn = " in rules else ""  # what nothing uses makes no other question
    (home / "en.md").write_text(f"# T\nstem{shown}\n{prose}", "utf-8")
    return Bank(folder).template("one")


def found(folder, rules, prose=WORDS + REASONS):
    said = review_template(template(folder, rules, prose))
    return [(one.label, one.level, one.what) for one in said]


@together(
    ("counts", "bits"),
    [((5,), 0), ((5, 5), 1), ((3, 1), 0.8113), ((1, 1, 1, 1), 2), ((2, 1, 1, 0), 1.5), ((), 0)],
)
def test_entropy_by_hand(counts, bits):
    """3 : 1 is 2 - (3/4) log2 3 = 0.8113 bits."""
    assert math.isclose(entropy_bits(counts), bits, abs_tol=1e-4)


def test_a_part_that_varies_and_explains_has_no_finding(tmp_path):
    assert found(tmp_path, DRAWN + GOOD) == []


def test_an_answer_that_hardly_varies(tmp_path):
    rules = DRAWN + GOOD.replace('"k = 0"', '"k < 3"').replace('"k = 1"', "false").replace(
        '"k = 2"', "false"
    )
    (bits, never) = found(tmp_path, rules)
    share = float(bits[2].split()[3])
    assert bits[1] == "error"
    assert bits[2] == f"its answer has {share:.2f} bits, at least 1.5 are wanted"
    assert math.isclose(share, 0.81, abs_tol=0.15), "3 : 1, over 200 draws"
    assert never == ("1", "note", "never right: b, c")


def test_the_longest_option_is_right(tmp_path):
    words = WORDS.replace(": one", ": one and much more").replace(
        ": two", ": two and more than that"
    )
    rules = DRAWN + GOOD.replace(", c", ", e = false, c").replace("k = 2", "k = 3 and k = 2")
    rules = rules.replace('a = "k = 0"', 'a = "k < 3"').replace('"k = 1"', "false")
    words = words.replace(": two and more than that", ": two")
    said = [what for _, _, what in found(tmp_path, rules, words + REASONS)]
    (longest,) = [what for what in said if "longest" in what]
    share = int(longest.split("%")[0].split()[-1])
    assert 65 < share < 85, "three draws of four"


def test_reasons_and_traps_are_asked_for(tmp_path):
    parts = [
        '{ kind = "match", take = 2, pairs = { a = "c", b = "d", e = "f" } }',
        '{ kind = "order", take = 2, steps = ["a", "b", "c"], distractors = ["d"] }',
        '{ kind = "gap", take = 2, gaps = ["x", "y", "z"] }',
        '{ kind = "tf", true = "k < 2" }',
        '{ kind = "expression", value = "k", symbols = { k = "real" } }',
    ]
    rules = DRAWN + "".join(f"[[part]]\nanswer = {answer}\n" for answer in parts)
    sections = "".join(f"## {label}\nask\n" for label in "abcde")
    prose = sections + WORDS + "- f: six\n- x: x\n- y: y\n- z: z\n## gaps\n- x: u\n- y: v\n- z: w\n"
    said = found(tmp_path, rules, f"{prose}## reasons\n- a = d: why\n- y: why\n- d: why\n")
    assert [(label, what) for label, level, what in said if label] == [
        ("a", "no reason for b, e"),
        ("b", "no reason for b, c"),
        ("b", "no trap names a wrong answer"),
        ("c", "no reason for x, z"),
        ("d", "a statement without a name has no reason: make it a claim"),
        ("e", "no trap names a wrong answer"),
    ]


def test_few_claims_and_shared_names(tmp_path):
    rules = 'pool = 4\n[claims]\na = true\nf = false\n[[part]]\nanswer = { kind = "tf", from = "claims" }\n'
    options = '[[part]]\nanswer = { kind = "choice", take = 2, options = { a = true, b = true, c = true, d = false } }\n'
    prose = f"## b\nWhich?\n{WORDS}## claims\n- a: A.\n- f: F.\n{REASONS}- f: six\n"
    said = [what for _, _, what in found(tmp_path, rules + options, prose)]
    assert said[:4] == [
        "6 different questions in 200 draws",
        "there are 6 different questions, not 4",
        "2 claims for 1 parts, 8 are wanted",
        "claims and options share names, and so their reason: a",
    ]


def test_letters_of_the_figure_are_not_those_of_options(tmp_path):
    """The figure of a lens shows its focal point F; six options reach that letter."""
    picture = '[figure]\nname = "thin_lens"\nvalues = { f = 50, z = 200 }\n'
    six = GOOD.replace(", d = ", ", e = false, f = false, d = ")
    prose = f"{WORDS}- f: six\n{REASONS}- f: six\n"
    clash = ("1", "error", "options and figure both have letters F")
    assert clash in found(tmp_path / "a", DRAWN + picture + six, prose)
    assert clash not in found(tmp_path / "b", DRAWN + picture + GOOD)


def test_an_article_is_no_letter(tmp_path):
    """ "A square grid ..." begins the words of this figure."""
    picture = '[figure]\nname = "distorted_grid"\nvalues = { k1 = "0.1" }\n'
    assert found(tmp_path, DRAWN + picture + GOOD) == []


def test_numbered_pictures_stand_in_order(tmp_path):
    words = "## options\n" + "".join(f"- {n}: picture {i}\n" for i, n in enumerate("abcd", 1))
    odd = ("1", "error", "numbered pictures are out of order: use in_order")
    assert odd in found(tmp_path / "a", DRAWN + GOOD, words + REASONS)
    ordered = DRAWN + GOOD.replace('"choice"', '"choice", in_order = true')
    assert found(tmp_path / "b", ordered, words + REASONS) == []


def test_pools_are_counted(tmp_path):
    assert count_pool(template(tmp_path / "a", DRAWN + GOOD)) == 36
    large = DRAWN.replace("[0, 1, 2, 3]", str([*range(300)]))
    assert count_pool(template(tmp_path / "b", large + GOOD)) == 0, "not counted"


def test_nobody_need_write_how_large_a_pool_is(tmp_path):
    counted = found(tmp_path / "without", DRAWN.removeprefix("pool = 36\n") + GOOD)
    assert counted == [("", "note", "there are 36 different questions")], "4 times 9"
    wrong = found(tmp_path / "wrong", DRAWN.replace("36", "35") + GOOD)
    assert wrong == [("", "error", "there are 36 different questions, not 35")]


def test_a_template_may_ask_not_to_be_told_of_a_finding(tmp_path):
    rules = 'ignore = ["QG304"]\n' + DRAWN + GOOD
    assert found(tmp_path, rules, WORDS) == []


def test_the_command_prints_a_table_and_fails_on_errors(tmp_path):
    template(tmp_path, DRAWN + GOOD)
    done = CliRunner().invoke(lint, [str(tmp_path), "--teach", "--seeds", "60"])
    assert (done.exit_code, done.output) == (0, "0 of 1 templates with errors\n")
    (tmp_path / "templates" / "light" / "one" / "en.md").write_text(f"# T\nstem\n{WORDS}", "utf-8")
    done = CliRunner().invoke(lint, [str(tmp_path), "--teach", "--seeds", "60"])
    assert done.exit_code == 1
    assert "no reason for a, b, c, d" in done.output
    assert done.output.endswith("1 of 1 templates with errors\n")

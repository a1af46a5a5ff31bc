"""The authored content: complete, bilingual, free of the notes' errors, with located complaints."""

from __future__ import annotations

import ast
import contextlib
import math
import operator
import re
import tomllib
from fractions import Fraction

import pytest
from fontTools.ttLib import TTFont
from sweep import together

from quizgen.bank.bank import builtin_bank
from quizgen.bank.entries import load_entries
from quizgen.cards import build_deck, content, note_types
from quizgen.cards.content import KINDS, CheatSheetEntry, StatementEntry, VocabularyEntry
from quizgen.cards.kinds.choice import pick_distractors
from quizgen.cards.note import field_names
from quizgen.cards.versions import note_digest, read_versions
from quizgen.core.errors import BankError
from quizgen.maths.notation import parse_formula
from quizgen.question.entry_prose import entry_blocks
from quizgen.question.formula_lines import parse_formula_line, typeset_inline, typeset_side
from quizgen.render.fonts import bangla_file
from quizgen.typeset import to_latex

BANK = builtin_bank()
AUTHORED = ("vocab", "formula", "cheat", "trap", "figure", "truth", "choice")
BENGALI = re.compile("[\u0980-\u09ff]")
BANGLA_DIGITS = re.compile("[০-৯]")


def entries(name):
    return content.read_card_entries(BANK, KINDS[name])


def read(name):
    return BANK.cards[name].read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def authored():
    return build_deck("both", kinds=AUTHORED)


@pytest.fixture(scope="module")
def glyphs():
    with TTFont(bangla_file(), lazy=True) as font:
        return {chr(code) for code in font.getBestCmap()}


def test_the_whole_inventory_is_there():
    assert len(entries("vocabulary")) == 41
    assert [entry.id for entry in entries("formulas")] == [f"F{n:02}" for n in range(1, 47)]
    assert [entry.id for entry in entries("traps")] == [f"TR{n:02}" for n in range(1, 29)]
    assert len(entries("cheat")) == 18
    assert len(entries("statements")) >= 18
    assert {f"FIG{n}" for n in range(1, 10)} <= {entry.id for entry in entries("figures")}


def test_the_terms_are_those_of_the_chapter():
    """Spot checks against the list of the notes, in its order."""
    terms = entries("vocabulary")
    assert [term.number for term in terms] == list(range(1, 42))
    for number, name in ((1, "Pixel"), (11, "Metamerism"), (15, "Bayer pattern"), (24, "f-number"),
                         (34, "Rolling shutter"), (41, "Signal-to-noise ratio")):  # fmt: skip
        assert terms[number - 1].term["en"] == name


@together("name", list(KINDS))
def test_topics_and_references_exist(name):
    formulas = {entry.id for entry in entries("formulas")}
    for entry in entries(name):
        assert entry.topic in BANK.topics
        assert {ref for ref in entry.refs if re.fullmatch(r"F\d\d", ref)} <= formulas


@together("name", list(KINDS))
def test_both_languages_are_written_in_themselves(name, glyphs):
    for row in tomllib.loads(read(name))["entry"]:
        for key, value in row.items():
            if isinstance(value, dict) and set(value) == {"en", "bn"}:
                assert not BENGALI.search(value["en"]), (row["id"], key)
                assert BENGALI.search(value["bn"]) or "$" in value["bn"], (row["id"], key)
                assert not BANGLA_DIGITS.search(value["bn"]), (row["id"], key)
                assert set(BENGALI.findall(value["bn"])) <= glyphs, (row["id"], key)


@pytest.mark.parametrize("name", [name for name in KINDS if name != "vocabulary"])
def test_both_languages_hold_the_same_formulas_and_numbers(name):
    """Numbers of two digits or more, and what stands between dollar signs."""
    for row in tomllib.loads(read(name))["entry"]:
        for key, value in row.items():
            if isinstance(value, dict) and set(value) == {"en", "bn"}:
                found = [
                    (
                        sorted(re.findall(r"\$[^$]+\$", value[lang])),
                        sorted(set(re.findall(r"\d[\d.]*\d", value[lang]))),
                    )
                    for lang in ("en", "bn")
                ]
                assert found[0] == found[1], (row["id"], key)


def test_sentences_of_the_notes_that_are_wrong_are_not_taught():
    """E01, E05, E06, E08 to E12, E37: none of these may be told as right."""
    told = "\n".join(
        str(value)
        for name in KINDS
        for entry in entries(name)
        for field in ("meaning", "about", "beware", "right", "answer", "why")
        if (value := getattr(entry, field, None))
    )
    for wrong in ("25x", "25 times", "the dress", "dress", "cat vision", "RG2BGR",
                  "all perceived colours", "1 eV", "same brightness"):  # fmt: skip
        assert wrong not in told
    for right in ("244 times", "1924", "1951", "33.5 %", "lecture view", "lightness", "pales"):
        assert right in told or right == "pales"


OPERATORS = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul", ast.Div: "truediv", ast.Pow: "pow"}
FUNCTIONS = {"mod": lambda a, b: a % b, "max": max, "min": min, "sqrt": math.sqrt}


def value(node):
    """A number from typed arithmetic, read by Python's own parser; LookupError for letters."""
    if isinstance(node, ast.Constant):
        return Fraction(str(node.value))
    if isinstance(node, ast.UnaryOp):
        return -value(node.operand)
    if isinstance(node, ast.Call):
        return FUNCTIONS[node.func.id](*map(value, node.args))
    if isinstance(node, ast.BinOp):
        return getattr(operator, OPERATORS[type(node.op)])(value(node.left), value(node.right))
    raise LookupError


def numbers_in(chain):
    for part in chain.split("="):
        with contextlib.suppress(LookupError, SyntaxError):
            yield float(value(ast.parse(part.strip().replace("^", "**"), mode="eval").body))


@pytest.mark.parametrize("name", ["traps", "statements", "figures"])
def test_worked_numbers_are_right(name):
    """Chains of equations in the texts hold, computed outside our code."""
    field = {"traps": "right", "statements": "why", "figures": "answer"}[name]
    chains = [
        numbers
        for row in tomllib.loads(read(name))["entry"]
        for text in re.findall(r"\$([^$]+)\$", row[field]["en"])
        if len(numbers := list(numbers_in(text))) > 1
    ]
    assert len(chains) >= {"traps": 10, "statements": 1, "figures": 2}[name]
    for numbers in chains:
        assert max(numbers) - min(numbers) < 1e-3 * max(1, abs(numbers[0])), numbers


def test_formulas_are_never_written_in_latex():
    for name in KINDS:
        assert "\\frac" not in read(name)
        assert "\\(" not in read(name)


def test_no_bangla_inside_mathjax(deck):
    """MathJax sets letter by letter and would break every conjunct."""
    for note in deck.notes:
        for text in note.fields():
            for formula in re.findall(r"\\\((.*?)\\\)", text):
                assert not BENGALI.search(formula), note.key


COMMANDS = {
    "\\" + name
    for line in (
        "alpha approx arctan bar begin beta bmod boldsymbol cdot chi circ cos delta Delta det",
        "displaystyle dots ell end eta exp frac gamma ge gg hat in int kappa lambda lceil le left",
        "lfloor lim ll ln log mathbf mathcal mathrm mathsf max mid min mu neq nu omega Omega",
        "operatorname phi Phi pi pm prod propto psi rceil rfloor rho right Rightarrow sigma Sigma",
        "sim sin sqrt sum tan tau text theta Theta tilde times to underset varepsilon varphi xi",
        "zeta arcsin arccos leq geq",
    )
    for name in line.split()
}


def test_mathjax_knows_every_command(deck):
    """Commands that MathJax 3 has in the configuration that Anki ships; braces in balance."""
    for note in deck.notes:
        for text in note.fields():
            for formula in re.findall(r"\\\((.*?)\\\)", text):
                assert set(re.findall(r"\\[A-Za-z]+", formula)) <= COMMANDS, (note.key, formula)
                bare = re.sub(r"\\[{}]", "", formula)
                assert bare.count("{") == bare.count("}"), (note.key, formula)
                assert "}}" not in bare, (note.key, formula)


def test_cloze_braces_close_only_once(authored):
    for note in authored.notes:
        if note.form == "cloze":
            text = note.fields()[field_names("cloze", note.columns).index("Text")]
            for hole in re.findall(r"\{\{c\d+::(.*?)\}\}", text):
                assert hole.startswith("\\(")
                assert hole.endswith("\\)")
            assert text.count("{{c") == text.count("}}")


def test_each_choice_has_four_terms_and_the_right_one_anywhere():
    terms = entries("vocabulary")
    places = []
    for term in terms:
        options = pick_distractors(term, terms)
        assert len({option.id for option in options}) == 4
        places.append(options.index(term))
    assert min(places.count(i) for i in range(4)) >= 3


def test_every_authored_card_is_in_the_list_of_versions(authored):
    """A changed card needs a higher version: run ``python -m quizgen.cards.update_versions``."""
    listed = read_versions(BANK)
    for note in authored.notes:
        version, digest = listed.get(note.key, (0, ""))
        assert (note.version, note_digest(note)) == (version, digest), (
            f"{note.key} changed: run `python -m quizgen.cards.update_versions`"
        )


@pytest.mark.parametrize("form", list(note_types.NAMES))
def test_every_note_type_is_in_the_list_of_versions(form):
    assert note_types.read_note_type_versions().looks[form][1] == note_types.note_type_digest(
        form
    ), "fields, card templates or style changed: run `python -m quizgen.cards.update_versions`"


GOOD = 'id = "x"\ntopic = "noise"\ntier = "A"\nsection = "1"\n'


@together(
    ("source", "kind", "words"),
    [
        ("[[entry]\n", CheatSheetEntry, ["f.toml", "line 1"]),
        ("[[card]]\n", CheatSheetEntry, ["f.toml", "[[entry]]", "card"]),
        (f'[[entry]]\n{GOOD}ask.en = "a"\n', CheatSheetEntry, ["f.toml", "'x'", "answer"]),
        (
            f'[[entry]]\n{GOOD}ask.en = "a"\nanswer.en = "a"\n',
            CheatSheetEntry,
            ["'x'", "ask.bn is missing"],
        ),
        (f"[[entry]]\n{GOOD}why = 1\n", StatementEntry, ["f.toml", "'x'"]),
        (f"[[entry]]\n{GOOD}colour = 1\n", StatementEntry, ["f.toml", "'x'"]),
        (f"[[entry]]\n{GOOD.replace('A', 'E')}", VocabularyEntry, ["f.toml", "'x'", "tier"]),
    ],
)
def test_bad_files_are_located(source, kind, words):
    with pytest.raises(BankError) as caught:
        load_entries(source, kind, "f.toml", ("en", "bn"))
    for word in words:
        assert word in str(caught.value)


def test_two_entries_of_one_name_are_refused():
    row = f'[[entry]]\n{GOOD}ask = {{ en = "a", bn = "b" }}\nanswer = {{ en = "a", bn = "b" }}\n'
    with pytest.raises(BankError, match="two entries have the id 'x'"):
        load_entries(row + row, CheatSheetEntry, "f.toml")


@pytest.mark.parametrize("text", ["$f*$", "{{ f }}", "{% if %}"])
def test_bad_prose_is_located(text):
    both = {"en": "fine", "bn": text}
    entry = CheatSheetEntry(
        id="x", topic="noise", tier="A", section="1", ask=both, answer=both, file="cheat.toml"
    )
    assert entry_blocks(entry, "ask", "en")
    with pytest.raises(BankError, match=r"^cheat\.toml: entry 'x': ask\.bn"):
        entry_blocks(entry, "ask", "bn")


def test_lines_split_only_outside_brackets():
    signs, parts = parse_formula_line("I = piecewise(0, u = 1, 255)", {})
    assert signs == ["="]
    assert len(parts) == 2


@pytest.mark.parametrize(
    ("text", "inside", "expected"),
    [
        ("B", {"B": {"integral": "L*V", "over": "lambda"}}, r"\int L V \, d \lambda"),
        ("A", {"A": {"apply": "P", "to": "s*p"}, "p": {"bold": "p"}}, r"P(s \mathbf{p})"),
        ("T", {"T": {"tuple": ["C", "X", "0"]}}, "(C , X , 0)"),
        ("H", {"H": {"interval": ["0", "360"], "ends": "[)"}}, "[0 , 360)"),
    ],
)
def test_pieces_beyond_the_grammar(text, inside, expected):
    squeezed = to_latex(typeset_side(text, inside).node).replace(" ", "")
    assert squeezed == expected.replace(" ", "")


def test_an_unknown_piece_is_located():
    with pytest.raises(BankError, match=r"'A': .*unknown piece"):
        typeset_side("A", {"A": {"sum": "x"}})


def test_a_chain_in_a_sentence_is_not_read_as_a_conjunction():
    assert to_latex(typeset_inline(parse_formula("a = b = c")).node).replace(" ", "") == "a=b=c"
    assert "and" in to_latex(typeset_inline(parse_formula("a = b and c = d")).node)


def test_every_figure_card_draws_and_hides_its_answer():
    from quizgen.figures import draw_figure

    for entry in entries("figures"):
        figure = BANK.figure(entry.figure)
        quiz, full = (
            draw_figure(figure, entry.values, quiz=quiz, lang="en") for quiz in (True, False)
        )
        assert quiz.inline_svg
        assert quiz.alt != full.alt

"""What no reader may believe: special files, sizes, depth, digits, names and marks in words."""

from __future__ import annotations

import csv
import io
import json
import os
import re
import struct
import zlib
from contextlib import suppress
from html.parser import HTMLParser

import pytest

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.camera.pixels.codecs import decode_photo
from quizgen.camera.scene_file import load_scene
from quizgen.camera.setup.scene import SceneError
from quizgen.cards import build_deck
from quizgen.cards.delimited import write_csv, write_tsv
from quizgen.cards.error_deck import deck_from_grades
from quizgen.cli.main import main
from quizgen.core.errors import BankError, BlueprintError, KeyFileError, PaperCodeError
from quizgen.core.untrusted import (
    DEEPEST,
    escape_control_characters,
    escape_csv_formula,
    format_csv,
    is_identifier,
    parse_json,
    parse_toml,
    read_bytes,
    unescape_csv_formula,
)
from quizgen.paper.answer_key import FORMAT, parse_answer_key
from quizgen.paper.blueprint import load_blueprint

TEMPLATE = """
topic = "{topic}"
tier = "A"
[draw]
a = {{ {draw} }}
[[part]]
points = {points}
answer = {{ {answer} }}
{more}"""
RULES = {
    "topic": "algebra", "draw": "pick = [2, 3, 5, 7]", "points": "1",
    "answer": 'kind = "tf", true = "a > 4"', "more": "",
}  # fmt: skip
PROSE = "# {title}\nLet $a$ = {{{{ a }}}}.\n\n## why\nCount.\n"


def a_bank(root, *, name="compare", title="A comparison", **rules):
    folder = root / "templates" / name
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(TEMPLATE.format(**{**RULES, **rules}), "utf-8")
    for lang in ("en", "bn"):
        (folder / f"{lang}.md").write_text(PROSE.format(title=title), "utf-8")
    return Bank(root)


# Files


@pytest.mark.parametrize("special", ["pipe", "folder", "device"])
def test_only_regular_files_are_read(tmp_path, special):
    path = tmp_path / "file"
    if special == "pipe":
        os.mkfifo(path)
    elif special == "folder":
        path.mkdir()
    else:
        path.symlink_to("/dev/zero")
    with pytest.raises(KeyFileError, match="not a file that can be read"):
        read_bytes(path, KeyFileError)


def test_a_file_is_not_read_past_its_limit(tmp_path):
    path = tmp_path / "file"
    path.write_bytes(b"x" * 2_000_001)
    assert len(read_bytes(path, KeyFileError, 2_000_001)) == 2_000_001
    with pytest.raises(KeyFileError, match=r"file: larger than 2 MB$"):
        read_bytes(path, KeyFileError, 2_000_000)


def test_prose_that_is_a_pipe_does_not_hang(tmp_path):
    bank = a_bank(tmp_path)
    prose = tmp_path / "templates" / "compare" / "en.md"
    prose.unlink()
    os.mkfifo(prose)
    with pytest.raises(BankError, match=r"en\.md: not a file"):
        bank.template("compare")


# Tables


@pytest.mark.parametrize("text", ["a = " + "[" * 500 + "]" * 500, "a" + ".a" * 500 + " = 1"])
def test_deep_toml_is_refused(text):
    with pytest.raises(KeyFileError, match=rf"^file.*more than {DEEPEST} tables and lists within"):
        parse_toml(text, "file", KeyFileError)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[" * 5000, "file: more than 30 tables and lists within each other"),
        ('{"a": 1, "b": {"c": 1, "c": 2}}', "file: 'c' stands twice in a table"),
        ('{"a": ["\\ud800"]}', "file: a[0]: half a character (U+D800) in a text"),
        ('{"a": NaN}', "file: NaN is no number"),
        ('{"a": ' + "9" * 401 + "}", "file: a: a number of more than 400 digits"),
        ('{\n"a": }', "file: line 2: Expecting value"),
    ],
)
def test_json_that_nobody_means_is_one_located_line(text, words):
    with pytest.raises(KeyFileError) as caught:
        parse_json(text, "file", KeyFileError)
    assert str(caught.value) == words


def test_a_long_number_in_hexadecimal_is_refused():
    with pytest.raises(KeyFileError, match=r"form: answers\.1a: a number of more than 400 digits"):
        parse_toml('[answers]\n"1a" = 0x' + "f" * 5000, "form", KeyFileError)


# Numbers, names and sizes of a bank


@pytest.mark.parametrize(
    ("formula", "value"),
    [("1 > 0", "1"), ("1 < 0", "0"), ("-(1 = 1)", "−1"), ("(1 = 1) + 1", "2"), ("3*(2 < 3)", "3")],
)
def test_a_condition_counts_one_if_it_holds(tmp_path, formula, value):
    from quizgen.bank.variant import draw_variant

    bank = a_bank(tmp_path, draw=f'is = "{formula}"')
    assert draw_variant(bank.template("compare"), 1).format_value("a") == value


@pytest.mark.parametrize(
    ("rules", "words"),
    [
        (
            {"draw": 'range = ["-15", "1e400000000", "1"]'},
            "draw.a.range: '1e400000000' is no number",
        ),
        ({"draw": "range = [-15, 1000000000, 1]"}, "draw.a.range: more than 10000 values"),
        ({"draw": "range = [15, -15, 1]"}, "draw.a.range: the step does not lead"),
        ({"draw": "range = [1, 5, 0]"}, "draw.a.range: the step does not lead"),
        ({"draw": 'pick = ["two"]'}, "draw.a.pick: 'two' is no number"),
        (
            {"draw": 'is = "b" }\nb = { pick = [1]'},
            "draw.a: uses ['b'], not drawn before it",
        ),
        ({"draw": "pick = [1], skip = []"}, None),
        ({"points": "-3"}, "part 1: points: -3 is not more than 0"),
        ({"points": "0"}, "part 1: points: 0 is not more than 0"),
        ({"points": '"1e100000000"'}, "part 1: points: '1e100000000' is no number"),
        ({"topic": "<script>"}, "topic: '<script>' is no name"),
        ({"draw": "normal = [1], size = 3, decimals = 1"}, "draw.a.normal: is [mean, standard dev"),
        (
            {"answer": 'kind = "order", steps = ["b", "c"], before = [["b", "d"]]'},
            "part 1: answer.before: names ['d'], which are not steps",
        ),
        ({"more": "[reference]\nb = 1"}, "reference names 'b', which is not drawn"),
        (
            {"more": '[figure]\nname = "f"\nquiz = false\nreads = ["a"]'},
            "figure.reads: nothing is read in a figure with quiz = false",
        ),
    ],
)
def test_rules_that_nobody_means_are_one_located_line(tmp_path, rules, words):
    from quizgen.bank.variant import draw_variant

    bank = a_bank(tmp_path, **rules)
    if words is None:
        assert draw_variant(bank.template("compare"), 1).format_value("a") == "1"
        return
    with pytest.raises(BankError) as caught:
        draw_variant(bank.template("compare"), 1)
    place = re.escape(f"{tmp_path}/templates/compare/template.toml")
    assert re.match(rf"{place}:\d+: {re.escape(words)}", str(caught.value))


@pytest.mark.parametrize(
    ("about", "words"),
    [
        (
            '[topics]\noptics = { en = "Optics" }\n',
            r"template.toml:\d+: topic 'algebra' is not in bank.toml \(optics\)",
        ),
        ('languages = ["French"]', "bank.toml:1: languages: 'French' is no language"),
    ],
)
def test_what_a_bank_says_of_itself_holds(tmp_path, about, words):
    bank = a_bank(tmp_path)
    (tmp_path / "templates" / "bank.toml").write_text(about)
    with pytest.raises(BankError, match=words):
        bank.template("compare")


@pytest.mark.parametrize(
    "name", ['x" onerror="alert(1)', "a b", "a\nb", "\x1b[31m", "é", "a" * 101]
)
def test_a_template_has_a_plain_name(tmp_path, name, capsys):
    bank = a_bank(tmp_path, name=name)
    with pytest.raises(BankError, match="is no name"):
        bank.template(name)
    a_bank(tmp_path)
    for command in (["templates"], ["exam", "--out", str(tmp_path / "out")], ["lint"]):
        with suppress(SystemExit):  # the others are asked
            main([*command, "--bank", str(tmp_path)])
        said = "".join(capsys.readouterr())
        assert "is no name" in said
        said = said.replace("\t", " ")  # between columns
        assert escape_control_characters(said) == said  # a terminal obeys none of it
    with pytest.raises(SystemExit) as stopped:
        main(["lint", "--bank", str(tmp_path)])
    assert stopped.value.code


@pytest.mark.parametrize("name", [".", "..", "...", "", "a/b", "a\x00"])
def test_a_name_is_never_a_path(name):
    assert not is_identifier(name)


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("raise RuntimeError('no luck')", "x.py:1: RuntimeError: no luck"),
        ("\n\n1 / 0", "x.py:3: ZeroDivisionError: division by zero"),
        ("def (", "x.py:1: SyntaxError: invalid syntax"),
        ("import sys\nsys.exit(3)", "x.py:2: SystemExit: 3"),
        ("MODEL = 5", "x.py: no MODEL in this solver"),
    ],
)
def test_what_an_authors_python_raises_is_one_located_line(tmp_path, source, words):
    a_bank(tmp_path)
    rules = tmp_path / "templates" / "compare" / "template.toml"
    rules.write_text('solver = "x"\n' + rules.read_text())
    (tmp_path / "solvers").mkdir()
    (tmp_path / "solvers" / "x.py").write_text(source)
    with pytest.raises(BankError) as caught:
        Bank(tmp_path, trusted=True).template("compare")
    assert str(caught.value).startswith(f"{tmp_path}/solvers/{words}")


# Papers


@pytest.mark.parametrize(
    ("slot", "words"),
    [
        ("count = 201", "slot 1: count must be 1 to 200"),
        ("count = 150\n[[slot]]\ncount = 150", "300 questions (at most 200)"),
        ("points = nan", "slot 1: points must be positive"),
        ("points = -1", "slot 1: points must be positive"),
        ('topic = "../x"', "slot 1: '../x' is no name"),
        ("[title]", None),
    ],
)
def test_a_blueprint_that_nobody_means_is_one_located_line(tmp_path, slot, words):
    path = tmp_path / "week3.toml"
    path.write_text(f'title = {{ en = "Week 3" }}\n[[slot]]\n{slot}\n')
    with pytest.raises(BlueprintError) as caught:
        load_blueprint(str(path))
    place = re.escape(str(path))
    assert re.match(rf"{place}(:\d+)?: {re.escape(words or 'not valid TOML')}", str(caught.value))


def test_a_reference_of_a_blueprint_is_never_a_path(tmp_path):
    path = tmp_path / "week3.toml"
    path.write_text('title = { en = "Week 3" }\nreference = ["../x"]\n[[slot]]\ncount = 1\n')
    with pytest.raises(BlueprintError, match=r"reference: '\.\./x' is no name"):
        load_blueprint(str(path))


def test_a_name_in_a_code_is_never_a_path(tmp_path):
    marks = tmp_path / "marks.json"
    marks.write_text(json.dumps({"code": "/dev/zero-1-en-000000", "parts": []}))
    with pytest.raises(PaperCodeError, match="no blueprint '/dev/zero'"):
        deck_from_grades(marks, "en", bank=builtin_bank())


SPEC = {"kind": "number", "value": "1"}


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ([("1", "-1")], "key: part '1': points '-1' (allowed: more than 0, at most 1000)"),
        ([("1", "0")], "key: part '1': points '0' (allowed: more than 0, at most 1000)"),
        (
            [("1", "1e300000000")],
            "key: part '1': points: '1e300000000' is no number (allowed: 12, 0.5, 1e-3, 1/500)",
        ),
        ([("1", "1"), ("1", "2")], "key: part '1' stands twice"),
    ],
)
def test_a_tampered_key_is_one_located_line(parts, words):
    listed = [{"id": name, "points": points, "spec": SPEC} for name, points in parts]
    with pytest.raises(KeyFileError) as caught:
        parse_answer_key({"format": FORMAT, "questions": [{"number": "1", "parts": listed}]})
    assert str(caught.value) == words


# Pictures and scenes


def chunk(kind, content):
    return (
        struct.pack(">I", len(content))
        + kind
        + content
        + struct.pack(">I", zlib.crc32(kind + content))
    )


def test_a_picture_that_inflates_to_more_than_its_size_is_read_no_further():
    header = struct.pack(">IIBBBBB", 4, 4, 8, 2, 0, 0, 0)
    packed = zlib.compress(bytes(200_000_000), 9)
    data = (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")
    )
    assert decode_photo(data).shape == (4, 4, 3)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[scene]\nwidth = 32768\nheight = 32768", "2: more than 24 megapixels"),
        ("[[thing]]\n" * 1001, "1: more than 1000 things"),
        (
            '[[thing]]\nshape = "polygon"\npoints = [' + "[1, 2]," * 1001 + "]",
            "3: points: expected at most 1000 corners",
        ),
        ("[scene]\nseed = -1", "2: seed: expected 0 to 9223372036854775808"),
        (
            '[scene]\nimage = "/dev/zero"',
            "2: /dev/zero: not a file that can be read (a folder, a pipe or a device)",
        ),
        (
            '[camera]\nfocal_length = "1e400000000 mm"',
            "2: focal_length: '1e400000000' is no number",
        ),
    ],
)
def test_a_scene_that_nobody_means_is_one_located_line(tmp_path, text, words):
    path = tmp_path / "scene.toml"
    path.write_text(text)
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    assert str(caught.value).startswith(f"{path}:{words}")


# Words of a bank in cards and tables


class Attributes(HTMLParser):
    """Collects tags and attributes as a browser would see them."""

    def __init__(self):
        super().__init__()
        self.seen = set()

    def handle_starttag(self, tag, attrs):
        self.seen |= {tag, *(name for name, _ in attrs)}


@pytest.mark.parametrize(
    "title", ["<img src=x onerror=alert(1)>", '" onerror="alert(1)', "{{c1::x}}"]
)
def test_no_word_of_a_bank_becomes_markup_on_a_card(tmp_path, title):
    if title.startswith("{{"):
        title = "{ {c1::x} }"  # double braces are refused when the file is read
    deck = build_deck("en", kinds=("question",), bank=a_bank(tmp_path, title=title))
    found = Attributes()
    found.feed(write_tsv(deck).decode().replace('""', '"'))
    assert not {"img", "script", "onerror"} & found.seen


@pytest.mark.parametrize(
    "title",
    ["\\(\\href{javascript:alert(1)}{x}\\)", "[sound:x.mp3]", "[latex]x[/latex]", "\\begin{x}"],
)
def test_no_word_of_a_bank_becomes_a_formula_or_a_sound(tmp_path, title):
    deck = build_deck("en", kinds=("question",), bank=a_bank(tmp_path, title=title))
    text = write_tsv(deck).decode()
    for mark in ("\\(\\href", "[sound:", "[latex]", "\\begin{"):
        assert mark not in text
    assert "x" in text


@pytest.mark.parametrize(
    "start",
    ["=", "+", "-", "@", " =", "\n=", "\r\n +", "\t=", "\uff1d", "\uff0b", "\u00a0=", "\u200b="],
)
def test_a_cell_is_no_formula(start):
    assert escape_csv_formula(f"{start}1+1") == f"'{start}1+1"


@pytest.mark.parametrize("text", ["", "Rahim", "1 = 1", "রহিম", "'x", " a", "<p>=1</p>"])
def test_a_harmless_cell_stays_as_it_is(text):
    assert escape_csv_formula(text) == text


@pytest.mark.parametrize(
    ("cell", "bare"),
    [("'=1", "=1"), ("'a", "'a"), ("=1", "=1"), ("'", "'"), ("''=1", "''=1"), ("' +", " +")],
)
def test_only_what_was_made_inert_is_undone(cell, bare):
    assert unescape_csv_formula(cell) == bare


def test_cells_of_a_table_are_inert_and_steer_no_terminal():
    made = format_csv([("a", "b"), ("=1+1", 'x, "y"'), ("\x1b[2J", "এক\nদুই")])
    assert made == 'a,b\n\'=1+1,"x, ""y"""\n[U+001B control character][2J,"এক\nদুই"\n'


def test_a_title_that_is_a_formula_is_none_in_the_deck(tmp_path):
    deck = build_deck("en", kinds=("question",), bank=a_bank(tmp_path, title="=1+1"))
    rows = list(csv.reader(io.StringIO(write_csv(deck).decode("utf-8-sig"))))
    assert any("=1+1" in cell for row in rows for cell in row)
    assert not [cell for row in rows for cell in row if cell.lstrip()[:1] in set("=+-@")]


@pytest.mark.slow
def test_our_own_deck_has_no_cell_that_a_spreadsheet_runs():
    rows = list(csv.reader(io.StringIO(write_csv(build_deck("both")).decode("utf-8-sig"))))
    assert not [cell for row in rows for cell in row if cell.lstrip()[:1] in set("=+-@'")]


def test_what_steers_a_terminal_is_named():
    assert escape_control_characters("a\x1b]0;x\x07\u202eb\x85") == (
        "a[U+001B control character]]0;x[U+0007 control character]"
        "[U+202E RIGHT-TO-LEFT OVERRIDE]b[U+0085 control character]"
    )
    assert escape_control_characters("রহিম\n é") == "রহিম\n é"

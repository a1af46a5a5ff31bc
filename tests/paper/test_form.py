"""Forms: when one holds something that must not be overwritten."""

from __future__ import annotations

import csv
import io

import pytest
from small_bank import ONE

from quizgen.core.errors import KeyFileError
from quizgen.paper.answer_form import has_answers, read_filled_form, write_blank_form
from quizgen.paper.paper import build_paper


def printed(bank, tmp_path, kind):
    path = tmp_path / f"answers.{kind}"
    path.write_bytes(write_blank_form(build_paper(bank, ONE, 1, figures=False), kind))
    return path


@pytest.fixture
def form(bank, tmp_path):
    return printed(bank, tmp_path, "toml")


@pytest.fixture
def sheet(bank, tmp_path):
    return printed(bank, tmp_path, "csv")


def test_a_blank_form_and_no_form_hold_nothing(form):
    assert not has_answers(form)
    assert not has_answers(form.with_name("none.toml"))


@pytest.mark.parametrize(
    ("old", "new"),
    [('"1" = ""', '"1" = "(4; 6)"'), ('"1" = ""', '"1" = 0'), ('name = ""', 'name = "Rahim"'),
     ("[answers]", "[answers"), ('decimal = "auto"', 'decimal = "dot"'),
     ('matriculation = ""', "matriculation = 4711"), ("[answers]", "[answers] # f = 2 cm, so x = 4"),
     ("[answers]", "# Divide by the depth!\n[answers]"), ("# 1.", "# not sure: 1.")],
)  # fmt: skip
def test_an_answer_a_name_a_note_or_what_cannot_be_read_is_kept(form, old, new):
    text = form.read_text("utf-8")
    assert old in text
    form.write_text(text.replace(old, new, 1), "utf-8")
    assert has_answers(form)


@pytest.mark.parametrize("kind", ["toml", "csv"])
def test_what_an_editor_or_a_spreadsheet_changes_by_itself_is_no_note(bank, tmp_path, kind):
    path = printed(bank, tmp_path, kind)
    text = path.read_text("utf-8-sig")
    for again in (text.replace("\n", "\r\n"), "\ufeff" + text, text + "\n\n"):
        path.write_text(again, "utf-8", newline="")
        assert not has_answers(path)
    path.write_text(text, "utf-16")
    assert not has_answers(path)
    rows = list(csv.reader(io.StringIO(text)))
    if kind == "csv":
        with path.open("w", encoding="utf-8", newline="") as stream:
            csv.writer(stream, delimiter=";", quoting=csv.QUOTE_ALL).writerows(rows)
        assert not has_answers(path)


def test_the_form_of_a_spreadsheet_keeps_code_paper_and_name(sheet, form):
    filled(sheet, **{"name": "Ayesha", "matriculation": "0815", "1": "(4; 6)"})
    found, model = read_filled_form(sheet), read_filled_form(form)
    assert (found.code, found.paper) == (model.code, model.paper)
    assert found.student.lang == model.student.lang == "en"
    assert (found.student.name, found.student.matriculation) == ("Ayesha", "0815")
    assert found.list_typed_texts() == {"1": "(4; 6)"}
    assert has_answers(sheet)


def filled(sheet, **cells):
    rows = list(csv.reader(io.StringIO(sheet.read_text("utf-8-sig"))))
    for row in rows:
        row[-1] = cells.get(row[0], row[-1])
    with sheet.open("w", encoding="utf-8", newline="") as stream:
        csv.writer(stream).writerows(rows)


@pytest.mark.parametrize(
    "data",
    [
        b'part,answer\n1a,"0,2"\n2,yes\n',
        b"part;answer\n1a;0,2\n2;yes\n",
        b"part\tanswer\n1a\t0,2\n2\tyes\n",
        b"\xef\xbb\xbfpart;answer\r\n1a;0,2\r\n2;yes\r\n",
        b"sep=;\r\npart;answer\r\n1a;0,2\r\n;\r\n2;yes\r\n",
        b'"Part";"Hint";"Answer";;\n"1a";"";"0,2";;\n"2";"";"yes";;\n',
        "part\tanswer\r\n1a\t0,2\r\n2\tyes\r\n".encode("utf-16"),
        b"part;answer\r1a;0,2\r2;yes\r",
    ],
    ids=["commas", "semicolons", "tabs", "mark", "sep", "quoted", "utf-16", "old line ends"],
)
def test_what_spreadsheets_write_is_read(tmp_path, data):
    path = tmp_path / "class.CSV"
    path.write_bytes(data)
    assert read_filled_form(path).list_typed_texts() == {"1a": "0,2", "2": "yes"}


def test_a_cell_may_hold_lines_and_quotes(tmp_path):
    path = tmp_path / "a.csv"
    path.write_bytes(b'part,answer\n1,"print(""x"")\nprint(2)"\n')
    assert read_filled_form(path).list_typed_texts() == {"1": 'print("x")\nprint(2)'}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the first row must name the columns"),
        ("1a,0.2\n", "the first row must name the columns"),
        ("part,answer,remark\n1a,0,2\n", "'answer' as the last"),
        ("part,hint,answer\n1a,,0,2\n", "line 2: more cells than columns"),
        ("part,answer\n1a,1\n\n1a,2\n", "line 4: part '1a' stands there twice"),
        ("part,answer\n,0.2\n", "line 2: an answer without its part"),
        ('part,answer\n1a,"0.2\n', "line 2: unexpected end of data"),
        ("part,answer\n1a," + "9" * 200_000, "line 2: field larger than field limit"),
        ("part,answer\ndecimal,dot\n", "student.decimal 'dot' is not"),
        ("part,answer\n1a,\0\n", "a zero byte"),
    ],
)
def test_a_sheet_that_cannot_be_read_is_one_located_line(tmp_path, text, message):
    path = tmp_path / "a.csv"
    path.write_text(text, "utf-8")
    with pytest.raises(KeyFileError) as caught:
        read_filled_form(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert message in str(caught.value)


@pytest.mark.parametrize("name", ["answers.toml.txt", "answers", "ANSWERS.TOML", "a.txt"])
def test_a_form_is_known_by_what_it_holds(form, tmp_path, name):
    renamed = tmp_path / name
    text = form.read_text("utf-8").replace('"1" = ""', '"1" = "4"')
    renamed.write_text(text, "utf-8")
    assert read_filled_form(renamed).list_typed_texts() == {"1": "4"}


def test_blanks_are_no_answer_and_a_form_reads_back(form):
    text = form.read_text("utf-8").replace('"1" = ""', '"1" = "  "')
    form.write_text(text, "utf-8")
    assert not has_answers(form)
    assert read_filled_form(form).list_typed_texts() == {"1": "  "}


@pytest.mark.parametrize(
    ("line", "meant"),
    [
        (r'"1" = "\frac{20}{3}"', r"\frac{20}{3}"),
        (r'"1" = "3 \times 10^5 \text{ m}"   # a \times b', r"3 \times 10^5 \text{ m}"),
        (r'"1" = "3\cdot 5"', r"3\cdot 5"),
        (r'"1" = "\beta\rho\nu\theta\upsilon"', r"\beta\rho\nu\theta\upsilon"),
        (r'"1" = "\\frac{1}{2}"', r"\frac{1}{2}"),
        (r'"1" = "two\nlines and a \"word\" \u09ea"', 'two\nlines and a "word" \u09ea'),
        (r'"1" = "\ttab\nnumber"', "\ttab\nnumber"),
        (r"'1' = '\frac{1}{2}'", r"\frac{1}{2}"),
        (r'"1" = """\t"""', "\t"),
        (r'"1" = "C:\x\"', None),
    ],
)
def test_latex_between_quotes_is_read_as_typed(tmp_path, line, meant):
    path = tmp_path / "a.toml"
    path.write_text(f"[answers]\n{line}\n", "utf-8")
    if meant is not None:
        assert read_filled_form(path).list_typed_texts() == {"1": meant}
        return
    with pytest.raises(KeyFileError, match=r"line 2.*between straight quotes"):
        read_filled_form(path)

"""Tables as offices save them, written by another library than the one that reads them."""

from __future__ import annotations

import datetime as dt
import io
import zipfile

import pytest
import xlsxwriter

from quizgen.core.errors import ClassError
from quizgen.core.spreadsheets import iter_spreadsheet_rows


def workbook(rows, *, first="Teilnehmer", **options):
    out = io.BytesIO()
    with xlsxwriter.Workbook(out, {"in_memory": True, **options}) as book:
        sheet = book.add_worksheet(first)
        for at, row in enumerate(rows):
            sheet.write_row(at, 0, row)
        book.add_worksheet("another").write(0, 0, "not read")
    return out.getvalue()


def read(tmp_path, data, name="roster.xlsx"):
    path = tmp_path / name
    path.write_bytes(data)
    return list(iter_spreadsheet_rows(path, ClassError))


@pytest.mark.parametrize("options", [{}, {"constant_memory": True}], ids=["shared", "inline"])
def test_cells_of_the_first_sheet_are_read_as_they_are_shown(tmp_path, options):
    rows = [
        ["Matrikel", "Name", "", "1a"],
        [2301259, "Müller, Ö.", None, 0.1 + 0.2],
        [],
        ["007", "=1+1", True, "রহিমা <b> & Co"],
        [12345678901234, "", "", 1e-5],
    ]
    data = workbook(rows, strings_to_formulas=False, **options)
    assert read(tmp_path, data) == [
        (1, ["Matrikel", "Name", "", "1a"][: 4]),
        (2, ["2301259", "Müller, Ö.", "", "0.3"]),
        (4, ["007", "=1+1", "true", "রহিমা <b> & Co"]),
        (5, ["12345678901234", "", "", "1e-05"]),
    ]  # fmt: skip


def test_what_a_spreadsheet_made_of_a_number_is_no_number(tmp_path):
    out = io.BytesIO()
    with xlsxwriter.Workbook(out) as book:
        sheet = book.add_worksheet()
        shown = ["d.m.yyyy", "h:mm", "0.00", '0.0 "days"', "[$-407]mmm yy", "[Red]0", "@"]
        for column, form in enumerate(shown):
            sheet.write_number(0, column, 46143, book.add_format({"num_format": form}))
        sheet.write_datetime(1, 0, dt.date(2026, 5, 1), book.add_format({"num_format": 14}))
        sheet.write_formula(1, 1, "=1+1", None, 2)
        sheet.write_formula(1, 2, "=1+2", None, 3)
    with zipfile.ZipFile(out) as book:
        sheet = book.read("xl/worksheets/sheet1.xml").replace(b"<v>3</v>", b"")
    first, second = read(tmp_path, replaced(out.getvalue(), "xl/worksheets/sheet1.xml", sheet))
    assert first[1] == ["#DATE!", "#DATE!", "46143", "46143", "#DATE!", "46143", "46143"]
    assert second[1] == ["#DATE!", "2", "#FORMULA!"]


@pytest.mark.parametrize(
    ("encoding", "name"), [("utf-8-sig", "Jörg"), ("utf-16", "Jörg"), ("cp1252", "Jörg – €")]
)
def test_text_is_read_in_the_encodings_of_windows(tmp_path, encoding, name):
    rows = read(tmp_path, f"id;name\r\n7;{name}\r\n".encode(encoding), "roster.csv")
    assert rows == [(1, ["id", "name"]), (2, ["7", name])]


def test_an_old_workbook_is_told_from_a_text(tmp_path):
    with pytest.raises(ClassError, match=r"old workbook \(\.xls\), or has a password"):
        read(tmp_path, b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1 id;name", "roster.xls")


def replaced(data, name, content):
    """The archive with another content of one file; without it if that is None."""
    out = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(out, "w") as new:
        for one in old.namelist():
            if one != name:
                new.writestr(one, old.read(one))
            elif content is not None:
                new.writestr(one, content)
    return out.getvalue()


SHEET = "xl/worksheets/sheet1.xml"
BOMB = '<!DOCTYPE x [<!ENTITY a "aaaa">]><x>&a;</x>'


@pytest.mark.parametrize(
    "spoil",
    [
        lambda data: data[:200],
        lambda data: data[:-30],
        lambda data: replaced(data, SHEET, None),
        lambda data: replaced(data, SHEET, "<torn"),
        lambda data: replaced(data, SHEET, BOMB),
        lambda data: replaced(data, SHEET, " " * 21_000_000),
        lambda data: replaced(data, "xl/sharedStrings.xml", "<s/>"),
        lambda data: replaced(data, "xl/workbook.xml", "<s/>"),
        lambda _: b"id\n\x00\x81\x9d\n",
    ],
)
def test_what_is_damaged_is_named(tmp_path, spoil):
    with pytest.raises(ClassError, match=r"roster\.xlsx"):
        read(tmp_path, spoil(workbook([["id"], ["7"]])))

"""Rosters: any columns, any names, and files that no name can leave the folder by."""

from __future__ import annotations

import pytest
import xlsxwriter

from quizgen.classes.roster import RosterStudent, read_roster, seat_neighbours, write_roster
from quizgen.core.errors import ClassError


def roster(tmp_path, text, **columns):
    path = tmp_path / "roster.csv"
    path.write_bytes(text.encode("utf-8-sig"))
    return read_roster(path, columns)


def test_columns_may_be_called_anything(tmp_path):
    text = "Nachname;Matrikel;Raum\nMüller, Ö.;104;A\n"
    assert roster(tmp_path, text, id="matrikel", name="Nachname", group="Raum") == [
        RosterStudent("104", "Müller, Ö.", group="A")
    ]


def test_a_roster_of_a_german_office_is_read_as_it_comes(tmp_path):
    """Windows-1252, semicolons, the name in two columns."""
    path, told = tmp_path / "roster.csv", []
    text = "Matrikelnummer;Nachname;Vorname;Raum;Sitzplatz;Bonuspunkte;PStatus\r\n0104;Müller;Zoë;HS1;12;2,5;AN\r\n"
    path.write_bytes(text.encode("cp1252"))
    assert read_roster(path, tell=told.append) == [
        RosterStudent("0104", "Zoë Müller", group="HS1", seat="12", bonus="2,5")
    ]
    assert told == ["PStatus"]


def test_names_in_two_columns_are_one(tmp_path):
    assert (
        roster(tmp_path, "id;Zuname;Rufname\n1;Weiß;Ben\n", name="Rufname+Zuname")[0].name
        == "Ben Weiß"
    )
    assert roster(tmp_path, "id;Name;Vorname\n1;Weiß;Ben\n")[0].name == "Ben Weiß"
    assert roster(tmp_path, "id;name;last name\n1;Ben W.;Weiß\n")[0].name == "Ben W."
    assert roster(tmp_path, "id;Nachname\n1;Weiß\n")[0].name == "Weiß"
    with pytest.raises(ClassError, match="no column 'zuname' \\(it has id"):
        roster(tmp_path, "id;Vorname\n1;Ben\n", name="Vorname+Zuname")


def test_a_workbook_is_a_roster(tmp_path):
    path = tmp_path / "roster.xlsx"
    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet()
        for at, row in enumerate([("Matrikel", "Name"), (2301259, "Ada"), ("007", "Bond")]):
            sheet.write_row(at, 0, row)
    assert read_roster(path) == [RosterStudent("2301259", "Ada"), RosterStudent("007", "Bond")]


def test_columns_in_full_words_are_known_and_what_is_not_read_is_told(tmp_path):
    path, unread = tmp_path / "roster.csv", []
    path.write_text("id,Language,extra time,E-mail,,name\n7,bn,25%,a@b,x,Ada\n", encoding="utf-8")
    assert read_roster(path, tell=unread.append) == [RosterStudent("7", "Ada", "bn", "25%")]
    assert unread == ["E-mail"]


def test_who_names_a_column_means_no_other(tmp_path):
    text = "id,language,Sprache\n7,en,bn\n"
    assert roster(tmp_path, text, lang="Sprache")[0].lang == "bn"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "is empty"),
        ("id,name\n", "has no students"),
        ("Nummer\n1\n", "it has Nummer"),
        ("id\nab\nc\nAB\n", "lines 2 and 4"),
        ("id,name\n,Ada\n", "line 2: has no id"),
        ("id,lang\n1,French\n", "line 2: lang 'French' (allowed: en, bn, de, both, or"),
        ("id,extra\n1,half\n", "line 2: extra 'half'"),
        ("id,bonus\n1,many\n", "line 2: bonus 'many'"),
        ("id,bonus\n1,-2\n", "line 2: bonus '-2'"),
        ('id,name\n1,"' + "x" * 201 + '"\n', "line 2: name is longer"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(tmp_path, text, said):
    with pytest.raises(ClassError, match=r"roster\.csv") as error:
        roster(tmp_path, text)
    assert said in str(error.value)


def test_a_column_that_is_not_there_is_named_with_those_that_are(tmp_path):
    with pytest.raises(ClassError, match=r"no column 'Matr' \(it has id, name"):
        roster(tmp_path, "id,name\n1,Ada\n", id="Matr")


def test_names_become_one_line_without_hidden_marks(tmp_path):
    text = 'id,name\n1,"O\'Neil ""Bo""\n=cmd()"\n2,\u202eevil\u202c\u0007\n3,রুবাইয়াত হোসেন\n4,=1+1\n'
    assert [one.name for one in roster(tmp_path, text)] == [
        "O'Neil \"Bo\" =cmd()", "evil", "রুবাইয়াত হোসেন", "=1+1"
    ]  # fmt: skip


HOSTILE = (
    "../../etc/passwd",
    "a/b",
    "a\\b",
    ".hidden",
    "con",
    "NUL.txt",
    "-rf",
    "রোল-১",
    "x" * 90,
    "..",
    "a b",
    "=1",
)


def test_no_id_leaves_the_folder_by_its_file(tmp_path):
    files = [RosterStudent(one).file for one in HOSTILE]
    assert len(set(files)) == len(HOSTILE)
    for file in files:
        made = tmp_path / f"{file}.pdf"
        made.write_bytes(b"")
        assert made.resolve().parent == tmp_path.resolve()
        assert file.isascii()
        assert file[0] not in ".-"
    assert RosterStudent("1234567").file == "1234567"
    assert RosterStudent("con").file != "con"


def test_seats_are_counted_and_groups_apart(tmp_path):
    text = "id,group,seat\na,H2,1\nb,H1,10\nc,H1,9\nd,H1,A2\ne,H1,8\n"
    found = roster(tmp_path, text)
    assert [one.id for one in found] == ["d", "e", "c", "b", "a"]
    assert seat_neighbours(found) == {
        "d": ["e"],
        "e": ["d", "c"],
        "c": ["e", "b"],
        "b": ["c"],
        "a": [],
    }


def test_a_roster_written_is_inert_and_reads_back(tmp_path):
    students = [
        RosterStudent("=1+1", '@Ada, "B"', "bn", "25%", "H1", "-3"),
        RosterStudent("'q", "+49"),
    ]
    path = tmp_path / "again.csv"
    path.write_bytes(write_roster(students))
    assert "\n'=1+1," in path.read_text(encoding="utf-8-sig")
    assert sorted(read_roster(path), key=lambda one: one.id) == sorted(
        students, key=lambda one: one.id
    )


@pytest.mark.parametrize(
    ("extra", "more"), [("", 0), ("25%", 30), ("30", 30), ("15 min", 15), ("33 %", 40)]
)
def test_extra_time_is_a_share_or_minutes(extra, more):
    assert RosterStudent("1", extra=extra).extra_minutes(120) == more

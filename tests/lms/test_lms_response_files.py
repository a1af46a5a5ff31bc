"""Files of responses that nobody should believe: each a clear line that names the place."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import pytest

from quizgen.core.errors import KeyFileError
from quizgen.lms.manifest import MANIFEST_FORMAT, read_manifest
from quizgen.lms.response_files import LARGEST_REPORT, read_attempts

GOOD = Path(__file__).parent / "moodle" / "responses.csv"
KEYS = Path(__file__).parent / "moodle" / "quiz.keys.jsonl"
HEAD = "Last name,First name,Question 1,Response 1\n"
KNOWN = {"abcd-2345"}


LONG = (
    '<assessmentResult><itemResult identifier="a"><responseVariable identifier="R">'
    f"<candidateResponse><value>{'x' * 140_000}</value></candidateResponse></responseVariable>"
    "</itemResult></assessmentResult>"
)


def refused(path, known=KNOWN):
    lost = []
    assert list(read_attempts([path], known, lost.append)) == []
    (told,) = lost
    return told


@pytest.mark.parametrize(
    ("name", "data", "told"),
    [
        ("a.csv", b"", "no column"),
        ("a.csv", b"\0\0", "a zero byte"),
        ("a.csv", HEAD.encode("utf-16-le"), "a zero byte"),
        ("a.csv", (HEAD + "\u00d6z,Cem,[abcd-2345],1").encode("latin-1"), "save it as UTF-8"),
        ("a.csv", (HEAD + 'Oz,Cem,[abcd-2345],"1').encode(), "line 2"),
        ("a.csv", b"Last name,Question 1\nOz,[abcd-2345]", "tick 'response'"),
        ("a.json", b"[[{]]", "line 1"),
        ("a.json", b"[" * 100_000, "within each other"),
        ("a.json", b'{"question1": "[abcd-2345]"}', "a list of attempts"),
        ("a.json", b'[[{"question1": "", "question1": ""}]]', "stands twice"),
        ("a.json", b"[" + b"{}," * 600_000 + b"{}]", "more than 500000 values"),
        ("a.json", b'["' + b'\\"' * 600_000, "line 1"),
        ("a.json", b'[[{"question1": "[abcd-2345]", "r1": "' + b"x;" * 100_000 + b'"}]]', "131072"),
        ("a.csv", b"\n" * 1_100_000 + b"a,b\n", "more than 500000 empty rows"),
        ("a.csv", b"a,b\n" + b" ,\n" * 600_000, "more than 500000 empty rows"),
        ("a.zip", b"PK\x03\x04 and no more", "not an archive"),
        ("a.pdf", b"%PDF", "no file of responses"),
        ("a.xml", b"<a><b></a>", "line 1, column 9: not XML"),
        ("a.xml", b"", "not XML"),
        ("a.xml", b'<a b="' + b"x" * 6_000_000 + b'"/>', "larger than 5 MB"),
        ("a.xml", LONG.encode(), "more than 131072 characters"),
        ("a.xml", b"<html/>", "not a result report of QTI (its first element is html)"),
        ("a.xml", b"<a>" * 100_000, "too deep"),
        ("a.xml", "<a>\u00f6</a>".encode("latin-1"), "save it as UTF-8"),
        ("a.xml", b'<!DOCTYPE a [<!ENTITY b "ha"><!ENTITY c "&b;&b;">]><a>&c;</a>', "DOCTYPE"),
        ("a.xml", b'<!DOCTYPE a [<!ENTITY b SYSTEM "file:///etc/passwd">]><a>&b;</a>', "DOCTYPE"),
        ("a.xml", '<!DOCTYPE a [<!ENTITY b "ha">]><a>&b;</a>'.encode("utf-16"), "DOCTYPE"),
    ],
)  # fmt: skip
def test_a_file_that_is_none(tmp_path, name, data, told):
    path = tmp_path / name
    path.write_bytes(data)
    message = refused(path)
    assert told in message
    assert str(path) in message


@pytest.mark.parametrize(
    ("name", "data", "told"),
    [
        ("a.csv", HEAD + "Oz,Cem,[abcd-2345],1\nOz,[abcd-2345]\nLi,Su,[abcd-2345],2,3\n", ": line "),
        ("a.json", '[[{"question1": "[abcd-2345]", "response1": "1"}, {"x": "1"}, {}]]', ": attempt "),
    ],
)  # fmt: skip
def test_a_row_that_cannot_be_read_stops_no_other(tmp_path, name, data, told):
    path, lost = tmp_path / name, []
    path.write_text(data, encoding="utf-8")
    (found,) = read_attempts([path], KNOWN, lost.append)
    assert [one.given for one in found.responses] == ["1"]
    assert [line.startswith(f"{path}{told}") for line in lost] == [True, True]


def test_commas_in_texts_are_no_values(tmp_path):
    """A long report is one of long texts."""
    path = tmp_path / "a.json"
    row = {"question1": "[abcd-2345]", "response1": 'so, "well", {[\\' * 5000}
    path.write_text(json.dumps([[row] * 40]), encoding="utf-8")
    assert path.read_bytes().count(b",") > 300_000
    found = list(read_attempts([path], KNOWN, pytest.fail))
    assert [one.responses[0].given for one in found] == [row["response1"]] * 40


def test_an_archive_without_reports(tmp_path):
    path = tmp_path / "a.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("inner.zip", b"PK")
    assert "no file of responses in it" in refused(path)


def test_a_bomb_is_not_unpacked(tmp_path):
    path = tmp_path / "bomb.zip"
    with (
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open("a.csv", "w") as stream,
    ):
        for _ in range(80):
            stream.write(b"a\n" * 500_000)
    assert path.stat().st_size < 200_000
    assert "60 MB unpacked" in refused(path)


METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA)


@pytest.mark.parametrize("method", METHODS)
def test_an_archive_with_a_wrong_byte_raises_nothing_else(tmp_path, method):
    """Wherever it is: the archive is read all the same, or named as one that cannot be."""
    path = tmp_path / "a.zip"
    with zipfile.ZipFile(path, "w", method) as archive:
        archive.writestr("\u00f6.csv", HEAD + "Oz,Cem,[abcd-2345],1\n")
    good, told = path.read_bytes(), []
    for place, byte in enumerate(good):
        path.write_bytes(good[:place] + bytes([byte ^ 0xA5]) + good[place + 1 :])
        list(read_attempts([path], KNOWN, told.append))
    assert any("not an archive that can be read" in line for line in told)
    assert all(line.startswith(str(path)) for line in told)


def test_a_file_of_a_hundred_megabytes(tmp_path):
    path = tmp_path / "long.csv"
    with path.open("wb") as stream:
        stream.truncate(100_000_000)
    assert f"larger than {LARGEST_REPORT // 10**6} MB" in refused(path)


def test_the_last_column_has_no_responses_behind_it(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("Name,Question\nAda,What is it? [abcd-2345]\n", "utf-8")
    assert "no responses behind the column 'Question" in refused(path)


def test_an_archive_of_reports(tmp_path):
    path = tmp_path / "all.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.write(GOOD, "group/responses.csv")
        archive.writestr("readme.md", "no report")
        archive.writestr("bad.csv", b"\xff")
    lost = []
    found = list(read_attempts([path], read_manifest(KEYS).found, lost.append))
    assert [line.split(":")[0] for line in lost] == [f"{path}/bad.csv"]
    assert [one.id for one in found] == ["78", "1815", "0042", "77", "77"]
    assert found[0].where == f"{path}/group/responses.csv: line 2"


@pytest.mark.parametrize(
    ("field", "told"),
    [
        ({"kind": "one"}, "has no options"),
        ({"kind": "many", "options": {"A": []}}, "has no options"),
        ({"kind": "pairs", "options": {"A B": ["x"]}}, "is no letter or number"),
        ({"kind": "order", "options": {"A": ["x"]}, "targets": {"first": ["1"]}}, "is no number"),
        ({"kind": "number", "part": "2"}, "belongs to no part"),
    ],
)
def test_keys_by_which_no_response_could_be_read(tmp_path, field, told):
    entry = {"mark": "abcd-2345", "id": "a", "asks": [{"part": "1", **field}]}
    item = {"id": "a", "slot": "a", "lang": "en", "question": {}, "shapes": {"1": {"form": "one"}},
            "entries": [entry]}  # fmt: skip
    path = tmp_path / "x.keys.jsonl"
    path.write_text(f'{{"format":"{MANIFEST_FORMAT}"}}\n{json.dumps(item)}\n', "utf-8")
    with pytest.raises(KeyFileError, match=f"x.keys.jsonl: line 2: .*{told}"):
        read_manifest(path)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("{}", "not the keys of an export"),
        (f'{{"format":"{MANIFEST_FORMAT}"}}\n{{"id":1}}', "line 2"),
        (f'{{"format":"{MANIFEST_FORMAT}"}}\n' + "[" * 10_000, "line 2"),
    ],
)
def test_keys_that_are_none(tmp_path, text, told):
    path = tmp_path / "x.keys.jsonl"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(KeyFileError, match=told):
        read_manifest(path)

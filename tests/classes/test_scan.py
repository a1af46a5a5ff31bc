"""Answer sheets come back on paper: filled by a simulated hand, scanned, read, asked, marked."""

from __future__ import annotations

import csv
import io
import json
import os
import random
import re
import shutil
import struct
import zlib

import pikepdf
import pytest
from made import run
from paper_and_pen import Pen, fill_sheet, rasterise, save_scan, scan, spoil
from PIL import Image

from quizgen.classes import generation
from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.scanning import pictures
from quizgen.classes.scanning.pages import PageReading, PartReading
from quizgen.classes.scanning.scan_folder import ScanFolder

PLAN = """
[title]
en = "Sheet"
[[slot]]
templates = ["rods-cones-and-peaks", "exposure-equivalence", "exposure-faults-and-remedies"]
count = 3
"""
pytestmark = [
    pytest.mark.skipif(not shutil.which("pdftoppm"), reason="rasterises with poppler"),
]


@pytest.fixture(scope="module")
def made_class(tmp_path_factory):
    """A class with answer sheets that nobody changes: tests copy it."""
    root = tmp_path_factory.mktemp("class")
    (root / "plan.toml").write_text(PLAN, "utf-8")
    (root / "roster.csv").write_text("id,name\n7,Ada\n8,Ben\n", "utf-8")
    wished = ("--blueprint", root / "plan.toml", "--out", root / "class", "--sheet", "--jobs", 1)
    with pytest.MonkeyPatch.context() as same:
        same.setattr(generation, "new_secret", lambda: "5" * 32)
        same.setattr(generation, "render_paper", lambda *_: b"")  # sheets alone are looked at
        assert run("class", "make", root / "roster.csv", *wished) == 0
    return root / "class"


@pytest.fixture(scope="module")
def lines(made_class):
    """The lines of ``keys.jsonl`` by student."""
    found = map(json.loads, (made_class / "keys.jsonl").read_text("utf-8").splitlines())
    return {line["id"]: line for line in found}


@pytest.fixture(scope="module")
def blanks(made_class):
    """The printed sheet of each student: one page."""
    return {path.stem: rasterise(path)[0] for path in sorted((made_class / "sheets").iterdir())}


@pytest.fixture
def folder(made_class, tmp_path):
    return shutil.copytree(made_class, tmp_path / "class")


def clear_pen(seed: object) -> Pen:
    """A hand that writes clearly."""
    pen = Pen(seed)
    pen.width, pen.dark, pen.shape, pen.shaky, pen.size = 0.5, 0.85, "cross", 0.05, 0.95
    return pen


def crossed(page: Image.Image, line: dict, options: dict[str, str], pen: Pen) -> Image.Image:
    """A copy of a page with a mark of some kind in boxes: by part and option, as ``1a A:2``."""
    page = page.copy()
    for box in line["sheet"]["fields"]:
        kind = options.get(f"{box['part']} {box.get('option', '')}")
        if kind:
            pen.mark(page, box, kind)
    return page


def options_of(line: dict, kind: str) -> list[str]:
    """Part and option of every box of the first part of some kind."""
    parts = [part for one in line["key"]["questions"] for part in one["parts"]]
    name = next(part["id"] for part in parts if part["spec"]["kind"] == kind)
    boxes = [box for box in line["sheet"]["fields"] if box["part"] == name]
    return [f"{box['part']} {box['option']}" for box in boxes]


def read_answers(folder) -> dict[tuple[str, str], str]:
    """What stands in the hand-in that was made of the scans, by student and part."""
    text = (folder / "answers" / "scan.csv").read_text("utf-8-sig")
    rows = csv.DictReader(io.StringIO(text))
    return {(row["id"], row["part"]): row["answer"] for row in rows}


def test_sheets_of_a_copier_and_a_phone_give_the_marks_of_typed_answers(
    folder, lines, blanks, tmp_path
):
    meant, pictures = {}, []
    for number, (student, how) in enumerate((("7", "skew"), ("8", "phone"))):
        kinds = {
            p["id"]: p["spec"]["kind"]
            for q in lines[student]["key"]["questions"]
            for p in q["parts"]
        }
        page, pen = blanks[student].copy(), clear_pen(number)
        meant[student], _ = fill_sheet(
            [page], lines[student]["sheet"]["fields"], kinds, pen, usual=True
        )
        pictures.append(scan(spoil(page, "punch", pen.random), how, pen.random))
    pictures[0].rotate(180).save(tmp_path / "stack.pdf", quality=50, resolution=150)
    save_scan(pictures[1], tmp_path / "phone", "phone")
    assert run("class", "scan", folder, tmp_path / "phone.jpg", tmp_path / "stack.pdf") == 0
    answers = read_answers(folder)
    for (student, part), answer in answers.items():
        expected = meant[student].get(part)
        assert answer == ("see paper" if expected is None else expected), (student, part)
    assert sum(answer != "see paper" for answer in answers.values()) >= 8
    assert run("class", "mark", folder) == 0
    typed = shutil.copytree(folder, tmp_path / "typed")
    shutil.rmtree(typed / "marks")
    shutil.rmtree(typed / "answers")
    rows = [
        [student, part, "" if answer is None else answer]
        for student, own in meant.items()
        for part, answer in own.items()
    ]
    with (tmp_path / "in.csv").open("w", encoding="utf-8", newline="") as stream:
        csv.writer(stream).writerows([["id", "part", "answer"], *rows])
    assert run("class", "mark", typed, tmp_path / "in.csv") in {0, 1}
    marks = [read_marks(one) for one in (folder, typed)]
    same = [key for key, answer in answers.items() if answer != "see paper"]
    assert {key: marks[0][key] for key in same} == {key: marks[1][key] for key in same}
    assert all(marks[0][key] is None for key in answers.keys() - {*same}), "nobody has decided"


def read_marks(folder) -> dict[tuple[str, str], float | None]:
    """The marks of the first run."""
    students = map(json.loads, (folder / "marks" / "001.jsonl").read_text("utf-8").splitlines())
    return {
        (one["student"], part["id"]): part["marks"] for one in students for part in one["parts"]
    }


def test_a_filled_box_is_withdrawn_and_what_is_not_clear_is_asked(
    folder, lines, blanks, tmp_path, capsys
):
    one, pairs = options_of(lines["7"], "choice"), options_of(lines["7"], "match")
    first = {one[0]: "crossed and filled", one[1]: "cross", pairs[0]: "dot", pairs[-1]: "cross"}
    second = options_of(lines["8"], "choice")
    save_scan(crossed(blanks["7"], lines["7"], first, clear_pen(1)), tmp_path / "a", "200")
    save_scan(
        crossed(blanks["8"], lines["8"], dict.fromkeys(second[:2], "cross"), clear_pen(2)),
        tmp_path / "b",
        "200",
    )
    assert run("class", "scan", folder, tmp_path / "a.jpg", tmp_path / "b.jpg") == 0
    said = capsys.readouterr().out
    assert "To be typed or decided: 2 answers" in said
    answers = read_answers(folder)
    part, option = one[1].split()
    assert answers["7", part] == option
    assert answers["7", pairs[0].split()[0]] == answers["8", second[0].split()[0]] == "see paper"
    report = json.loads((folder / "scans" / "report.json").read_text("utf-8"))["students"]
    asked = report["7"]["parts"][pairs[0].split()[0]]
    assert (asked["answer"], asked["why"], asked["page"]) == (None, "unclear", 1)
    assert report["8"]["parts"][second[0].split()[0]]["why"] == "several"
    assert (folder / "scans" / asked["crop"]).read_bytes().startswith(b"\x89PNG")
    assert asked["crop"] == f"{lines['7']['code']}/{pairs[0].split()[0]}.png"
    page = (folder / "scans" / "scans.html").read_text("utf-8")
    assert asked["crop"] in page
    assert 'placeholder="' in page


def test_what_a_person_types_counts_and_a_wrong_table_is_refused_with_its_line(
    folder, lines, blanks, tmp_path, capsys
):
    pairs = options_of(lines["7"], "match")
    part = pairs[0].split()[0]
    save_scan(
        crossed(blanks["7"], lines["7"], {pairs[0]: "dot"}, clear_pen(1)), tmp_path / "a", "200"
    )
    assert run("class", "scan", folder, tmp_path / "a.jpg") == 0
    (tmp_path / "wrong.csv").write_text("id,part,answer\n7,99,x\n", "utf-8")
    assert run("class", "scan", folder, tmp_path / "wrong.csv") == 2
    assert "wrong.csv:2: the paper of 7 has no part 99" in capsys.readouterr().err
    (tmp_path / "typed.csv").write_text(f'id,part,answer\n7,{part},"A:1, B:2"\n', "utf-8")
    assert run("class", "scan", folder, tmp_path / "typed.csv") == 0
    assert "1 answer taken from what was typed" in capsys.readouterr().out
    assert read_answers(folder)["7", part] == "A:1, B:2"
    (tmp_path / "typed.csv").write_text(f"id,part,answer\n7,{part},\n", "utf-8")
    assert run("class", "scan", folder, tmp_path / "typed.csv") == 0
    assert read_answers(folder)["7", part] == "", "blank after all"
    assert run("class", "scan", folder) == 0, "it stays"
    line = next(box["part"] for box in lines["7"]["sheet"]["fields"] if box["kind"] == "line")
    (tmp_path / "typed.csv").write_text(f"id,part,answer\n7,{line},'-3\n", "utf-8")
    assert run("class", "scan", folder, tmp_path / "typed.csv") == 0
    assert run("class", "mark", folder) == 0
    marked = json.loads((folder / "marks" / "001.jsonl").read_text("utf-8").splitlines()[0])
    assert next(one["typed"] for one in marked["parts"] if one["id"] == line) == "-3"
    assert read_answers(folder)["7", part] == ""


def test_every_picture_is_attributed_or_listed(folder, lines, blanks, tmp_path, capsys):
    r = random.Random(3)
    page = crossed(
        blanks["7"], lines["7"], {options_of(lines["7"], "choice")[0]: "cross"}, clear_pen(4)
    )
    save_scan(page, tmp_path / "fax", "bilevel")
    torn = blanks["8"].copy()
    for box in (5, 1500):
        torn.paste(255, (0, box, 1700, box + 760))
    save_scan(torn, tmp_path / "torn", "200")
    save_scan(scan(Image.new("L", page.size, 255), "150", r), tmp_path / "back", "150")
    other = tmp_path / "foreign.png"
    import segno

    segno.make("Q1:GAAAABBBBCCCC:1:00000000").save(other, scale=9, border=9)
    files = [tmp_path / name for name in ("fax.png", "torn.jpg", "back.jpg", "foreign.png")]
    assert run("class", "scan", folder, *files) == 1
    said = capsys.readouterr().out
    assert "7, page 1: black and white without greys: scan it again in grey" in said
    assert (
        "foreign.png, page 1: the code is not of this class (Q1:GAAAABBBBCCCC:1:00000000)" in said
    )
    assert "1 with nothing on them" in said
    assert "torn.jpg, page 1: no code can be read" in said
    assert "No sheet came of:\n8\n" in said
    assert {read_answers(folder)["7", part] for _, part in read_answers(folder)} == {"see paper"}
    save_scan(page, tmp_path / "again", "200")
    assert run("class", "scan", folder, tmp_path / "again.jpg") == 1, (
        "of one no sheet came, and pictures are odd"
    )
    part, option = options_of(lines["7"], "choice")[0].split()
    assert read_answers(folder)["7", part] == option, "the second picture is a better one"


def test_a_page_without_a_code_is_assigned_by_hand_and_taken_back(
    folder, lines, blanks, tmp_path, capsys
):
    box = options_of(lines["7"], "choice")[1]
    part, option = box.split()
    page = crossed(blanks["7"], lines["7"], {box: "cross"}, clear_pen(4))
    x, y, side = (round(one * 200 / 25.4) for one in lines["7"]["sheet"]["code"])
    page.paste(90, (x, y, x + side, y + side))  # a coffee cup on the code
    save_scan(page, tmp_path / "cup", "200", upside_down=True)
    torn = page.copy()
    torn.paste(255, (0, 0, 1700, 800))  # two marks are gone, too
    save_scan(torn, tmp_path / "torn", "200")
    assert run("class", "scan", folder, tmp_path / "cup.jpg", tmp_path / "torn.jpg") == 1
    assert "cup.jpg, page 1: no code can be read" in capsys.readouterr().out
    strays = [one for one in ScanFolder(ClassFolder(folder)).iter_pages() if not one.student]
    cup, rest = (f"{one.digest}-{one.number}" for one in strays)
    shown = (folder / "scans" / "scans.html").read_text("utf-8")
    assert f'data-picture="{cup}"' in shown
    [picture] = re.findall(rf'src="([^"]*{cup}\.jpg)"', shown)
    assert (folder / "scans" / picture).read_bytes().startswith(b"\xff\xd8"), "a JPEG to look at"

    def assign(who: str, page: str, picture: str = cup) -> int:
        table = tmp_path / "typed.csv"
        table.write_text(f"id,part,answer\n{who},{page},{picture}\n", "utf-8")
        return run("class", "scan", folder, table)

    assert assign("7", "page 2") == 2
    assert "the paper of 7 has 1 pages, and no page 2" in capsys.readouterr().err
    assert assign("7", "page 1", "../../../etc/passwd") == 2
    assert "there is no picture" in capsys.readouterr().err
    kept = folder / "scans" / picture
    whole = kept.read_bytes()
    kept.write_bytes(whole[: len(whole) // 2])
    assert assign("7", "page 1") == 2
    assert f"{cup}.jpg: is damaged" in capsys.readouterr().err
    kept.write_bytes(whole)
    assert assign("7", "page 1") == 1, "the other picture is still of nobody"
    assert read_answers(folder)["7", part] == option
    assert assign("", "page", cup) == 1
    assert "No sheet came of:\n7\n8\n" in capsys.readouterr().out
    assert not [*(folder / "scans" / lines["7"]["code"]).iterdir()]
    assert assign("8", "page 1", rest) == 1
    assert "8, page 1: corner marks cannot be found" in capsys.readouterr().out
    crops = {path.stem for path in (folder / "scans" / lines["8"]["code"]).glob("*.png")}
    assert crops == {one["part"] for one in lines["8"]["sheet"]["fields"]}, (
        "each part has a picture"
    )
    assert assign("7", "page 1", rest) == 1, "it was another one's"
    assert not [*(folder / "scans" / lines["8"]["code"]).iterdir()]
    said = [json.loads(one) for one in (folder / "scans" / "pages.jsonl").read_text().splitlines()]
    assert [one.get("student", "") for one in said] == ["", "", "7", "", "8", "7"], "all is kept"


def test_what_was_read_is_not_read_again_and_a_torn_line_is(
    folder, lines, blanks, tmp_path, capsys
):
    save_scan(blanks["7"], tmp_path / "a", "200")
    save_scan(blanks["8"], tmp_path / "b", "200")
    assert run("class", "scan", folder, tmp_path / "a.jpg", tmp_path / "b.jpg") == 0
    before = {path.name: path.read_bytes() for path in (folder / "scans").glob("*.*")}
    capsys.readouterr()
    shutil.copy(tmp_path / "a.jpg", tmp_path / "other-name.jpg")
    assert run("class", "scan", folder, tmp_path / "other-name.jpg", tmp_path / "b.jpg") == 0
    assert "0 pages read, 2 had been read before" in capsys.readouterr().out
    pages = folder / "scans" / "pages.jsonl"
    pages.write_bytes(pages.read_bytes()[:-9])
    assert run("class", "scan", folder, tmp_path / "a.jpg", tmp_path / "b.jpg") == 0
    assert "1 page read, 1 had been read before" in capsys.readouterr().out
    after = {path.name: path.read_bytes() for path in (folder / "scans").glob("*.*")}
    assert after == before
    pages.write_bytes(b'{"file": 3}\n')
    assert run("class", "scan", folder) == 2
    assert "pages.jsonl: line 1" in capsys.readouterr().err


def png_of(width: int, height: int) -> bytes:
    """The bytes of a PNG that says it is so large, and has no pixels."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return (
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        )

    head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", head)
        + chunk(b"IDAT", zlib.compress(b""))
        + chunk(b"IEND", b"")
    )


def hostile_files(root) -> dict[str, str]:
    """Files that are no scans, each with what is said of it."""
    Image.new("L", (300, 400), 255).save(root / "page.jpg")
    (root / "cut.jpg").write_bytes((root / "page.jpg").read_bytes()[:300])
    (root / "large.png").write_bytes(png_of(60_000, 60_000))
    (root / "wide.png").write_bytes(png_of(13_000, 12_000))
    (root / "text.pdf").write_bytes(b"%PDF-1.7\nno more of it")
    (root / "text.jpg").write_text("no picture", "utf-8")
    (root / "notes.docx").write_bytes(b"PK")
    (root / "empty.tif").write_bytes(b"")
    (root / "folder.pdf").mkdir()
    os.mkfifo(root / "pipe.png")
    with pikepdf.new() as locked:
        locked.add_blank_page()
        locked.save(root / "locked.pdf", encryption=pikepdf.Encryption(owner="a", user="b"))
    with pikepdf.new() as bare:
        bare.save(root / "bare.pdf")
    with pikepdf.new() as vast:
        vast.add_blank_page(page_size=(14_000, 14_000))
        image = vast.make_stream(b"\0" * 10, Type=pikepdf.Name.XObject, Subtype=pikepdf.Name.Image, Width=90_000,
                                 Height=90_000, BitsPerComponent=8, ColorSpace=pikepdf.Name.DeviceGray)  # fmt: skip
        vast.pages[0].Resources = pikepdf.Dictionary(XObject=pikepdf.Dictionary(I=image))
        vast.pages[0].Contents = vast.make_stream(b"q 14000 0 0 14000 0 0 cm /I Do Q")
        vast.save(root / "vast.pdf")
    frames = [Image.new("L", (300, 400), 255)]
    frames[0].save(root / "long.tif", save_all=True, append_images=frames)
    return {
        "cut.jpg": "is damaged (Truncated", "large.png": "more than 120 million pixels", "wide.png": "more than 120 million pixels",
        "text.pdf": "is no sound PDF", "text.jpg": "is no sound picture", "notes.docx": "is no picture of a page",
        "empty.tif": "is no sound picture", "folder.pdf": "is no file", "pipe.png": "is no file", "locked.pdf": "is locked by a password",
        "bare.pdf": "is no sound PDF",  # right after it: pdfium keeps its last error
        "vast.pdf": "more than 120 million pixels", "long.tif": "has 2 pages", "gone.pdf": "No such file",
    }  # fmt: skip


def test_files_that_are_no_scans_are_named_and_stop_no_others(
    folder, blanks, tmp_path, capsys, monkeypatch
):
    monkeypatch.setattr(pictures, "MOST_PAGES", 1)
    expected = hostile_files(tmp_path)
    save_scan(blanks["7"], tmp_path / "a", "200")
    assert run("class", "scan", folder, *(tmp_path / name for name in (*expected, "a.jpg"))) == 1
    said = capsys.readouterr().out
    for name, what in expected.items():
        line = next((line for line in said.splitlines() if name in line), "")
        assert what in line, (name, said)
    assert ("7", "1a") in read_answers(folder) or read_answers(folder)


def test_a_class_without_sheets_says_so(folder, blanks, tmp_path, capsys):
    save_scan(blanks["7"], tmp_path / "a", "200")
    keys = folder / "keys.jsonl"
    table = [json.loads(line) for line in keys.read_text("utf-8").splitlines()]
    keys.write_text(
        "".join(
            json.dumps({k: v for k, v in line.items() if k != "sheet"}) + "\n" for line in table
        ),
        "utf-8",
    )
    assert run("class", "scan", folder, tmp_path / "a.jpg") == 2
    assert (
        "has no papers or sheets to read (quizgen class make --scan, --sheet)"
        in capsys.readouterr().err
    )
    assert run("class", "scan", tmp_path) == 2
    assert "is not the folder of a class" in capsys.readouterr().err


@pytest.mark.parametrize("wrong", [{"x": 0.5}, {"y": 296.0}, {"w": -4.0}, {"h": 1e9}])
def test_boxes_that_lie_on_no_page_are_an_error_in_one_line(
    folder, blanks, tmp_path, wrong, capsys
):
    save_scan(blanks["7"], tmp_path / "a", "200")
    keys = folder / "keys.jsonl"
    table = [json.loads(line) for line in keys.read_text("utf-8").splitlines()]
    for line in table:
        next(one for one in line["sheet"]["fields"] if one["kind"] == "box").update(wrong)
    keys.write_text("".join(json.dumps(line) + "\n" for line in table), "utf-8")
    assert run("class", "scan", folder, tmp_path / "a.jpg") == 2
    assert "places of a sheet that lie on no page" in capsys.readouterr().err


def test_two_pictures_of_a_page_must_agree_and_a_missing_page_is_neither_right_nor_wrong(
    folder, lines
):
    part, other = (p["id"] for p in lines["7"]["key"]["questions"][0]["parts"][:2])

    def page(digest: str, answer: str | None) -> PageReading:
        read = {
            part: PartReading(answer, 1.0, 1, (1.0, 1.0, 1.0, 1.0), "" if answer else "unclear")
        }
        return PageReading("a.pdf", digest, 1, "7", lines["7"]["code"], 1, parts=read)

    def joined(*answers: str | None) -> tuple[str | None, str, tuple[int, ...]]:
        scans = ScanFolder(ClassFolder(folder))
        shutil.rmtree(scans.path, ignore_errors=True)
        scans.add_pages([(page(f"{number}", one), {}) for number, one in enumerate(answers)])
        sheet = scans.join_sheets()[0]
        assert sheet.parts[other].reading.answer is None
        return sheet.parts[part].reading.answer, sheet.parts[part].reading.why, sheet.twice

    assert joined("A") == ("A", "", ())
    assert joined("A", "A") == ("A", "", (1,))
    assert joined(None, "B") == ("B", "", (1,))
    assert joined("A", "B") == (None, "differs", (1,))
    assert joined(None, None) == (None, "unclear", (1,))

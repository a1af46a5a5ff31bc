"""A class on paper: how much of it is read, how much asked, and that nothing is lost.

A few students with every kind of damage. ``QUIZGEN_SWEEP=full`` in the environment is the full size, by
which what docs/class.md says was measured.
"""

from __future__ import annotations

import json
import random
import shutil
import time
from collections import Counter

import pytest
from made import run
from paper_and_pen import Pen, fill_sheet, rasterise, save_scan, scan, spoil
from PIL import Image
from sweep import IS_FULL, draws
from test_scan import read_answers, read_marks

from quizgen.classes import generation
from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.scanning.pages import PageReading
from quizgen.classes.scanning.scan_folder import ScanFolder

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not shutil.which("pdftoppm"), reason="rasterises with poppler"),
]
STUDENTS = {"--sheet": draws(4, full=60), "--scan": draws(2, full=15)}
FULL = IS_FULL
FOLDERS = {"--sheet": "sheets", "--scan": "papers"}
FLAT = ("300", "200", "150", "150", "skew", "upside down", "stain", "punch", "staple")
HARD = ("fold", "phone")
ASKED, SILENT, SECONDS = 0.04 if FULL else 0.08, 0.001, 0.35
"""Share of boxes that may be asked of flat sheets, and be wrong without a word; CPU of a page."""


@pytest.fixture(scope="module", params=[*STUDENTS])
def paper(tmp_path_factory, request):
    """A class, its pages as pictures with how each was scanned, and what was meant."""
    root = tmp_path_factory.mktemp("scanned")
    roster = "".join(f"{4711000 + n},Student {n}\n" for n in range(STUDENTS[request.param]))
    (root / "roster.csv").write_text("id,name\n" + roster, "utf-8")
    with pytest.MonkeyPatch.context() as same:
        same.setattr(generation, "new_secret", lambda: "5" * 32)
        same.setattr(generation, "render_paper", lambda *_: b"")
        wished = ("--out", root / "class", request.param, "--jobs", 1)
        assert run("class", "make", root / "roster.csv", *wished) == 0
    meant, boxes, pages = {}, {}, []
    lines = (root / "class" / "keys.jsonl").read_text("utf-8").splitlines()
    for number, line in enumerate(map(json.loads, lines)):
        kinds = {p["id"]: p["spec"]["kind"] for q in line["key"]["questions"] for p in q["parts"]}
        printed = rasterise(root / "class" / FOLDERS[request.param] / f"{line['id']}.pdf")
        pen = Pen(f"fresh {line['id']}")
        fields = line["sheet"]["fields"]
        meant[line["id"]], _ = fill_sheet(printed, fields, kinds, pen)
        boxes |= {(line["id"], one["part"]): one["kind"] == "box" for one in fields}
        for page, picture in enumerate(printed, 1):
            how = (*FLAT, *HARD)[(2 * number + 5 * page) % 11]
            seen = scan(spoil(picture, how, pen.random), how, pen.random)
            pages.append((line["id"], page, how, seen))
    random.Random(5).shuffle(pages)
    return root, pages, meant, boxes


def test_every_page_is_attributed_and_few_boxes_are_asked_or_wrong(paper, tmp_path):
    root, pages, meant, boxes = paper
    folder = shutil.copytree(root / "class", tmp_path / "class")
    kinds, lost = {}, pages[7][:2]
    for number, (student, page, how, seen) in enumerate(pages):
        kinds[student, page] = how
        if (student, page) != lost:
            save_scan(seen, tmp_path / f"{number:03}", how, upside_down=how == "upside down")
    pages[0][3].save(tmp_path / "twice.jpg", quality=66)  # other bytes of the same page
    Image.new("L", (1240, 1754), 250).save(tmp_path / "back.png")
    pictures = sorted((*tmp_path.glob("*.jpg"), *tmp_path.glob("*.png")))
    start = time.process_time()
    assert run("class", "scan", folder, *pictures, "--jobs", 1) == 1, "a page is missing"
    seconds = (time.process_time() - start) / len(pictures)

    read = [*ScanFolder(ClassFolder(folder)).iter_pages()]
    assert {(one.student, one.page) for one in read if one.student} == kinds.keys() - {lost}
    assert [one.fault for one in read if not one.student] == ["empty"]
    assert seconds <= SECONDS
    flat = [one for one in read if kinds.get((one.student, one.page)) in FLAT]
    count = sum(one.boxes for one in flat)
    assert count > 10 * len(meant)
    assert sum(one.doubtful for one in flat) <= ASKED * count
    wrong = [*find_silent_errors(read, meant, boxes)]
    assert len(wrong) <= SILENT * sum(one.boxes for one in read), wrong
    report = json.loads((folder / "scans" / "report.json").read_text("utf-8"))["students"]
    assert report[lost[0]]["missing"] == [lost[1]]
    assert report[pages[0][0]]["twice"] == [pages[0][1]]
    check_marks(folder, read, meant, tmp_path)


def find_silent_errors(read: list[PageReading], meant, boxes):
    """Parts that say something else than was meant, and nobody is asked."""
    for page in read:
        for part, one in page.parts.items():
            wanted = meant[page.student][part]
            if one.answer is not None and one.answer != wanted:
                yield page.student, part, one.answer, wanted, boxes[page.student, part]


def check_marks(folder, read, meant, tmp_path) -> None:
    """Marks are those of the same answers typed, wherever they were read as they were meant."""
    assert run("class", "mark", folder) == 0
    answers = read_answers(folder)
    typed = shutil.copytree(
        folder, tmp_path / "typed", ignore=lambda _, names: {"marks", "answers", "scans"} & {*names}
    )
    rows = ["id,part,answer"]
    same = [
        key
        for key, answer in answers.items()
        if answer not in {"see paper", ""} and answer == meant[key[0]].get(key[1])
    ]
    rows += [f'{student},{part},"{answers[student, part]}"' for student, part in same]
    (tmp_path / "in.csv").write_text("\n".join(rows) + "\n", "utf-8")
    assert run("class", "mark", typed, tmp_path / "in.csv") == 0
    marks, others = read_marks(folder), read_marks(typed)
    assert len(same) > 4 * len(meant)
    assert {key: marks[key] for key in same} == {key: others[key] for key in same}


def test_processes_and_a_run_that_was_killed_come_to_the_same_bytes(paper, tmp_path):
    root, pages, *_ = paper
    stack = [seen for *_, seen in pages[:4]]
    stack[0].save(
        tmp_path / "stack.pdf", save_all=True, append_images=stack[1:], resolution=150, quality=60
    )
    made = []
    for jobs, cut in ((1, 0), (2, 0), (1, 900)):
        folder = shutil.copytree(root / "class", tmp_path / "one" / "class")
        run("class", "scan", folder, tmp_path / "stack.pdf", "--jobs", jobs)
        if cut:
            lines = folder / "scans" / "pages.jsonl"
            lines.write_bytes(lines.read_bytes()[: -lines.stat().st_size // 2])
            run("class", "scan", folder, tmp_path / "stack.pdf", "--jobs", jobs)
        files = sorted(path for path in (folder / "scans").rglob("*") if path.is_file())
        made.append({str(path.relative_to(folder)): path.read_bytes() for path in files})
        made[-1]["answers"] = (folder / "answers" / "scan.csv").read_bytes()
        shutil.rmtree(folder)
    counts = Counter(map(len, made))
    assert made[0] == made[1] == made[2], counts

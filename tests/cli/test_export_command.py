"""``quizgen export``: files, the report of what a person marks, mistakes in one line."""

from __future__ import annotations

from xml.etree import ElementTree as ET

import pytest
from inside import run


def test_a_topic_in_both_languages(tmp_path):
    done = run("export", "moodle", "--topic", "Optics", "--lang", "both", "--variants", "1",
               "--out", "o/optics.xml", cwd=tmp_path)  # fmt: skip
    assert done.returncode == 0, done.stderr
    page = ET.parse(tmp_path / "o" / "optics.xml").getroot()
    slots = [one.findtext("category/text") for one in page if one.get("type") == "category"]
    assert slots[0].startswith("$course$/top/quizgen/bn/")
    assert len(slots) == len({*slots})
    report = (tmp_path / "o" / "optics.xml.report.txt").read_text("utf-8").splitlines()
    assert report
    assert all(" exported as essay: " in line for line in report)
    assert f"parts exported as essay: {len(report)} (" in done.stdout.splitlines()[-1]


def test_the_same_call_writes_the_same_bytes(tmp_path):
    options = ["--template", "rgb-to-hsv,imread-missing-file", "--variants", "3", "--seed", "7"]
    for name in "ab":
        done = run("export", "moodle", *options, "--out", f"{name}.txt", cwd=tmp_path)
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "a.txt").read_bytes() == (tmp_path / "b.txt").read_bytes()
    assert "slots: 2," in done.stdout


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["qti9"], "'qti9' is not one of"),
        (["moodle", "--topic", "optic"], "'optic' (allowed: projection"),
        (["moodle", "--topic", "optics", "--blueprint", "mock"], "give one"),
        (["moodle", "--template", "nothing-such"], "nothing-such"),
        (["moodle", "--template", ","], "names no template"),
        (["moodle", "--variants", "0"], "--variants"),
        (["qti3", "--maths", "tex"], "not for qti3, only for moodle, canvas"),
        (["moodle", "--blueprint", "none-such"], "no blueprint 'none-such'"),
    ],
)
def test_a_mistake_is_one_line_and_nothing_is_written(tmp_path, options, told):
    done = run("export", *options, cwd=tmp_path)
    assert done.returncode == 2
    assert told in done.stderr
    assert "Traceback" not in done.stderr
    assert list(tmp_path.iterdir()) == []

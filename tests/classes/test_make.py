"""Papers of a class: comparable, not alike, and made once."""

from __future__ import annotations

import json
import shutil
import stat
from itertools import pairwise

import pikepdf
import pytest
from made import run
from small import begun, bytes_of, with_papers

from quizgen.classes import generation
from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.print_file import write_print_file
from quizgen.classes.pseudonyms import student_seed
from quizgen.classes.roster import RosterStudent
from quizgen.core.errors import ClassError
from quizgen.paper.answer_key import answer_key_digest, parse_answer_key

IDS = ("11", "12", "13", "14", "../15")
STUDENTS = [
    RosterStudent("11", '李 "Ada" #raw(1)', extra="25%"),
    *(RosterStudent(one, one) for one in IDS[1:]),
]


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder, plan = begun(tmp_path_factory.mktemp("class"), STUDENTS)
    return folder, plan, with_papers(folder, plan, STUDENTS)


@pytest.fixture
def copied(made, tmp_path):
    """A folder of one's own to spoil."""
    shutil.copytree(made[0].path, tmp_path / "class")
    return ClassFolder(tmp_path / "class"), made[1]


def keys(folder):
    lines = (folder.path / "keys.jsonl").read_text(encoding="utf-8").splitlines()
    return {table["id"]: table for table in map(json.loads, lines)}


def test_each_student_has_paper_solutions_form_and_key(made):
    folder, _, report = made
    assert [one.student for one in report.made] == list(IDS)
    assert list(keys(folder)) == list(IDS)
    for part, ending in (("papers", "pdf"), ("solutions", "pdf"), ("forms", "toml")):
        names = {path.name for path in (folder.path / part).iterdir()}
        assert len(names) == len(IDS)
        assert {f"{one}.{ending}" for one in IDS[:4]} < names


def test_papers_ask_the_same_with_other_numbers(made):
    asked = [[q["template"] for q in one["key"]["questions"]] for one in keys(made[0]).values()]
    points = [[q["points"] for q in one["key"]["questions"]] for one in keys(made[0]).values()]
    numbers = [one["key"]["questions"][0]["identity"] for one in keys(made[0]).values()]
    assert len({*map(tuple, asked)}) == len({*map(tuple, points)}) == 1
    assert all(left != right for left, right in pairwise(numbers))
    assert len({(one.points, one.minutes, one.tiers) for one in made[2].made}) == 1


def test_what_leads_to_answers_is_for_the_examiner_alone(made):
    for path in made[0].path.rglob("*"):
        assert stat.S_IMODE(path.stat().st_mode) & 0o077 == 0, path


def printed(path):
    """Every stream of a PDF file, unpacked, and what it says about itself."""
    with pikepdf.open(path) as pdf:
        streams = [one.read_bytes() for one in pdf.objects if isinstance(one, pikepdf.Stream)]
        return b"\n".join([*streams, str(pdf.docinfo).encode()])


def test_every_page_says_whose_it_is(made):
    """The foot of the page is text on all pages; the code is among the words about the file."""
    for one in keys(made[0]).values():
        name = RosterStudent(one["id"]).file
        assert one["code"].encode() in printed(made[0].path / f"papers/{name}.pdf")
    text = (made[0].path / "forms/11.toml").read_text(encoding="utf-8")
    assert 'matriculation = "11"' in text
    assert 'name = "李 \\"Ada\\" #raw(1)"' in text


def test_nothing_that_students_hold_leads_to_the_key(made):
    """Not the secret, no seed, and no digest that would confirm a guess at what is not printed."""
    folder = made[0]
    secret = folder.settings.secret
    for one in keys(folder).values():
        name, key = RosterStudent(one["id"]).file, parse_answer_key(one["key"])
        digest = answer_key_digest(key, one["made"])
        form = (folder.path / f"forms/{name}.toml").read_bytes()
        held = form + printed(folder.path / f"papers/{name}.pdf")
        for told in (
            secret,
            student_seed(secret, one["id"]),
            student_seed(secret),
            digest,
            one["made"],
        ):
            assert told.encode() not in held
        assert key.paper.encode() in form
        assert key.questions[0].identity.encode() not in held


def test_another_class_of_the_same_students_has_other_numbers_and_codes(made, tmp_path):
    folder, plan = begun(tmp_path, STUDENTS)
    with_papers(folder, plan, STUDENTS[:2])
    for one, other in zip(keys(folder).values(), keys(made[0]).values(), strict=False):
        assert one["code"] != other["code"]
        pairs = zip(one["key"]["questions"], other["key"]["questions"], strict=True)
        assert any(left["identity"] != right["identity"] for left, right in pairs)


def test_a_second_run_makes_nothing(copied):
    folder, plan = copied
    before = bytes_of(folder.path)
    report = with_papers(folder, plan, STUDENTS)
    assert (len(report.made), report.kept) == (0, len(IDS))
    assert bytes_of(folder.path) == before


def test_only_what_is_missing_or_changed_is_made_again_and_the_same(copied):
    folder, plan = copied
    before = bytes_of(folder.path)
    (folder.path / "papers/12.pdf").unlink()
    changed = [*STUDENTS[:3], RosterStudent("14", "Renamed"), STUDENTS[4]]
    report = with_papers(folder, plan, changed)
    assert {one.student for one in report.made} == {"12", "14"}
    after = bytes_of(folder.path)
    other = {name for name in before if before[name] != after[name]}
    assert other == {
        "papers/14.pdf",
        "solutions/14.pdf",
        "forms/14.toml",
        "keys.jsonl",
        "roster.csv",
    }
    assert keys(folder)["14"]["code"] == json.loads(before["keys.jsonl"].splitlines()[3])["code"]


def test_who_comes_late_changes_no_other_paper_and_who_leaves_keeps_the_key(copied):
    folder, plan = copied
    before = bytes_of(folder.path)
    students = [STUDENTS[0], RosterStudent("late"), *STUDENTS[2:]]
    report = with_papers(folder, plan, students)
    assert [one.student for one in report.made] == ["late"]
    assert report.left == ("12",)
    after = bytes_of(folder.path)
    assert {
        n: before[n] for n in before if n not in {"keys.jsonl", "roster.csv"}
    }.items() <= after.items()
    assert keys(folder)["12"]["key"]
    assert keys(folder)["late"]["beside"] == ["11", "13"]


def test_an_interrupted_run_goes_on_to_the_same_bytes(made, copied):
    whole, (folder, plan) = bytes_of(made[0].path), copied
    for name in ("papers/13.pdf", "solutions/14.pdf", "forms/14.toml"):
        (folder.path / name).unlink()
    lines = whole["keys.jsonl"].splitlines(keepends=True)
    (folder.path / "keys.jsonl").write_bytes(b"".join(lines[:2]) + lines[2][:500])
    with_papers(folder, plan, STUDENTS)
    assert bytes_of(folder.path) == whole


def test_a_form_with_answers_is_never_written_over(copied):
    folder, plan = copied
    form = folder.path / "forms/12.toml"
    typed = form.read_text(encoding="utf-8").replace('"1" = ""', '"1" = "3 mm"')
    form.write_text(typed, encoding="utf-8")
    (folder.path / "papers/12.pdf").unlink()
    with_papers(folder, plan, STUDENTS)
    assert form.read_text(encoding="utf-8") == typed


def test_another_blueprint_needs_another_folder(copied, tmp_path):
    import msgspec

    folder, plan = copied
    before = bytes_of(folder.path)
    with pytest.raises(ClassError, match="new folder"):
        with_papers(folder, msgspec.structs.replace(plan, source=plan.source + "#"), STUDENTS)
    assert bytes_of(folder.path) == before
    (tmp_path / "other").mkdir()
    (tmp_path / "other/notes.txt").touch()
    with pytest.raises(ClassError, match="something else than a class"):
        assert ClassFolder(tmp_path / "other").is_new


def test_a_code_leads_to_its_student_as_long_as_the_key_is_that_of_the_paper(copied):
    folder, _ = copied
    code = keys(folder)["13"]["code"]
    assert folder.find_by_code(f" {code.lower()} ").head.id == "13"
    with pytest.raises(ClassError, match="no paper of this class"):
        folder.find_by_code("G-0000-0000-0000-0000")
    path = folder.path / "keys.jsonl"
    identity = json.dumps(keys(folder)["13"]["key"]["questions"][0]["identity"])
    path.write_text(path.read_text(encoding="utf-8").replace(identity, '"other"'), encoding="utf-8")
    with pytest.raises(ClassError, match="has been changed"):
        folder.find_by_code(code)


def test_a_paper_is_composed_again_as_it_was_printed_or_not_at_all(made):
    folder, plan, _ = made
    job, code = generation.list_paper_jobs(folder, plan)["11"], keys(folder)["11"]["code"]
    assert generation.compose_paper_again(job, code).code == code
    with pytest.raises(ClassError, match="the paper of 11 is not the one that was made"):
        generation.compose_paper_again(job, keys(folder)["12"]["code"])


def test_for_the_printer_every_paper_begins_on_a_right_hand_page(copied):
    folder, _ = copied
    write_print_file(folder, STUDENTS)
    with pikepdf.open(folder.path / "print.pdf") as whole:
        at = 0
        for one in STUDENTS:
            with pikepdf.open(folder.path / f"papers/{one.file}.pdf") as paper:
                assert at % 2 == 0
                first = whole.pages[at].Contents.read_bytes()
                assert first == paper.pages[0].Contents.read_bytes()
                at += len(paper.pages) + len(paper.pages) % 2
        assert len(whole.pages) == at


FAMILY = """
[title]
en = "One of three"
[[slot]]
templates = ["stored-values-and-bytes", "value-range-and-type", "coordinate-conventions"]
"""


def test_other_templates_of_the_same_kind_are_worth_and_take_as_much(tmp_path):
    """Of eight students some have one template and some another, and a rerun keeps to that."""
    (tmp_path / "one.toml").write_text(FAMILY, "utf-8")
    with (tmp_path / "roster.csv").open("w", encoding="utf-8") as stream:
        stream.writelines(["id\n", *(f"{number}\n" for number in range(8))])
    wished = ("--blueprint", tmp_path / "one.toml", "--out", tmp_path / "class", "--jobs", 1)
    with pytest.MonkeyPatch.context() as same:
        same.setattr(generation, "new_secret", lambda: "5" * 32)
        assert run("class", "make", tmp_path / "roster.csv", *wished, "--vary") == 0
    folder = ClassFolder(tmp_path / "class")
    asked = [one["key"]["questions"][0] for one in keys(folder).values()]
    assert {one["template"] for one in asked} == {
        "stored-values-and-bytes", "coordinate-conventions",  # the third takes two minutes more
    }  # fmt: skip
    assert len({(one["points"], one["topic"], one["tier"]) for one in asked}) == 1
    before = bytes_of(folder.path)
    (folder.path / "papers/3.pdf").unlink()
    for again in ((*wished, "--vary"), wished):
        assert run("class", "make", tmp_path / "roster.csv", *again) == 0
    assert bytes_of(folder.path) == before


def test_a_class_without_other_templates_does_not_get_them_later(tmp_path, capsys):
    (tmp_path / "one.toml").write_text(FAMILY, "utf-8")
    (tmp_path / "roster.csv").write_text("id\n1\n", "utf-8")
    wished = ("--blueprint", tmp_path / "one.toml", "--out", tmp_path / "class", "--jobs", 1)
    assert run("class", "make", tmp_path / "roster.csv", *wished) == 0
    assert run("class", "make", tmp_path / "roster.csv", *wished, "--vary") == 2
    assert "was made without --vary" in capsys.readouterr().err

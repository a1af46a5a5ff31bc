"""From a marked paper to cards of what went wrong, with the real checker on both ends."""

from __future__ import annotations

import json

import pytest
from click.testing import CliRunner

from quizgen.cards.error_deck import deck_from_grades
from quizgen.cli.main import root_group
from quizgen.core.errors import KeyFileError, PaperCodeError
from quizgen.paper.answer_key import write_answer_key
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.grading import grade_paper
from quizgen.paper.paper import build_paper

BLUEPRINT = """
[title]
en = "Two questions"
bn = "দুটি প্রশ্ন"
[[slot]]
templates = ["point-to-image-plane", "image-height-and-fill-distance"]
count = 2
"""


@pytest.fixture(scope="module")
def blueprint(tmp_path_factory):
    path = tmp_path_factory.mktemp("plan") / "two.toml"
    path.write_text(BLUEPRINT, encoding="utf-8")
    return str(path)


@pytest.fixture(scope="module")
def key(bank, blueprint):
    return json.loads(
        write_answer_key(build_paper(bank, load_blueprint(blueprint), 3, "en", figures=False))
    )


def part_of(key, template):
    question = next(q for q in key["questions"] if q["template"] == template)
    return question["parts"][0]


def marked(key, answers, folder):
    path = folder / "result.json"
    table = grade_paper(key, answers, "en").as_json()
    path.write_text(json.dumps(table, ensure_ascii=False), encoding="utf-8")
    return path


def swapped(key):
    """The projection answered with both coordinates exchanged."""
    part = part_of(key, "point-to-image-plane")
    return part["id"], "({}; {})".format(*part["spec"]["traps"]["swapped"])


def text(note, name):
    from quizgen.cards.note import field_names

    return note.fields()[field_names("basic", note.columns).index(name)]


def test_the_mistake_is_on_the_front_and_the_right_way_on_the_back(key, blueprint, bank, tmp_path):
    name, typed = swapped(key)
    path = marked(key, {name: typed}, tmp_path)
    deck = deck_from_grades(path, "both", bank=bank, blueprint=blueprint)
    note = next(note for note in deck.notes if "swapped" in note.key)
    assert note.key == "mistake/A3/-/trap:swapped"
    assert typed.replace("-", "−") in text(note, "Front").replace("-", "−")
    assert "coordinates are exchanged" in text(note, "Back")
    assert "অদলবদল" in text(note, "Back bn")
    right = part_of(key, "point-to-image-plane")["spec"]["values"]
    two = "; ".join(f"{float(value):.2f}" for value in right)
    assert two.replace("-", "−") in text(note, "Back")
    assert "frac" in text(note, "Work")
    assert note.media()


def test_right_answers_give_no_card_and_blank_ones_do(key, blueprint, bank, tmp_path):
    part = part_of(key, "point-to-image-plane")
    right = "({}; {})".format(*part["spec"]["values"])
    deck = deck_from_grades(
        marked(key, {part["id"]: right}, tmp_path), "en", bank=bank, blueprint=blueprint
    )
    assert {note.refs[0] for note in deck.notes} == {"image-height-and-fill-distance"}
    assert all("You left this blank" in text(note, "Front") for note in deck.notes)
    assert len(deck.notes) == len(
        next(q for q in key["questions"] if q["template"] == "image-height-and-fill-distance")[
            "parts"
        ]
    )


def test_an_unreadable_answer_is_not_a_mistake(key, blueprint, bank, tmp_path):
    name, _ = swapped(key)
    deck = deck_from_grades(
        marked(key, {name: "((("}, tmp_path), "en", bank=bank, blueprint=blueprint
    )
    assert not [note for note in deck.notes if note.refs[0] == "point-to-image-plane"]


def test_the_same_mistake_on_two_papers_is_one_note(bank, blueprint, tmp_path):
    guids = set()
    for seed in (3, 4):
        key = json.loads(
            write_answer_key(
                build_paper(bank, load_blueprint(blueprint), seed, "en", figures=False)
            )
        )
        name, typed = swapped(key)
        deck = deck_from_grades(marked(key, {name: typed}, tmp_path), "en", bank=bank,
                          blueprint=blueprint)  # fmt: skip
        assert deck.wish.seed == seed
        guids |= {note.guid for note in deck.notes if "swapped" in note.key}
    assert len(guids) == 1


def test_several_papers_in_one_file(key, blueprint, bank, tmp_path):
    name, typed = swapped(key)
    path = marked(key, {name: typed}, tmp_path)
    table = json.loads(path.read_text("utf-8"))
    path.write_text(json.dumps([table, table]), encoding="utf-8")
    notes = deck_from_grades(path, "en", bank=bank, blueprint=blueprint).notes
    assert len({note.key for note in notes}) == len(notes)


def test_typed_html_stays_text(key, blueprint, bank, tmp_path):
    name, _ = swapped(key)
    path = marked(key, {name: "(1; 2)"}, tmp_path)
    table = json.loads(path.read_text("utf-8"))
    for part in table["parts"]:
        part.update(status="wrong", typed="<script>x</script>", read_as="")
    path.write_text(json.dumps(table), encoding="utf-8")
    for note in deck_from_grades(path, "en", bank=bank, blueprint=blueprint).notes:
        assert "<script>" not in "".join(note.fields())
        assert "&lt;script&gt;" in text(note, "Front")


@pytest.mark.parametrize("content", ["", "{", "[1]", '{"code": 1, "parts": []}', "[" * 5000])
def test_a_bad_file_is_named(content, bank, tmp_path):
    path = tmp_path / "bad.json"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(KeyFileError, match=r"bad\.json"):
        deck_from_grades(path, "en", bank=bank)


def test_a_paper_of_other_templates_is_refused(key, blueprint, bank, tmp_path):
    path = marked(key, {}, tmp_path)
    table = json.loads(path.read_text("utf-8"))
    table["code"] = table["code"][:-6] + "000000"
    path.write_text(json.dumps(table), encoding="utf-8")
    with pytest.raises(PaperCodeError, match="other templates"):
        deck_from_grades(path, "en", bank=bank, blueprint=blueprint)


def test_a_result_of_another_paper_is_refused(key, blueprint, bank, tmp_path):
    path = marked(key, {}, tmp_path)
    table = json.loads(path.read_text("utf-8"))
    table["parts"][0]["question"] = "99"
    path.write_text(json.dumps(table), encoding="utf-8")
    with pytest.raises(KeyFileError, match="not in the paper"):
        deck_from_grades(path, "en", bank=bank, blueprint=blueprint)


def test_the_command(key, blueprint, collection, tmp_path):
    """``check --json`` to ``cards --from-marks`` to Anki."""
    from anki.collection import ImportAnkiPackageOptions, ImportAnkiPackageRequest

    name, typed = swapped(key)
    path = marked(key, {name: typed}, tmp_path)
    result = CliRunner().invoke(
        root_group, ["cards", "--from-marks", str(path), "--blueprint", blueprint, "--out",
                str(tmp_path / "out")]
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    request = ImportAnkiPackageRequest(
        package_path=str(tmp_path / "out" / "quizgen.apkg"), options=ImportAnkiPackageOptions()
    )
    log = collection.import_anki_package(request).log
    assert len(log.new) == 4
    assert not collection.media.check().missing
    assert collection.find_cards("tag:quizgen::kind::mistake")

"""Each kind of file that is read: a mutant of it, and everything that is done with such a file."""

from __future__ import annotations

import csv
import io
import json
import random
import tomllib
from collections.abc import Callable
from functools import cache
from pathlib import Path

from values import as_json, bent, damaged, huge, mutated, toml

from quizgen.bank import sampler as planning
from quizgen.bank.bank import Bank, builtin_bank
from quizgen.bank.entries import load_entries, localised_fields
from quizgen.camera import PreparedScene, plan_budget
from quizgen.camera.question_photo import take_question_photo
from quizgen.camera.scene_file import load_scene
from quizgen.camera.simulation import run_plan
from quizgen.cards.content import KINDS as CARDS
from quizgen.cards.error_deck import deck_from_grades
from quizgen.figures.svg import encode_png
from quizgen.paper.answer_form import read_filled_form
from quizgen.paper.answer_key import read_answer_key, write_answer_key
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.grade_report import format_table, write_class_csv
from quizgen.paper.grading import grade_paper
from quizgen.paper.paper import build_paper, single_question_paper
from quizgen.paper.selection import count_papers, select_templates
from quizgen.question.entry_prose import entry_blocks
from quizgen.render import render_paper
from quizgen.render.text import format_question

SCENES = Path(planning.__file__).parents[1] / "camera" / "scenes"
SMALL = 200_000
"""Pixels of a scene that is photographed, not only planned."""

Chance = random.Random


def a_bank(folder: Path, name: str) -> Path:
    """A bank of one template without solvers of its own; returns the template's folder."""
    source = builtin_bank().template_paths[name]
    target = folder / "templates" / source.parent.name / name
    target.mkdir(parents=True, exist_ok=True)
    for file in source.iterdir():
        (target / file.name).write_bytes(file.read_bytes())
    return target


def use_bank(folder: Path, name: str, chance: Chance) -> None:
    """List, draw, print and mark what a bank holds."""
    planning._PLANS.clear()
    bank = Bank(folder)
    for lang in bank.languages:
        bank.title(lang)
    template = bank.template(name)
    lang = chance.choice(template.languages)
    paper = single_question_paper(
        template, chance.randrange(100), lang, figures=chance.random() < 0.1
    )
    write_answer_key(paper)
    format_question(paper.items[0])
    if chance.random() < 0.2:
        render_paper(paper, "solutions", "html")


def template(folder: Path, chance: Chance) -> None:
    name = chance.choice(list(builtin_bank().template_paths))
    file = a_bank(folder, name) / "template.toml"
    table = tomllib.loads(file.read_text("utf-8"))
    if chance.random() < 0.1:
        file.write_bytes(damaged(file.read_bytes(), chance))
    else:
        file.write_text(toml(mutated(table, chance)), "utf-8")
    use_bank(folder, name, chance)


def prose(folder: Path, chance: Chance) -> None:
    name = chance.choice(list(builtin_bank().template_paths))
    file = a_bank(folder, name) / f"{chance.choice(('en', 'bn'))}.md"
    file.write_text(bent(file.read_text("utf-8"), chance), "utf-8", errors="replace")
    use_bank(folder, name, chance)


def bank(folder: Path, chance: Chance) -> None:
    a_bank(folder, "point-to-image-plane")
    file = chance.choice(("bank.toml", "curriculum.toml"))
    table = tomllib.loads((builtin_bank().folder / file).read_text("utf-8"))
    (folder / "templates" / file).write_text(toml(mutated(table, chance)), "utf-8")
    found = Bank(folder)
    assert found.curriculum.inventory is not None
    use_bank(folder, "point-to-image-plane", chance)


def cards(folder: Path, chance: Chance) -> None:
    name = chance.choice(list(CARDS))
    table = tomllib.loads(builtin_bank().cards[name].read_text("utf-8"))
    few = {"entry": chance.sample(table["entry"], 3)}
    file = folder / f"{name}.toml"
    entries = load_entries(toml(mutated(few, chance)), CARDS[name], str(file))
    for entry in entries:
        for field in localised_fields(type(entry)):
            entry_blocks(entry, field, "en")


def blueprint(folder: Path, chance: Chance) -> None:
    source = chance.choice(list(builtin_bank().blueprints.values()))
    file = folder / "paper.toml"
    file.write_text(toml(mutated(tomllib.loads(source.read_text("utf-8")), chance)), "utf-8")
    found = load_blueprint(str(file))
    chosen = select_templates(builtin_bank(), found, chance.randrange(100))
    count_papers(builtin_bank(), found)
    if len(chosen) <= 2:
        build_paper(builtin_bank(), found, 1, figures=False)


def scene(folder: Path, chance: Chance) -> None:
    source = chance.choice(sorted(SCENES.glob("*.toml")))
    file = folder / "scene.toml"
    table = tomllib.loads(source.read_text("utf-8"))
    table.setdefault("scene", {}).update(width=80, height=60)
    file.write_text(toml(mutated(table, chance)), "utf-8")
    given, camera = load_scene(file)
    if given.width * given.height <= SMALL:
        prepared = PreparedScene(given, camera)
        run_plan(prepared, plan_budget(prepared).names)
        if given.question:
            take_question_photo(given, camera)


@cache
def a_picture() -> bytes:
    import numpy as np

    return encode_png(np.arange(12 * 16 * 3, dtype=np.uint8).reshape(12, 16, 3))


def png(folder: Path, chance: Chance) -> None:
    data = bytearray(damaged(a_picture(), chance))
    if chance.random() < 0.3 and len(data) > 24:
        data[chance.randrange(16, 24)] = chance.randrange(256)
    (folder / "picture.png").write_bytes(data)
    file = folder / "scene.toml"
    file.write_text('[scene]\nimage = "picture.png"\n', "utf-8")
    load_scene(file)


@cache
def keys() -> tuple[dict, ...]:
    """Keys of papers of all topics."""
    built = (
        build_paper(builtin_bank(), load_blueprint(f"{topic}.20"), 3, "en", figures=False)
        for topic in builtin_bank().topics
    )
    return tuple(json.loads(write_answer_key(paper)) for paper in built)


def use_answers(folder: Path, key: Path, form: Path) -> None:
    answers = read_filled_form(form)
    result = grade_paper(
        read_answer_key(key), answers.list_typed_texts(), decimal=answers.student.decimal
    )
    list(format_table(result, "en", 80, paint=False))
    write_class_csv([(str(form), str(answers.student.name), "", result)])
    json.dumps(result.as_json()).encode()


def form_of(table: dict) -> dict:
    """A form with a right answer in each part."""
    from quizgen.kinds.grade import show_key

    typed = {p["id"]: show_key(p["spec"]) for q in table["questions"] for p in q["parts"]}
    return {
        "code": table["code"],
        "student": {"name": "Rahim", "lang": "en", "decimal": "point"},
        "answers": typed,
    }


def key(folder: Path, chance: Chance) -> None:
    table = chance.choice(keys())
    chosen = {**table, "questions": [chance.choice(table["questions"])]}
    (folder / "key.json").write_text(as_json(mutated(chosen, chance)), "utf-8")
    (folder / "answers.toml").write_text(toml(form_of(chosen)), "utf-8")
    use_answers(folder, folder / "key.json", folder / "answers.toml")


def rows(form: dict) -> str:
    """A form as a spreadsheet saves it."""
    out = io.StringIO()
    filled = form.get("answers")
    pairs = filled.items() if isinstance(filled, dict) else [("1", filled)]
    shown = ((part, "1" * 6000 if huge([v]) else v) for part, v in pairs)
    csv.writer(out, delimiter=";").writerows([("part", "answer"), *shown])
    return out.getvalue()


FORMS = {"answers.toml": toml, "answers.json": as_json, "answers.csv": rows}


def answers(folder: Path, chance: Chance) -> None:
    table = chance.choice(keys())
    question = chance.choice(table["questions"])
    form = form_of({**table, "questions": [question]})
    (folder / "key.json").write_text(as_json({**table, "questions": [question]}), "utf-8")
    file, write = chance.choice(tuple(FORMS.items()))
    data = write(mutated(form, chance)).encode("utf-8", "replace")
    (folder / file).write_bytes(damaged(data, chance) if chance.random() < 0.2 else data)
    use_answers(folder, folder / "key.json", folder / file)


@cache
def a_result() -> dict:
    paper = build_paper(builtin_bank(), load_blueprint("projection.5"), 3, "en", figures=False)
    table = json.loads(write_answer_key(paper))
    wrong = {p["id"]: "1" for q in table["questions"] for p in q["parts"]}
    return grade_paper(table, wrong).as_json()


def marks(folder: Path, chance: Chance) -> None:
    file = folder / "marks.json"
    file.write_text(as_json(mutated(a_result(), chance)), "utf-8")
    deck_from_grades(file, "en", bank=builtin_bank())


KINDS: dict[str, tuple[int, Callable[[Path, Chance], None]]] = {
    "template": (30, template), "prose": (10, prose), "bank": (5, bank), "cards": (5, cards),
    "blueprint": (10, blueprint), "scene": (8, scene), "png": (7, png), "key": (12, key),
    "answers": (10, answers), "marks": (3, marks),
}  # fmt: skip
"""Name to its share in a hundred mutants, and what makes one and uses it."""

"""Every command that takes a file, sound files for it, and what it says of damaged ones."""

from __future__ import annotations

import contextlib
import io
import json
import os
import random
import re
import resource
import shutil
import signal
import sys
import tempfile
import tomllib
import traceback
import zipfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache, partial
from importlib import import_module
from pathlib import Path
from typing import NoReturn
from unittest import mock

from file_damage import damage_file
from values import toml

from quizgen import camera
from quizgen.classes import generation
from quizgen.cli.main import main
from quizgen.core import cache
from quizgen.figures.svg import encode_png
from quizgen.kinds.grade import show_key
from quizgen.store import Store

LONGEST, LARGEST = 5.0, 1000
"""CPU seconds and MB that one mutant may take."""
HANGS = 20
"""CPU seconds after which a mutant is stopped."""
BIGGEST = 4 << 30
"""Bytes of addresses that a command may have: a machine is not to be brought down."""
SENTENCE = 3000
"""Characters of the longest message: more is no sentence but a file."""
MOODLE = Path(__file__).parents[1] / "lms" / "moodle"
SCENES = Path(camera.__file__).parent / "scenes"


@dataclass(frozen=True)
class FileCommand:
    """A command, the base folder that it is run in, and the files of it that are damaged.

    ``{}`` in the arguments is the folder. ``typed`` is the file of the standard input, or text.
    """

    name: str
    base: str
    files: tuple[str, ...]
    arguments: str
    typed: str = ""
    share: int = 4


EXAM = "exam --blueprint {}/short.toml --seed 1 --format html --out {}/made"
FORM = "exam --blueprint {}/kinds.toml --seed 1 --lang en --format html --out {}/exam"
MAKE = "class make {}/roster.csv --blueprint {}/short.toml --jobs 1 --out {}/class"
BANK = "--bank {}/bank --trust"
BANK_FILES = (
    "bank/templates/bank.toml", "bank/templates/curriculum.toml",
    "bank/templates/example/*/template.toml", "bank/templates/example/*/*.md",
    "bank/templates/cards/*.toml", "bank/templates/locale/fr/*.toml",
    "bank/templates/blueprints/*.toml", "bank/templates/quantities/*.toml", "bank/solvers/*/*.py",
)  # fmt: skip
RULES = ("bank/templates/bank.toml", "bank/templates/example/*/template.toml")
WORDS = ("bank/templates/example/*/*.md", "bank/templates/locale/fr/*.toml")
CARDS = ("bank/templates/cards/*.toml",)
CLASS = ("class/class.toml", "class/keys.jsonl", "class/roster.csv")
MARKED = (*CLASS, "class/rulings.csv", "class/marks/*.jsonl")

COMMANDS = [
    FileCommand("exam --blueprint", "paper", ("short.toml",), EXAM),
    FileCommand("exam again", "paper", ("exam/key.json", "exam/answers.*"), FORM),
    FileCommand("exam --bank", "bank", BANK_FILES,
                f"exam {BANK} --lang fr --seed 1 --format html --out {{}}/made", share=8),
    FileCommand("exam --code", "bank", ("exam/key.json", "bank/templates/bank.toml"),
                f"exam {BANK} --code CODE --format html --out {{}}/exam", share=2),
    FileCommand("check toml", "paper", ("exam/key.json", "exam/answers.toml", "exam/exam.html"),
                "check {}/exam/key.json {}/exam/answers.toml", share=8),
    FileCommand("check json", "paper", ("exam/key.json", "exam/answers.json"),
                "check {}/exam/key.json {}/exam/answers.json --json", share=8),
    FileCommand("check csv", "paper", ("exam/key.json", "exam/answers.csv"),
                "check {}/exam/key.json {}/exam/answers.csv --csv", share=8),
    FileCommand("check --bank", "bank", ("exam/key.json", "bank/templates/bank.toml"),
                "check {}/exam/key.json {}/exam/answers.toml --bank {}/bank", share=2),
    FileCommand("check responses.csv", "quiz", ("moodle.keys.jsonl", "responses.csv"),
                "check {}/moodle.keys.jsonl {}/responses.csv"),
    FileCommand("check responses.json", "quiz", ("moodle.keys.jsonl", "responses.json"),
                "check {}/moodle.keys.jsonl {}/responses.json --csv"),
    FileCommand("check reports of QTI", "quiz", ("qti.zip.keys.jsonl", "reports/*.xml"),
                "check {}/qti.zip.keys.jsonl {}/reports/1.xml {}/reports/2.xml --json"),
    FileCommand("check an archive", "quiz", ("reports.zip",),
                "check {}/qti.zip.keys.jsonl {}/reports.zip"),
    FileCommand("class make", "class", ("roster.csv", "short.toml"),
                MAKE.replace("/class", "/made"), share=3),
    FileCommand("class make again", "class", (*CLASS, "class/forms/*", "roster.csv"),
                MAKE, share=3),
    FileCommand("class make --one-file", "class", ("class/papers/*.pdf",), f"{MAKE} --one-file",
                share=2),
    FileCommand("class code", "class", CLASS, "class code {}/class CODE", share=2),
    FileCommand("class take", "quiz", ("moodle.keys.jsonl", "responses.*"),
                "class take {}/moodle.keys.jsonl {}/responses.csv --out {}/made", share=3),
    FileCommand("class take again", "quiz", tuple(f"quiz/{one}" for one in (
                "class.toml", "keys.jsonl", "roster.csv", "answers/*")),
                "class take {}/moodle.keys.jsonl {}/responses.json --out {}/quiz", share=3),
    FileCommand("class mark", "class", (*MARKED, "class/answers/*", "class/decisions.csv"),
                "class mark {}/class", share=8),
    FileCommand("class mark a quiz", "quiz", tuple(f"quiz/{one}" for one in (
                "class.toml", "keys.jsonl", "roster.csv", "answers/*")),
                "class mark {}/quiz"),
    FileCommand("class mark FILES", "class", ("inbox/*",),
                "class mark {}/class {}/inbox/1.toml {}/inbox/2.json {}/inbox/3.csv"),
    FileCommand("class scan", "class", (*CLASS, "class/sheets/103.pdf", "class/scans/pages.jsonl",
                "class/scans/typed.csv", "page.jpg", "stack.pdf", "typed.csv"),
                "class scan {}/class {}/page.jpg {}/stack.pdf {}/typed.csv --jobs 1", share=6),
    FileCommand("class rule", "class", MARKED, "class rule {}/class drop ITEM", share=2),
    FileCommand("class lists", "class", CLASS, "class lists {}/class", share=2),
    FileCommand("class table", "class", CLASS, "class table {}/class {}/answers.xlsx", share=2),
    FileCommand("class points", "class", (*MARKED, "points.csv"),
                "class points {}/class {}/points.csv", share=2),
    FileCommand("class object", "class", MARKED, "class object {}/class", share=2),
    FileCommand("class inspect", "class", MARKED, "class inspect {}/class 101", share=2),
    FileCommand("class status", "class", MARKED, "class status {}/class 101 sick", share=2),
    FileCommand("class forget", "class", MARKED, "class forget {}/class --yes", share=2),
    FileCommand("class history", "class", MARKED, "class history {}/class 101", share=2),
    FileCommand("class grade", "class", (*MARKED, "class/scale.toml", "class/scale.toml"),
                "class grade {}/class --reports html", share=4),
    FileCommand("class analyse", "class", MARKED, "class analyse {}/class", share=3),
    FileCommand("mark --batch", "paper", ("lines.jsonl",), "mark --batch", "lines.jsonl", 8),
    FileCommand("cards --from-marks", "paper", ("marks.json", "kinds.toml"),
                "cards --from-marks {}/marks.json --blueprint {}/kinds.toml --out {}/made"),
    FileCommand("cards --bank", "bank", (*CARDS, *RULES, *WORDS),
                f"cards {BANK} --lang fr --jobs 1 --format tsv,csv --out {{}}/made"),
    FileCommand("sheet --bank", "bank", (*CARDS, "bank/templates/quantities/*.toml"),
                f"sheet {BANK} --format html --out {{}}/made", share=2),
    FileCommand("templates --bank", "bank", (*RULES, *WORDS, "bank/templates/curriculum.toml"),
                f"templates {BANK}", share=2),
    FileCommand("templates --coverage", "bank", (*RULES, "bank/templates/curriculum.toml"),
                f"templates {BANK} --coverage", share=2),
    FileCommand("preview --bank", "bank", (*RULES, *WORDS, "bank/solvers/*/*.py"),
                f"preview travel-time {BANK} --lang fr"),
    FileCommand("banks --bank", "bank", RULES, f"banks {BANK}", share=1),
    FileCommand("export --bank", "bank", (*RULES, *WORDS),
                f"export moodle {BANK} --topic example --variants 1 --out {{}}/made.xml", share=3),
    FileCommand("lint", "bank", BANK_FILES, "lint {}/bank --trust --seeds 2 --jobs 1 --limit 20",
                share=12),
    FileCommand("lint --teach", "bank", RULES, "lint {}/bank --trust --teach --seeds 60 --jobs 1",
                share=2),
    FileCommand("lint --papers", "bank", (*RULES, "bank/templates/blueprints/*.toml"),
                "lint {}/bank --trust --papers 1 --jobs 1", share=2),
    FileCommand("new template --bank", "bank", RULES,
                "new template example/more --bank {}/bank", share=2),
    FileCommand("new language --bank", "bank", RULES, "new language it --bank {}/bank", share=1),
    FileCommand("practice", "bank", ("config/quizgen/practice/*.json", "learning.sqlite3", *RULES),
                f"practice {BANK} --count 2 --seed x --database sqlite:///{{}}/learning.sqlite3",
                "42\n?\n!\nquit\n"),
    FileCommand("simulate", "scene", ("scene.toml",), "simulate {}/scene.toml --json", share=4),
    FileCommand("simulate --compare", "scene", ("photo.toml", "picture.png"),
                "simulate {}/photo.toml --out {}/made.png --compare {}/made.html", share=3),
    FileCommand("serve --backup", "bank", ("learning.sqlite3",),
                "serve --backup {}/copy.sqlite3 --database sqlite:///{}/learning.sqlite3", share=2),
]  # fmt: skip

SHORT = """
total = 12
minutes = [8, 20]
[title]
en = "A short test"
bn = "ছোট পরীক্ষা"
[[slot]]
templates = ["normalise-from-8-bit-range"]
[[slot]]
templates = ["exposure-equivalence"]
[[slot]]
templates = ["blur-and-light-factors"]
"""
KINDS = """
[title]
en = "A question with each kind of answer"
""" + "".join(
    f'[[slot]]\ntemplates = ["{name}"]\n'
    for name in (
        "rgb-to-hsv",
        "add-noise-to-uint8-order",
        "gaussian-2d-formula-and-shapes",
        "mixing-kind-and-primaries",
        "opencv-image-in-matplotlib",
        "salt-and-pepper-thresholds",
        "draw-distortion-to-scale",
        "diameter-stops-and-exposure-time",
        "blur-and-light-factors",
        "hsv-nonlinearity-counterexample",
        "exposure-equivalence",
    )
)
CURRICULUM = """
beyond = ["X"]
[groups]
all = ["F1..F3"]
"""
TERMS = """
[[entry]]
id = "speed"
number = 1
topic = "example"
tier = "A"
section = "1"
group = "all"
term = { en = "Speed", fr = "Vitesse" }
meaning.en = "Way by time."
meaning.fr = "Le chemin par le temps."
[[entry]]
id = "way"
number = 2
topic = "example"
tier = "A"
section = "1"
group = "all"
term = { en = "Way", fr = "Chemin" }
meaning.en = "Speed times time."
meaning.fr = "La vitesse par le temps."
"""
FORMULAS = """
[[entry]]
id = "F1"
topic = "example"
tier = "A"
section = "1"
title = { en = "Time of travel", fr = "Temps" }
lines = ["t = s/v"]
about = { en = "$s$: way; $v$: speed.", fr = "$s$ : chemin ; $v$ : vitesse." }
units = { m = ["s"], "m/s" = ["v"], s = ["t"] }
beware = { en = "Mind the units.", fr = "Attention aux unités." }
holds = { en = "Constant speed.", fr = "Vitesse constante." }
limits = { en = "Never at rest.", fr = "Jamais au repos." }
"""
PAPER = """
[title]
en = "All"
fr = "Tout"
[[slot]]
templates = ["travel-time", "my-solver"]
[[slot]]
templates = ["my-choice"]
[[slot]]
templates = ["my-match"]
"""
QUANTITIES = """
["example/travel_time".names]
s = { en = "the way", fr = "le chemin" }
v = { en = "the speed", fr = "la vitesse" }
t = { en = "the time", fr = "le temps" }
"""
PHOTO = """
[scene]
title = "A picture"
image = "picture.png"
[camera]
focal_length = "8 mm"
pixel_pitch = "14 um"
k1 = -0.25
"""
REPORT = """<?xml version="1.0" encoding="UTF-8"?>
<assessmentResult xmlns="http://www.imsglobal.org/xsd/imsqti_result_v2p1">
<context sourcedId="{}"/>{}</assessmentResult>"""
"""A result report of QTI, as the specification shows one."""


@dataclass
class RunResult:
    """What a shell would see of a command, and what it took: CPU seconds and MB."""

    code: int
    out: str
    err: str
    seconds: float
    megabytes: int


def run_command(arguments: Iterable[str], folder: Path, typed: bytes = b"") -> RunResult:
    """Return what a command comes to, run in a folder that also holds settings and data.

    Its cache is beside the folder. It runs in a fork of this process: nothing of it is left in this one, its memory and time are
    its own, and what this process has imported need not be loaded again.
    """
    files = [folder / f".{name}" for name in ("typed", "out", "err", "loaded")]
    for file, data in zip(files, (typed, b"", b"", b""), strict=True):
        file.write_bytes(data)
    sys.stdout.flush()
    child = os.fork()
    if not child:
        _become_command([*arguments], folder, files)
    _, status, used = os.wait4(child, 0)
    out, err, loaded = (file.read_text("utf-8", "replace") for file in files[1:])
    for name in loaded.split():
        with contextlib.suppress(ImportError):
            import_module(name)
    for file in files:
        file.unlink()
    code = os.waitstatus_to_exitcode(status)
    return RunResult(code, out, err, used.ru_utime + used.ru_stime, used.ru_maxrss // 1024)


def _become_command(arguments: list[str], folder: Path, files: list[Path]) -> NoReturn:
    """Run a command as a shell starts it, and end; also write down what it imported."""
    code, before = 70, {*sys.modules}
    try:
        for number, file in enumerate(files[:3]):
            os.dup2(os.open(file, os.O_RDONLY if number == 0 else os.O_WRONLY), number)
        streams = (os.fdopen(n, "rw"[n > 0], encoding="utf-8") for n in range(3))
        sys.stdin, sys.stdout, sys.stderr = streams
        own = {
            "CONFIG": folder / "config",
            "DATA": folder / "data",
            "CACHE": folder.parent / "cache",
        }
        os.environ |= {f"XDG_{name}_HOME": str(place) for name, place in own.items()}
        cache.user_cache_folder.cache_clear()
        os.chdir(folder)
        resource.setrlimit(resource.RLIMIT_CPU, (HANGS, HANGS + 5))
        resource.setrlimit(resource.RLIMIT_AS, (BIGGEST, BIGGEST))
        signal.signal(signal.SIGINT, signal.default_int_handler)
        code = _run_main(arguments)
        sys.stdout.flush()
        sys.stderr.flush()
        named = (one for one in {*sys.modules} - before if not one.startswith(("_", "sys")))
        files[3].write_text("\n".join(named), "utf-8")
    finally:
        os._exit(code)


def _run_main(arguments: list[str]) -> int:
    """Return the exit code of the command, which Python would end with."""
    try:
        main(arguments)
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else 1
    except BaseException:  # noqa: BLE001 - Python prints whatever it is
        traceback.print_exc()
        return 1
    return 0


def sound(arguments: str, folder: Path, **words: str) -> RunResult:
    """Run a command that is to succeed; ``{}`` is the folder."""
    split = [one.format(folder) for one in arguments.split()]
    done = run_command([words.get(one, one) for one in split], folder)
    assert done.code == 0, (arguments, done)
    return done


def write(folder: Path, contents: dict[str, str | bytes]) -> None:
    """Write texts and bytes into files of a folder."""
    for name, data in contents.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data.encode() if isinstance(data, str) else data)


def right_answers(key: dict) -> dict[str, str]:
    """Return an answer to each part: right ones, and one that is not."""
    parts = [part for question in key["questions"] for part in question["parts"]]
    typed = {part["id"]: show_key(part["spec"]) for part in parts}
    return {**typed, parts[0]["id"]: "1"}


def as_form(key: dict, number: str) -> dict[str, object]:
    """Return a filled form as a table."""
    return {"code": key["code"], "student": {"name": "Rahim", "matriculation": number,
            "lang": "en", "decimal": "point"}, "answers": right_answers(key)}  # fmt: skip


def as_toml(form: dict) -> str:
    """Return a filled form in TOML, as an editor saves it."""
    quoted = partial(json.dumps, ensure_ascii=False)
    tables = [f"code = {quoted(form['code'])}"]
    for name in ("student", "answers"):
        tables += [f"\n[{name}]", *(f"{quoted(k)} = {quoted(v)}" for k, v in form[name].items())]
    return "\n".join(tables) + "\n"


def as_rows(form: dict) -> str:
    """Return a filled form in CSV, as a spreadsheet saves it."""
    quoted = ('"{}";"{}"'.format(k, v.replace('"', '""')) for k, v in form["answers"].items())
    return "\n".join(["part;answer", f"code;{form['code']}", *quoted]) + "\n"


def make_paper(folder: Path) -> None:
    """Make a paper, filled forms in all three formats, its marks, and a batch of answers."""
    write(folder, {"short.toml": SHORT, "kinds.toml": KINDS})
    sound(FORM, folder)
    key = json.loads((folder / "exam/key.json").read_text("utf-8"))
    form = as_form(key, "1")
    forms = {".toml": as_toml(form), ".json": json.dumps(form), ".csv": as_rows(form)}
    write(folder, {f"exam/answers{ending}": text for ending, text in forms.items()})
    marks = sound("check {}/exam/key.json {}/exam/answers.toml --json", folder).out
    lines = [
        json.dumps({"spec": part["spec"], "typed": show_key(part["spec"]), "lang": lang})
        for question in key["questions"] for part in question["parts"] for lang in ("en", "bn")
    ]  # fmt: skip
    write(folder, {"marks.json": marks, "lines.jsonl": "\n".join(lines)})


def make_bank(folder: Path) -> None:
    """Make a bank of every kind of file, a paper of it, and a database and a session of practice."""
    sound("new bank {}/bank --lang en --lang fr", folder)
    for kind in ("solver", "choice", "claims", "match", "order", "gap"):
        sound(f"new template example/my-{kind} --{kind} --bank {{}}/bank", folder)
    sound("new language fr --bank {}/bank --all", folder)
    write(folder / "bank/templates", {
        "curriculum.toml": CURRICULUM, "cards/vocabulary.toml": TERMS,
        "cards/formulas.toml": FORMULAS, "blueprints/mock.toml": PAPER,
        "quantities/example.toml": QUANTITIES,
    })  # fmt: skip
    sound(f"exam {BANK} --seed 1 --format html --out {{}}/exam", folder)
    form = as_form(json.loads((folder / "exam/key.json").read_text("utf-8")), "1")
    write(folder, {"exam/answers.toml": as_toml(form)})
    place = f"sqlite:///{folder}/learning.sqlite3"
    done = run_command(
        [*f"practice --bank {folder}/bank --trust --count 2 --seed x --database {place}".split()],
        folder, b"42\n!\n1\nquit\n",
    )  # fmt: skip
    assert done.code == 0, done
    assert [*folder.glob("config/quizgen/practice/*.json")], done
    store = Store(place)
    store.sittings.begin(store.learner().id, "mock-1-en-0a1b2c", None, pauses=True)
    store.close()


def make_quiz(folder: Path) -> None:
    """Make a quiz that Moodle played, a class of it, and one that a player of QTI played."""
    write(folder, {
        "moodle.keys.jsonl": (MOODLE / "quiz.keys.jsonl").read_bytes(),
        "responses.csv": (MOODLE / "responses.csv").read_bytes(),
        "responses.json": (MOODLE / "responses.json").read_bytes(),
    })  # fmt: skip
    sound("class take {}/moodle.keys.jsonl {}/responses.csv --out {}/quiz", folder)
    sound("export qti21 --template uint8-product,red-of-bgr-pixel,demosaic-at-border "
          "--variants 1 --out {}/qti.zip", folder)  # fmt: skip
    lines = (folder / "qti.zip.keys.jsonl").read_text("utf-8").splitlines()[1:]
    asked = [entry for line in lines for entry in json.loads(line)["entries"]]
    for who in ("1", "2"):
        items = "".join(map(report_item, asked))
        write(folder, {f"reports/{who}.xml": REPORT.format(f"s{who}", items)})
    with zipfile.ZipFile(folder / "reports.zip", "w") as archive:
        for who in ("1", "2"):
            archive.write(folder / f"reports/{who}.xml", f"{who}.xml")


def report_item(entry: dict) -> str:
    """Return the result of an item whose fields hold their first option, or 1."""
    fields = "".join(
        f'<responseVariable identifier="{one["name"]}"><candidateResponse><value>'
        f"{one['name'].replace('RESPONSE', 'C', 1) + '_A' if one.get('options') else '1'}"
        "</value></candidateResponse></responseVariable>"
        for one in entry["asks"]
    )
    return f'<itemResult identifier="{entry["id"]}" sessionStatus="final">{fields}</itemResult>'


def make_class(folder: Path) -> None:
    """Make a class of three that was marked, with decisions, rulings and a scale."""
    roster = "id;name;lang;extra\n101;Ada;en;25%\n102;রহিমা;bn;\n103;Cem;en;10\n"
    write(folder, {"short.toml": SHORT, "roster.csv": roster})
    with mock.patch.object(generation, "new_secret", return_value="5" * 32):
        sound(f"{MAKE} --sheet", folder)
    lines = map(json.loads, (folder / "class/keys.jsonl").read_text("utf-8").splitlines())
    forms = [as_form({**one["key"], "code": one["code"]}, one["id"]) for one in lines]
    write(folder, {
        "class/answers/1.toml": as_toml(forms[0]), "class/answers/2.json": json.dumps(forms[1]),
        "class/answers/3.csv": as_table(forms[2]),
    })  # fmt: skip
    sound("class mark {}/class", folder)
    decisions = folder / "class/decisions.csv"
    assert decisions.read_text("utf-8-sig").count("\n") > 1
    write(folder, {
        "class/scale.toml": 'passed = 45\nbest = 90\ngrades = ["1.0", "2.0", "4.0"]\nfail = "5.0"\n',
        "inbox/1.toml": as_toml(forms[0]), "inbox/2.json": json.dumps(forms[1]),
        "inbox/3.csv": as_table(forms[2]), "points.csv": "id,1a\n101,0\n",
    })  # fmt: skip
    sound("class rule {}/class accept ITEM --answer 1 --value 0.5 --who me", folder, ITEM=ITEM)
    sound("class grade {}/class --reports none", folder)
    write(folder, {"typed.csv": "id,part,answer\n101,1a,0.5\n102,2a,1\n"})
    sheets = [folder / f"class/sheets/{student}.pdf" for student in (102, 103)]
    write(folder, {"page.jpg": photograph(sheets[0]), "stack.pdf": sheets[1].read_bytes()})
    sound("class scan {}/class {}/page.jpg {}/typed.csv --jobs 1", folder)
    (folder / "class/answers/scan.csv").unlink()


def photograph(sheet: Path) -> bytes:
    """Return the first page of a PDF file as JPEG."""
    import pypdfium2

    out = io.BytesIO()
    with pypdfium2.PdfDocument(sheet) as document:
        document[0].render(scale=2, grayscale=True).to_pil().save(out, "JPEG")
    return out.getvalue()


ITEM = "normalise-from-8-bit-range/a"


def as_table(form: dict) -> str:
    """Return a table with a row for a student, as a spreadsheet saves it."""
    cells = {"id": form["student"]["matriculation"], **form["answers"]}
    rows = ('"' + '","'.join(one.replace('"', '""') for one in row) + '"'
            for row in (cells, cells.values()))  # fmt: skip
    return "\n".join(rows) + "\n"


def make_scene(folder: Path) -> None:
    """Make a small scene of the camera with a question, and one of a picture."""
    import numpy as np

    scene = tomllib.loads((SCENES / "portrait.toml").read_text("utf-8"))
    scene["scene"].update(width=160, height=120)
    picture = np.arange(12 * 16 * 3, dtype=np.uint8).reshape(12, 16, 3)
    write(folder, {
        "scene.toml": toml(scene), "photo.toml": PHOTO, "picture.png": encode_png(picture),
    })  # fmt: skip


BASES = {"paper": make_paper, "bank": make_bank, "quiz": make_quiz, "class": make_class,
         "scene": make_scene}  # fmt: skip


@dataclass
class Mutant:
    """What a command came to with one damaged file."""

    command: FileCommand
    number: int
    file: str
    result: RunResult
    failures: list[str]


class Workshop:
    """Sound files, made once by the commands themselves, and commands run on damaged copies."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.words: dict[str, dict[str, str]] = {}
        self.accepted: set[str] = set()

    def base(self, name: str) -> Path:
        """Return the folder of sound files, which is made when first asked for."""
        folder = self.folder / name
        if not folder.exists():
            folder.mkdir(parents=True)
            BASES[name](folder)
            self.words[name] = read_codes(folder)
        return folder

    def run(self, command: FileCommand, folder: Path) -> RunResult:
        """Return what a command comes to in a copy of its base."""
        words = {"ITEM": ITEM, **self.words[command.base]}
        arguments = [words.get(one, one.replace("{}", str(folder)))
                     for one in command.arguments.split()]  # fmt: skip
        typed = command.typed.encode()
        if (folder / command.typed.partition("\n")[0]).is_file():
            typed = (folder / command.typed).read_bytes()
        return run_command(arguments, folder, typed)

    @contextlib.contextmanager
    def copy(self, command: FileCommand) -> Iterator[Path]:
        """Give a copy of a command's base, for a ``with`` block."""
        base = self.base(command.base)
        folder = Path(tempfile.mkdtemp(prefix="hostile-", dir=self.folder))
        try:
            shutil.copytree(base, folder, dirs_exist_ok=True)
            yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def accept(self, command: FileCommand) -> None:
        """Check that a command takes its files as they are."""
        if command.name not in self.accepted:
            with self.copy(command) as folder:
                files = [len([*folder.glob(one)]) for one in command.files]
                assert all(files), f"{command.name}: no such files: {command.files} {files}"
                done = self.run(command, folder)
            assert done.code == 0, (command.name, done)
            self.accepted.add(command.name)

    def try_mutant(self, command: FileCommand, number: int) -> Mutant:
        """Return what a command comes to with one of its files damaged."""
        self.accept(command)
        chance = random.Random(f"{command.name} {number}")
        with self.copy(command) as folder:
            file = chance.choice(sorted(folder.glob(chance.choice(command.files))))
            damage_file(file, chance)
            done = self.run(command, folder)
            name = str(file.relative_to(folder))
            failures = [*find_failures(command, done, folder, name)]
        return Mutant(command, number, name, done, failures)


def read_codes(folder: Path) -> dict[str, str]:
    """Return the code of the paper, or of a paper of the class, in a folder."""
    for file in ("exam/key.json", "class/keys.jsonl"):
        if (folder / file).exists():
            line = (folder / file).read_text("utf-8")
            text = line.splitlines()[0] if file.endswith("l") else line
            return {"CODE": json.loads(text)["code"]}
    return {}


def describe_traceback(err: str) -> str:
    """Return the error of a traceback and the last line of quizgen in it."""
    places = re.findall(r'File ".*/quizgen/(.*)", line (\d+)', err)
    last = ":".join(places[-1]) if places else "?"
    return f"{err.strip().splitlines()[-1][:120]} at {last}"


def find_failures(
    command: FileCommand, done: RunResult, folder: Path, damaged: str
) -> Iterator[str]:
    """Yield what a user must never see."""
    if done.code not in {0, 1, 2}:
        yield f"ends with {done.code}"
    if "Traceback (most" in done.err:
        yield f"raises {describe_traceback(done.err)}"
    if "QG603" in done.err + done.out and not damaged.endswith(".py"):
        crash = re.search(r".*QG603.*", done.err + done.out)
        yield f"shows a crash: {crash[0][-200:] if crash else ''}"
    if re.search("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u202e]", done.err):
        yield "sends control characters to the terminal"
    lines = done.err.splitlines()
    if any(len(line) > SENTENCE for line in lines):
        yield "says far too much"
    if done.code == 2:
        if f"{folder}/" not in done.err:
            yield f"names no file: {done.err[:200]}"
        wrong = [one for one in lines if not one.startswith("quizgen: ")]
        if wrong and not command.name.startswith("lint"):
            yield f"is no sentence: {wrong[0][:200]}"


def spread_mutants(count: int, first: int = 0) -> Iterator[tuple[FileCommand, int]]:
    """Yield commands and numbers, each command as often as its share says and at least once.

    Of fewer mutants than commands, every second command has one.
    """
    whole = sum(one.share for one in COMMANDS)
    for command in COMMANDS[:: 1 if count >= len(COMMANDS) else 2]:
        for number in range(max(1, round(count * command.share / whole))):
            yield command, first + number


@lru_cache(maxsize=1)
def _open_workshop(folder: Path) -> Workshop:
    """Return the one workshop of this process."""
    return Workshop(folder)


def try_mutants_of_base(folder: Path, base: str, count: int, first: int) -> list[Mutant]:
    """Return what became of the mutants of one base, among so many of all."""
    workshop = _open_workshop(folder)
    spread = spread_mutants(count, first)
    return [workshop.try_mutant(one, number) for one, number in spread if one.base == base]

"""A paper for each student: the same templates, other numbers, none shared with a neighbour.

A paper follows from the secret of the class, the id of its student and the neighbours it gives way
to, and from nothing else: who is made first, where, and what was made before does not matter.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import NamedTuple

import msgspec

from quizgen.bank.draw import Draw
from quizgen.bank.folder import Bank
from quizgen.bank.mixed import opened, sources
from quizgen.bank.plan import pick
from quizgen.classes.folder import (
    FORMS,
    PAPERS,
    SOLUTIONS,
    ClassFolder,
    Head,
    Settings,
    line_of,
)
from quizgen.classes.roster import Student, neighbours
from quizgen.classes.secret import code_of, new_secret, seal_of, seed_of
from quizgen.errors import ClassError
from quizgen.executors import run
from quizgen.files import PRIVATE, write_all
from quizgen.paper.banks import differing
from quizgen.paper.blueprint import Blueprint
from quizgen.paper.choose import choose, families, levels
from quizgen.paper.code import Code, digest_of
from quizgen.paper.draws import draws, shared
from quizgen.paper.form import form_bytes, holds_answers
from quizgen.paper.key import key_of
from quizgen.paper.paper import Holder, Paper, Progress, composed
from quizgen.render import KINDS, render_paper
from quizgen.render.typ import forget

CHUNK = 8
"""Papers of a job: what a killed worker costs."""
PRETENDED = 1
"""Documents after each paper: a tenth of a worker's memory is what papers before it left."""
CLASS = "class"
"""Stands for the seed where a code would show one."""


@dataclass(frozen=True)
class Job:
    """Papers to be made together.

    Parameters
    ----------
    settings : Settings
    blueprint : Blueprint
    students : tuple of Student
    beside : mapping of str to tuple of str
        To whom each of them gives way, and those in turn.
    former : mapping of str to tuple of str
        Codes that each has had.
    """

    settings: Settings
    blueprint: Blueprint
    students: tuple[Student, ...]
    beside: Mapping[str, tuple[str, ...]]
    former: Mapping[str, tuple[str, ...]]


class Made(NamedTuple):
    """A student's paper: its files, its line of the keys, and what a report says of it."""

    student: str
    files: dict[str, bytes]
    line: bytes
    points: Fraction
    minutes: int
    tiers: str
    alike: tuple[int, ...]


@dataclass(frozen=True)
class Report:
    """What was made.

    Parameters
    ----------
    made : tuple of Made
        Without files and lines.
    kept : int
        Papers that were there already.
    left : tuple of str
        Ids that have a paper, and are no longer on the roster.
    """

    made: tuple[Made, ...]
    kept: int
    left: tuple[str, ...]


def new_settings(
    name: str, bank: Bank, blueprint: Blueprint, lang: str, *, vary: bool = False
) -> Settings:
    """Settings of a new class, with a secret that nobody has had before.

    Parameters
    ----------
    name : str
    bank : Bank
    blueprint : Blueprint
    lang : str
        Of students whose row of the roster names none.
    vary : bool
        Whether a question may be made from any template of a family, or from one for all.
    """
    secret = new_secret()
    chosen = choose(bank, blueprint, seed_of(secret))
    templates = families(bank, blueprint, chosen) if vary else [(one,) for one in chosen]
    own = blueprint.name not in bank.blueprints and blueprint.file
    return Settings(
        name=name,
        secret=secret,
        blueprint=str(own.resolve()) if own else blueprint.name,
        banks=sources(bank),
        lang=lang,
        digest=_digest(bank, blueprint, templates),
        templates=tuple(templates),
    )


def _digest(bank: Bank, blueprint: Blueprint, templates: Sequence[Sequence[str]]) -> str:
    """Digest of the files behind all papers of a class."""
    asked = [
        (bank.template(name), level)
        for family, level in zip(templates, levels(blueprint), strict=False)
        for name in family
    ]
    return digest_of(blueprint.source, [t for t, _ in asked], [level for _, level in asked])


def make(
    folder: ClassFolder,
    students: Sequence[Student],
    blueprint: Blueprint,
    executor: Executor,
    ahead: int,
    tell: Progress,
) -> Report:
    """Make the papers that are missing, or whose row of the roster has changed.

    Raises
    ------
    ClassError
        If the bank or the blueprint is no longer that of the papers there are.
    """
    _check(folder, blueprint)
    heads = folder.heads()
    todo = [one for one in students if not _is_made(folder, one, heads.get(one.id))]
    folder.write_roster(students)
    done: list[Made] = []
    former = {one: head.codes for one, head in heads.items()}
    jobs = _jobs(folder.settings, blueprint, todo, _beside(students, heads), former)
    for results in run(executor, papers, jobs, ahead):
        _write(folder, results)
        for one in results:
            done.append(one._replace(files={}, line=b""))
            tell(one.student)
    order = dict.fromkeys(one.id for one in students)
    if done:
        folder.settle([*order])
    left = tuple(one for one in heads if one not in order)
    return Report(tuple(done), len(students) - len(todo), left)


def _check(folder: ClassFolder, blueprint: Blueprint) -> None:
    settings = folder.settings
    bank = bank_of(settings)
    if _digest(bank, blueprint, settings.templates) != settings.digest:
        code = next((head.code for head in folder.heads().values()), "")
        told = differing(folder.whose(code).key.banks, bank.parts) if code else ""
        raise ClassError(
            f"{folder.path}: was made with other templates or another blueprint"
            f"{told and f' ({told})'}; its papers keep their keys, and new ones need a new folder "
            "(--out)"
        )


def _jobs(
    settings: Settings,
    blueprint: Blueprint,
    todo: Sequence[Student],
    beside: Mapping[str, tuple[str, ...]],
    former: Mapping[str, tuple[str, ...]],
) -> Iterator[Job]:
    for at in range(0, len(todo), CHUNK):
        chunk = tuple(todo[at : at + CHUNK])
        had = {one.id: former.get(one.id, ()) for one in chunk}
        yield Job(settings, blueprint, chunk, _needed(chunk, beside), had)


def _write(folder: ClassFolder, results: Sequence[Made]) -> None:
    """Papers first, then their keys: who has a key has a paper. Forms with answers stay."""
    files = {name: data for one in results for name, data in one.files.items()}
    contents = {
        name: data
        for name, data in files.items()
        if not (name.startswith(FORMS) and holds_answers(folder.path / name))
    }
    write_all(folder.path, contents, PRIVATE)
    folder.append(one.line for one in results)


def _stamp(settings: Settings, one: Student) -> str:
    """Digest of all that a student's files depend on."""
    row = [one.id, one.name, one.lang or settings.lang, one.extra, settings.digest]
    return hashlib.sha256(json.dumps(row).encode()).hexdigest()[:16]


def _is_made(folder: ClassFolder, one: Student, head: Head | None) -> bool:
    if head is None or head.stamp != _stamp(folder.settings, one):
        return False
    return all((folder.path / name).exists() for name in _names(one))


def _names(one: Student) -> tuple[str, ...]:
    """The files of a student, as ``render.KINDS``, and the form."""
    return f"{PAPERS}/{one.file}.pdf", f"{SOLUTIONS}/{one.file}.pdf", f"{FORMS}/{one.file}.toml"


def _beside(students: Sequence[Student], heads: Mapping[str, Head]) -> dict[str, tuple[str, ...]]:
    """To whom each paper gives way: every second one to both sides, a late one to those there."""
    found = {one: head.beside for one, head in heads.items()}
    near = neighbours(students)
    for seat, one in enumerate(students):
        if one.id not in heads:
            found[one.id] = tuple(
                other
                for other in near[one.id]
                if (one.id not in heads[other].beside if other in heads else seat % 2)
            )
    return found


def _needed(
    students: Sequence[Student], beside: Mapping[str, tuple[str, ...]]
) -> dict[str, tuple[str, ...]]:
    """What of ``beside`` concerns some students."""
    found: dict[str, tuple[str, ...]] = {}
    todo = [one.id for one in students]
    while todo:
        one = todo.pop()
        if one not in found:
            found[one] = beside[one]
            todo += beside[one]
    return found


def papers(job: Job) -> list[Made]:
    """Make the papers of a job: the same bytes whatever the process."""
    drawing = _Drawing(job)
    return [_made(job, one, drawing) for one in job.students]


class _Drawing:
    """The draws of students, each made once."""

    def __init__(self, job: Job) -> None:
        self.job, self.bank = job, bank_of(job.settings)
        self._known: dict[str, list[Draw]] = {}

    def of(self, student: str) -> list[Draw]:
        """The questions of a student."""
        if student not in self._known:
            seed = seed_of(self.job.settings.secret, student)
            near = [self.of(other) for other in self.job.beside[student]]
            names = _one_of_each(self.job.settings.templates, seed)
            self._known[student] = [
                *draws(self.bank, names, seed, near, colour=self.job.blueprint.colour)
            ]
        return self._known[student]


def _one_of_each(templates: Sequence[Sequence[str]], seed: str) -> list[str]:
    return [family[pick(f"{seed}/{place}", len(family))] for place, family in enumerate(templates)]


def _made(job: Job, one: Student, drawing: _Drawing) -> Made:
    drawn, beside = drawing.of(one.id), job.beside[one.id]
    made = _composed(job, one, drawing.bank, drawn)
    paper = _graded(job.settings, one, made)
    sheets = [render_paper(paper, kind, "pdf") for kind in KINDS]
    forget(PRETENDED)
    former = tuple(sorted({*job.former[one.id]} - {paper.code}))
    head = Head(one.id, paper.code, made.code, _stamp(job.settings, one), beside, former=former)
    return Made(
        one.id,
        dict(zip(_names(one), [*sheets, form_bytes(paper)], strict=True)),
        line_of(head, key_of(paper)),
        paper.points,
        paper.minutes,
        "".join(item.questions[0].tier for item in paper.items),
        _alike(drawn, [drawing.of(other) for other in beside]),
    )


def _composed(job: Job, one: Student, bank: Bank, drawn: Sequence[Draw]) -> Paper:
    lang = one.lang or job.settings.lang
    named = Code(job.blueprint.name, CLASS, lang, level=job.blueprint.level)
    return composed(bank, job.blueprint, drawn, named)


def _graded(settings: Settings, one: Student, paper: Paper) -> Paper:
    """A paper with a code that tells nothing of it, for one student."""
    return msgspec.structs.replace(
        paper,
        code=code_of(settings.secret, one.id, paper.digest),
        seal=seal_of(settings.secret, one.id, paper.digest),
        holder=Holder(one.id, one.name, one.more(paper.minutes)),
    )


def _alike(drawn: Sequence[Draw], beside: Sequence[Sequence[Draw]]) -> tuple[int, ...]:
    """Questions that share a number with a neighbour's, because there are too few to choose."""
    return tuple(
        number
        for number, one in enumerate(drawn, 1)
        if any(shared(one, other[number - 1]) for other in beside)
    )


@cache
def bank_of(settings: Settings) -> Bank:
    """The bank that a class is made from, opened once a process."""
    return opened(settings.banks)

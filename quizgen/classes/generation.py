"""A paper for each student: the same templates, other numbers, none shared with a neighbour.

A paper follows from the secret of the class, the id of its student and the neighbours it gives way
to, and from nothing else: who is made first, where, and what was made before does not matter.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache, partial
from typing import NamedTuple

import msgspec

from quizgen.bank.bank import Bank
from quizgen.bank.combined import bank_sources, open_banks
from quizgen.bank.sampler import pick_index
from quizgen.bank.variant import Variant
from quizgen.classes.class_folder import (
    DATA,
    FORMS,
    PAPERS,
    SETTINGS,
    SHEETS,
    SOLUTIONS,
    ClassFolder,
    ClassSettings,
    PrintedHead,
    format_record,
)
from quizgen.classes.exam_details import FILE as EXAM
from quizgen.classes.exam_details import ExamDetails, read_exam_details
from quizgen.classes.lock import lock_folder
from quizgen.classes.pseudonyms import form_seal, new_secret, student_code, student_seed
from quizgen.classes.roster import RosterStudent, seat_neighbours
from quizgen.classes.sheet_codes import format_sheet_code
from quizgen.core.errors import BlueprintError, ClassError
from quizgen.core.executor import map_unordered
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import error_context
from quizgen.paper.answer_form import has_answers, write_blank_form
from quizgen.paper.answer_key import make_answer_key
from quizgen.paper.blueprint import Blueprint, load_blueprint
from quizgen.paper.code import PaperCode, source_digest
from quizgen.paper.paper import (
    Paper,
    PaperCover,
    PaperHolder,
    PaperItem,
    ProgressCallback,
    compose_paper,
    compose_paper_item,
)
from quizgen.paper.provenance import describe_differences
from quizgen.paper.selection import (
    alternatives,
    select_instead,
    select_templates,
    slot_levels,
)
from quizgen.paper.variants import draw_variants, shared_content
from quizgen.render import KINDS, render_paper
from quizgen.render.answer_sheet import PAPER_VERSION, VERSION, SheetPlaces, make_answer_sheet
from quizgen.render.scanned_paper import render_scanned_paper
from quizgen.render.typst_document import evict_cache

CHUNK = 8
"""Papers of a job: what a killed worker costs."""
PRETENDED = 1
"""Documents after each paper: a tenth of a worker's memory is what papers before it left."""
PREVIEW = "preview"
"""Stands for a student on the paper that is looked at before there are others, and names its
files."""
CLASS = "class"
"""Stands for the seed where a code would show one."""


@dataclass(frozen=True)
class GenerationJob:
    """Papers that one worker generates together.

    Parameters
    ----------
    settings : ClassSettings
    blueprint : Blueprint
    students : tuple of RosterStudent
    neighbours : mapping of str to tuple of str
        To whom each of them gives way, and those in turn.
    former : mapping of str to tuple of str
        Codes that each has had.
    exam : ExamDetails
        What covers say.
    sheet : bool
        Whether there are compact answer sheets, too.
    """

    settings: ClassSettings
    blueprint: Blueprint
    students: tuple[RosterStudent, ...]
    neighbours: Mapping[str, tuple[str, ...]]
    former: Mapping[str, tuple[str, ...]]
    exam: ExamDetails
    sheet: bool = False


class GeneratedPaper(NamedTuple):
    """A student's files by name, the line for ``keys.jsonl``, and what a report says.

    ``alike`` are the numbers of questions that share a value with a neighbour's.
    """

    student: str
    files: dict[str, bytes]
    line: bytes
    points: Fraction
    minutes: int
    tiers: str
    alike: tuple[int, ...]


@dataclass(frozen=True)
class GenerationReport:
    """What a run of generation did.

    Parameters
    ----------
    made : tuple of GeneratedPaper
        Without files and lines.
    kept : int
        Papers that were there already.
    left : tuple of str
        Ids that have a paper, and are no longer on the roster.
    """

    made: tuple[GeneratedPaper, ...]
    kept: int
    left: tuple[str, ...]


def create_settings(
    name: str,
    bank: Bank,
    blueprint: Blueprint,
    lang: str,
    *,
    vary: bool = False,
    without: Sequence[str] = (),
) -> ClassSettings:
    """Return the settings of a new class, with a new random secret.

    Parameters
    ----------
    name : str
    bank : Bank
    blueprint : Blueprint
    lang : str
        Of students whose row of the roster names none.
    vary : bool
        Whether a question may be made from any template of a family, or from one for all.
    without : sequence of str
        Templates that no question may be made from.
    """
    secret = new_secret()
    chosen = select_templates(bank, blueprint, student_seed(secret), without)
    templates = (
        alternatives(bank, blueprint, chosen, without) if vary else [(one,) for one in chosen]
    )
    own = blueprint.name not in bank.blueprints and blueprint.file
    return ClassSettings(
        name=name,
        secret=secret,
        blueprint=str(own.resolve()) if own else blueprint.name,
        banks=bank_sources(bank),
        lang=lang,
        digest=_compute_class_digest(bank, blueprint, templates),
        templates=tuple(templates),
        without=tuple(without),
    )


def replace_template(
    settings: ClassSettings, bank: Bank, blueprint: Blueprint, number: int, template: str = ""
) -> ClassSettings:
    """Return the settings with another template for one question.

    Parameters
    ----------
    settings : ClassSettings
    bank : Bank
    blueprint : Blueprint
    number : int
        Of the question, from 1.
    template : str
        Which; by default any that fits the slot and is worth as much.

    Raises
    ------
    ClassError
        If there is no such question, or nothing else that may stand there.
    """
    _find_asked_template(settings, number)
    chosen = [family[0] for family in settings.templates]
    without = settings.without
    if template and template not in bank.template_paths:
        raise ClassError(f"there is no template {template!r}")
    if template:
        without = (*without, *({*bank.template_paths} - {template}))
    try:
        chosen = select_instead(bank, blueprint, chosen, number - 1, new_secret(), without)
    except BlueprintError as error:
        what = f"{template} cannot" if template else "nothing else can"
        raise ClassError(f"{what} stand for question {number}: {error}") from None
    vary = any(len(family) > 1 for family in settings.templates)
    templates = (
        alternatives(bank, blueprint, chosen, settings.without)
        if vary
        else [(one,) for one in chosen]
    )
    return msgspec.structs.replace(
        settings,
        templates=tuple(templates),
        digest=_compute_class_digest(bank, blueprint, templates),
    )


def replace_by_comparable(
    settings: ClassSettings,
    bank: Bank,
    blueprint: Blueprint,
    number: int,
    difficulties: Mapping[str, float],
) -> ClassSettings:
    """Return the settings with the template for one question that was about as difficult.

    Parameters
    ----------
    settings : ClassSettings
    bank : Bank
    blueprint : Blueprint
    number : int
        Of the question, from 1.
    difficulties : mapping of str to float
        Template to the mean share of the points in earlier classes.

    Raises
    ------
    ClassError
        If nothing is known of the question, or of nothing that may stand there.
    """
    now = _find_asked_template(settings, number)
    if now not in difficulties:
        raise ClassError(f"no earlier class was asked {now}, of question {number}")
    others = (difficulties.keys() - {now}) & bank.template_paths.keys()
    for other in sorted(others, key=lambda one: (abs(difficulties[one] - difficulties[now]), one)):
        with suppress(ClassError):
            return replace_template(settings, bank, blueprint, number, other)
    raise ClassError(f"nothing that earlier classes were asked can stand for question {number}")


def _find_asked_template(settings: ClassSettings, number: int) -> str:
    """Return the template of a question, from 1; ``ClassError`` if there is no such question."""
    if not 1 <= number <= len(settings.templates):
        raise ClassError(f"no question {number} (there are {len(settings.templates)})")
    return settings.templates[number - 1][0]


def make_preview(settings: ClassSettings, blueprint: Blueprint, exam: ExamDetails) -> Paper:
    """Return a paper as students will get it, with numbers that nobody gets."""
    sample = RosterStudent(PREVIEW, PREVIEW)
    job = GenerationJob(settings, blueprint, (sample,), {PREVIEW: ()}, {}, exam)
    drawing = _Drawing(job)
    made = _compose_student_paper(job, sample, drawing.bank, drawing.of(PREVIEW))
    return _assign_student_code(job, sample, made)


def _compute_class_digest(
    bank: Bank, blueprint: Blueprint, templates: Sequence[Sequence[str]]
) -> str:
    """Return the digest of blueprint and templates: of all that the papers depend on."""
    asked = [
        (bank.template(name), level)
        for family, level in zip(templates, slot_levels(blueprint), strict=False)
        for name in family
    ]
    return source_digest(blueprint.source, [t for t, _ in asked], [level for _, level in asked])


def generate_papers(
    folder: ClassFolder,
    students: Sequence[RosterStudent],
    blueprint: Blueprint,
    executor: Executor,
    ahead: int,
    tell: ProgressCallback,
) -> GenerationReport:
    """Generate the papers that are missing, or whose roster row has changed.

    A class that has a folder for compact answer sheets gets these, too.

    Raises
    ------
    ClassError
        If the bank or the blueprint is no longer that of the papers there are, or another
        command writes there.
    """
    with lock_folder(folder.path):
        _check_bank_unchanged(folder, blueprint)
        heads, exam = folder.heads(), read_exam_details(folder.path / EXAM) or ExamDetails()
        todo = [one for one in students if not _is_up_to_date(folder, one, exam, heads.get(one.id))]
        folder.write_roster(students)
        done: list[GeneratedPaper] = []
        former = {one: head.codes for one, head in heads.items()}
        whole = GenerationJob(
            folder.settings,
            blueprint,
            tuple(todo),
            _assign_neighbours(students, heads),
            former,
            exam,
            (folder.path / SHEETS).exists(),
        )
        jobs = _iter_jobs(whole)
        for results in map_unordered(executor, run_generation_job, jobs, ahead):
            _write_papers_and_keys(folder, results)
            for one in results:
                done.append(one._replace(files={}, line=b""))
                tell(one.student)
        order = dict.fromkeys(one.id for one in students)
        if done:
            folder.compact([*order])
        left = tuple(one for one in heads if one not in order)
        return GenerationReport(tuple(done), len(students) - len(todo), left)


def _check_bank_unchanged(folder: ClassFolder, blueprint: Blueprint) -> None:
    """Raise ``ClassError`` if bank or blueprint have changed since the class was created.

    Papers made from both states could not be compared, and their keys would differ.
    """
    settings = folder.settings
    with error_context(folder.path / SETTINGS):
        bank = open_class_bank(settings)
        digest = _compute_class_digest(bank, blueprint, settings.templates)
    if digest != settings.digest:
        code = next((head.code for head in folder.heads().values()), "")
        told = (
            describe_differences(folder.find_by_code(code).key.banks, bank.members) if code else ""
        )
        raise ClassError(
            f"{folder.path}: was made with other templates or another blueprint"
            f"{told and f' ({told})'}; its papers keep their keys, and new ones need a new folder "
            "(--out)"
        )


def list_paper_jobs(folder: ClassFolder, blueprint: Blueprint) -> dict[str, GenerationJob]:
    """Return for each student with a paper the job that composes it once more.

    Raises
    ------
    ClassError
        If the bank or the blueprint is no longer that of the papers there are.
    """
    _check_bank_unchanged(folder, blueprint)
    heads, students = folder.heads(), folder.students()
    exam = read_exam_details(folder.path / EXAM) or ExamDetails()
    near = _assign_neighbours(students, heads)
    return {
        one.id: GenerationJob(
            folder.settings, blueprint, (one,), _select_neighbours((one,), near), {}, exam
        )
        for one in students
        if one.id in heads
    }


def compose_paper_again(job: GenerationJob, code: str) -> Paper:
    """Return the paper of a job's first student, as it was printed with a code.

    Raises
    ------
    ClassError
        If another paper would be composed now.
    """
    one, drawing = job.students[0], _Drawing(job)
    made = _compose_student_paper(job, one, drawing.bank, drawing.of(one.id))
    paper = _assign_student_code(job, one, made)
    if paper.code != code:
        raise ClassError(
            f"the paper of {one.id} is not the one that was made; run quizgen class make again"
        )
    return paper


def _iter_jobs(whole: GenerationJob) -> Iterator[GenerationJob]:
    """Yield jobs of ``CHUNK`` students, each with the neighbours its papers depend on."""
    for at in range(0, len(whole.students), CHUNK):
        chunk = whole.students[at : at + CHUNK]
        yield replace(
            whole,
            students=chunk,
            neighbours=_select_neighbours(chunk, whole.neighbours),
            former={one.id: whole.former.get(one.id, ()) for one in chunk},
        )


def _write_papers_and_keys(folder: ClassFolder, results: Sequence[GeneratedPaper]) -> None:
    """Write papers, then their keys; forms that hold answers are not overwritten.

    In this order a key in the file always has its paper.
    """
    files = {name: data for one in results for name, data in one.files.items()}
    contents = {
        name: data
        for name, data in files.items()
        if not (name.startswith(FORMS) and has_answers(folder.path / name))
    }
    write_all(folder.path, contents, PRIVATE)
    folder.append(one.line for one in results)


def _compute_student_digest(settings: ClassSettings, one: RosterStudent, exam: ExamDetails) -> str:
    """Return a digest of all that a student's files depend on."""
    row: list[object] = [one.id, one.name, one.lang or settings.lang, one.extra, settings.digest]
    shown = exam.build_cover(one)
    if shown != PaperCover() or exam.title or exam.pseudonyms:
        row.append([msgspec.to_builtins(shown), exam.title, exam.pseudonyms])
    return hashlib.sha256(json.dumps(row).encode()).hexdigest()[:16]


def _is_up_to_date(
    folder: ClassFolder, one: RosterStudent, exam: ExamDetails, head: PrintedHead | None
) -> bool:
    """Return whether a student's files exist and are up to date."""
    if head is None or head.stamp != _compute_student_digest(folder.settings, one, exam):
        return False
    names = [*_list_student_files(one)]
    if (folder.path / SHEETS).exists():
        names.append(f"{SHEETS}/{one.file}.pdf")
    return all((folder.path / name).exists() for name in names)


def _list_student_files(one: RosterStudent) -> tuple[str, ...]:
    """Return the paths of paper, solution (in the order of ``render.KINDS``) and form."""
    return f"{PAPERS}/{one.file}.pdf", f"{SOLUTIONS}/{one.file}.pdf", f"{FORMS}/{one.file}.toml"


def _assign_neighbours(
    students: Sequence[RosterStudent], heads: Mapping[str, PrintedHead]
) -> dict[str, tuple[str, ...]]:
    """Return for each student the neighbours whose numbers the paper must avoid.

    Every second paper avoids both sides, so no two wait for each other; a student who comes late
    avoids the papers that exist.
    """
    found = {one: head.beside for one, head in heads.items()}
    near = seat_neighbours(students)
    for seat, one in enumerate(students):
        if one.id not in heads:
            found[one.id] = tuple(
                other
                for other in near[one.id]
                if (one.id not in heads[other].beside if other in heads else seat % 2)
            )
    return found


def _select_neighbours(
    students: Sequence[RosterStudent], neighbours: Mapping[str, tuple[str, ...]]
) -> dict[str, tuple[str, ...]]:
    """Return the entries of ``neighbours`` that the papers of some students depend on.

    Those of neighbours too, and of their neighbours in turn.
    """
    found: dict[str, tuple[str, ...]] = {}
    todo = [one.id for one in students]
    while todo:
        one = todo.pop()
        if one not in found:
            found[one] = neighbours[one]
            todo += neighbours[one]
    return found


def run_generation_job(job: GenerationJob) -> list[GeneratedPaper]:
    """Return the generated papers of a job; the same bytes in any process."""
    drawing = _Drawing(job)
    return [_make_student_files(job, one, drawing) for one in job.students]


class _Drawing:
    """The variants of each student, drawn once: a neighbour's are needed too."""

    def __init__(self, job: GenerationJob) -> None:
        self.job, self.bank = job, open_class_bank(job.settings)
        self._known: dict[str, list[Variant]] = {}

    def of(self, student: str) -> list[Variant]:
        """Return the variants of a student's questions, in order."""
        if student not in self._known:
            seed = student_seed(self.job.settings.secret, student)
            near = [self.of(other) for other in self.job.neighbours[student]]
            names = _choose_templates(self.job.settings.templates, seed)
            self._known[student] = [
                *draw_variants(self.bank, names, seed, near, colour=self.job.blueprint.colour)
            ]
        return self._known[student]


def _choose_templates(templates: Sequence[Sequence[str]], seed: str) -> list[str]:
    """Return one template of each family, chosen by the student's seed."""
    return [
        family[pick_index(f"{seed}/{place}", len(family))] for place, family in enumerate(templates)
    ]


def _make_student_files(
    job: GenerationJob, one: RosterStudent, drawing: _Drawing
) -> GeneratedPaper:
    """Return one student's paper with its files, key and report."""
    drawn, neighbours = drawing.of(one.id), job.neighbours[one.id]
    made = _compose_student_paper(job, one, drawing.bank, drawn)
    paper = _assign_student_code(job, one, made)
    printed, places = _print_paper(job.settings, paper)
    evict_cache(PRETENDED)
    former = tuple(sorted({*job.former[one.id]} - {paper.code}))
    head = PrintedHead(
        one.id,
        paper.code,
        made.code,
        _compute_student_digest(job.settings, one, job.exam),
        neighbours,
        former=former,
        minutes=paper.minutes,
    )
    files = dict(zip(_list_student_files(one), [*printed, write_blank_form(paper)], strict=True))
    if job.sheet:
        files[f"{SHEETS}/{one.file}.pdf"], places = make_answer_sheet(
            paper, partial(format_sheet_code, job.settings.secret, paper.code, VERSION)
        )
    files |= {f"{DATA}/{one.file}/{name}": data for name, data in paper.data_files.items()}
    return GeneratedPaper(
        one.id,
        files,
        format_record(head, make_answer_key(paper), sheet=places),
        paper.points,
        paper.minutes,
        "".join(item.questions[0].tier for item in paper.items),
        _find_shared_questions(drawn, [drawing.of(other) for other in neighbours]),
    )


def _print_paper(settings: ClassSettings, paper: Paper) -> tuple[list[bytes], SheetPlaces | None]:
    """Return paper and solutions, and the places of fields if the paper is to be scanned."""
    if not settings.scan:
        return [render_paper(paper, kind, "pdf") for kind in KINDS], None
    codes = partial(format_sheet_code, settings.secret, paper.code, PAPER_VERSION)
    asked, places = render_scanned_paper(paper, codes)
    return [asked, *(render_paper(paper, kind, "pdf") for kind in KINDS[1:])], places


def _compose_student_paper(
    job: GenerationJob, one: RosterStudent, bank: Bank, drawn: Sequence[Variant]
) -> Paper:
    """Return the paper of a student's variants, in the student's language."""
    lang = one.lang or job.settings.lang
    named = PaperCode(job.blueprint.name, CLASS, lang, level=job.blueprint.level)
    return compose_paper(bank, job.blueprint, drawn, named)


def _assign_student_code(job: GenerationJob, one: RosterStudent, paper: Paper) -> Paper:
    """Return the paper with the student's name, cover, code and seal.

    The code is a message authentication code: it reveals nothing about the numbers.
    """
    cover, secret = job.exam.build_cover(one), job.settings.secret
    titled = msgspec.structs.replace(job.blueprint, title=dict(job.exam.titles))
    return msgspec.structs.replace(
        paper,
        code=student_code(secret, one.id, paper.digest),
        seal=form_seal(secret, one.id, paper.digest),
        holder=PaperHolder(one.id, one.name, job.exam.pseudonyms),
        cover=None if cover == PaperCover() else cover,
        blueprint=titled if job.exam.title else paper.blueprint,
    )


def _find_shared_questions(
    drawn: Sequence[Variant], neighbours: Sequence[Sequence[Variant]]
) -> tuple[int, ...]:
    """Return the numbers (from 1) of questions that share a value with a neighbour's.

    This happens where a template has too few values to choose from.
    """
    return tuple(
        number
        for number, one in enumerate(drawn, 1)
        if any(shared_content(one, other[number - 1]) for other in neighbours)
    )


def redraw_question(
    settings: ClassSettings,
    heads: Mapping[str, PrintedHead],
    student: str,
    template: str,
    lang: str,
) -> PaperItem | None:
    """Return a question of a student's paper as it was printed, in one language.

    None where the class has no papers of its own, or its bank has changed since.

    Parameters
    ----------
    settings : ClassSettings
    heads : mapping of str to PrintedHead
        What was printed for each student.
    student, template, lang : str
        If the template is not written in this language, it comes in its first one.

    Raises
    ------
    QuizgenError
        If bank or blueprint cannot be read.
    """
    opened = _open_unchanged_class(settings)
    if opened is None or student not in heads:
        return None
    beside = {one: head.beside for one, head in heads.items()}
    near = _select_neighbours([RosterStudent(student, "")], beside)
    drawn = _Drawing(GenerationJob(settings, opened, (), near, {}, ExamDetails())).of(student)
    for place, one in enumerate(drawn):
        if one.template.id == template:
            spoken = lang if lang in one.template.languages else one.template.languages[0]
            return compose_paper_item(opened, drawn, place, (spoken,))
    return None


@cache
def _open_unchanged_class(settings: ClassSettings) -> Blueprint | None:
    """Return the blueprint of a class; None if its papers cannot be made again.

    Its bank has changed since, or the class has no papers of its own.
    """
    if not settings.digest:
        return None
    bank = open_class_bank(settings)
    blueprint = load_blueprint(settings.blueprint, bank)
    is_same = _compute_class_digest(bank, blueprint, settings.templates) == settings.digest
    return blueprint if is_same else None


@cache
def open_class_bank(settings: ClassSettings) -> Bank:
    """Return the bank that a class is generated from, opened once per process."""
    return open_banks(settings.banks)

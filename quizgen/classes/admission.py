"""Cards to hand out: with the code on it a student comes into the exam in the browser, once."""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path

from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.exam_details import FILE as EXAM
from quizgen.classes.exam_details import ExamDetails, read_exam_details
from quizgen.classes.room_lists import FOLDER, PACKAGE, number_seats
from quizgen.classes.safe_exam_browser import write_settings_file
from quizgen.classes.seats import entry_code
from quizgen.core.files import PRIVATE, write_all
from quizgen.locale import load_words
from quizgen.render.typst_document import (
    compile_pdf,
    document_files,
    replace_unprintable,
    typst_literal,
)

FILE = "admission.pdf"
ON_A_PAGE = 8


def write_admission_files(folder: ClassFolder, address: str, lang: str) -> list[Path]:
    """Write the cards of all students, in the order of their seats; return the paths.

    If the exam is sat in Safe Exam Browser, its settings file is written, too.

    Parameters
    ----------
    folder : ClassFolder
    address : str
        Of the server, as students reach it.
    lang : str
        Of what the cards say.
    """
    exam = read_exam_details(folder.path / EXAM) or ExamDetails()
    words = load_words(lang, "classes")["admission"]
    title = exam.pick("title", lang) or exam.pick("course", lang) or folder.settings.name
    pictures: dict[str, bytes] = {}
    cards = []
    for place, (one, seat) in enumerate(number_seats(folder.students())):
        code = entry_code(folder.settings.secret, one.id, 0)
        picture = f"code-{place}.svg"
        pictures[picture] = _draw_link(f"{address}/?code={code}")
        room = one.group or exam.pick("room", lang)
        facts = {"id": one.id, "room": room, "seat": seat}
        cards.append(_typeset_card(one.name or one.id, facts, code, picture, words))
    pages = [cards[at : at + ON_A_PAGE] for at in range(0, len(cards), ON_A_PAGE)]
    body = "#pagebreak()\n".join(
        f"#sheet(({''.join(f'{card}, ' for card in page)}))\n" for page in pages
    )
    head = (
        f"#show: admission.with(title: {_typeset_text(title)}, lang: {typst_literal(lang)}, "
        f"address: {typst_literal(address)}, how: {_typeset_text(words['how'])}, "
        f"once: {_typeset_text(words['once'])})\n"
    )
    sources = document_files("admission.typ", head + body, PACKAGE) | pictures
    written = write_all(folder.path / FOLDER, {FILE: compile_pdf(sources)}, PRIVATE)
    if exam.browser.safe_exam_browser:
        password = exam.browser.quit_password
        written.append(write_settings_file(folder.path / FOLDER, address, password))
    return written


def _typeset_card(
    name: str, facts: Mapping[str, str], code: str, picture: str, words: Mapping[str, str]
) -> str:
    """Return Typst source of a card."""
    told = " · ".join(f"{words[key]} {value}" for key, value in facts.items() if value)
    return (
        f"(name: {_typeset_text(name)}, facts: {_typeset_text(told)}, "
        f"code: {typst_literal(code)}, picture: {typst_literal(picture)})"
    )


def _draw_link(address: str) -> bytes:
    """Return the QR code of an address as SVG."""
    import segno

    out = io.BytesIO()
    segno.make(address, error="m", micro=False).save(out, kind="svg", border=2, xmldecl=False)
    return out.getvalue()


def _typeset_text(text: str) -> str:
    """Return a text as a Typst literal, with ``?`` for what no font has."""
    return typst_literal(replace_unprintable(text))

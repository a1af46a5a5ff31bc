"""What an exam shows and what marks it, kept from its beginning.

A later bank, or a later quizgen, would make another paper from the same code, or none. So an exam
keeps its paper: in every language, with keys, versions, and each figure once, by its digest.
"""

from __future__ import annotations

import asyncio
import hashlib
import logging
import zlib
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Any

import msgspec
from starlette.concurrency import run_in_threadpool

import quizgen
from quizgen.bank.bank import Bank
from quizgen.core.decoding import convert, decode_json
from quizgen.core.errors import QuizgenError
from quizgen.store import ExamRecord, Packed, Store
from quizgen.web.job_cache import ResultCache, WorkerPool
from quizgen.web.question_view import PaperView, make_papers

FORMAT = 1
"""Rises with what cannot be read as before; new members of what is kept have defaults instead."""
ROOM = 30_000_000
"""Bytes of papers that stay in memory: any other is read in some milliseconds."""
READERS = 2
"""Papers that are unpacked at the same time: more take memory and no less time."""
UNPACKED = 4
"""Bytes in memory for each that is kept."""
PICTURES = frozenset({"figure", "solved_figure", "board"})
MARK = "sha256:"
_LOG = logging.getLogger("quizgen.papers")


class KeptPaper(msgspec.Struct):
    """A paper as it is stored, with each figure once."""

    format: int
    quizgen: str
    papers: dict[str, msgspec.Raw]
    figures: dict[str, str]


@dataclass(frozen=True)
class MakePaper:
    """Builds a paper from its code, or from a blueprint and a seed."""

    code: str = ""
    blueprint: str = ""
    seed: int = 0

    def run(self, bank: Bank) -> bytes:
        """Return the paper in all its languages, packed for storage.

        Raises
        ------
        QuizgenError
            If there is no such paper, or a template is wrong.
        """
        return msgspec.msgpack.encode(pack(make_papers(bank, self.code, self.blueprint, self.seed)))


def pack(papers: dict[str, PaperView]) -> Packed:
    """Return a paper in its languages, compressed for storage.

    Languages share their figures, so each is stored once, by its digest.
    """
    figures: dict[str, str] = {}

    def note(svg: str) -> str:
        """Store a figure once and return the name that stands in its place."""
        if not svg:
            return ""
        name = MARK + hashlib.sha256(svg.encode()).hexdigest()
        figures[name] = svg
        return name

    whole = {
        lang: msgspec.Raw(msgspec.json.encode(_replace_pictures(msgspec.to_builtins(paper), note)))
        for lang, paper in papers.items()
    }
    data = msgspec.json.encode(KeptPaper(FORMAT, quizgen.__version__, whole, figures))
    paper = next(iter(papers.values()))
    name = hashlib.sha256(data).hexdigest()
    parts = tuple(part.field.id for item in paper.items for part in item.parts)
    return Packed(name, paper.code, zlib.compress(data, 6), paper.minutes, paper.pauses, parts)


def unpack(data: bytes, lang: str) -> PaperView:
    """Return a stored paper in a language, or in its first one."""
    kept = decode_json(zlib.decompress(data), KeptPaper)
    raw = kept.papers.get(lang) or next(iter(kept.papers.values()))
    return convert(
        _replace_pictures(msgspec.json.decode(raw), lambda name: kept.figures.get(name, name)),
        PaperView,
    )


def _replace_pictures(value: Any, other: Callable[[str], str]) -> Any:
    """Return JSON data with every picture replaced by ``other(picture)``."""
    if isinstance(value, list):
        return [_replace_pictures(one, other) for one in value]
    if not isinstance(value, dict):
        return value
    return {
        name: other(one)
        if name in PICTURES and isinstance(one, str)
        else _replace_pictures(one, other)
        for name, one in value.items()
    }


class Papers:
    """The stored papers of exams, with a cache of the latest.

    Parameters
    ----------
    store : Store
    workers : WorkerPool
    """

    def __init__(self, store: Store, workers: WorkerPool) -> None:
        self.store, self.workers = store, workers
        self._kept: ResultCache[tuple[str, str], PaperView] = ResultCache(ROOM)
        self._reading = asyncio.Semaphore(READERS)

    async def make(self, wanted: MakePaper, asker: Hashable = None) -> Packed:
        """Return a new paper, packed for storage; a worker builds it.

        Parameters
        ----------
        wanted : MakePaper
        asker : hashable, optional
            Who waits for it.

        Raises
        ------
        QuizgenError
            If there is no such paper, or a template is wrong.
        """
        # Nobody asks for a drawn seed again; a code may be entered by everybody in a room.
        data = await self.workers.get_result(wanted, asker, is_kept=bool(wanted.code))
        return convert(msgspec.msgpack.decode(data), Packed)

    async def of(self, sitting: ExamRecord, lang: str) -> PaperView:
        """Return the paper of an exam in a language.

        The paper of an old exam without one is built from its code and stored.

        Raises
        ------
        QuizgenError
            If it is of before and cannot be made any more.
        """
        name = sitting.paper or await self._attach(sitting)
        found = self._kept.get((name, lang))
        if found is None:
            async with self._reading:
                data = await run_in_threadpool(self.store.sittings.paper, name)
                found = await run_in_threadpool(unpack, data, lang)
            self._kept.store_result((name, lang), found, len(data) * UNPACKED)
        return found

    async def _attach(self, sitting: ExamRecord) -> str:
        """Build and store the paper of an old exam; return its id."""
        packed = await self.make(MakePaper(sitting.code), self)
        await run_in_threadpool(self.store.sittings.attach, sitting, packed)
        return packed.id

    async def attach_all(self) -> None:
        """Store the papers of all old exams without one; log how many cannot be built."""
        lost = 0
        for sitting in await run_in_threadpool(self.store.sittings.without_paper):
            try:
                await self._attach(sitting)
            except QuizgenError:
                lost += 1
        if lost:
            _LOG.warning(
                "%d exams kept only the code of a paper that cannot be made any more; their "
                "answers stay, but cannot be shown",
                lost,
            )

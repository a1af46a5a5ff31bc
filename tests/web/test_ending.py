"""How a server ends, and what happens where one of its processes does."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
import time

import pytest
from served import ran

from quizgen.core.errors import BankError, WorkerError
from quizgen.web.job_cache import WorkerPool
from quizgen.web.question_view import QuestionRequest
from quizgen.web.settings import ServerSettings

pytestmark = pytest.mark.slow  # servers in processes of their own


@pytest.fixture
def workers():
    found = WorkerPool(ServerSettings("sqlite://", workers=1))
    found.warm()
    yield found
    found.close()


def test_a_process_that_dies_is_followed_by_another(workers):
    async def run() -> list[str]:
        first = await workers.get_question(QuestionRequest("point-to-image-plane", "1", "en"))
        workers.pool.processes[0].kill()
        second = await workers.get_question(QuestionRequest("point-to-image-plane", "2", "en"))
        due = asyncio.ensure_future(
            workers.get_question(QuestionRequest("point-to-image-plane", "3", "en"))
        )
        await asyncio.sleep(0)
        workers.pool.processes[0].kill()
        return [first.stem, second.stem, (await due).stem]

    assert len(set(ran(run()))) == 3


def test_a_template_that_is_not_there_is_said_and_the_process_lives(workers):
    before = workers.pool.processes[0].pid
    with pytest.raises(BankError):
        ran(workers.get_question(QuestionRequest("nothing", "1", "en")))
    assert ran(workers.get_question(QuestionRequest("point-to-image-plane", "1", "en"))).stem
    assert workers.pool.processes[0].pid == before


def test_ctrl_c_is_left_to_the_server(workers):
    before = workers.pool.processes[0]
    os.kill(before.pid, signal.SIGINT)
    assert ran(workers.get_question(QuestionRequest("point-to-image-plane", "1", "en"))).stem
    assert workers.pool.processes[0] is before


def test_a_server_that_ends_leaves_nobody_waiting(workers):
    async def run() -> None:
        due = asyncio.ensure_future(
            workers.get_question(QuestionRequest("point-to-image-plane", "1", "en"))
        )
        await asyncio.sleep(0.05)
        workers.close()
        with pytest.raises(WorkerError):
            await due

    ran(run())


def _gone(group: int) -> bool:
    """Whether no process of a group is left, within a minute."""
    for _ in range(600):
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.1)
    return False


SLOW = pytest.mark.slow


@pytest.mark.parametrize(
    ("how", "to_all", "code"),
    [
        (signal.SIGINT, True, 0),
        (signal.SIGKILL, False, -signal.SIGKILL),
        pytest.param(signal.SIGINT, False, 0, marks=SLOW),
        pytest.param(signal.SIGTERM, False, 0, marks=SLOW),
        pytest.param(signal.SIGHUP, False, 0, marks=SLOW),
    ],
)
def test_a_server_that_ends_leaves_no_process_and_no_warning(tmp_path, how, to_all, code):
    with subprocess.Popen(
        [sys.executable, "-m", "quizgen", "serve", "--no-open", "--database",
         f"sqlite:///{tmp_path / 'x.sqlite3'}"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    ) as server:  # fmt: skip
        assert "/enter?key=" in server.stdout.readline()
        (os.killpg if to_all else os.kill)(server.pid, how)
        _, errors = server.communicate(timeout=60)
    assert _gone(server.pid)
    assert (server.returncode, errors) == (code, "")

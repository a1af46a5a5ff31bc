"""Executors: the same bytes from all, and a worker that dies costs its job alone."""

from __future__ import annotations

import gc
import os
import pickle
import time

import pytest
from dying import Long, Mortal, always_dead
from small import begun, bytes_of, with_papers

from quizgen.classes import generation
from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.grading import GradedClassPart, StudentMarks
from quizgen.classes.grading_history import GradingHistory
from quizgen.classes.roster import RosterStudent
from quizgen.core.errors import InvalidChoiceError, WorkerError
from quizgen.core.executor import InlineExecutor, ProcessExecutor, map_unordered, open_executor

STUDENTS = [RosterStudent(f"{n}") for n in range(4)]


def pid_of(_job):
    return os.getpid()


def threshold_of(_job):
    return gc.get_threshold()


def test_a_worker_looks_for_garbage_as_seldom_as_its_parent():
    before = gc.get_threshold()
    gc.set_threshold(12_345, 6, 7)
    try:
        with open_executor(2) as (executor, ahead):
            found = list(map_unordered(executor, threshold_of, range(2), ahead))
    finally:
        gc.set_threshold(*before)
    assert found == [(12_345, 6, 7)] * 2


def test_few_jobs_are_done_in_this_process():
    with open_executor(1) as (executor, ahead):
        assert list(map_unordered(executor, pid_of, range(3), ahead)) == [os.getpid()] * 3


def test_no_more_jobs_wait_than_keep_the_workers_busy():
    begun_jobs = []

    def jobs():
        for job in range(9):
            begun_jobs.append(job)
            yield job

    results = map_unordered(InlineExecutor(), str, jobs(), 2)
    next(results)
    assert begun_jobs == [0, 1]


def test_the_jobs_of_a_process_that_is_killed_are_done_by_another(tmp_path):
    executor = Mortal(2, tmp_path / "dead")
    try:
        found = list(map_unordered(executor, pid_of, range(6), 4))
    finally:
        executor.shutdown()
    assert (tmp_path / "dead").exists()
    assert len(found) == 6
    assert os.getpid() not in found


@pytest.mark.slow
def test_a_process_that_dies_amid_its_answer_is_not_waited_for(tmp_path):
    executor = ProcessExecutor(1)
    try:
        told = executor.submit(Long, tmp_path / "dead").result(60)
    finally:
        executor.stop()
    assert (tmp_path / "dead").exists()
    assert len(told) == 300_000_000


class TwoWordsError(Exception):
    def __init__(self, one, two):
        super().__init__(f"{one} and {two}")


def fails(number):
    raise (ValueError("a plain one") if number else TwoWordsError(1, 2))


def test_an_error_of_a_job_comes_back_with_its_place():
    with open_executor(2) as (executor, _):
        plain, other = (executor.submit(fails, number) for number in (1, 0))
        with pytest.raises(ValueError, match="a plain one") as caught:
            plain.result()
        with pytest.raises(RuntimeError, match="TwoWordsError: 1 and 2"):
            other.result()
    assert "in fails" in "".join(caught.value.__notes__)


def sleeps(_job):
    time.sleep(600)


def test_work_that_is_given_up_ends_its_processes():
    waiting = []

    def given_up():
        with open_executor(2) as (executor, _):
            waiting.extend(executor.submit(sleeps, job) for job in range(6))
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        given_up()
    assert all(one.done() for one in waiting)


@pytest.mark.slow
def test_a_worker_that_is_killed_changes_no_byte(tmp_path, monkeypatch):
    monkeypatch.setattr(generation, "CHUNK", 1)
    folder, plan = begun(tmp_path, STUDENTS)
    other = ClassFolder(tmp_path / "other")
    other.create(folder.settings, STUDENTS)
    with_papers(folder, plan, STUDENTS)
    executor = Mortal(2, tmp_path / "dead")
    try:
        with_papers(other, plan, STUDENTS, executor)
    finally:
        executor.shutdown()
    assert (tmp_path / "dead").exists()
    assert bytes_of(other.path) == bytes_of(folder.path)


@pytest.mark.slow
def test_papers_that_kill_every_worker_are_given_up_with_a_sentence():
    executor = ProcessExecutor(1)
    try:
        with pytest.raises(WorkerError, match="3 processes died"):
            executor.submit(always_dead).result()
    finally:
        executor.shutdown()


@pytest.mark.slow
def test_a_scheduler_that_is_not_there_is_named():
    with (
        pytest.raises(InvalidChoiceError, match=r"scheduler tcp://127\.0\.0\.1:1"),
        open_executor(1, "tcp://127.0.0.1:1"),
    ):
        pass


def test_marks_from_another_process_are_the_same_marks(tmp_path):
    marks = StudentMarks("4711001", (GradedClassPart("1", "a", "7", "correct", 2.0, 2.0),), "en")
    history = GradingHistory(tmp_path)
    history.write([marks])
    written = bytes_of(tmp_path)
    history.write([pickle.loads(pickle.dumps(marks))])
    assert bytes_of(tmp_path) == written

"""One command at a time writes in the folder of a class."""

from __future__ import annotations

import threading

import pytest

from quizgen.classes.lock import lock_folder
from quizgen.classes.rulings import Ruling, append_rulings, read_rulings
from quizgen.core.errors import ClassError


def test_a_second_command_waits_for_the_first(tmp_path):
    ruling = Ruling("drop", "rgb-to-hsv:a", who="me")
    with lock_folder(tmp_path):
        second = threading.Thread(target=append_rulings, args=(tmp_path, [ruling]))
        second.start()
        second.join(0.2)
        assert read_rulings(tmp_path) == []
    second.join()
    assert len(read_rulings(tmp_path)) == 1


def test_one_that_waited_too_long_is_told_so(tmp_path):
    with (
        lock_folder(tmp_path),
        pytest.raises(ClassError, match="another command writes there"),
        lock_folder(tmp_path, 0.0),
    ):
        pass


def test_it_is_let_go_of_after_an_error(tmp_path):
    with pytest.raises(ZeroDivisionError), lock_folder(tmp_path):
        raise ZeroDivisionError
    with lock_folder(tmp_path, 0.0):
        pass

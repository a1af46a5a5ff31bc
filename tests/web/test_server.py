"""Where a server listens, and what it has in common with the one before it."""

from __future__ import annotations

import asyncio
import socket
import time
from http.client import HTTPConnection

import pytest
from served import ran

from quizgen.web.server import _as_before, _listening
from quizgen.web.settings import Settings
from quizgen.web.site import Site
from quizgen.web.store import Store


def test_a_server_lets_in_whom_the_one_before_it_let_in(tmp_path):
    address = f"sqlite:///{tmp_path / 'learning.sqlite3'}"
    tokens = set()
    for _ in range(2):
        site = Site(Settings(address, workers=1))
        tokens.add(site.settings.token)
        site.close()
    assert len(tokens) == 1
    other = Site(Settings(f"sqlite:///{tmp_path / 'other.sqlite3'}", workers=1))
    assert other.settings.token not in tokens
    other.close()


def test_it_listens_on_the_port_of_the_first_time_while_that_is_free(tmp_path):
    store = Store(f"sqlite:///{tmp_path / 'learning.sqlite3'}")
    first = _as_before("127.0.0.1", store)
    port = first.getsockname()[1]
    first.listen()
    beside = _as_before("127.0.0.1", store)
    assert beside.getsockname()[1] != port
    beside.close()
    first.close()
    again = _as_before("127.0.0.1", store)
    assert again.getsockname()[1] == port
    again.close()
    store.close()


def test_an_answer_is_sent_before_what_went_before_it_is_acknowledged():
    found = []

    async def answer(_, there) -> None:
        sent_to = there.get_extra_info("socket")
        found.append(sent_to.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY))
        there.close()

    async def ask() -> None:
        listening = _listening("127.0.0.1", 0)
        async with await asyncio.start_server(answer, sock=listening):
            reader, writer = await asyncio.open_connection(*listening.getsockname())
            await reader.read()
            writer.close()
            await writer.wait_closed()

    ran(ask())
    assert found[0]


@pytest.mark.slow  # it waits
def test_a_connection_outlives_some_seconds_of_thought(served):
    kept = HTTPConnection("127.0.0.1", served.port)
    for pause in (0, 7):
        time.sleep(pause)
        kept.request("GET", "/static/app.css")
        assert kept.getresponse().read()
    kept.close()

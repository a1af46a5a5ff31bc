"""Where a server listens, and what it has in common with the one before it."""

from __future__ import annotations

import asyncio
import os
import re
import socket
import stat
import time
from http.client import HTTPConnection
from pathlib import Path

import pytest
import uvicorn
from served import ran
from starlette.testclient import TestClient

from quizgen.store import Store
from quizgen.web import server as own
from quizgen.web.app import create_app
from quizgen.web.server import _build_browser_url, _open_listening_socket, _open_previous_port
from quizgen.web.settings import ServerSettings

ADDRESS = "http://127.0.0.1:8000"


def test_a_server_lets_in_whom_the_one_before_it_let_in_and_knows_its_key_no_more(tmp_path):
    address = f"sqlite:///{tmp_path / 'learning.sqlite3'}"
    first = create_app(ServerSettings(address, workers=1))
    with TestClient(first, ADDRESS) as browser:
        key = first.state.site.settings.token
        assert browser.get(f"/enter?key={key}").status_code == 200
    second = create_app(ServerSettings(address, workers=1))
    with TestClient(second, ADDRESS, cookies=browser.cookies) as again:
        assert again.get("/progress").status_code == 200
        assert TestClient(second, ADDRESS).get(f"/enter?key={key}").status_code == 403
    other = create_app(ServerSettings(f"sqlite:///{tmp_path / 'other.sqlite3'}", workers=1))
    with TestClient(other, ADDRESS, cookies=browser.cookies) as elsewhere:
        assert elsewhere.get("/progress").status_code == 403


def test_the_browser_is_started_with_a_file_whose_key_lets_in_once(tmp_path, monkeypatch):
    """What a program is started with is read by everybody on the machine (``ps``)."""
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    app = create_app(ServerSettings(f"sqlite:///{tmp_path / 'l.sqlite3'}", workers=1))
    with TestClient(app, ADDRESS):
        site = app.state.site
        before = os.umask(0)
        started = _build_browser_url(site, f"{ADDRESS}/enter?key={site.settings.token}")
        os.umask(before)
        assert started.startswith("file://")
        assert "key" not in started
        page = Path(started.removeprefix("file://"))
        assert stat.S_IMODE(page.stat().st_mode) == 0o600
        there = re.search(r"url=([^\"]+)", page.read_text())[1]
        assert site.settings.token not in there
        assert TestClient(app, ADDRESS).get(there).status_code == 200
        assert not page.exists()
        assert TestClient(app, ADDRESS).get(there).status_code == 403
        unused = Path(_build_browser_url(site, f"{ADDRESS}/enter").removeprefix("file://"))
    assert not unused.exists(), "nobody has used it while the server ran"


@pytest.mark.parametrize("existing", [False, True])
def test_nobody_else_reads_the_database_whatever_the_umask(tmp_path, existing):
    file = tmp_path / "learning.sqlite3"
    before = os.umask(0)
    if existing:
        file.touch(0o666)
    store = Store(f"sqlite:///{file}")
    store.learner()
    modes = {path.name: stat.S_IMODE(path.stat().st_mode) for path in tmp_path.iterdir()}
    store.close()
    os.umask(before)
    assert modes == dict.fromkeys(modes, 0o600)
    assert "learning.sqlite3-wal" in modes


def test_it_listens_on_the_port_of_the_first_time_while_that_is_free(tmp_path):
    store = Store(f"sqlite:///{tmp_path / 'learning.sqlite3'}")
    first = _open_previous_port("127.0.0.1", store)
    port = first.getsockname()[1]
    first.listen()
    beside = _open_previous_port("127.0.0.1", store)
    assert beside.getsockname()[1] != port
    beside.close()
    first.close()
    again = _open_previous_port("127.0.0.1", store)
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
        listening = _open_listening_socket("127.0.0.1", 0)
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


@pytest.mark.parametrize(
    "sent",
    [b"", b"GET / HTTP/1.1\r\nHost: x\r\n", b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 9\r\n\r\nab"],
)  # fmt: skip
def test_a_request_that_never_comes_whole_is_given_up(monkeypatch, sent):
    monkeypatch.setattr(own, "HEAD", 0.05)
    monkeypatch.setattr(own, "BODY", 0.05)

    async def app(scope, receive, send) -> None:
        await receive()
        await asyncio.Event().wait()

    async def ask() -> tuple[bytes, int]:
        config = uvicorn.Config(app, http=own.TimedProtocol, lifespan="off", log_level="critical")
        config.load()
        server = uvicorn.Server(config)
        listening = _open_listening_socket("127.0.0.1", 0)
        loop = asyncio.get_running_loop()

        def protocol():
            return config.http_protocol_class(config, server.server_state, {})

        async with await loop.create_server(protocol, sock=listening):
            reader, writer = await asyncio.open_connection(*listening.getsockname())
            writer.write(sent)
            answer = await asyncio.wait_for(reader.read(), 20)
            writer.close()
            return answer, len(server.server_state.connections)

    assert ran(ask()) == (b"", 0), "closed, and nothing is kept of it"

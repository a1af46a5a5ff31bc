"""Firefox for Playwright, over WebDriver BiDi, but for commands that this Firefox lacks.

The Firefox of a distribution is older than the protocol of Playwright. So Playwright starts this
module in its place: it starts Firefox, hands on what both say, and answers what Firefox does not
know as if it had been done. What such commands would set stands in the profile.
"""

from __future__ import annotations

import asyncio
import json
import os
import re
import shlex
import sys
from pathlib import Path

ABSENT = frozenset({"emulation.setMediaFeaturesOverride"})
"""Commands that are answered here."""
LISTENS = re.compile(r"WebDriver BiDi listening on (ws://127\.0\.0\.1:\d+)")
MOST = 2**27
"""Bytes of one message: a picture of a page."""


def firefox(program: str, folder: Path, scheme: str):
    """What opens Firefox, given Playwright's driver; pages are light or dark by ``scheme``."""
    start = folder / "firefox"
    start.write_text(
        f'#!/bin/sh\nexec {shlex.quote(sys.executable)} {shlex.quote(__file__)} "$@"\n'
    )
    start.chmod(0o755)
    return lambda driver: driver.firefox.launch(
        channel="moz-firefox",
        executable_path=start,
        env={**os.environ, "FIREFOX": program},
        firefox_user_prefs={"ui.systemUsesDarkTheme": int(scheme == "dark")},
    )


async def pass_on(source, target, asker) -> None:
    """Hand on what one side says; answer what Firefox does not know."""
    async for message in source:
        said = json.loads(message)
        if said.get("method") in ABSENT:
            await asker.send(json.dumps({"type": "success", "id": said["id"], "result": {}}))
        else:
            await target.send(message)


async def run() -> None:
    """Run Firefox until it ends, and stand before it."""
    from websockets.asyncio.client import connect
    from websockets.asyncio.server import serve

    began = await asyncio.create_subprocess_exec(
        os.environ["FIREFOX"], *sys.argv[1:], stderr=asyncio.subprocess.PIPE
    )

    async def talk(client) -> None:
        async with connect(address + client.request.path, max_size=MOST) as server:
            ways = pass_on(client, server, client), pass_on(server, client, client)
            tasks = [asyncio.ensure_future(way) for way in ways]
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)

    async for line in began.stderr:
        if found := LISTENS.search(line.decode()):
            address = found[1]
            async with serve(talk, "127.0.0.1", 0, max_size=MOST) as before:
                port = before.sockets[0].getsockname()[1]
                print(
                    f"WebDriver BiDi listening on ws://127.0.0.1:{port}",
                    file=sys.stderr,
                    flush=True,
                )
                await began.communicate()
            return


if __name__ == "__main__":
    asyncio.run(run())

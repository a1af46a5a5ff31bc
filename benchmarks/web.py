"""What the browser waits for: ``uv run python benchmarks/web.py [SECONDS]``.

Starts a server of its own and asks it on a schedule, with a bounded number of requests: the echo
of what is typed 100 times a second, answers, the next question of somebody who looks at each for
a second, and 300 students whose exams save themselves every 5 seconds (60 seconds, or as many as
are given). Prints what half and what 95 and 99 of a hundred waited, beside what they may, errors,
CPU of the server for each request, and memory of all its processes; exit code 1 if one is over.
Waiting counts from when a request was due; the client shares the machine.
"""

from __future__ import annotations

import asyncio
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Awaitable, Callable
from pathlib import Path

import httpx2

STUDENTS, EVERY, PAPERS = 300, 5.0, 6
MEMORY = 400
FIRST_PAGE = 60_000
QUESTION = "point-to-image-plane"

over: list[str] = []


def told(name: str, value: float, most: float, unit: str, more: str = "") -> None:
    """Print a number beside its budget."""
    if value > most:
        over.append(name)
    print(f"{name:34} {value:9.1f} {unit:3} of {most:6.0f}{'  OVER' * (value > most)}  {more}")


class Served:
    """A server in processes of its own."""

    def __init__(self, folder: str) -> None:
        began = time.perf_counter()
        self.process = subprocess.Popen(
            [sys.executable, "-m", "quizgen", "serve", "--no-open", "--database",
             f"sqlite:///{folder}/x.sqlite3"],
            stdout=subprocess.PIPE, text=True, start_new_session=True,
        )  # fmt: skip
        self.entrance = self.process.stdout.readline().split()[-1]
        self.ready = time.perf_counter() - began

    def cpu(self) -> float:
        """CPU seconds of the process that answers."""
        fields = Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def memory(self) -> float:
        """Megabytes of all processes; what they share counts once."""
        found = 0
        for folder in Path("/proc").glob("[0-9]*"):
            try:
                if os.getpgid(int(folder.name)) == self.process.pid:
                    text = (folder / "smaps_rollup").read_text()
                    found += int(re.search(r"^Pss:\s+(\d+)", text, re.MULTILINE)[1])
            except (OSError, TypeError):
                continue
        return found / 1024

    def end(self) -> None:
        """End it as Ctrl-C does."""
        os.killpg(self.process.pid, signal.SIGINT)
        self.process.wait()


async def scheduled(
    served: Served, count: int, rate: float, ask: Callable[[int], Awaitable[httpx2.Response]]
) -> tuple[list[float], int, float]:
    """Ask ``count`` times, ``rate`` a second, however slow the answers are."""
    waited: list[float] = []
    wrong = 0
    cpu, begin = served.cpu(), time.perf_counter() + 0.1

    async def one(number: int) -> None:
        nonlocal wrong
        due = begin + number / rate
        await asyncio.sleep(max(0.0, due - time.perf_counter()))
        try:
            answer = await ask(number)
            wrong += answer.status_code not in {200, 303}
        except httpx2.HTTPError:
            wrong += 1
        waited.append(1000 * (time.perf_counter() - due))

    await asyncio.gather(*map(one, range(count)))
    return sorted(waited), wrong, 1000 * (served.cpu() - cpu) / count


def share(waited: list[float], of: float) -> float:
    return waited[min(len(waited) - 1, int(len(waited) * of))]


def report(
    name: str, result: tuple[list[float], int, float], most: float, of: float = 0.95
) -> None:
    waited, wrong, cpu = result
    told(f"{name}, p{100 * of:.0f}", share(waited, of), most, "ms",
         f"p50 {share(waited, 0.5):.1f}, p99 {share(waited, 0.99):.1f}, CPU {cpu:.1f} ms, "
         f"{len(waited)} requests")  # fmt: skip
    told(f"{name}, errors", wrong, 0, "")


async def practice(client: httpx2.AsyncClient, served: Served, token: str) -> None:
    sent = {"token": token, "template": QUESTION}
    at = (await client.post("/practice", data=sent)).headers["location"]
    await client.get(at)
    typed = {"token": token, "a": ["2/3", "0,5"]}
    report("echo at 100 a second", await scheduled(
        served, 500, 100, lambda _: client.post(f"{at}/1/read", data=typed)), 15)  # fmt: skip
    many = [
        (await client.post(f"{at}/again", data={"token": token})).headers["location"]
        for _ in range(100)
    ]
    report("answer marked, 20 a second", await scheduled(
        served, 100, 20, lambda n: client.post(f"{many[n]}/1", data=typed)), 40)  # fmt: skip
    report("its page, 20 a second", await scheduled(
        served, 100, 20, lambda n: client.get(many[n])), 60)  # fmt: skip

    async def following(_: int) -> httpx2.Response:
        nonlocal at
        at = (await client.post(f"{at}/next", data={"token": token})).headers["location"]
        return await client.get(at)

    report("next question, 1 a second", await scheduled(served, 40, 1, following), 60)


async def exams(client: httpx2.AsyncClient, served: Served, token: str, seconds: float) -> None:
    codes = []
    for _ in range(PAPERS):
        sent = {"token": token, "blueprint": "mock"}
        at = (await client.post("/exam", data=sent, timeout=60)).headers["location"]
        page = (await client.get(at)).text
        codes.append(re.search(r"<code>([\w.-]+)</code>", page)[1])
    parts = re.findall(r'<fieldset data-part="(\w+)"', page)
    sittings = [
        (await client.post("/exam", data={"token": token, "code": codes[n % PAPERS]}, timeout=60))
        .headers["location"]
        for n in range(STUDENTS)
    ]  # fmt: skip

    def save(number: int) -> Awaitable[httpx2.Response]:
        part = parts[number // STUDENTS % len(parts)]
        body = {"token": token, f"on-{part}": "", f"a-{part}": f"{number},5"}
        return client.post(sittings[number % STUDENTS], data=body,
                           headers={"accept": "application/json"})  # fmt: skip

    count = int(STUDENTS * seconds / EVERY)
    report("300 students save", await scheduled(served, count, STUDENTS / EVERY, save), 250, 0.99)
    report("an exam's page, 2 a second", await scheduled(
        served, 20, 2, lambda n: client.get(sittings[n])), 250)  # fmt: skip


async def first_page(client: httpx2.AsyncClient) -> None:
    page = await client.get("/")
    size, found = (
        page.num_bytes_downloaded,
        re.findall(r'(?:src|href)="(/static/[^"]+)"', page.text),
    )
    for address in found:
        async with client.stream("GET", address) as answer:
            async for _ in answer.aiter_raw():
                pass
            size += answer.num_bytes_downloaded
    told("first page besides fonts", size / 1000, FIRST_PAGE / 1000, "kB")


async def ask(served: Served, seconds: float) -> None:
    limits = httpx2.Limits(max_connections=100, max_keepalive_connections=100)
    base, _, _ = served.entrance.partition("/enter")
    async with httpx2.AsyncClient(base_url=base, limits=limits, timeout=30) as client:
        await client.get(served.entrance)
        token = re.search(r'name="token" value="(\w+)"', (await client.get("/")).text)[1]
        await first_page(client)
        await practice(client, served, token)
        await exams(client, served, token, seconds)


def main(seconds: float) -> int:
    with tempfile.TemporaryDirectory() as folder:
        served = Served(folder)
        try:
            told("ready", 1000 * served.ready, 1000, "ms")
            asyncio.run(ask(served, seconds))
            told("memory", served.memory(), MEMORY, "MB")
        finally:
            served.end()
    return bool(over)


if __name__ == "__main__":
    sys.exit(main(float(sys.argv[1]) if len(sys.argv) > 1 else 60))

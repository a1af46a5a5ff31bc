"""What the browser waits for: ``uv run python benchmarks/web.py [SECONDS]``.

Starts a server of its own and asks it on a schedule, with a bounded number of requests: the echo
of what is typed 100 times a second, answers, wrong ones with the page that draws them, the next
part, the next question of somebody who looks at each for a second. Then 300 learners with papers
of their own, made ahead, begin within 10 seconds, save every 5 seconds (60 seconds, or as many as
are given) and hand in within 10. Beside them are four who mean harm: one sends halves of requests,
one wrong passwords, one begins long exams as one of the learners who may, one sends answers under
parts that no paper has; what they are answered counts nowhere. ``--exam`` leaves the first part
out. ``--class N`` (or ``N:BLUEPRINT``, if not mock) has only a class of N students, with papers of
its folder, come in by their codes, begin, save, ask what has changed, and hand in; it ends when
all forms are in the folder. Prints what half and what 95 and 99 of a hundred waited, beside what
they may, errors, CPU of the server for each request, and memory of all its processes; exit code 1
if one is over. Waiting counts from when a request was due; the client shares the machine.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Awaitable, Callable
from http.cookiejar import DefaultCookiePolicy
from pathlib import Path

import httpx2
from sqlalchemy import func, insert, select

from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.seats import DATABASE, entry_code
from quizgen.store import Store
from quizgen.store.schema import ACCOUNT, LEARNER, STOCK
from quizgen.web.auth import COOKIE, csrf_token
from quizgen.web.server import allow_connections

STUDENTS, EVERY, WITHIN = 300, 5.0, 10.0
MEMORY, MEMORY_OF_CLASS = 400, 700
FIRST_PAGE = 60_000
QUESTION = "point-to-image-plane"
QUESTION_OF_PARTS = "recognise-and-sketch-distortion"

over: list[str] = []


def told(name: str, value: float, most: float, unit: str, more: str = "") -> None:
    """Print a number beside its budget."""
    if value > most:
        over.append(name)
    print(f"{name:34} {value:9.1f} {unit:3} of {most:6.0f}{'  OVER' * (value > most)}  {more}")


class Served:
    """A server in processes of its own."""

    def __init__(
        self, folder: str, file: str = "x.sqlite3", *more: str, command: tuple[str, ...] = ()
    ) -> None:
        began = time.perf_counter()
        own = ("serve", "--database", f"sqlite:///{folder}/{file}")
        self.process = subprocess.Popen(
            [sys.executable, "-m", "quizgen", *(command or own), "--no-open", *more],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, start_new_session=True,
        )  # fmt: skip
        self.entrance = self.process.stdout.readline().split()[-1]
        self.ready = time.perf_counter() - began

    def cpu(self) -> float:
        """CPU seconds of the process that answers."""
        fields = Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def memory(self) -> float:
        """Megabytes of all processes; what they share counts once."""
        return sum(self.list_memory())

    def list_memory(self) -> list[float]:
        """Megabytes of each process, the largest first; what they share is shared out."""
        found = []
        for folder in Path("/proc").glob("[0-9]*"):
            try:
                if os.getpgid(int(folder.name)) == self.process.pid:
                    text = (folder / "smaps_rollup").read_text()
                    kilobytes = int(re.search(r"^Pss:\s+(\d+)", text, re.MULTILINE)[1])
                    found.append(kilobytes / 1024)
            except (OSError, TypeError):
                continue
        return sorted(found, reverse=True)

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

    async def verdict(number: int) -> httpx2.Response:
        """Answer with a wrong value, and get the page on which it is drawn."""
        wrong = {"token": token, "a": [str(number + 3), "-7"]}
        return await client.get(
            (await client.post(f"{many[number]}/1", data=wrong)).headers["location"]
        )

    many = [
        (await client.post(f"{at}/again", data={"token": token})).headers["location"]
        for _ in range(60)
    ]
    report("verdict and its page, 2 a second", await scheduled(served, 60, 2, verdict), 60)
    parts = {"token": token, "template": QUESTION_OF_PARTS}
    of = (await client.post("/practice", data=parts)).headers["location"]
    await client.get(of)

    async def part(number: int) -> httpx2.Response:
        return await client.get(of, params={"part": f"1{'ab'[number % 2]}"})

    report("next part, 2 a second", await scheduled(served, 60, 2, part), 80)

    async def following(_: int) -> httpx2.Response:
        nonlocal at
        at = (await client.post(f"{at}/next", data={"token": token})).headers["location"]
        return await client.get(at)

    report("next question, 1 a second", await scheduled(served, 40, 1, following), 60)


ATTACKERS = 2
"""Learners with accounts who mean harm: one begins long exams, one sends invented parts."""
HALVES = 1100
"""Requests of which only a part is ever sent, open at the same time."""


class Class:
    """Learners with sessions of their own, as if each had signed in; they sit the mock exam.

    Parameters
    ----------
    database : str
        Address of the database of a server where people sign in.
    """

    def __init__(self, database: str) -> None:
        store = Store(database)
        with store.database.writing() as connection:
            for number in range(STUDENTS + ATTACKERS):
                row = {"name": f"s{number}", "settings": {}, "since": time.time()}
                (learner,) = connection.execute(insert(LEARNER).values(row)).inserted_primary_key
                account = {"key": f"s{number}", "password": "", "manages": False}
                connection.execute(insert(ACCOUNT).values(learner=learner, **account))
        self.tokens = [
            store.accounts.start_session(store.learner(f"s{number}").id)
            for number in range(STUDENTS + ATTACKERS)
        ]
        store.close()
        self.sittings: dict[int, str] = {}
        self.parts: dict[int, list[str]] = {}
        self.marked = 0.0

    def _who(self, number: int) -> dict[str, str]:
        return {"cookie": f"{COOKIE}={self.tokens[number]}", "accept": "application/json"}

    async def begin(self, client: httpx2.AsyncClient, number: int) -> httpx2.Response:
        """Begin a paper of one's own and see it."""
        sent = {"token": csrf_token(self.tokens[number]), "blueprint": "mock"}
        answer = await client.post("/exam", data=sent, headers=self._who(number))
        self.sittings[number] = answer.headers.get("location", "/")
        page = await client.get(self.sittings[number], headers=self._who(number))
        self.parts[number] = re.findall(r'<fieldset data-part="(\w+)"', page.text) or ["1"]
        return page

    async def save(self, client: httpx2.AsyncClient, number: int) -> httpx2.Response:
        """Save an answer, as a page of somebody who has begun does every few seconds."""
        count = len(self.parts)
        who = [*self.parts][number % count]
        part = self.parts[who][number // count % len(self.parts[who])]
        body = {"token": csrf_token(self.tokens[who]), f"on-{part}": "", f"a-{part}": f"{number},5"}
        return await client.post(self.sittings[who], data=body, headers=self._who(who))

    async def hand_in(self, client: httpx2.AsyncClient, number: int) -> httpx2.Response:
        """Hand in and see the marks."""
        sent = {"token": csrf_token(self.tokens[number]), "do": "hand-in"}
        at = self.sittings[number]
        answer = await client.post(at, data=sent, headers=self._who(number))
        if answer.status_code == 303:
            answer = await client.get(at, headers=self._who(number))
            if f'data-handed="{at.rpartition("/")[2]}"' not in answer.text:
                raise httpx2.HTTPError("no marks")
        self.marked = time.perf_counter()
        return answer


class Attackers:
    """One of each who means harm, each with a connection pool of their own.

    Parameters
    ----------
    sat : Class
    port : int
        Where the server listens.
    """

    def __init__(self, sat: Class, port: int) -> None:
        self.sat, self.port = sat, port
        self.base = f"http://127.0.0.1:{port}"
        self.done = dict.fromkeys(("halves", "passwords", "exams", "parts"), 0)
        self.answers: dict[str, set[int]] = {name: set() for name in self.done}

    async def attack(self) -> None:
        """Go on until cancelled."""
        limits = httpx2.Limits(max_connections=20)
        async with httpx2.AsyncClient(base_url=self.base, limits=limits, timeout=120) as client:
            await asyncio.gather(
                self._send_halves(),
                *(self._repeat("passwords", 0.0, client, self._guess) for _ in range(4)),
                *(self._repeat("exams", 0.0, client, self._begin_long) for _ in range(8)),
                *(self._repeat("parts", 0.05, client, self._invent_parts) for _ in range(2)),
            )

    async def _send_halves(self) -> None:
        """Hold as many half-sent requests as ``HALVES``; one that is shut is opened again."""

        async def hold() -> None:
            while True:
                with contextlib.suppress(OSError):
                    reader, writer = await asyncio.open_connection("127.0.0.1", self.port)
                    self.done["halves"] += 1
                    writer.write(b"POST /exam HTTP/1.1\r\nhost: 127.0.0.1\r\n")
                    await reader.read()  # until the server has had enough
                    writer.close()
                await asyncio.sleep(0.5)

        await asyncio.gather(*(hold() for _ in range(HALVES)))

    async def _repeat(
        self,
        name: str,
        pause: float,
        client: httpx2.AsyncClient,
        ask: Callable[[httpx2.AsyncClient, int], Awaitable[httpx2.Response]],
    ) -> None:
        while True:
            with contextlib.suppress(httpx2.HTTPError):
                answer = await ask(client, self.done[name])
                self.done[name] += 1
                self.answers[name].add(answer.status_code)
                if answer.status_code == 429:
                    await asyncio.sleep(0.2)
            await asyncio.sleep(pause)

    async def _guess(self, client: httpx2.AsyncClient, number: int) -> httpx2.Response:
        """A wrong password for another name each time."""
        page = await client.get("/sign-in", headers={"accept": "text/html"})
        token = re.search(r'name="token" value="(\w+)"', page.text)[1]
        sent = {"token": token, "name": f"s{number % STUDENTS}", "password": "wrong guess"}
        return await client.post("/sign-in", data=sent)

    async def _begin_long(self, client: httpx2.AsyncClient, _: int) -> httpx2.Response:
        """An exam of everything, as long as is allowed."""
        token = self.sat.tokens[STUDENTS]
        sent = {"token": csrf_token(token), "blueprint": "all", "minutes": "300"}
        return await client.post("/exam", data=sent, headers={"cookie": f"{COOKIE}={token}"})

    async def _invent_parts(self, client: httpx2.AsyncClient, number: int) -> httpx2.Response:
        """Answers of 500 kB under parts that the paper has not."""
        token = self.sat.tokens[STUDENTS + 1]
        mine = {"cookie": f"{COOKIE}={token}", "accept": "application/json"}
        if not hasattr(self, "own"):
            sent = {"token": csrf_token(token), "blueprint": "trial"}
            self.own = (await client.post("/exam", data=sent, headers=mine)).headers["location"]
        parts = {f"{kind}-{n}zz": "x" * 9000 for n in range(900, 927) for kind in ("on", "a")}
        return await client.post(
            self.own, data={"token": csrf_token(token), **parts, "number": number}, headers=mine
        )


async def wait_for_stock(database: str) -> float:
    """Seconds until a paper waits for each learner."""
    began, store = time.perf_counter(), Store(database)
    with contextlib.closing(store):
        while True:
            with store.database.reading() as connection:
                if connection.execute(select(func.count()).select_from(STOCK)).scalar() >= STUDENTS:
                    return time.perf_counter() - began
            await asyncio.sleep(1)


async def exams(folder: str, seconds: float) -> None:
    """300 learners with papers of their own: all begin in 10 s, save, hand in in 10 s."""
    database = f"sqlite:///{folder}/class.sqlite3"
    served = Served(
        folder, "class.sqlite3", "--host", "0.0.0.0", "--papers-ahead", f"mock={STUDENTS}"
    )
    try:
        port = int(re.search(r":(\d+)/", served.entrance)[1])
        sat = Class(database)
        print(f"{STUDENTS} papers made ahead in {await wait_for_stock(database):.0f} s")
        told("memory before an exam", served.memory(), MEMORY, "MB")
        attackers = Attackers(sat, port)
        attacking = asyncio.ensure_future(attackers.attack())
        limits = httpx2.Limits(max_connections=400, max_keepalive_connections=400)
        async with httpx2.AsyncClient(
            base_url=f"http://127.0.0.1:{port}", limits=limits, timeout=120
        ) as client:
            each = STUDENTS / WITHIN
            report("300 learners begin", await scheduled(
                served, STUDENTS, each, lambda n: sat.begin(client, n)), 8000)  # fmt: skip
            count = int(STUDENTS * seconds / EVERY)
            saved = await scheduled(served, count, STUDENTS / EVERY, lambda n: sat.save(client, n))
            report("300 learners save", saved, 500, 0.99)
            due = time.perf_counter() + WITHIN
            report("300 learners hand in", await scheduled(
                served, STUDENTS, each, lambda n: sat.hand_in(client, n)), 60_000)  # fmt: skip
            told("last marks after the last due", max(0.0, sat.marked - due), 60, "s")
        attacking.cancel()
        for name, count in attackers.done.items():
            print(f"attacker, {name}: {count} requests, answers {sorted(attackers.answers[name])}")
        each = " + ".join(f"{one:.0f}" for one in served.list_memory())
        told("memory in an exam", served.memory(), MEMORY_OF_CLASS, "MB", each)
    finally:
        served.end()


class Seated(Class):
    """Students of a class's folder, who come in by the codes of their cards.

    Parameters
    ----------
    folder : ClassFolder
    """

    def __init__(self, folder: ClassFolder) -> None:
        self.codes = [entry_code(folder.settings.secret, one.id, 0) for one in folder.students()]
        self.tokens = [""] * len(self.codes)
        self.sittings, self.parts, self.tags, self.marked = {}, {}, {}, 0.0

    async def begin(self, client: httpx2.AsyncClient, number: int) -> httpx2.Response:
        """Come in, begin, and see the paper."""
        door = await client.get("/")
        token = door.headers["set-cookie"].partition("=")[2].partition(";")[0]
        sent = {"token": csrf_token(token), "code": self.codes[number]}
        inside = await client.post("/", data=sent, headers={"cookie": f"{COOKIE}={token}"})
        self.tokens[number] = inside.headers["set-cookie"].partition("=")[2].partition(";")[0]
        return await self._see_paper(client, number)

    async def _see_paper(self, client: httpx2.AsyncClient, number: int) -> httpx2.Response:
        """Press the button and read the page."""
        who = self._who(number)
        sent = {"token": csrf_token(self.tokens[number])}
        begun = await client.post("/seat/begin", data=sent, headers=who)
        self.sittings[number] = begun.headers.get("location", "/")
        page = await client.get(self.sittings[number], headers=who)
        self.parts[number] = re.findall(r'<fieldset data-part="(\w+)"', page.text) or ["1"]
        self.tags[number] = re.search(r"tag=(\w+)", page.text)[1]
        return page

    async def ask(self, client: httpx2.AsyncClient, number: int) -> httpx2.Response:
        """Ask whether anything has changed, as a page does every 8 s."""
        who = [*self.tags][number % len(self.tags)]
        at = f"/seat/state?tag={self.tags[who]}"
        answer = await client.get(at, headers=self._who(who))
        answer.status_code = 200 if answer.status_code == 204 else 500
        return answer

    async def hand_in(self, client: httpx2.AsyncClient, number: int) -> httpx2.Response:
        """Hand in; what is marked is the form in the folder."""
        if number not in self.sittings:
            raise httpx2.HTTPError("has not begun")
        sent = {"token": csrf_token(self.tokens[number]), "do": "hand-in"}
        return await client.post(self.sittings[number], data=sent, headers=self._who(number))


def make_class(folder: Path, count: int, blueprint: str) -> ClassFolder:
    """A class that may begin now; a paper of the mock exam takes a third of a second."""
    lines = ["id,name", *(f"{4711000 + n},Student {n}" for n in range(count))]
    (folder / "roster.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    about = "[browser]\nbegins = 2020-01-01T10:00:00\n"
    (folder / "exam.toml").write_text(about, encoding="utf-8")
    command = [sys.executable, "-m", "quizgen", "class", "make", str(folder / "roster.csv"),
               "--out", str(folder / "class"), "--about", str(folder / "exam.toml"),
               "--blueprint", blueprint]  # fmt: skip
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return ClassFolder(folder / "class")


def wait_for_papers(folder: Path) -> float:
    """Seconds until each student's paper is made."""
    began, store = time.perf_counter(), Store(f"sqlite:///{folder / DATABASE}")
    with contextlib.closing(store):
        while any(one.paper is None for one in store.seats.list_seats()):
            time.sleep(0.5)
    return time.perf_counter() - began


def wait_for_files(folder: Path, count: int, most: float) -> float:
    """Seconds until a folder has so many files."""
    began = time.perf_counter()
    while time.perf_counter() - began < most and len([*folder.glob("*.json")]) < count:
        time.sleep(0.2)
    return time.perf_counter() - began


async def class_exam(place: str, count: int, blueprint: str, seconds: float) -> None:
    """A class with papers of its folder: all come in and begin in 10 s, save, hand in in 10 s."""
    folder = make_class(Path(place), count, blueprint)
    served = Served(place, "x.sqlite3", command=("class", "open", str(folder.path)))
    try:
        print(f"{count} papers made ahead in {wait_for_papers(folder.path):.0f} s")
        seated = Seated(folder)
        port = int(re.search(r":(\d+)/", served.entrance)[1])
        limits = httpx2.Limits(max_connections=400, max_keepalive_connections=400)
        async with httpx2.AsyncClient(
            base_url=f"http://127.0.0.1:{port}", limits=limits, timeout=120
        ) as client:
            client.cookies.jar.set_policy(
                DefaultCookiePolicy(allowed_domains=[])
            )  # each has others
            each = count / WITHIN
            report(f"{count} come in and begin", await scheduled(
                served, count, each, lambda n: seated.begin(client, n)), 8000)  # fmt: skip
            saved, asked = await asyncio.gather(
                scheduled(served, int(count * seconds / EVERY), count / EVERY,
                          lambda n: seated.save(client, n)),
                scheduled(served, int(count * seconds / 8), count / 8,
                          lambda n: seated.ask(client, n)),
            )  # fmt: skip
            report(f"{count} save", saved, 500, 0.99)
            report(f"{count} ask for news", asked, 500, 0.99)
            report(f"{count} hand in", await scheduled(
                served, count, each, lambda n: seated.hand_in(client, n)), 8000)  # fmt: skip
        stored = wait_for_files(folder.path / "answers" / "browser", count, 120)
        told("last form in the folder", stored, 60, "s")
        told("memory in an exam", served.memory(), MEMORY_OF_CLASS, "MB")
    finally:
        served.end()


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


async def ask(served: Served) -> None:
    limits = httpx2.Limits(max_connections=100, max_keepalive_connections=100)
    base, _, _ = served.entrance.partition("/enter")
    async with httpx2.AsyncClient(base_url=base, limits=limits, timeout=30) as client:
        await client.get(served.entrance)
        token = re.search(r'name="token" value="(\w+)"', (await client.get("/")).text)[1]
        await first_page(client)
        await practice(client, served, token)


def main(seconds: float, *, alone: bool) -> int:
    with tempfile.TemporaryDirectory() as folder:
        if not alone:
            one_learner(folder)
        asyncio.run(exams(folder, seconds))
    return bool(over)


def one_learner(folder: str) -> None:
    served = Served(folder)
    try:
        told("ready", 1000 * served.ready, 1000, "ms")
        asyncio.run(ask(served))
        told("memory", served.memory(), MEMORY, "MB")
    finally:
        served.end()


if __name__ == "__main__":
    given = [one for one in sys.argv[1:] if one != "--exam"]
    allow_connections()
    if "--class" in given:
        count, _, name = given.pop(given.index("--class") + 1).partition(":")
        given.remove("--class")
        with tempfile.TemporaryDirectory() as place:
            asyncio.run(class_exam(place, int(count), name or "mock", float((given or ["60"])[0])))
        sys.exit(bool(over))
    sys.exit(main(float(given[0]) if given else 60, alone="--exam" in sys.argv))

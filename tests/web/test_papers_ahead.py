"""Papers made ahead: each for one learner, none of another bank, and none where none is left."""

from __future__ import annotations

import re
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from click.testing import CliRunner
from own_bank import NAME, own_bank
from sqlalchemy import func, insert, select
from starlette.testclient import TestClient

from quizgen.bank.bank import Bank
from quizgen.cli.serve import serve as serve_command
from quizgen.store import Packed, Store
from quizgen.store.schema import LEARNER, PAPER, STOCK
from quizgen.web import papers_ahead
from quizgen.web.app import create_app
from quizgen.web.auth import COOKIE, csrf_token
from quizgen.web.settings import ServerSettings

BLUEPRINT = f"""[title]
en = "Short"
[[slot]]
templates = ["{NAME}"]
"""


def packed(number: int, blueprint: str = "mock") -> Packed:
    """A paper that nobody looks into."""
    code = f"{blueprint}-{number}-both-000000"
    return Packed(f"{number:064d}", code, b"packed", 45, None, ("1",))


def add_learners(store: Store, count: int) -> list[int]:
    """Ids of new learners."""
    with store.database.writing() as connection:
        return [
            connection.execute(
                insert(LEARNER).values(name=f"s{number}", settings={}, since=0.0)
            ).inserted_primary_key[0]
            for number in range(count)
        ]


def count_rows(store: Store, table) -> int:
    with store.database.reading() as connection:
        return connection.execute(select(func.count()).select_from(table)).scalar_one()


@pytest.fixture
def stores(database):
    """The stores of two servers on one database."""
    address = database()
    found = [Store(address) for _ in range(2)]
    yield found
    for store in found:
        store.close()


def begin(store: Store, learner: int, blueprint: str = "mock", version: str = "v"):
    return store.stock.begin_exam(learner, blueprint, version, has_clock=True, pauses=True)


@pytest.mark.both_databases
class TestStock:
    def test_of_a_crowd_at_two_servers_each_gets_a_paper_of_their_own(self, stores):
        learners = add_learners(stores[0], 24)
        for number in range(20):
            assert stores[0].stock.add_paper("mock", "v", packed(number))
        with ThreadPoolExecutor(12) as threads:
            begun = list(
                threads.map(lambda n: begin(stores[n % 2], learners[n]), range(len(learners)))
            )
        given = [exam.code for exam in begun if exam is not None]
        assert sorted(given) == sorted(packed(number).code for number in range(20))
        assert stores[1].stock.count_papers("mock", "v") == 0
        assert stores[1].stock.is_empty()
        for learner, exam in zip(learners, begun, strict=True):
            assert stores[0].sittings.latest(learner) == ([exam] if exam else [])

    def test_an_exam_of_the_stock_is_as_its_paper_says(self, stores):
        (store, _), (me,) = stores, add_learners(stores[0], 1)
        store.stock.add_paper("mock", "v", packed(1))
        exam = begin(store, me)
        assert (exam.code, exam.limit, exam.pauses, exam.learner) == (
            "mock-1-both-000000", 2700.0, True, me,
        )  # fmt: skip
        assert store.sittings.paper(exam.paper) == b"packed"
        assert store.sittings.find(me, exam.id) == exam

    def test_nobody_empties_it_by_beginning_again_and_again(self, stores):
        store, (greedy, modest) = stores[0], add_learners(stores[0], 2)
        for number in range(3):
            store.stock.add_paper("mock", "v", packed(number))
        store.stock.add_paper("trial", "v", packed(9, "trial"))
        first = begin(store, greedy)
        assert begin(store, greedy) is None
        store.sittings.hand_in(first)
        assert begin(store, greedy) is None
        assert begin(store, greedy, "trial") is not None
        assert begin(store, modest) is not None

    def test_a_paper_that_somebody_sits_is_given_to_nobody_else(self, stores):
        store, (me, _) = stores[0], add_learners(stores[0], 2)
        store.sittings.begin(me, packed(1).code, None, pauses=True, paper=packed(1))
        assert not store.stock.add_paper("mock", "v", packed(1))
        store.stock.add_paper("mock", "v", packed(2))
        assert not store.stock.add_paper("mock", "v", packed(2))
        assert store.stock.count_papers("mock", "v") == 1

    def test_of_another_version_nothing_is_given_and_all_is_dropped(self, stores):
        store, (me, other) = stores[0], add_learners(stores[0], 2)
        for number in range(3):
            store.stock.add_paper("mock", "old", packed(number))
        store.stock.add_paper("mock", "new", packed(7))
        exam = begin(store, me, version="old")
        assert begin(store, other, version="newest") is None
        assert store.stock.drop_other_versions("new") == 2
        assert begin(store, other, version="old") is None
        assert store.stock.count_papers("mock", "new") == 1
        assert store.sittings.paper(exam.paper) == b"packed"
        assert count_rows(store, PAPER) == 2  # the one that is sat, and the one that waits

    def test_who_is_removed_takes_no_paper_that_waits(self, stores):
        store, (me, other) = stores[0], add_learners(stores[0], 2)
        for number in range(2):
            store.stock.add_paper("mock", "v", packed(number))
        begin(store, me)
        store.accounts.remove(me)
        assert count_rows(store, PAPER) == 1
        assert begin(store, other) is not None


class Browser:
    """A browser at a server that has papers made ahead, and was let in."""

    def __init__(self, address, root, ahead=(("short", 2),)) -> None:
        bank = Bank(root, trusted=True)
        app = create_app(ServerSettings(address, bank=bank, workers=1, papers_ahead=ahead))
        self.site = app.state.site
        self.client = TestClient(app, "http://127.0.0.1:8000")
        self.client.__enter__()
        self.client.get(f"/enter?key={self.site.settings.token}")
        self.token = csrf_token(self.client.cookies[COOKIE])

    def stocked(self) -> set[str]:
        """Codes of papers that wait."""
        with self.site.store.database.reading() as connection:
            query = select(PAPER.c.code).join(STOCK, STOCK.c.paper == PAPER.c.id)
            return set(connection.execute(query).scalars())

    def wait_for_stock(self, count: int) -> set[str]:
        """Codes of papers that wait once there are as many."""
        last = time.monotonic() + 60
        while len(found := self.stocked()) < count:
            assert time.monotonic() < last, "no papers are made"
            time.sleep(0.05)
        return found

    def begin(self, **sent) -> str:
        """Code of the exam that is begun."""
        data = {"token": self.token, "blueprint": "short", **sent}
        page = self.client.post("/exam", data=data)
        assert page.status_code == 200
        return re.search(r"<code>([^<]+)</code>", page.text)[1]

    def end(self):
        self.client.__exit__(None, None, None)


@pytest.fixture
def bank_folder(tmp_path):
    own_bank(tmp_path)
    (tmp_path / "templates" / "blueprints").mkdir()
    (tmp_path / "templates" / "blueprints" / "short.toml").write_text(BLUEPRINT)
    return tmp_path


@pytest.fixture
def serve(database, bank_folder, monkeypatch):
    """Starts a server of the database and the bank, in place of the one before."""
    for name in ("QUIET", "LOOK", "IDLE_LOOK"):
        monkeypatch.setattr(papers_ahead, name, 0.01)
    address, began = database(), []

    def start(**more) -> Browser:
        while began:
            began.pop().end()
        began.append(Browser(address, bank_folder, **more))
        return began[0]

    yield start
    while began:
        began.pop().end()


def test_a_file_of_the_bank_that_changes_is_another_version(bank_folder):
    bank = Bank(bank_folder, trusted=True)
    before = papers_ahead.compute_stock_version(bank)
    solver = next((bank_folder / "solvers").rglob("*.py"))
    solver.write_text(solver.read_text("utf-8") + "\n", "utf-8")
    assert papers_ahead.compute_stock_version(bank) != before


@pytest.mark.slow
class TestServer:
    def test_exams_begin_with_papers_of_the_stock_which_is_filled_again(self, serve):
        browser = serve()
        waiting = browser.wait_for_stock(2)
        seeds = sorted(int(code.split("-")[1]) for code in waiting)
        assert all(seed > 1000 for seed in seeds)
        assert seeds[1] - seeds[0] > 1000  # drawn and not counted
        code = browser.begin()
        assert code in waiting
        waiting = browser.wait_for_stock(2)
        assert code not in waiting
        assert browser.begin(code=code) == code  # its own, and none of the stock
        assert browser.stocked() == waiting
        assert browser.begin() not in waiting  # nobody empties it

    def test_without_a_paper_that_waits_one_is_made(self, serve):
        browser = serve(ahead=())
        assert browser.begin().startswith("short-")
        assert browser.stocked() == set()

    def test_the_next_server_gives_what_the_one_before_has_made(self, serve):
        waiting = serve().wait_for_stock(2)
        browser = serve()
        assert browser.wait_for_stock(2) == waiting

    def test_a_changed_bank_drops_what_was_made_of_it(self, serve, bank_folder):
        old = serve().wait_for_stock(2)
        file = bank_folder / "templates" / "projection" / NAME / "template.toml"
        file.write_text(f"{file.read_text()}\n# changed\n")
        browser = serve()
        last = time.monotonic() + 60
        while old & browser.stocked() or len(browser.stocked()) < 2:
            assert time.monotonic() < last, "the stock of the old bank is still there"
            time.sleep(0.05)
        assert browser.begin() not in old

    def test_another_version_drops_what_was_made_by_it(self, serve, monkeypatch):
        old = serve().wait_for_stock(2)
        monkeypatch.setattr("quizgen.__version__", "99.0")
        browser = serve(ahead=())
        last = time.monotonic() + 60
        while browser.stocked():
            assert time.monotonic() < last, "the stock of the other version is still there"
            time.sleep(0.05)
        assert browser.begin() not in old


@pytest.mark.parametrize(
    ("given", "complaint"),
    [
        (["mock"], "'mock' is not like mock=300"),
        (["mock=many"], "'mock=many' is not like mock=300"),
        (["mock=0"], "1 to 5000 papers"),
        (["mock=5001"], "1 to 5000 papers"),
        (["nowhere=3"], "no blueprint 'nowhere' (mock"),
        (["../mock=3"], "no blueprint '../mock'"),
        (["mock=3", "mock=4"], "mock stands there twice"),
    ],
)
def test_what_cannot_be_made_ahead_is_refused(given, complaint, tmp_path):
    options = [part for one in given for part in ("--papers-ahead", one)]
    database = f"sqlite:///{tmp_path / 'x.sqlite3'}"
    done = CliRunner().invoke(serve_command, [*options, "--database", database])
    assert done.exit_code == 2
    assert complaint in " ".join(done.output.replace("│", " ").split())

"""One evening: start, one part on a screen, a block with its end, one's own value in the figure."""

from __future__ import annotations

import html
import re
from datetime import datetime, timedelta

import msgspec
import pytest

from quizgen.practice.scheduler import local_date
from quizgen.practice.session_state import PartOutcome, PartState
from quizgen.store import AttemptRecord, OutcomeRecord
from quizgen.web.block import PracticeBlockView

pytestmark = pytest.mark.usefixtures("nothing_done")
POINT = "point-to-image-plane"


def text(page: str) -> str:
    return html.unescape(" ".join(re.sub(r"<[^>]*>", " ", page).split()))


def give_up(client, token, page):
    """Show the solution of every part of a question that was begun; its address."""
    at = page.url.path
    for part in dict.fromkeys(re.findall(r"\?part=(\w+)", page.text)):
        client.post(f"{at}/{part}", data={"token": token, "do": "solution"})
    return at


def test_the_start_asks_two_things_and_begins(client, token, app):
    first = client.get("/").text
    assert (
        len(
            text(
                re.search(r'<section class="start-page".*?</section>', first, re.DOTALL)[0]
            ).split()
        )
        < 90
    )
    page = client.post("/start", data={"token": token, "days": "7", "minutes": "15"})
    assert page.url.path.startswith("/q/")
    store = app.state.site.store
    settings = store.learner().settings
    began = store.latest(store.learner().id, 1)[0].begun
    assert settings["exam"] == str(local_date(began) + timedelta(days=7))
    assert settings["minutes"] == "15"
    assert 'class="start-page"' not in client.get("/").text


@pytest.mark.parametrize("days", ["", "-1", "many", "99999"])
def test_no_day_is_no_obstacle(client, token, app, days):
    page = client.post("/start", data={"token": token, "days": days, "minutes": "0"})
    assert page.url.path.startswith("/q/")
    assert "exam" not in app.state.site.store.learner().settings


def test_a_part_is_shown_alone_and_leads_to_the_next(client, token, begin):
    at = begin("rgb-to-hsv")
    page = client.get(at).text
    shown = re.findall(r'<section class="part[^"]*" id="part-(\w+)"', page)
    others = dict.fromkeys(re.findall(r"\?part=(\w+)", page))
    assert shown == [next(iter(others))]
    done = client.post(f"{at}/{shown[0]}", data={"token": token, "do": "solution"}).text
    coming = list(others)[1]
    assert f'<a class="button main" href="{at}?part={coming}"' in done
    assert f'id="part-{coming}"' in client.get(at).text, "what is open comes first"
    assert f'id="part-{shown[0]}"' in client.get(at, params={"part": shown[0]}).text


def test_the_solution_comes_after_a_try_or_help(client, token, begin):
    at = begin(POINT)
    assert 'value="solution"' not in client.get(at).text
    helped = client.post(f"{at}/1", data={"token": token, "do": "hint"}).text
    assert '<li class="on">Hint</li>' in helped
    assert 'value="solution"' not in helped
    tried = client.post(f"{at}/1", data={"token": token, "a": ["1", "2"]}).text
    assert 'value="solution"' in tried


def test_a_block_ends_with_what_it_brought(client, token, app):
    page = client.post("/start", data={"token": token, "days": "1", "minutes": "15"})
    size = int(re.search(r'aria-label="Question 1 of (\d+)"', page.text)[1])
    for number in range(size):
        assert page.text.count('<li class="hollow"></li>') == number
        at = give_up(client, token, page)
        page = client.post(f"{at}/next", data={"token": token})
    assert page.url.path.startswith("/block/")
    told = text(page.text)
    assert f"0 of {size} questions right" in told
    weak = re.findall(r'action="(/q/[^/"]+/variant)"', page.text)
    assert 1 <= len(weak) <= size, "each template once"
    again = client.post(weak[0], data={"token": token})
    assert again.url.path.startswith("/q/")


def test_a_wrong_value_is_drawn_into_the_figure(client, token, begin):
    at = begin(POINT)
    before = re.search(
        r'<figure class="figure" id="figure">.*?</figure>', client.get(at).text, re.DOTALL
    )[0]
    wrong = client.post(f"{at}/1", data={"token": token, "a": ["-77", "-77"]}).text
    after = re.search(r'<figure class="figure" id="figure">.*?</figure>', wrong, re.DOTALL)[0]
    assert before != after
    assert "learned" in after
    assert "is asked for" in after, "the right height stays hidden"


def test_before_handing_in_what_cannot_be_read_is_listed(client, token):
    page = client.post("/exam", data={"token": token, "blueprint": "trial"})
    at = page.url.path
    point = next(
        name
        for name, boxes in re.findall(
            r'<fieldset data-part="(\w+)">(.*?)</fieldset>', page.text, re.DOTALL
        )
        if boxes.count('type="text"') == 2
    )
    data = {"token": token, f"on-{point}": "[]", f"a-{point}": ["1", "?"]}
    client.post(at, data=data)
    listed = client.get(f"{at}/hand-in").text
    found = re.search(r"What could not be read</h2>\s*<ul>(.*?)</ul>", listed, re.DOTALL)[1]
    assert f"#part-{point}" in found


def test_the_end_of_a_block_counts_what_had_gone_wrong_before():
    def attempt(template, begun, *right):
        states = [PartState(outcome=PartOutcome("t", one, one)) for one in right]
        parts = {str(i): {"state": msgspec.to_builtins(one)} for i, one in enumerate(states)}
        return AttemptRecord(id=template, learner=1, template=template, seed="1", level="exam", wish={},
                             state={"parts": parts}, begun=begun, ended=begun + 1)  # fmt: skip

    def outcome(template, at, *, right):
        return OutcomeRecord(template, "t", "", "", right, right, at)

    block = PracticeBlockView(
        "b", 4, None,
        (attempt("mended", 10, True), attempt("always", 20, True), attempt("wrong", 30, True, False)),
    )  # fmt: skip
    seen = [outcome("mended", 5, right=False), outcome("always", 5, right=True), outcome("always", 40, right=False),
            outcome("wrong", 5, right=False)]  # fmt: skip
    assert block.count_mended(seen) == 1


@pytest.mark.parametrize(
    ("days_ago", "told"),
    [((0, 1, 1, 2, 4), "3 days in a row"), ((1, 2), "2 days in a row"), ((2, 3), "")],
)
def test_days_in_a_row_end_today_or_yesterday(client, app, monkeypatch, days_ago, told):
    store = app.state.site.store
    noon = datetime.now().astimezone().replace(hour=12).timestamp()
    attempts = [
        AttemptRecord(str(n), 1, POINT, "1", "exam", {}, {}, noon - 86400 * days, ended=noon)
        for n, days in enumerate(days_ago)
    ]
    monkeypatch.setattr(store, "latest", lambda _learner, most: attempts[:most])
    page = text(client.get("/").text)
    assert told in page
    assert ("in a row" in page) == bool(told)

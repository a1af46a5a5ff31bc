"""What accuracy costs, in the browser: what the command's page says, in the site's frame."""

from __future__ import annotations

import asyncio
import re
from types import SimpleNamespace

import msgspec
import pytest

from quizgen.bank.bank import builtin_bank
from quizgen.locale import list_languages
from quizgen.tradeoff.page import render_tradeoff_fragment
from quizgen.tradeoff.report import measure_tradeoff
from quizgen.web.tradeoff import COMMAND, TradeoffJob

FEW = ("compare-two-gaussian-noises", "dynamic-range-of-sensor", "photon-energy-and-band")


@pytest.fixture(scope="module")
def report():
    bank = builtin_bank()
    return measure_tradeoff(SimpleNamespace(template_paths=FEW, template=bank.template))


@pytest.fixture
def measured(app, monkeypatch, report):
    """The answer of a worker that has measured; what it was asked."""
    asked = []

    async def done(job):
        asked.append(job)
        return msgspec.json.encode(
            {one: render_tradeoff_fragment(report, COMMAND, one) for one in list_languages()}
        )

    monkeypatch.setattr(app.state.site.workers, "get_result", done)
    return asked


def test_the_page_of_the_command_stands_in_the_frame(client, token, measured, report):
    page = client.get("/tradeoff").text
    assert measured == [TradeoffJob()]
    assert '<nav aria-label="Menu">' in page
    assert '<a href="/tradeoff" aria-current="page">Accuracy</a>' in page
    assert render_tradeoff_fragment(report, COMMAND, "en") in page
    client.post("/settings", data={"token": token, "lang": "bn", "back": "/"})
    assert render_tradeoff_fragment(report, COMMAND, "bn") in client.get("/tradeoff").text
    client.post("/settings", data={"token": token, "lang": "en", "back": "/"})


def test_nothing_on_it_needs_what_the_policy_forbids(client, measured):
    page = client.get("/tradeoff").text
    assert (
        re.findall(r"<script(?![^>]*src=)|\son\w+=|http://(?!www\.w3\.org)|data:font", page) == []
    )


def test_while_it_is_measured_the_page_says_so_and_looks_again(client, app, monkeypatch):
    async def done(job):
        del job
        await asyncio.sleep(60)

    monkeypatch.setattr(app.state.site.workers, "get_result", done)
    page = client.get("/tradeoff").text
    assert "That takes some seconds." in page
    assert 'hx-get="/tradeoff"' in page
    assert '<a href="/tradeoff">Look again</a>' in page


def test_it_is_measured_once_for_all_languages(bank, monkeypatch, report):
    asked = []

    def once(of):
        asked.append(of)
        return report

    monkeypatch.setattr("quizgen.tradeoff.report.measure_tradeoff", once)
    said = msgspec.json.decode(TradeoffJob().run(bank))
    assert asked == [bank]
    assert set(said) >= {"en", "bn"}
    assert COMMAND in said["en"]


def test_its_style_and_what_moves_its_slider_are_served(client):
    answer = client.get("/static/tradeoff.css")
    assert answer.headers["content-type"].startswith("text/css")
    assert ".measured" in answer.text
    assert 'closest(".sweep")' in client.get("/static/tradeoff.js").text

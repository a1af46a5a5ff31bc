"""Finding a question by a word of it, by a formula, by an item of the notes."""

from __future__ import annotations

import html
import re

from quizgen.bank.metadata import Curriculum


def text(page: str) -> str:
    return html.unescape(" ".join(re.sub(r"<[^>]*>", " ", page).split()))


def found(page: str) -> list[str]:
    return re.findall(r'<button class="link" name="template" value="([^"]+)"', page)


def test_without_a_search_every_question_is_there_once(client, bank):
    names = found(client.get("/questions").text)
    assert sorted(names) == sorted(bank.template_paths)


def test_a_word_of_the_title_finds_only_titles_and_topics(client, bank):
    names = found(client.get("/questions", params={"q": "Bayer"}).text)
    assert "why-bayer-green-and-demosaicing" in names
    assert "bayer-site-counts" in names
    assert len(names) < 20


def test_a_formula_an_item_and_a_word_of_the_text(client, bank):
    by_item = found(client.get("/questions", params={"q": "Q4a"}).text)
    assert by_item == [n for n in bank.template_paths if "Q4a" in bank.rules(n).covers]
    assert by_item
    by_word = found(client.get("/questions", params={"q": "overexposed"}).text)
    assert by_word
    assert set(by_word) == {
        name for name, path in bank.template_paths.items()
        if "overexposed" in (path / "en.md").read_text("utf-8").casefold()
    }  # fmt: skip


def test_what_is_not_there_is_said_and_shown_back_unharmed(client):
    page = client.get("/questions", params={"q": '"><b>zebra'}).text
    assert found(page) == []
    assert "Nothing by that name." in page
    assert '"><b>zebra' not in page
    shown = re.search(r'name="q" value="([^"]*)"', page)[1]
    assert html.unescape(shown) == '"><b>zebra'


def test_what_lies_beyond_the_notes_is_folded_and_the_exam_is_named(client, bank):
    page = client.get("/questions").text
    inside, _, folded = page.partition("<details>")
    assert found(folded)
    beyond = bank.curriculum.beyond
    for name in found(folded):
        assert (
            all(item.startswith(beyond) for item in bank.rules(name).covers)
            or bank.rules(name).beyond
        )
    row = re.search(r'value="mixing-kind-and-primaries">.*?</li>', inside, re.DOTALL)[0]
    assert "in the trial exam" in row


def test_a_question_found_is_begun(client, token):
    asked = client.post("/practice", data={"token": token, "template": "rgb-to-hsv"})
    assert asked.url.path.startswith("/q/")


def test_in_bangla_too(client, token):
    client.post("/settings", data={"token": token, "lang": "bn", "back": "/"})
    page = client.get("/questions", params={"q": "সারি"}).text
    assert found(page)
    assert "টা প্রশ্ন" in page


def test_the_notes_stand_by_section_and_their_numbers_find_questions(
    client, token, bank, nothing_done
):
    numbers = [one.section for one in bank.curriculum.notes]
    assert numbers == sorted(numbers, key=lambda n: [int(i) for i in n.split(".")])
    home = client.get("/").text
    buttons = dict(re.findall(r'name="section" value="([\d.]+)"><span class="s">(§[\d.]+)<', home))
    assert buttons == {number: f"§{number}" for number in numbers}
    found = text(client.get("/questions", params={"q": "4.5"}).text)
    assert "§4.5 Radial distortion" in found
    assert "§4.6" not in found
    whole = client.get("/questions", params={"q": "§ 2"}).text
    heads = re.findall(r"<h2>§([\d.]+) ", whole)
    assert heads[0] == "2.1"
    assert all(head.startswith("2.") for head in heads)
    page = client.post("/practice", data={"token": token, "section": "4.5"})
    store = client.app.state.site.store
    template = store.latest(store.learner().id, 1)[0].template
    assert bank.notes_section(template) == "4.5"
    assert re.search(r'<p class="stands">[^<]*§4\.5</p>', page.text)


def test_every_item_of_the_curriculum_stands_in_one_section_of_the_notes(bank):
    listed = [i for one in bank.curriculum.notes for i in Curriculum({"": one.items}).inventory[""]]
    assert len(listed) == len({*listed})
    assert {item for group in bank.curriculum.inventory.values() for item in group} <= {*listed}

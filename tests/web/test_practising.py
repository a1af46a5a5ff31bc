"""Practising in the browser, over its addresses: answers typed as forms post them."""

from __future__ import annotations

import html
import re

import pytest

from quizgen.grading.programs import can_run_programs
from quizgen.question.compose import compose_question

pytestmark = pytest.mark.both_databases


def text(page: str) -> str:
    return html.unescape(" ".join(re.sub(r"<[^>]*>", " ", page).split()))


def verdicts(page: str) -> list[str]:
    return re.findall(r'<div class="verdict (\w+)"', page)


def test_from_the_first_page_to_a_question(client, token):
    page = client.get("/").text
    assert "Image Acquisition" in page
    asked = client.post("/practice", data={"token": token, "topic": "optics", "tier": ""})
    assert asked.status_code == 200
    assert re.fullmatch(r"/q/[\w-]{16}", asked.url.path)
    assert 'name="a"' in asked.text
    assert re.search(r"Question bank: image-acquisition 1\.0 \([0-9a-f]{12}\)", text(asked.text))


def test_a_topic_that_nobody_knows_has_no_question(client, token):
    asked = client.post("/practice", data={"token": token, "topic": "astrology"})
    assert asked.status_code == 404
    assert "No question fits" in asked.text


def test_right_wrong_and_unreadable_answers(client, token, begin, bank):
    at = begin("point-to-image-plane")
    _, key = compose_question(bank.template("point-to-image-plane"), "3", "en")
    x, y = key.solution.parts[0].answer.strip("()").split("; ")
    unread = client.post(f"{at}/1", data={"token": token, "a": [x, "?"]})
    assert verdicts(unread.text) == ["asked"]
    swapped = client.post(f"{at}/1", data={"token": token, "a": [y, x]})
    assert verdicts(swapped.text) == ["wrong"]
    assert "Tries left: 2." in text(swapped.text)
    right = client.post(f"{at}/1", data={"token": token, "a": [x.replace(".", ","), y]})
    assert verdicts(right.text) == ["correct"]
    assert "How this question works" in right.text
    assert f'value="{x.replace(".", ",")}"' in right.text, "what was typed stays"
    assert client.get(at).text.count("verdict correct") == 1, "and is there again after a reload"


@pytest.mark.parametrize(
    ("typed", "told", "place"),
    [
        (["0.5", "0.2", " 0.4 +"], "S : Column 7: something is missing.", 2),
        (["0.5", "1/0", "0.4"], "Δ : Division by zero.", 1),
        (["0.2 0.3", "0.2", "0.4"], "V : Column 5: “0.3” does not fit here.", 0),
        (["", "0.2", "0.4"], "Fill in every field.", 0),
    ],
)
def test_of_several_fields_the_one_that_cannot_be_read_is_named(
    client, token, begin, typed, told, place
):
    page = client.post(f"{begin('rgb-to-hsv')}/1a", data={"token": token, "a": typed}).text
    verdict = re.search(r'<div class="verdict asked".*?</div>', page, re.DOTALL)[0]
    assert told in text(verdict)
    boxes = re.findall('<input type="text" name="a" id="a-1a[^>]*>', page)
    wrong = [number for number, box in enumerate(boxes) if "aria-invalid" in box]
    assert wrong == [place]
    assert "left" not in text(verdict)


def test_three_wrong_answers_show_the_solution(client, token, begin):
    at = begin("point-to-image-plane")
    for _ in range(3):
        page = client.post(f"{at}/1", data={"token": token, "a": ["123", "456"]}).text
    assert 'class="steps"' in page
    after = client.post(f"{at}/1", data={"token": token, "a": ["1", "2"]}).text
    assert verdicts(after) == ["wrong"]


def test_an_answer_sent_after_the_solution_was_shown_does_not_count(client, token, begin, bank):
    """A page left open still has its fields; what they send must not make the part right."""
    at = begin("point-to-image-plane")
    _, key = compose_question(bank.template("point-to-image-plane"), "3", "en")
    answer = key.solution.parts[0].answer.strip("()").split("; ")
    client.post(f"{at}/1", data={"token": token, "do": "solution", "a": ["", ""]})
    late = client.post(f"{at}/1", data={"token": token, "a": answer})
    assert late.status_code == 200
    assert verdicts(late.text) == []
    assert verdicts(client.get(at).text) == []


def test_the_language_changes_and_the_numbers_stay(client, token, begin):
    at = begin("point-to-image-plane")
    english = client.get(at).text
    client.post("/settings", data={"token": token, "lang": "bn", "back": at})
    bangla = client.get(at).text
    client.post("/settings", data={"token": token, "lang": "en", "back": at})
    assert 'lang="bn"' in bangla
    stems = [
        re.search(r'<div class="stem">(.*?)</div>', page, re.DOTALL)[1]
        for page in (english, bangla)
    ]
    numbers = [sorted(re.findall(r"<mn>([\d.]+)</mn>|(\d+)", stem)) for stem in stems]
    assert numbers[0] == numbers[1]
    assert re.search(r"[\u0980-\u09ff]", stems[1])


@pytest.mark.parametrize(
    ("typed", "read"),
    [(["2/3", "0,5"], True), (["-", "1"], False), (["2.", "1"], False), (["2", ""], True),
     (["<script>", "1"], False)],
)  # fmt: skip
def test_a_field_shows_how_it_is_read_and_never_whether_it_is_right(
    client, token, begin, typed, read
):
    at = begin("point-to-image-plane")
    answer = client.post(f"{at}/1/read", data={"token": token, "a": typed})
    assert answer.status_code == 200
    assert bool(answer.text) == read
    assert "<script" not in answer.text
    assert not re.search("right|correct|wrong|trap", answer.text, re.IGNORECASE)


def test_hints_come_one_by_one_and_solution_ends_a_part(client, token, begin):
    at = begin("point-to-image-plane")
    one = client.post(f"{at}/1", data={"token": token, "do": "hint", "a": ["", ""]}).text
    two = client.post(f"{at}/1", data={"token": token, "do": "hint", "a": ["", ""]}).text
    count = [
        re.search(r'<ol class="hints">(.*?)</ol>', page, re.DOTALL)[1].count("<li>")
        for page in (one, two)
    ]
    assert count == [1, 2]
    shown = client.post(f"{at}/1", data={"token": token, "do": "solution", "a": ["", ""]}).text
    assert 'class="result"' in shown
    assert 'class="verdict' not in shown, "nothing was answered"


def test_a_variant_is_the_same_question_with_other_numbers(client, token, begin):
    at = begin("point-to-image-plane")
    page = client.get(at).text
    fresh = client.post(f"{at}/variant", data={"token": token})
    assert fresh.url.path != at
    title = re.search("<h1.*?</h1>", page)[0]
    assert title in fresh.text
    stem = re.search(r'<div class="stem">.*?</div>', page, re.DOTALL)[0]
    assert stem not in fresh.text


def test_working_it_through_asks_the_steps_of_the_same_question(client, token, begin):
    at = begin("rgb-to-hsv")
    page = client.get(at).text
    guided = client.post(f"{at}/guided", data={"token": token})
    stem = re.search(r'<div class="stem">(.*?)</div>', page, re.DOTALL)[1]
    assert text(stem)[:60] in text(guided.text)
    assert guided.text.count("?part=") > page.count("?part="), "more parts, one on a screen"
    assert guided.text.count('<section class="part') == page.count('<section class="part') == 1


def test_what_is_not_there_is_said(client, token, begin):
    at = begin("point-to-image-plane")
    assert client.get("/q/nobody").status_code == 404
    assert client.post(f"{at}/9z", data={"token": token, "a": "1"}).status_code == 404
    assert client.get("/q/../../etc").status_code == 404


def test_what_is_typed_is_text(client, token, begin):
    at = begin("point-to-image-plane")
    page = client.post(
        f"{at}/1", data={"token": token, "a": ['"><script>alert(1)</script>', "1"]}
    ).text
    assert "<script>alert" not in page


@pytest.mark.parametrize(("lang", "said"), [("en", "Write it as"), ("bn", "আকারে লিখুন")])
def test_what_to_type_speaks_of_fields_where_there_are_fields(client, token, begin, lang, said):
    client.post("/settings", data={"token": token, "lang": lang, "back": "/"})
    for template in (
        "point-to-image-plane", "mixing-kind-and-primaries", "lens-aberrations-causes-remedies",
        "rgb-to-hsv",
    ):  # fmt: skip
        page = text(client.get(begin(template)).text)
        assert said not in page
        assert not re.search("semicolon|সেমিকোলন|A2 B1", page), template
    client.post("/settings", data={"token": token, "lang": "en", "back": "/"})


def test_an_empty_field_is_said_as_such(client, token, begin):
    page = client.post(f"{begin('point-to-image-plane')}/1", data={"token": token, "a": ["7", ""]})
    assert verdicts(page.text) == ["asked"]
    assert "Fill in every field." in text(page.text)
    assert "Separate them" not in page.text


def test_readings_of_an_answer_are_buttons_and_none_is_marked_as_right(client, token, begin):
    page = client.post(
        f"{begin('thin-lens-image-distance')}/1a", data={"token": token, "a": ["16 mm or 17 mm"]}
    )
    buttons = re.findall(r'<button[^>]*name="reading" value="(.):1a">([^<]*)<', page.text)
    assert buttons == [("1", "16 mm"), ("2", "17 mm")]
    address = str(page.url.path)
    chosen = client.post(f"{address}/1a", data={"token": token, "a": ["99"], "reading": "2:1a"})
    assert verdicts(chosen.text) == ["wrong"]
    assert 'value="17 mm"' in chosen.text
    assert 'name="reading"' not in chosen.text
    late = client.post(f"{address}/1a", data={"token": token, "reading": "1:1a"})
    assert "Tries left: 2." in text(late.text), "a page left open costs no try"


def test_a_reading_chosen_declares_the_decimal_sign_which_is_kept(client, token, begin, bank):
    at = begin("salt-and-pepper-mean-and-psnr")
    _, key = compose_question(bank.template("salt-and-pepper-mean-and-psnr"), "3", "en")
    assert key.solution.parts[1].answer == "1385"
    asked = client.post(f"{at}/1b", data={"token": token, "a": ["1,385"]})
    assert verdicts(asked.text) == ["asked"]
    assert re.findall(r'name="reading" value=".:1b">([^<]*)<', asked.text) == ["1.385", "1385"]
    chosen = client.post(f"{at}/1b", data={"token": token, "a": ["1,385"], "reading": "2:1b"})
    assert verdicts(chosen.text) == ["correct"]
    declared = '<button class="small" name="decimal" value="{}" aria-pressed="true">'
    assert declared.format("point") in client.get(at).text
    client.post("/settings", data={"token": token, "decimal": "auto", "back": at})
    assert declared.format("auto") in client.get(at).text


SENTENCES = "why-bayer-green-and-demosaicing"


def test_a_sentence_is_judged_by_criteria(client, token):
    page = client.post("/practice", data={"token": token, "template": SENTENCES})
    at = page.url.path
    (part,) = set(re.findall(rf'action="{at}/(\w+)"', page.text)[:1])
    said = "The eye sees green best, but detail does not matter."
    judging = client.post(f"{at}/{part}", data={"token": token, "do": "answer", "a": said}).text
    assert "Recognised: “The eye sees green best”" in judging
    assert "Says the contrary: “detail does not matter”" in judging
    assert re.findall(rf'name="mark-{part}" value="([\w-]+)"', judging) == ["eye", "detail"]
    assert "checked" not in judging[judging.index('class="criteria"') :][:600]  # it decides nothing
    ticked = {"token": token, "do": "marks", f"mark-{part}": ["eye", "cheat"]}
    assert "You gave yourself 1 point." in client.post(f"{at}/{part}", data=ticked).text
    client.post(f"{at}/{part}", data={**ticked, f"mark-{part}": ["eye", "detail"]})
    page = client.get(f"{at}?part={part}").text
    assert "You gave yourself 1 point." in page  # what has ended stays


def test_letters_of_a_formula_are_buttons(client, begin):
    assert 'data-put="N"' in client.get(begin("photon-snr-formula-and-model")).text


@pytest.mark.skipif(not can_run_programs(), reason="no process can be locked here")
def test_a_function_is_written_line_by_line(client, token, begin):
    at = begin("write-hue-shift")
    lines = ["def shift_hue(h, degrees):", "    wide = h.astype(np.int32)", "    wide += degrees"]
    typed = "\r\n".join([*lines, "    return (wide % 180).astype(np.uint8)"])
    first = client.post(f"{at}/1", data={"token": token, "a": typed}).text
    assert "add half the degrees" in text(first)
    assert "wide = h.astype" in first, "what was typed stays in the field"
    right = client.post(
        f"{at}/1", data={"token": token, "a": typed.replace("degrees\r", "degrees // 2\r")}
    )
    assert verdicts(right.text)[-1] == "correct"

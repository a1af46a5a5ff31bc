"""The camera in the browser."""

from __future__ import annotations

import html
import io
import re
from base64 import b64decode

import numpy as np
import pytest
from PIL import Image


def shown(page: str) -> str:
    return html.unescape(" ".join(re.sub(r"<[^>]*>", " ", page).split()))


def pictures(page: str) -> list[np.ndarray]:
    found = re.findall(r'src="data:image/png;base64,([^"]+)"', page)
    return [np.asarray(Image.open(io.BytesIO(b64decode(one)))).astype(int) for one in found]


def rows(page: str) -> dict[str, str]:
    return dict(re.findall(r'<th scope="row">([^<]*)</th><td>([^<]*)</td>', page))


def test_a_photograph_with_and_without_what_is_asked(client):
    page = client.get("/camera", params={"scene": "portrait"}).text
    taken, plain, difference = pictures(page)
    assert taken.shape == (480, 640, 3)
    assert np.abs(taken - plain).max() > 32
    assert difference.max() > 64, "scaled so that it is seen"
    assert "With: defocus" in shown(page)
    assert "It is seen: 18 % of the pixels differ" in shown(page)
    assert rows(page)["defocus"] == "simulated: it is asked"
    assert rows(page)["gamma"] == "simulated: no picture without it"
    assert rows(page)["read noise"] == "left out: not asked"


def test_another_effect_can_be_asked(client):
    flat = {"scene": "flat", "before": "flat"}
    noise = shown(client.get("/camera", params={**flat, "effect": "read noise"}).text)
    assert "With: read noise" in noise
    assert "It is seen" in noise
    distortion = shown(client.get("/camera", params={**flat, "effect": "distortion"}).text)
    assert "It cannot be seen in this picture." in distortion


def test_what_is_set_is_simulated_besides(client):
    page = client.get("/camera", params={"scene": "portrait", "before": "portrait", "k1": "0"}).text
    assert rows(page)["lens distortion"] == "simulated: you set it"
    assert rows(page)["defocus"] == "simulated: it is asked"


def test_a_metered_picture_says_how_long_it_exposes(client):
    """f/32 after f/1.8: (32/1.8)^2 = 316 times 1/200 s."""
    page = client.get(
        "/camera", params={"scene": "portrait", "before": "portrait", "f_number": "11"}
    ).text
    assert re.search(r'<output for="set-f_number">f/32</output>', page)
    assert "it exposes for 1.6 s instead of 1/200 s" in shown(page)
    assert "it exposes" not in shown(client.get("/camera", params={"scene": "portrait"}).text)


def test_a_stop_more_light_is_brighter(client):
    own = client.get("/camera", params={"scene": "fisheye", "before": "fisheye"}).text
    darker = client.get(
        "/camera", params={"scene": "fisheye", "before": "fisheye", "exposure": "3"}
    ).text
    assert "−1 EV" in shown(darker)
    white, grey = pictures(own)[0].max(), pictures(darker)[0].max()
    assert (white, grey) == (255, 128), "half the light, without a gamma curve"


def test_another_scene_begins_with_settings_of_its_own(client):
    page = client.get(
        "/camera", params={"scene": "landscape", "before": "portrait", "f_number": "0"}
    ).text
    assert re.search(r'<output for="set-f_number">f/16</output>', page)


@pytest.mark.parametrize(
    "sent", [{"exposure": "99"}, {"exposure": "-1"}, {"exposure": "1e9"}, {"exposure": "x" * 9999},
             {"scene": "../../etc/passwd"}, {"effect": "inf"}, {"k1": "৫"}],
)  # fmt: skip
def test_what_no_slider_sends_changes_nothing(client, sent):
    answer = client.get("/camera", params={"scene": "pinhole", "before": "pinhole", **sent})
    assert answer.status_code == 200
    assert "etc" not in answer.text.split("<main")[1][:400]


def test_an_ideal_camera_computes_nothing(client):
    page = shown(client.get("/camera", params={"scene": "pinhole"}).text)
    assert "Nothing to compute" in page
    assert "Without" not in page


@pytest.mark.parametrize("scene", ["portrait", "landscape", "night", "texture", "propeller"])
def test_every_scene_and_both_languages(client, token, scene):
    client.post("/settings", data={"token": token, "lang": "bn", "back": "/"})
    bangla = client.get("/camera", params={"scene": scene})
    client.post("/settings", data={"token": token, "lang": "en", "back": "/"})
    english = client.get("/camera", params={"scene": scene})
    assert (bangla.status_code, english.status_code) == (200, 200)
    assert [one.sum() for one in pictures(bangla.text)] == [
        one.sum() for one in pictures(english.text)
    ]


@pytest.mark.browser
def test_a_slider_by_keyboard_takes_another_photograph(opened, served):
    from playwright.sync_api import expect

    page = opened(viewport={"width": 390, "height": 800})
    page.goto(f"{served.address}/camera?scene=fisheye")
    before = page.locator("#shot img").first.get_attribute("src")
    page.locator("#set-exposure").focus()
    page.keyboard.press("ArrowLeft")
    expect(page.locator("output[for=set-exposure]")).to_have_text("−1 EV")
    expect(page.locator("#shot img").first).not_to_have_attribute("src", before)
    expect(page.locator("#set-exposure")).to_be_focused()

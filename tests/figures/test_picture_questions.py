"""Questions about a picture: the key is what the picture of the same draw shows."""

from __future__ import annotations

import pytest
from figure_cases import module

from quizgen.arrays import luminosity
from quizgen.bank.draw import draw
from quizgen.question.kinds import build

staircase = module("staircase")

SEEDS = range(60)
LAMPS = "two-lamps-by-day-and-by-night"


def _drawn(bank, name, seed, part=0):
    """Drawn numbers and the name of the right option of a part."""
    drawn = draw(bank.template(name), seed)
    ((_, right),) = build(drawn, part).right
    return {key: float(value) for key, value in drawn.shown.items()}, right


@pytest.mark.parametrize("seed", SEEDS)
def test_the_brighter_laser_is_the_higher_on_the_curve(bank, seed):
    given, key = _drawn(bank, "two-lasers-from-curves", seed)
    curve = luminosity.NIGHT if given["dark"] else luminosity.DAY
    heights = [float(luminosity.efficiency(given[name], curve)) for name in ("l_1", "l_2")]
    assert [given["h_1"], given["h_2"]] == pytest.approx(heights, rel=0.01)
    assert heights[("first", "second").index(key)] == max(heights)


@pytest.mark.parametrize("seed", SEEDS)
def test_spikes_stand_where_the_limits_cut(bank, seed):
    given, key = _drawn(bank, "normalisation-from-histograms", seed)
    cuts = given["low"] > given["a"], given["b"] > given["high"]
    touches = given["low"] == given["a"] and given["high"] == given["b"]
    seen = {(True, True): "both", (True, False): "bottom", (False, True): "top"}
    assert key == seen.get(cuts, "fits" if touches else "wide")


@pytest.mark.parametrize("seed", SEEDS)
def test_the_order_of_five_lights_is_that_of_the_curves(bank, seed):
    given, key = _drawn(bank, "order-wavelengths-by-brightness", seed, part=1)
    by_day = [float(luminosity.efficiency(given[f"n_{k}"])) for k in range(1, 6)]
    assert by_day == sorted(by_day, reverse=True)
    assert [given[f"V_{k}"] for k in range(1, 6)] == pytest.approx(by_day, rel=0.01)
    by_night = [
        float(luminosity.efficiency(given[name], luminosity.NIGHT)) for name in ("m_1", "m_2")
    ]
    assert [given["W_1"], given["W_2"]] == pytest.approx(by_night, rel=0.01)
    assert by_night[("short", "long").index(key)] == max(by_night)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_lamps_have_the_heights_of_both_curves(bank, seed):
    given = {k: float(v) for k, v in draw(bank.template(LAMPS), seed).shown.items()}
    for k in "12":
        assert given[f"V_{k}"] == pytest.approx(luminosity.efficiency(given[f"l_{k}"]), abs=0.001)
        by_night = luminosity.efficiency(given[f"l_{k}"], luminosity.NIGHT)
        assert given[f"V'_{k}"] == pytest.approx(by_night, abs=0.001)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_curve_is_as_high_at_the_wavelength_beyond_the_peak(bank, seed):
    given = {
        k: float(v)
        for k, v in draw(bank.template("power-for-equal-brightness"), seed).shown.items()
    }
    curve = luminosity.NIGHT if given["dark"] else luminosity.DAY
    assert float(luminosity.efficiency(given["l_1"], curve)) == pytest.approx(
        given["h_1"], abs=0.002
    )
    assert float(luminosity.efficiency(given["l_2"], curve)) == pytest.approx(
        given["h_2"], abs=0.002
    )
    assert float(luminosity.efficiency(given["lambda_3"], curve)) == pytest.approx(
        given["h_s"], abs=0.002
    )
    assert float(luminosity.efficiency(given["lambda_3"] + given["w"], curve)) == pytest.approx(
        given["h_s"], abs=0.008
    )


@pytest.mark.parametrize("seed", SEEDS)
def test_the_staircase_rises_where_the_key_says(bank, seed):
    given, key = _drawn(bank, "quantiser-from-staircase", seed, part=1)
    drawn = draw(bank.template("quantiser-from-staircase"), seed)
    rises = staircase.jumps(given)
    ends = {
        "nearest": (0.5, 0.5), "down": (1, 0), "parts": (1, 1), "up": (0, 1)
    }[key]  # fmt: skip
    tread = rises[1] - rises[0]
    assert (rises[0] / tread, (1 - rises[-1]) / tread) == pytest.approx(ends, abs=1e-9)
    k, q = (float(v) for v in build(drawn, 2).spec.show().replace("k = ", "").split("; q = "))
    assert k == sum(rise < given["I"] for rise in rises) == staircase.code(given["I"], given)
    assert q == pytest.approx(k / len(rises), abs=0.0001)



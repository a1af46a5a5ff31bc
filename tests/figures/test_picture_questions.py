"""Questions about a picture: the key is what the picture of the same draw shows."""

from __future__ import annotations

import pytest

from quizgen.arrays import luminosity
from quizgen.bank.draw import draw
from quizgen.figures import artefacts, depth_of_field, noise
from quizgen.question.kinds import build

SEEDS = range(60)
NAMES = {
    "blooming": "blooming",
    "streak": "streak",
    "rolling": "rolling shutter",
    "vignetting": "vignetting",
    "lateral": "lateral colour",
    "barrel": "barrel",
    "pincushion": "pincushion",
    "motion": "motion blur",
    "defocus": "defocus",
    "moire": "false colour",
    "clipping": "clipping",
    "hot": "hot pixels",
}


def _drawn(bank, name, seed, part=0):
    """Drawn numbers and the name of the right option of a part."""
    drawn = draw(bank.template(name), seed)
    ((_, right),) = build(drawn, part).right
    return {key: float(value) for key, value in drawn.shown.items()}, right


@pytest.mark.parametrize("seed", SEEDS)
def test_the_named_artefact_is_the_one_shown(bank, seed):
    given, key = _drawn(bank, "name-artefact-from-photo", seed)
    assert artefacts.KINDS[int(given["k"])] == NAMES[key]


@pytest.mark.parametrize("seed", SEEDS)
def test_the_noise_asked_for_stands_where_the_key_says(bank, seed):
    given, key = _drawn(bank, "recognise-noise-from-histograms", seed)
    place = ("left", "middle", "right").index(key)
    asked = ("clean", "gaussian", "impulse")[int(given["asked"])]
    assert noise.noise_order(given["order"])[place] == asked


@pytest.mark.parametrize("seed", SEEDS)
def test_the_wide_aperture_stands_where_the_key_says(bank, seed):
    given, key = _drawn(bank, "which-photo-which-f-number", seed)
    shown = {"N_1": given["N_b"], "N_2": given["N_a"], "order": given["order"]}
    pair = depth_of_field.f_numbers(shown)
    assert pair[("left", "right").index(key)] == min(pair) == given["N_a"]


@pytest.mark.parametrize("seed", SEEDS)
def test_the_object_in_focus_is_the_one_of_the_key(bank, seed):
    given, key = _drawn(bank, "which-photo-which-f-number", seed, part=1)
    objects = [given[name] for name in ("z_1", "z_2", "z_3")]
    assert objects == sorted(objects)
    assert objects[("nearer", "middle", "farther").index(key)] == given["s"]


@pytest.mark.parametrize("seed", SEEDS)
def test_the_brighter_laser_is_the_higher_on_the_curve(bank, seed):
    given, key = _drawn(bank, "two-lasers-from-curves", seed)
    curve = luminosity.scotopic if given["dark"] else luminosity.photopic
    heights = [float(curve(given[name])) for name in ("l_1", "l_2")]
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
    by_day = [float(luminosity.photopic(given[f"n_{k}"])) for k in range(1, 6)]
    assert by_day == sorted(by_day, reverse=True)
    assert [given[f"V_{k}"] for k in range(1, 6)] == pytest.approx(by_day, rel=0.01)
    by_night = [float(luminosity.scotopic(given[name])) for name in ("m_1", "m_2")]
    assert [given["W_1"], given["W_2"]] == pytest.approx(by_night, rel=0.01)
    assert by_night[("short", "long").index(key)] == max(by_night)

"""Every effect of the camera has a question that is answered by a number of that effect."""

from sweep import together

from quizgen.camera.effects import EFFECTS

ASKED = {
    "projection": "point-to-pixel",
    "distortion": "radial-points-and-line-bow",
    "lateral colour": "lateral-colour-shift",
    "axial colour": "axial-colour-blur",
    "defocus": "blur-disc-diameter",
    "diffraction": "diffraction-and-pixel-pitch",
    "motion blur": "motion-blur-in-pixels",
    "rolling shutter": "rolling-shutter-skew",
    "vignetting": "vignetting-from-a-profile",
    "flare": "veiling-glare-and-contrast",
    "colour filters": "infrared-leak",
    "exposure": "exposure-equivalence",
    "shot noise": "photon-snr-and-decibels",
    "dark current": "snr-of-one-pixel",
    "blooming": "ccd-streak-and-overflow",
    "smear": "ccd-streak-and-overflow",
    "full well": "dynamic-range-of-sensor",
    "fixed pattern": "flat-field-two-pixels",
    "read noise": "snr-of-one-pixel",
    "gain": "exposure-equivalence",
    "mosaic": "bayer-site-counts",
    "quantisation": "quantisation-levels-and-error",
    "dark frame": "flat-field-two-pixels",
    "demosaicing": "demosaic-blue-and-green-site",
    "flat field": "flat-field-two-pixels",
    "white balance": "white-balance-and-chromaticity",
    "binning": "binning-and-noise",
    "gamma": "gamma-encoded-average",
    "hsv edit": "luma-before-and-after-turn",
    "gaussian noise": "gaussian-peak-and-tail-shares",
    "impulse noise": "salt-and-pepper-counts",
    "normalisation": "normalise-from-8-bit-range",
}
"""Effect to the name of a template."""


def test_no_effect_is_left_out():
    assert list(ASKED) == [effect.name for effect in EFFECTS]


@together("name", sorted(set(ASKED.values())))
def test_it_asks_for_a_number_of_its_computation(bank, name):
    template = bank.template(name)
    kinds = {part.answer["kind"] for part in template.rules.part}
    assert template.rules.solver
    assert kinds & {"number", "quantity", "numbers", "point", "table", "vector"}, kinds

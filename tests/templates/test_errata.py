"""docs/errata.md: what it names exists and says so, and its numbers are recomputed here."""

from __future__ import annotations

import math
import re
import tomllib
from fractions import Fraction
from pathlib import Path

import mpmath
import pytest
from sweep import together

ROOT = Path(__file__).parents[2]
CONTENT = ROOT / "templates" / "cards"
TEXT = (ROOT / "docs" / "errata.md").read_text(encoding="utf-8")
CELLS = [
    [cell.strip() for cell in line.strip("|").split("|")]
    for line in TEXT.splitlines()
    if line.startswith("| ")
]
ROWS = {row[0].split()[0]: row for row in CELLS if re.match(r"EC?\d", row[0])}
COINCIDENCES = [row for row in CELLS if len(row) == 3 and row[0] != "example"]
CARD = re.compile(r"[a-z]+/[\w-]+")


def names(cell: str) -> list[str]:
    return re.findall(r"`([^`]+)`", cell)


def flat(value: object) -> str:
    """All strings of a TOML entry, one after the other."""
    if isinstance(value, dict):
        return " ".join(flat(part) for part in value.values())
    return " ".join(flat(part) for part in value) if isinstance(value, list) else str(value)


def wording(name: str) -> str:
    """What a template, a card or a file named on the page says."""
    if "." in name:
        return (ROOT / name).read_text(encoding="utf-8")
    if CARD.fullmatch(name):
        deck, entry = name.split("/")
        table = tomllib.loads((CONTENT / f"{deck}.toml").read_text(encoding="utf-8"))
        return flat(next(e for e in table["entry"] if e["id"] == entry))
    folder = next(ROOT.glob(f"templates/*/{name}"))
    return " ".join(
        (folder / file).read_text(encoding="utf-8") for file in ("template.toml", "en.md")
    )


def test_every_erratum_stands_on_the_page_once():
    listed = [row[0].split()[0] for row in CELLS if re.match(r"EC?\d", row[0])]
    assert len(listed) == len(set(listed))
    known = {f"E{i:02}" for i in range(1, 53)} | {f"EC{i}" for i in range(1, 10)}
    # E45 and E52 are asked nowhere: a nickname of a camera, and the axes of a drawing.
    assert set(listed) == known - {"E45", "E52"}


@together("row", ROWS.values())
def test_what_a_row_names_exists(row):
    assert len(row) == 6
    assert names(row[5])
    for name in names(row[5]):
        assert wording(name), name


@pytest.mark.parametrize("row", COINCIDENCES, ids=[row[0] for row in COINCIDENCES])
def test_what_avoids_a_coincidence_exists(row):
    assert names(row[2])
    for name in names(row[2]):
        assert wording(name), name


SAID = [
    ("E01", "two-lasers-flux-ratio", "the ratio is 244"),
    ("E01", "formulas/F03", "244 times"),
    ("E02", "radial-points-and-line-bow", "such a line stays straight"),
    ("E02", "straight-line-counterexample", "needs a line that misses it"),
    ("E02", "true-or-false-projection", "only lines that miss the centre bend"),
    ("E02", "statements/radial-line", "stays straight under barrel"),
    ("E03", "radial-points-and-line-bow", "1 + 3*k_1*x_B^2 > 0.2"),
    ("E03", "radial-point-off-axis", "5*k_2*(x^2 + y^2)^2 > 0.2"),
    ("E03", "formulas/F20", "folds over"),
    ("E03", "templates/figures/distorted_grid.py", "never folds over"),
    ("E04", "hsv-edit-effects", "not the perceived brightness"),
    ("E04", "hsv-edit-from-pictures", "V$ is the largest"),
    ("E04", "traps/TR26", "0.449"),
    ("E04", "traps/TR26", "0.096"),
    ("E04", "statements/v-luminance", "0.072"),
    ("E05", "hsv-edit-effects", "makes a colour lighter"),
    ("E05", "hsv-edit-from-pictures", "washed-out colours are in fact lighter"),
    ("E05", "true-or-false-colour", "pure blue to 0 turns it into white"),
    ("E05", "statements/blue-white", "(1, 1, 1)"),
    ("E06", "opencv-bayer-constant", "exchanges red and blue"),
    ("E07", "why-pinhole-model", "linear in homogeneous coordinates only"),
    ("E08", "true-or-false-colour", "Light cannot be negative"),
    ("E08", "rods-cones-and-peaks", "the sensitivity curves overlap"),
    ("E08", "statements/all-colours", "33.5 %"),
    ("E09", "vocabulary/metamerism", "Two different spectra"),
    ("E09", "metamers-under-two-lamps", "cloth"),
    ("E10", "rods-cones-and-peaks", "daylight was standardised in 1924"),
    ("E10", "cheat/rods-cones", "1951"),
    ("E11", "bands-of-imaging-methods", "20 000 to 150 000 eV"),
    ("E12", "bands-of-imaging-methods", "1.6 to 3.3 eV"),
    ("E13", "metamers-under-two-lamps", "three equal sums"),
    ("E13", "formulas/F04", "Three equations must hold"),
    ("E14", "blur-and-light-factors", "depth of field only roughly"),
    ("E15", "image-height-and-fill-distance", "the result keeps the unit of $f$"),
    ("E15", "formulas/F05", "has the unit of $f$"),
    ("E16", "hsv-nonlinearity-counterexample", "share no largest channel"),
    ("E17", "gaussian-peak-and-tail-shares", "Both are accepted"),
    ("E18", "gaussian-peak-and-tail-shares", "before rounding to integers"),
    ("E18", "formulas/F18", "before rounding"),
    ("E19", "radial-point-off-axis", "what share of its radius"),
    ("E19", "cheat/distortion", "relative shift"),
    ("E20", "recognise-noise-from-description", "Subtracting a dark frame removes the shot noise"),
    ("E21", "uint8-sum", "arrays wrap around"),
    ("E21", "opencv-add-and-subtract", "saturates"),
    ("E21", "floats-or-uint8", "In NumPy arrays"),
    ("E22", "exposure-faults-and-remedies", "too few photons"),
    ("E22", "true-or-false-noise", "grow by the same factor"),
    ("E22", "blur-and-light-factors", "amplifies signal and noise alike"),
    ("E23", "photon-snr-formula-and-model", "variance $N$"),
    ("E23", "photon-snr-and-decibels", "In absolute terms the bright part is the noisier"),
    ("E24", "vocabulary/focal-plane", "plane of focus"),
    ("E25", "vocabulary/dynamic-range", "a ratio"),
    ("E26", "uses-of-colour-spaces", "It is lightness"),
    ("E26", "cheat/colour-spaces", "L is lightness"),
    ("E27", "point-to-pixel", "principal point at"),
    ("E27", "traps/TR28", "(319.5, 239.5)"),
    ("E28", "point-to-pixel", "$y$ points down"),
    ("E28", "point-to-non-square-pixel", "$y$ points up"),
    ("E28", "formulas/F09", "o_y - f_y"),
    ("E29", "radial-points-and-line-bow", "from undistorted to distorted"),
    ("E29", "traps/TR27", "**barrel**"),
    ("E29", "formulas/F22", "has the opposite sign"),
    ("E30", "blur-and-light-factors", "ratio = 8 or ratio = 16"),
    ("E30", "diameter-stops-and-exposure-time", "ratio = { pick = [2, 4, 8, 16] }"),
    ("E31", "lens-aberrations-causes-remedies", "falls on a larger area"),
    ("E31", "formulas/F39", "dark frame has been subtracted"),
    ("E32", "thin-lens-image-distance", "only in the limit of far objects"),
    ("E32", "thin-lens-limits", "0.5 % at 10 m for 50 mm"),
    ("E33", "cheat/quantisation", "two pixels per period"),
    ("E34", "apparent-colour-of-surface", "light of the source"),
    ("E34", "luminous-flux-over-bands", "belongs to the lamp"),
    ("E34", "formulas/F03", "*arrives*"),
    ("E35", "coordinate-conventions", "That is OpenGL"),
    ("E36", "pinhole-size-effects", "left and right are exchanged as well"),
    ("E37", "ccd-or-cmos-properties", "properties of early chips"),
    ("E37", "ccd-and-cmos-artefacts", "not a read-out effect"),
    ("E38", "salt-and-pepper-counts", "almost half"),
    ("E39", "formulas/F14", "clipping shifts the mean"),
    ("E40", "gaussian-2d-formula-and-shapes", "correlation along the rows"),
    ("E41", "weak-perspective-scale-error", "exactly half the depth range"),
    ("E42", "gamma-encoded-average", "0.7354 and 0.6954"),
    ("E43", "floats-or-uint8", "65504"),
    ("E44", "normalise-and-clamp", "cannot be normalised at all"),
    ("E44", "formulas/F13", "Both sides"),
    ("E46", "opencv-image-in-matplotlib", "bluish parts turn reddish"),
    ("E46", "traps/TR01", "**swapped**"),
    ("E47", "recognise-and-sketch-distortion", "through the principal point stay straight"),
    ("E47", "radial-points-and-line-bow", "all its points move along the line itself"),
    ("E48", "channel-counts", "bands"),
    ("E49", "cheat/aperture-tradeoff", "diffraction"),
    ("E49", "pinhole-size-effects", "diffraction"),
    ("E50", "two-lasers-flux-ratio", "not of sensation"),
    ("E50", "luminous-flux-over-bands", "lm"),
    ("E51", "quantisation-levels-and-error", "only made small"),
    ("E51", "cheat/quantisation", "q/sqrt(12)"),
    ("EC1", "opencv-hue-shift", "one degree less than asked"),
    ("EC2", "opencv-stored-hue", "OpenCV stores half the angle"),
    ("EC2", "formulas/F37", "_FULL"),
    ("EC3", "uint8-hue-shift", "wraps around at 256"),
    ("EC4", "point-projection-in-python", "6.666666666666667"),
    ("EC4", "projection-non-positive-depth", "disappears under"),
    ("EC5", "random-generator-default-argument", "evaluated once"),
    ("EC5", "noise-function-return-types", "keeps the type of the input"),
    ("EC6", "salt-and-pepper-thresholds", "masks overlap"),
    ("EC7", "uint8-neighbour-mean", "wraps around at 256"),
    ("EC7", "demosaic-at-border", "opposite border"),
    ("EC8", "flat-field-correction-output", "cuts the decimals off"),
    ("EC9", "imread-16-bit-grey", "three channels of 8 bits"),
    ("EC9", "imread-missing-file", "if image is None"),
]


@together(("erratum", "name", "words"), SAID)
def test_it_says_what_the_page_claims(erratum, name, words):
    assert name in names(ROWS[erratum][5])
    assert words in " ".join(wording(name).split())


def test_no_row_names_a_place_that_is_not_looked_up():
    looked_up = {(erratum, name) for erratum, name, _ in SAID}
    assert {(key, name) for key, row in ROWS.items() for name in names(row[5])} == looked_up


def light(u: float) -> float:
    """Linear value of an sRGB channel (IEC 61966-2-1)."""
    return u / 12.92 if u <= 0.04045 else ((u + 0.055) / 1.055) ** 2.4


def srgb(x: float) -> float:
    return 12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055


def luminance(*rgb: float) -> float:
    return sum(w * light(u) for w, u in zip((0.2126, 0.7152, 0.0722), rgb, strict=True))


def triangle(a, b, c) -> float:
    return abs((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])) / 2


def depth_of_field(f: float, f_number: float, c: float, s: float) -> float:
    """Exact depth of field of a thin lens; all lengths in mm."""
    hyperfocal = f * f / (f_number * c) + f
    far = s * (hyperfocal - f) / (hyperfocal - s) if s < hyperfocal else math.inf
    return far - s * (hyperfocal - f) / (hyperfocal + s - 2 * f)


def beyond(k: float) -> mpmath.mpf:
    """Share of a normal distribution more than k standard deviations from its mean, on both sides."""
    return mpmath.erfc(k / mpmath.sqrt(2))


HC = 6.62607015e-34 * 299792458 / 1.602176634e-19 * 1e9
WIDER = [depth_of_field(50, 8, 0.03, s) / depth_of_field(50, 2, 0.03, s) for s in (2000, 5000)]
DISTORTED = [
    Fraction(1, 2) * (1 - Fraction(1, 5) * (Fraction(1, 4) + y * y)) for y in (0, Fraction(1, 2), 1)
]
FOLD = 1 / math.sqrt(0.6)

NUMBERS = [
    ("E01", "0.004102, so it has 244", 1 / 0.004102, 244, 0.5),
    ("E01", "667 nm", 660 + 10 * (0.061 - 0.04) / (0.061 - 0.032), 667, 0.5),
    ("E02", "0.475", DISTORTED[0], 0.475, 0),
    ("E02", "0.450", DISTORTED[1], 0.45, 0),
    ("E02", "0.375", DISTORTED[2], 0.375, 0),
    ("E03", "1.291", FOLD, 1.291, 5e-4),
    ("E03", "0.8607", FOLD * (1 - 0.2 * FOLD**2), 0.8607, 5e-5),
    ("E03", "0.8485", math.sqrt(2) * (1 - 0.2 * 2), 0.8485, 5e-5),
    ("E04", "0.449", luminance(0.2, 0.8, 0.4), 0.449, 6e-4),
    ("E04", "0.096", luminance(0.4, 0.2, 0.8), 0.096, 6e-4),
    ("E05", "0.0722 to 1", luminance(0, 0, 1), 0.0722, 1e-12),
    ("E05", "0.0722 to 1", luminance(1, 1, 1), 1, 1e-12),
    ("E07", "is 1, not 2", Fraction(2, 2), 1, 0),
    ("E08", "0.1121", triangle((0.64, 0.33), (0.3, 0.6), (0.15, 0.06)), 0.1121, 6e-5),
    ("E08", "33.5 %", 0.1121 / 0.3342 * 100, 33.5, 0.05),
    ("E12", "1.59", HC / 780, 1.59, 5e-3),
    ("E12", "3.26", HC / 380, 3.26, 5e-3),
    ("E12", "1240 nm", HC, 1240, 0.5),
    ("E14", "4.14 times at 2 m", WIDER[0], 4.14, 5e-3),
    ("E14", "5.09 at 5 m", WIDER[1], 5.09, 5e-3),
    ("E14", "10.47 m", (2500 / (8 * 0.03) + 50) / 1000, 10.47, 5e-3),
    ("E15", "2.5 mm", Fraction(50 * 30, 600), 2.5, 0),
    ("E17", "4.550 %", beyond(2) * 100, 4.55, 5e-4),
    ("E17", "2700 of a million", beyond(3) * 1_000_000, 2700, 0.5),
    ("E18", "2.445 %", beyond(2.25) * 100, 2.445, 5e-4),
    ("E19", "4 times as large", Fraction(2) ** 2, 4, 0),
    ("E19", "8 times", Fraction(2) ** 3, 8, 0),
    ("E21", "= 4", 260 % 256, 4, 0),
    ("E22", "factor 4", math.sqrt(16), 4, 0),
    ("E25", "4000 : 1", Fraction(20_000, 5), 4000, 0),
    ("E25", "11.97 stops", math.log2(4000), 11.97, 5e-3),
    ("E25", "72.04 dB", 20 * math.log10(4000), 72.04, 5e-3),
    ("E26", "49.5", 116 * 0.18 ** (1 / 3) - 16, 49.5, 0.05),
    ("E27", "(319.5, 239.5)", Fraction(0 + 639, 2), 319.5, 0),
    ("E27", "(319.5, 239.5)", Fraction(0 + 479, 2), 239.5, 0),
    ("E30", "8.16", (8 / 2.8) ** 2, 8.16, 5e-3),
    ("E31", "0.4096", (1 / math.sqrt(1 + (3 / 4) ** 2)) ** 4, 0.4096, 1e-12),
    ("E32", "0.5 %", Fraction(50, 10_000 - 50) * 100, 0.5, 5e-3),
    ("E33", "100 line pairs", 1000 / 5 / 2, 100, 0),
    ("E33", "130 looks like 70", abs(130 - 200), 70, 0),
    ("E38", "48.7 %", (1 - 0.92**8) * 100, 48.7, 0.05),
    ("E39", "0.399 sigma", 1 / mpmath.sqrt(2 * mpmath.pi), 0.399, 5e-4),
    ("E39", "5.09 levels", 255 * 0.05 / math.sqrt(2 * math.pi), 5.09, 5e-3),
    ("E41", "exactly 1 %", (Fraction(1, 99) - Fraction(1, 100)) / Fraction(1, 99) * 100, 1, 0),
    ("E41", "exactly 1 %", (Fraction(1, 100) - Fraction(1, 101)) / Fraction(1, 101) * 100, 1, 0),
    ("E41", "1.0101 %", Fraction(100, 99), 1.0101, 5e-5),
    ("E41", "0.9901 %", Fraction(100, 101), 0.9901, 5e-5),
    ("E42", "0.730", mpmath.mpf("0.5") ** (1 / mpmath.mpf("2.2")), 0.73, 5e-4),
    ("E42", "0.692", (0.2 ** (1 / 2.2) + 0.8 ** (1 / 2.2)) / 2, 0.692, 5e-4),
    ("E42", "0.693", (0.481 + 0.904) / 2, 0.693, 5.1e-4),
    ("E42", "0.7354", srgb(0.5), 0.7354, 5e-5),
    ("E42", "0.6954", (srgb(0.2) + srgb(0.8)) / 2, 0.6954, 5e-5),
    ("E43", "65504", (2 - Fraction(1, 2**10)) * 2**15, 65504, 0),
    ("E43", "16777216", 2**24, 16777216, 0),
    ("E49", "21.5 µm", 2.44 * 0.55 * 16, 21.5, 0.05),
    ("E51", "0.289", 1 / math.sqrt(12), 0.289, 5e-4),
    ("EC1", "becomes 14°", 2 * (15 // 2), 14, 0),
    ("EC1", "becomes −16°", 2 * (-15 // 2), -16, 0),
    ("EC3", "239", 179 + 120 // 2, 239, 0),
    ("EC3", "154°", 2 * (256 - 179), 154, 0),
    ("EC6", "25 % black", (1 - Fraction(3, 2) / 2) * 100, 25, 0),
    ("EC6", "75 % white", Fraction(3, 2) / 2 * 100, 75, 0),
    ("EC7", "gives 51", Fraction(460 % 256, 4), 51, 0),
    ("EC7", "for 115", Fraction(100 + 120 + 110 + 130, 4), 115, 0),
    ("EC8", "191.25", Fraction(255 * 150, 200), 191.25, 0),
    ("EC9", "becomes 156", 40000 // 256, 156, 0),
]


@together(("erratum", "words", "value", "stated", "within"), NUMBERS)
def test_a_stated_number_is_right(erratum, words, value, stated, within):
    assert words in " ".join(ROWS[erratum])
    assert abs(float(value) - stated) <= within


def test_the_depth_of_field_has_no_bound_from_the_stated_distance():
    assert depth_of_field(50, 8, 0.03, 10_460) < math.inf
    assert depth_of_field(50, 8, 0.03, 10_470) == math.inf


def test_the_metamers_of_the_page_cancel_in_every_pair_of_bands():
    difference = (1, -1, 1, -1)
    assert "(1, −1, 1, −1)" in ROWS["E13"][4]
    assert [sum(difference[i : i + 2]) for i in range(3)] == [0, 0, 0]


def test_the_hidden_mistakes_are_hidden():
    assert round(45 / 255, 3) == round(45 / 256, 3) == 0.176
    assert Fraction(125 - 50, 150) == 1 - Fraction(125 - 50, 150)
    assert 8 / 2 == math.log2((8 / 2) ** 2) == 4

"""Units in the questions of the bank: right ones are never refused, missing ones cost little.

The rows were typed by hand from the numbers that the notes print, else from seed 1.
"""

from __future__ import annotations

import re
from fractions import Fraction
from functools import cache

from sweep import spread, together

from quizgen.bank.bank import builtin_bank
from quizgen.grading.options import GradingOptions
from quizgen.kinds import quantity
from quizgen.maths.units import format_unit
from quizgen.paper.answer_key import make_key_question
from quizgen.paper.grading import QuestionGrader
from quizgen.paper.paper import PaperItem
from quizgen.question.compose import compose_question

FULL = {
    ("stored-values-and-bytes", "b"): "6220800|6220800 B|6220800 bytes|6.2208 MB|6,220,800 Byte|6.2208 megabytes"
    "|6.2208 million bytes|62.208 lakh bytes|৬২.২০৮ লাখ বাইট|6,2208 Mio. Byte|৬২২০৮০০ বাইট|62,20,800|6075 KiB|49766400 bits",
    ("floats-or-uint8", "c"): "24883200|24883200 B|24883200 bytes|24.8832 MB|24300 KiB|২৪৮৮৩২০০ বাইট",
    ("value-range-and-type", "a"): "256; 255; 1|256 levels; 255; 1 byte|256 levels, 255, 8 bits|২৫৬টি স্তর; ২৫৫; ১ বাইট"
    "|L = 256, M = 255, B = 1 B|256 grey levels; 255; 1 B",
    ("stored-values-and-bytes", "a"): "6220800|6220800 values|6,220,800 values|৬২২০৮০০টি মান|6220800 samples",
    ("diameter-stops-and-exposure-time", "a"): "25; 6.25|25 mm; 6.25 mm|2.5 cm; 0.625 cm|25 millimetres, 6.25 millimetres"
    "|২৫ মিমি; ৬.২৫ মিমি|D_1 = 25 mm, D_2 = 6.25 mm|25 mm and 6.25 mm|D1=25mm D2=6,25mm",
    ("diameter-stops-and-exposure-time", "b"): "16|16x|16 times|16-fold|৬/৬*১৬|১৬ গুণ|1600 %",
    ("diameter-stops-and-exposure-time", "c"): "4|4 stops|4 stop|4 f-stops|4 EV|৪ স্টপ|৪টি স্টপ|log2(16)|4 Blendenstufen",
    ("photon-snr-and-decibels", "b"): "40.0|40|40 dB|40.0 decibels|৪০ ডেসিবেল|20*log10(100) = 40 dB|40 decibel",
    ("which-effects-to-simulate", "b"): "2.5|2.5 px|2.5 pixels|2,5 Pixel|২.৫ পিক্সেল",
    ("which-effects-to-simulate", "d"): "0.051|0.051 steps|0.051 quantisation steps|0.051 ধাপ",
    ("blur-disc-diameter", "c"): "20|20 px|20 pixels|২০টি পিক্সেল|20 Pixel|100 µm / 5 µm = 20",
    ("image-height-and-fill-distance", "b"): "500|500 px|500 pixels|500 Pixel|৫০০ পিক্সেল|৫০০টি পিক্সেল|0.5 kpx",
    ("gaussian-peak-and-tail-shares", "a"): "0.1995|0.1995 per grey level|0.1995 / grey level|০.১৯৯৫ প্রতি ধূসর মাত্রায়"
    "|1/(2*sqrt(2*pi))",
    ("gaussian-peak-and-tail-shares", "b"): "4.55|4.55 %|0.0455|4.55 percent|4.55 per cent|4,55 Prozent|৪.৫৫ শতাংশ"
    "|শতকরা ৪.৫৫|5 %",
    ("gaussian-peak-and-tail-shares", "c"): "2700|2700 px|2700 pixels|2.7 kpx|২৭০০ পিক্সেল|২৭০০টি পিক্সেল|2 700 pixels",
    ("salt-and-pepper-counts", "a"): "64000; 64000; 1152000|64000 px; 64000 px; 1152000 px"
    "|64000 pixels, 64000 pixels, 1152000 pixels|৬৪০০০টি; ৬৪০০০টি; ১১৫২০০০টি|N_b = 64000 px; N_w = 64 kpx; N_0 = 1152 kpx",
    ("salt-and-pepper-thresholds", ""): "250; 750|250 750|250 pixels; 750 pixels|250 values, 750 values|(250, 750)",
    ("channel-counts", ""): "1; 3; 4; 4|1 channel, 3 channels, 4 channels, 4 channels|১টি; ৩টি; ৪টি; ৪টি|1 3 4 4",
    ("bayer-site-counts", "a"): "9; 12; 4|9 photosites; 12 photosites; 4 photosites|R=9, G=12, B=4|9 px, 12 px, 4 px"
    "|৯টি ফটোসাইট; ১২টি ফটোসাইট; ৪টি ফটোসাইট",
    ("demosaic-blue-and-green-site", "b"): "65|65 grey levels|R = 65|65 DN|৬৫",
    ("quantisation-levels-and-error", "a"): "8; 0.1429|8 levels; 0.1429|8 levels; 1/7|৮টি স্তর; ১/৭|8; 14.29 %",
    ("quantisation-levels-and-error", "b"): "7|level 7|k = 7|স্তর ৭|7 levels",
    ("rgb-to-hsv", "a"): "0.8; 0.6; 0.75|80 %; 60 %; 75 %|80%, 60%, 75%|0.8; 0.6; 75 percent|৮০ শতাংশ; ৬০ শতাংশ; ৭৫ শতাংশ"
    "|V = 80 %, Δ = 60 %, S = 75 %|4/5; 3/5; 3/4",
    ("rgb-to-hsv", "b"): "140|140°|140 degrees|140 deg|১৪০ ডিগ্রি|7π/9 rad|H = 140°",
    ("hsv-to-rgb", ""): "0.2; 0.8; 0.4|20 %; 80 %; 40 %|(20 %, 80 %, 40 %)|RGB = (0.2, 0.8, 0.4)|২০ শতাংশ; ৮০ শতাংশ; ৪০ শতাংশ"
    "|(20; 80; 40) %|R = 20 %; G = 80 %; B = 40 %",
    ("radial-point-off-axis", "b"): "-10 %|-10|-0.1|−10 percent|-১০ শতাংশ|-10 Prozent|q = -10 %",
    ("weak-perspective-scale-error", "c"): "1 %|1|0.01|1 percent|১ শতাংশ|শতকরা ১",
    ("point-to-pixel", ""): "440; 160|(440; 160) px|440 px; 160 px|(440, 160) pixels|u = 440 px, v = 160 px|৪৪০ পিক্সেল; ১৬০ পিক্সেল"
    "|(440 px ¦ 160 px)|P(440¦160)",
    ("luminous-flux-over-bands", ""): "21.77 lm|21.77 lumens|21.77 Lumen|২১.৭৭ লুমেন|0.02177 klm|21.77 (lm)|21.77 [lm]",
    ("two-lasers-flux-ratio", "a"): "243.9|243.9x|243.9 times|২৪৩.৯ গুণ|10000/41|243.9 fold",
    ("two-lasers-flux-ratio", "b"): "243.9 mW|0.2439 W|243.9 milliwatts|২৪৩.৯ মিলিওয়াট|10000/41 mW ≈ 243.9 mW",
    ("focal-length-size-and-distance", "b"): "30 m|30 metres|30 meters|3000 cm|৩০ মিটার|৩০ মি.|30 (m)|0.03 km",
    ("thin-lens-image-distance", "a"): "66.67 mm|66,67 mm|200/3 mm|6.667 cm|66.67 Millimeter|৬৬.৬৭ মি.মি.|66.67\\,\\text{mm}|z' = 66.67 mm",
    ("blur-disc-diameter", "a"): "100 µm|100 um|100 micrometres|100 microns|0.1 mm|১০০ মাইক্রোমিটার|১০০ মাইক্রন|100 μm",
    ("blur-and-light-factors", "e"): "0.128 s|128 ms|0.128 seconds|0,128 Sek.|০.১২৮ সেকেন্ড|16/125 s|0.128 sec|128 milliseconds",
    ("rods-cones-and-peaks", "b"): "one; rods; 507|one; rods; 507 nm|1, rods, 507 nm|(1) one (2) rods (3) 507 nm"
    "|এক; রড; ৫০৭ ন্যানোমিটার|1; rods; 507nm",
}  # fmt: skip
"""Template and part to answers that get full marks, between bars; ``¦`` is a bar that is typed."""

MISSING = {
    ("luminous-flux-over-bands", "", "21.77"): "3.5",
    ("thin-lens-image-distance", "a", "66.67"): "2.5",
    ("thin-lens-image-distance", "c", "16.67"): "1",
    ("blur-disc-diameter", "a", "100"): "3.5",
    ("focal-length-size-and-distance", "b", "৩০"): "1.5",
    ("blur-and-light-factors", "e", "0.128"): "0.5",
    ("image-scaling-laws", "b", "3.333"): "0.25",
    ("two-lasers-flux-ratio", "b", "10000/41"): "1.5",
    ("image-height-and-fill-distance", "a", "2,5"): "1.5",
}
"""A number right without its unit, and the marks it gets: never more than half a point is lost."""

OTHER = {
    ("diameter-stops-and-exposure-time", "c", "4 px"),
    ("stored-values-and-bytes", "b", "6220800 px"),
    ("stored-values-and-bytes", "a", "6220800 B"),
    ("blur-disc-diameter", "c", "20 µm"),
    ("gaussian-peak-and-tail-shares", "c", "২৭০০ বাইট"),
    ("photon-snr-and-decibels", "b", "40 B"),
    ("thin-lens-image-distance", "a", "66.67 px"),
    ("quantisation-levels-and-error", "b", "7 px"),
}
"""The right number of something else: said to be another unit."""

SHAPES = ("number", "quantity", "point", "table")


MEASURED = sorted(
    name
    for name in builtin_bank().template_paths
    if any(part.answer["kind"] in SHAPES for part in builtin_bank().rules(name).part)
)


@cache
def keyed(name: str, lang: str = "en"):
    template = builtin_bank().template(name)
    seed = "reference" if template.rules.reference else 1
    question, key = compose_question(template, seed, lang, figures=False)
    return question, key, make_key_question(PaperItem("1", (question,), (key,)))


def marked(name: str, part: str, typed: str, lang: str = "en"):
    _, _, table_of_key = keyed(name, lang)
    (one,) = [p for p in table_of_key.parts if p.id == f"1{part}"]
    return QuestionGrader(table_of_key, GradingOptions(lang)).grade_part(one, typed)


@together("lang", ["en", "bn"])
@together("where", FULL)
def test_a_right_unit_is_never_refused(where, lang):
    for typed in FULL[where].split("|"):
        result = marked(*where, typed.replace("¦", "|"), lang)
        assert result.marks == result.points, (typed, result.verdict)


@together("where", MISSING)
def test_a_missing_unit_costs_half_a_point_at_most(where):
    result = marked(*where)
    assert result.verdict.note == "unit-missing"
    assert result.marks == Fraction(MISSING[where])


@together("where", sorted(OTHER))
def test_another_unit_is_told_as_such(where):
    result = marked(*where)
    assert (result.marks, result.verdict.note) == (0, "unit-wrong"), result.verdict


NAMES = {"B": r"\bbytes\b", "dB": r"decibel", "px": r"\bpixels?\b", "%": r"percent",
         "e-": "electrons", "bit": "bits"}  # fmt: skip
NAMED_BN = {"B": r"\bbytes?\b", "dB": "decibel|ডেসিবেল", "px": "pixel", "%": "শত(াংশ|করা)|percent",
            "e-": "electron", "bit": r"\bbits?\b"}  # fmt: skip


def _asks(question, label: str, lang: str) -> str:
    """The question's own sentence, without its numbers and their units."""
    (part,) = [p for p in question.parts if p.label == label]
    text = str(part.to_html(lang)) if label else question._repr_html_()
    text = re.sub(r"<p><small>.*?</small></p>", "", text)
    bold = re.findall(r"<strong>(.*?)</strong>", text, re.DOTALL)
    return re.sub(r"<[^>]+>", " ", bold[-1] if bold else text)


@together("lang", ["en", "bn"])
@together("name", spread(MEASURED, 16))
def test_where_the_question_names_the_unit_a_bare_number_has_full_marks(name, lang):
    question, key, _ = keyed(name, lang)
    for part, spec in zip(question.parts, key.specs, strict=True):
        if isinstance(spec, quantity.QuantitySpec):
            known = (NAMES if lang == "en" else NAMED_BN).get(spec.unit)
            sentence = _asks(question, part.label, lang)
            named = bool(known and re.search(known, sentence))
            named |= bool(
                re.search(
                    rf"\bin {re.escape(format_unit(spec.unit))}\b|{format_unit(spec.unit)}-এ",
                    sentence,
                )
            )
            assert named == spec.bare, (part.label, sentence)


def _answers(printed: str) -> list[str]:
    """The printed answer with its unit, without, and with the unit in words."""
    exact = printed.rsplit(" ≈ ", maxsplit=1)[-1]
    units = {"mm": "millimetres", "px": "pixels", "m": "metres", "s": "seconds", "ms": "milliseconds", "µm": "micrometres", "lm": "lumens",
             "mW": "milliwatts", "B": "bytes", "dB": "decibels", "%": "percent",
             "e⁻": "electrons", "bit": "bits", "stop": "stops",
             "eV": "electronvolts", "nm": "nanometres",
             "Gbit/s": "gigabits per second", "GB": "gigabytes", "lp/mm": "line pairs per millimetre", "MB/s": "megabytes per second"}  # fmt: skip
    words = re.sub(r"(?<=[\d)]) (\S+?)(?=$|;)", lambda m: f" {units[m[1]]}", exact)
    bangla = exact.translate(str.maketrans("0123456789", "০১২৩৪৫৬৭৮৯"))
    bare = re.sub(r"(?<=[\d)]) (\S+?)(?=$|;)", "", exact)
    return [exact, words, bangla, bare]


@together("lang", ["en", "bn"])
@together("name", spread(MEASURED, 16))
def test_every_printed_number_with_its_unit_without_and_in_words(name, lang):
    _, key, question_key = keyed(name, lang)
    marker = QuestionGrader(question_key, GradingOptions(lang))
    parts = zip(question_key.parts, key.specs, key.solution.parts, strict=True)
    for part, spec, solved in parts:
        if spec.kind not in SHAPES:
            continue
        *with_unit, bare = _answers(solved.answer)
        for typed in with_unit:
            assert marker.grade_part(part, typed).verdict.verdict == "correct", (part.id, typed)
        lost = part.points_exact() - marker.grade_part(part, bare).marks
        most = Fraction(1, 2) if isinstance(spec, quantity.QuantitySpec) and not spec.bare else 0
        assert lost <= most, (part.id, bare)

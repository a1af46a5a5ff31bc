"""What a person gets, kept to be read: papers with solutions, keys, forms, cards, schemas.

Three templates of every topic, chosen so that every kind of answer is among them. What differs is
shown line by line; ``uv run pytest --snapshot-update`` keeps it, and the diff is the review.
"""

from __future__ import annotations

import hashlib
import json
import re

import pytest
from msgspec.structs import replace

from quizgen.bank.json_schema import build_json_schema
from quizgen.cards import build_deck
from quizgen.cards.apkg import write_apkg
from quizgen.cards.delimited import write_tsv
from quizgen.paper.answer_form import write_blank_form
from quizgen.paper.answer_key import write_answer_key
from quizgen.paper.blueprint import Blueprint, SlotRule, load_blueprint
from quizgen.paper.paper import build_paper
from quizgen.render import KINDS, render_paper
from quizgen.render.text import format_question

ASKED = {
    "aperture": (
        "blur-and-light-factors",
        "derive-blur-disc",
        "which-photo-which-f-number",
        "which-photo-which-focus",
    ),
    "camera": ("exposure-faults-and-remedies", "which-effects-to-simulate", "why-pinhole-model"),
    "code": ("add-noise-to-uint8-order", "uint8-sum", "uint8-sum-repair", "write-hue-shift"),
    "colour": ("hsv-edit-from-pictures", "rgb-to-hsv", "white-balance-and-chromaticity"),
    "distortion": (
        "draw-distortion-to-scale",
        "undistort-by-iteration",
        "vignetting-from-a-profile",
    ),
    "eye": ("rods-cones-and-peaks", "two-lasers-flux-ratio", "two-lasers-from-curves"),
    "image": ("quantiser-from-staircase", "stored-values-and-bytes", "value-range-and-type"),
    "noise": (
        "photon-snr-formula-and-model",
        "recognise-noise-from-histograms",
        "true-or-false-noise",
    ),
    "normalisation": (
        "normalisation-from-histograms",
        "normalise-from-8-bit-range",
        "normalise-from-offset-range",
    ),
    "optics": ("thin-lens-image-distance", "thin-lens-limits", "veiling-glare-and-contrast"),
    "projection": (
        "points-on-one-ray",
        "vanishing-point-of-a-line",
        "weak-perspective-scale-error",
    ),
    "sensor": ("rolling-shutter-skew", "snr-of-one-pixel", "why-bayer-green-and-demosaicing"),
}
"""Topic to templates."""
LEVELS = {"exam": "", "guided": "-guided", "transfer": "-transfer"}
"""Level to what stands behind a topic in names of files; the last two for one topic alone."""
LANGS = ("en", "bn")
PAGES = [(topic, "exam") for topic in ASKED] + [("optics", "guided"), ("optics", "transfer")]


def paper_of(bank, topic, lang, level):
    slots = tuple(SlotRule(templates=(name,)) for name in ASKED[topic])
    blueprint = Blueprint({"en": topic}, slots, name=topic, source=topic, level=level)
    # A code names the files of the bank, which may change while the paper stays what it is.
    return replace(build_paper(bank, blueprint, 1, lang, figures=False), code="snapshot")


@pytest.mark.parametrize(("topic", "level"), PAGES)
@pytest.mark.parametrize("lang", LANGS)
def test_the_text_of_a_paper_with_its_solutions(bank, snapshots, topic, level, lang):
    items = paper_of(bank, topic, lang, level).items
    text = "\n\n\n".join(f"{item.number}. {format_question(item)}" for item in items)
    snapshots.check(f"papers/{topic}{LEVELS[level]}.{lang}.txt", f"{text}\n")


@pytest.mark.parametrize(("topic", "level"), PAGES)
def test_the_key_of_a_paper_in_both_languages(bank, snapshots, topic, level):
    key = write_answer_key(paper_of(bank, topic, "both", level)).decode()
    snapshots.check(f"papers/{topic}{LEVELS[level]}.key.json", key)


def test_the_page_of_a_paper(bank, snapshots):
    """The markup of optics, a tag a line, without styles and fonts; solutions are read as text."""
    page = render_paper(paper_of(bank, "optics", "both", "exam"), "exam", "html").decode()
    page = re.sub(r'(?<=data-paper=")\w+', "snapshot", page)
    page = re.sub(r"(?<=>)(?=<)", "\n", re.sub(r"<style.*?</style>", "", page, flags=re.DOTALL))
    snapshots.check("pages/optics.exam.html", f"{page}\n")


def test_every_topic_and_kind_of_answer_is_among_them(bank, snapshots):
    assert set(ASKED) == {bank.rules(name).topic for name in bank.template_paths}
    asked = {name for names in ASKED.values() for name in names}
    kinds = {
        name: {part.answer["kind"] for part in bank.rules(name).part}
        for name in bank.template_paths
    }
    assert set().union(*(kinds[name] for name in asked)) == set().union(*kinds.values())
    ends = [*(f"{lang}.txt" for lang in LANGS), "key.json"]
    names = [f"{topic}{LEVELS[level]}.{end}" for topic, level in PAGES for end in ends]
    snapshots.check_names("papers", names)


def test_the_form_to_fill_in(bank, snapshots):
    trial = replace(
        build_paper(bank, load_blueprint("trial"), 5, "both", figures=False), code="snapshot"
    )
    snapshots.check("forms/trial.toml", write_blank_form(trial).decode())


def test_the_cards_of_a_topic(snapshots):
    snapshots.check("cards/noise.tsv", write_tsv(build_deck("both", topics=("noise",))).decode())


@pytest.mark.parametrize("kind", ["template", "bank"])
def test_the_schema_that_editors_check_by(snapshots, kind):
    table = json.dumps(json.loads(build_json_schema(kind)), indent=1, ensure_ascii=False)
    snapshots.check(f"schemas/{kind}.json", f"{table}\n")


@pytest.mark.slow
def test_files_that_no_person_reads_keep_their_bytes(bank, snapshots):
    """Hashes, for these are binary: where one changes, the snapshots beside it tell why."""
    trial = replace(build_paper(bank, load_blueprint("trial"), 5, "both"), code="snapshot")
    made = {f"trial/{kind}.pdf": render_paper(trial, kind, "pdf") for kind in KINDS}
    made["noise.apkg"] = write_apkg(build_deck("both", topics=("noise",)))
    hashes = {name: hashlib.sha256(data).hexdigest() for name, data in made.items()}
    snapshots.check("hashes.json", json.dumps(hashes, indent=1) + "\n")

"""Scene files, the command and PNG files."""

import json
import subprocess
import sys
import zlib
from base64 import b64decode
from importlib import import_module
from pathlib import Path

import html5lib
import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image
from sweep import spread, together

from quizgen.camera import PreparedScene, SceneError, plan_budget
from quizgen.camera.comparison import amplify_difference
from quizgen.camera.pixels import codecs
from quizgen.camera.question_photo import InvisibleEffectError
from quizgen.camera.scene_file import load_scene
from quizgen.cli.simulate import SCENES, simulate
from quizgen.cli.terminal import ProgressLine
from quizgen.figures.svg import encode_png

NAMES = sorted(path.stem for path in SCENES.glob("*.toml"))

WRONG = [
    ('[camera]\nfocal_lenght = "50 mm"\n', 2, "did you mean 'focal_length'"),
    ('[camera]\n\nfocal_length = "50 kg"\n', 3, "expected a unit like 'm'"),
    ('[camera]\nfocal_length = "50 s"\n', 2, "expected a unit like 'm'"),
    ("[camera]\nfocal_length = 50\n", 2, "quantity with its unit"),
    ('[camera]\nfocal_length = "-50 mm"\n', 2, "focal_length must be 1e-06 to 1000 m"),
    ('[camera]\nread_noise = "3 e-"\n', 2, "read_noise needs full_well"),
    ("[camera]\nmechanical_vignetting = 1.5\n", 2, "must be in [0, 1)"),
    ('[camera]\n\nexposure = "2000 stop"\n', 3, "exposure must be -40 to 40 stop"),
    ('[camera]\n\nexposure = "-2000 stop"\n', 3, "exposure must be -40 to 40 stop"),
    ("[camera]\ngaussian_noise = 1e300\n", 2, "at most 1e+12"),
    ("[camera]\nspin = 1\ngamma = 2000\n", 2, "unknown key"),
    ('[camera]\nshutter = "1 s"\ngamma = 2000\n', 3, "a number from 1 to 100"),
    (
        '[camera]\nfull_well = "9 e-"\nshutter = "1 s"\ndark_current = "1e12 e-/s"\n',
        4,
        "more than 1e+08 e-",
    ),
    (
        '[scene]\nwidth = 40\nheight = 30\n[camera]\nlateral_colour = "-30 px"\n',
        5,
        "more than half of the 24.3 px to the corner",
    ),
    (
        '[camera]\nfocal_length = "50 mm"\nsensor_width = "36 mm"\nf_number = "f/two"\n',
        4,
        "cannot read 'f/two'; expected 2.8 or 'f/2.8'",
    ),
    (
        '[camera]\nfocal_length = "50 mm"\nsensor_width = "36 mm"\nk1 = -20\n',
        4,
        "k1=-0.6, k2=0 does not",
    ),
    ("[camera]\nnormalise = [0, 1e-300, 0, 1]\n", 2, "max - min"),
    ("[scene]\nbackground = [1e9, 0, 0]\n", 2, "radiance of at most 1e+06"),
    ("[scene]\nwidth = 32768\nheight = 32768\n", 2, "more than 24 megapixels"),
    ("[camera]\nbit_depth = true\n", 2, "whole number"),
    ('[camera]\nmosaic = "RGBG"\n', 2, "expected one of RGGB"),
    ("[camra]\nk1 = 0\n", 1, "did you mean 'camera'"),
    ('[[thing]]\nshape = "full"\n[[thing]]\nshape = "disc"\ncolor = "#ffffff"\n', 5, "'colour'"),
    ('[[thing]]\nshape = "disc"\n', 1, "a disc needs radius"),
    ('[[thing]]\nshape = "star"\n', 2, "expected one of box"),
    ('[[thing]]\nshape = "full"\ncolour = "red"\n', 3, "list of 3"),
    ('[[thing]]\nshape = "full"\ndepth = "-1 m"\n', 3, "positive"),
    ("[scene]\nwidth = 0\n", 2, "2 to 32768"),
    ('[scene]\nimage = "missing.png"\n', 2, "missing.png"),
    ('[question]\nasks = ["colour"]\n', 2, "expected one of"),
    ("[question]\nreads = { corner = 3 }\n", 1, "a question needs asks"),
    ('[question]\nasks = "gamma"\nreads = { corner = -3 }\n', 3, "must be positive"),
    ('[scene]\nwidth = "1/0 px"\n', 2, "whole number"),
    ('[camera]\nshutter = "1/0 s"\n', 2, "shutter"),
]


@pytest.mark.parametrize(("text", "line", "words"), WRONG)
def test_a_wrong_file_is_one_line_with_its_place(tmp_path, text, line, words):
    path = tmp_path / "scene.toml"
    path.write_text(text, "utf-8")
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    message = str(caught.value)
    assert message.startswith(f"{path}:{line}: ")
    assert words in message
    assert "\n" not in message


def a_picture(name):
    data = encode_png(np.random.default_rng(3).integers(0, 256, (6, 5, 3), np.uint8))
    header = b"IHDR" + (20_000).to_bytes(4, "big") * 2 + data[24:29]
    huge = data[:12] + header + zlib.crc32(header).to_bytes(4, "big") + data[33:]
    return {"other": b"GIF89a", "short": data[:60], "none": b"", "huge": huge}[name]


@pytest.mark.parametrize(
    ("name", "words"),
    [("other", "not a PNG or JPEG file"), ("short", "a broken PNG file"), ("none", "not a PNG or JPEG file"),
     ("huge", "more than 24 megapixels")],
)  # fmt: skip
@pytest.mark.parametrize("key", ["image", "depth_map"])
def test_a_bad_picture_is_one_line_with_its_place(tmp_path, key, name, words):
    (tmp_path / "bad.png").write_bytes(a_picture(name))
    path = tmp_path / "scene.toml"
    path.write_text(f'[scene]\nseed = 1\n{key} = "bad.png"\n', "utf-8")
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    assert str(caught.value) == f"{path}:3: bad.png: {words}"


@pytest.mark.parametrize("size", [(1, 1), (1, 300), (300, 1)])
def test_pictures_without_a_neighbour_are_refused(tmp_path, size):
    (tmp_path / "line.png").write_bytes(encode_png(np.zeros((*size, 3), np.uint8)))
    path = tmp_path / "scene.toml"
    path.write_text('[scene]\nimage = "line.png"\n', "utf-8")
    with pytest.raises(SceneError, match=r":2: line.png: .* at least 2 rows and columns"):
        load_scene(path)


def test_a_blur_much_wider_than_the_picture_is_one_line(tmp_path):
    """Focus at the near end and everything else at infinity."""
    path = tmp_path / "scene.toml"
    path.write_text(
        '[camera]\nfocal_length = "50 mm"\nsensor_width = "23.6 mm"\nf_number = "F/1.4"\n'
        'focus_distance = "60 mm"\n',
        "utf-8",
    )
    with pytest.raises(SceneError, match=r"a blur of 4.84e\+03 px is more than 800 px"):
        plan_budget(PreparedScene(*load_scene(path)))


@pytest.mark.parametrize("key", ["width", "none"])
def test_a_sensor_is_as_wide_as_the_picture_on_it(tmp_path, key):
    """A photograph brings its own width; 36 mm over 90 columns are 400 um each."""
    (tmp_path / "photo.png").write_bytes(encode_png(np.zeros((6, 90, 3), np.uint8)))
    path = tmp_path / "scene.toml"
    width = "width = 30\n" if key == "width" else ""
    path.write_text(
        f'[scene]\nimage = "photo.png"\n{width}[camera]\nfocal_length = "50 mm"\n'
        'sensor_width = "36 mm"\n',
        "utf-8",
    )
    assert load_scene(path)[1].given["pixel_pitch"] == pytest.approx(400e-6)


def test_broken_toml_and_missing_files_are_named(tmp_path):
    (tmp_path / "a.toml").write_text("[scene\n", "utf-8")
    for name in ("a.toml", "b.toml"):
        with pytest.raises(SceneError, match=name):
            load_scene(tmp_path / name)


def test_units_become_base_units(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(
        '[camera]\nfocal_length = "50 mm"\nsensor_width = "36 mm"\nf_number = "f/2.8"\n'
        'focus_distance = "300 cm"\nshutter = "1/250 s"\nhue = "180 deg"\nsmear = "2 %"\n'
        'full_well = "20000 e-"\nvelocity = ["3 px/s", "-1 px/s"]\n'
        '[[thing]]\nshape = "box"\nwidth = "2 m"\nheight = "30 px"\ndepth = "4 m"\n'
        'colour = "#bcbcbc"\nvelocity = ["1 m/s", "2 px/s"]\n',
        "utf-8",
    )
    scene, camera = load_scene(path)
    assert camera.given == {
        "focal_length": 0.05, "f_number": 2.8, "focus_distance": 3.0, "shutter": 0.004,
        "smear": 0.02, "velocity": (3.0, -1.0), "full_well": 20000.0,
        "pixel_pitch": pytest.approx(0.036 / 640), "hue": pytest.approx(np.pi),
    }  # fmt: skip
    thing = scene.things[0]
    assert (thing.width, thing.height) == ((2.0, True), (30.0, False))
    assert thing.velocity == ((1.0, True), (2.0, False))
    assert thing.colour == pytest.approx([0.5029] * 3, abs=1e-4)


def test_a_picture_with_a_depth_map(tmp_path):
    codes = np.random.default_rng(0).integers(0, 256, (12, 16, 3), np.uint8)
    (tmp_path / "photo.png").write_bytes(encode_png(codes))
    nearness = np.zeros((12, 16), np.uint8)
    nearness[:, 8:] = 255
    (tmp_path / "near.png").write_bytes(encode_png(nearness))
    path = tmp_path / "scene.toml"
    path.write_text(
        '[scene]\nimage = "photo.png"\ndepth_map = "near.png"\ndepth_near = "2 m"\n'
        'depth_far = "10 m"\n[camera]\ngamma = "srgb"\n',
        "utf-8",
    )
    scene, _ = load_scene(path)
    assert (scene.width, scene.height) == (16, 12)
    assert scene.depth[0, 0] == pytest.approx(10)
    assert scene.depth[0, 15] == pytest.approx(2)
    out = tmp_path / "out.png"
    result = CliRunner().invoke(simulate, [str(path), "--out", str(out)], catch_exceptions=False)
    assert result.exit_code == 0
    assert np.array_equal(codecs.decode_photo(out.read_bytes()), codes)


def invoke(*arguments):
    result = CliRunner().invoke(simulate, list(arguments), catch_exceptions=False)
    assert result.exit_code == 0
    return result.output


@pytest.mark.parametrize("name", spread(NAMES, 2))
def test_shipped_scenes(name, tmp_path):
    """Each runs, keeps its bound and writes the same bytes twice; what it asks about is seen."""
    out = tmp_path / "photo.png"
    report = json.loads(invoke(name, "--json", "--out", str(out)))
    first = out.read_bytes()
    assert codecs.decode_photo(first).shape == (480, 640, 3)
    assert all(one["is_visible"] for one in report.get("seen", ()))
    invoke(name, "--json", "--out", str(out))
    assert out.read_bytes() == first
    compared = json.loads(invoke(name, "--everything", "--json"))["everything"]
    assert compared["bound_kept"]
    assert compared["difference_dn"] <= report["bound_dn"] + 1e-4


EXPECTED = {
    "pinhole": [],
    "fisheye": ["distortion"],
    "flat": ["shot noise", "gamma"],
    "night": ["blooming", "smear", "gamma"],
    "portrait": ["projection", "defocus", "gamma"],
    "propeller": ["rolling shutter", "gamma"],
    "texture": ["mosaic", "demosaicing", "gamma"],
}


@together("name", EXPECTED)
def test_only_what_a_scene_asks_about_runs(name):
    assert json.loads(invoke(name, "--json"))["ran"] == EXPECTED[name]


def test_what_was_left_out_is_said_in_words():
    said = invoke("flat")
    assert "read noise: not asked; would add noise of 2 electrons" in said
    assert "shot noise is seen: spreads counts by up to 4.47 electrons" in said


def test_effects_are_chosen_by_name():
    def ran(*options):
        return json.loads(invoke("flat", "--json", *options))["ran"]

    assert ran("--only", "read-noise") == ["read noise", "gamma"]
    assert ran("--with", "read noise") == ["shot noise", "read noise", "gamma"]
    assert ran("--without", "gamma") == ["shot noise"]
    assert ran("--asks", "noise") == ["shot noise", "read noise", "gamma"]
    assert "quantisation" not in ran("--budget", "0.5", "--without", "quantisation")
    assert "distortion" in ran("--budget", "0.5", "--with", "distortion")


@together(
    ("options", "message"),
    [
        (["flat", "--asks", "distortion"], "distortion cannot be seen: moves points by up to 0.06"),
        (["flat", "--asks", "defocus"], "changes no pixel by more than 0 grey levels"),
        (["fisheye", "--asks", "noise"], "nothing in this camera answers 'noise'"),
        (["fisheye", "--asks", "colour"], "unknown question 'colour'; one of"),
        (["fisheye", "--only", "gama"], "no effect 'gama'; did you mean 'gamma'?"),
        (["fisheye", "--only", "vignetting"], "has no vignetting: it needs natural_vignetting"),
        (["fisheye", "--budget", "1", "--asks", "distortion"], "pictures without a question"),
    ],
)
def test_what_cannot_be_asked_is_an_error(options, message):
    result = CliRunner().invoke(simulate, options)
    assert message in str(result.exception)


def test_one_thing_in_focus_before_an_even_ground_shows_no_depth_of_field(tmp_path):
    path = tmp_path / "sharp.toml"
    path.write_text(
        """
        [scene]
        width = 64
        height = 48
        [question]
        asks = "depth of field"
        [camera]
        focal_length = "50 mm"
        sensor_width = "23.6 mm"
        f_number = "f/1.8"
        focus_distance = "2 m"
        [[thing]]
        shape = "ellipse"
        width = "0.2 m"
        height = "0.3 m"
        depth = "2 m"
        """,
        "utf-8",
    )
    result = CliRunner().invoke(simulate, [str(path)])
    assert isinstance(result.exception, InvisibleEffectError)
    assert "sharp.toml: depth of field cannot be seen: blurs by discs" in str(result.exception)
    assert "changes no pixel by more than 0 grey levels" in str(result.exception)


def test_the_old_place_of_a_question_is_an_error(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text('[scene]\nquestion = ["gamma"]\n', "utf-8")
    with pytest.raises(SceneError, match=r"s.toml:2: unknown key 'question' in scene"):
        load_scene(path)


def test_both_times_are_measured_in_turns():
    """With nothing left out the same work is done twice, so the times are alike."""
    report = json.loads(invoke("fisheye", "--everything", "--json"))["everything"]
    assert len(report["ms"]) == len(report["chosen_ms"]) >= 3
    assert report["ms"] == sorted(report["ms"])
    assert "medians of" in invoke("fisheye", "--everything")


def test_there_are_eight_scenes_and_a_list():
    assert len(NAMES) == 8
    assert all(name in invoke() for name in NAMES)


def test_budgets_by_name_skip_more():
    counts = [
        len(json.loads(invoke("landscape", "--json", "--budget", b))["ran"])
        for b in ("0", "same", "visible", "sketch")
    ]
    assert counts == sorted(counts, reverse=True)
    assert counts[0] > counts[-1]


def test_the_table_fits_the_narrowest_usual_terminal(tmp_path):
    for arguments in ([], ["--compare", str(tmp_path / "c.jpg")]):
        lines = invoke("portrait", *arguments).splitlines()
        assert len(lines[1:10]) == 9
        assert max(map(len, lines[1:10])) <= 80


def test_what_was_run_and_left_out_says_its_bound_and_what_is_real(tmp_path):
    report = json.loads(invoke("landscape", "--json", "--compare", str(tmp_path / "c.png")))
    told = {item["effect"]: item for item in report["steps"] + report["left_out"]}
    assert [step["effect"] for step in report["steps"]] == report["ran"]
    for item in told.values():
        assert 0 <= item["really_dn"] <= item["bound_dn"] + 1e-4, item
    # gamma lifts linear 0.2 to 0.48; a converter of 14 bits is off by half a code of 1/16383
    assert 60 < told["gamma"]["really_dn"] < 80
    assert 0 < told["quantisation"]["really_dn"] < 12.92 * 255 / 16383
    assert told["full well"]["really_dn"] == 0
    assert report["seed"] == 2
    assert {"read", "drawn", "effects"} == set(report["times_ms"])
    assert min(report["times_ms"].values()) >= 0


def picture(path):
    with Image.open(path) as file:
        return np.asarray(file).astype(int)


def test_a_comparison_stands_side_by_side(tmp_path):
    """With what is asked, without, and their difference, with 8 white columns between."""
    beside, alone = tmp_path / "c.png", tmp_path / "p.png"
    invoke("texture", "--compare", str(beside), "--out", str(alone))
    wide, planned = picture(beside), picture(alone)
    height, width = planned.shape[:2]
    assert wide.shape == (height, 3 * width + 16, 3)
    assert (wide[:, width : width + 8] == 255).all()
    left, middle, right = (wide[:, n * (width + 8) :][:, :width] for n in range(3))
    assert np.array_equal(left, planned)
    apart = np.abs(left - middle)[100:]  # below the scale that is written on it
    assert apart.max() > 32
    assert np.abs(right[100:] - apart).max() <= 1, "so large that it is seen as it is"


def test_a_small_difference_is_amplified():
    one = np.full((20, 30, 3), 0.5)
    scale, codes = amplify_difference(one, one + 0.004)
    assert scale == 200
    assert (codes == round(0.004 * 200 * 255)).all()
    assert amplify_difference(one, one)[1].max() == 0


def test_a_page_shows_the_pictures_and_the_table(tmp_path):
    page = tmp_path / "c.html"
    invoke("pinhole", "--compare", str(page))
    invoke("portrait", "--compare", str(page))
    tree = html5lib.HTMLParser(strict=True, namespaceHTMLElements=False).parse(
        page.read_text("utf-8")
    )
    images = [image.get("src") for image in tree.iter("img")]
    assert len(images) == 3
    sizes = {
        codecs.decode_photo(b64decode(source.partition("base64,")[2])).shape for source in images
    }
    assert sizes == {(480, 640, 3)}
    cells = [[cell.text or "" for cell in row] for row in tree.iter("tr")]
    assert [row[0] for row in cells][1:4] == ["projection", "defocus", "gamma"]
    assert all(len(row) == 6 for row in cells)
    assert [caption.text for caption in tree.iter("figcaption")] == [
        "with defocus",
        "without defocus",
        "difference × 5",
    ]


def test_another_ending_of_a_comparison_is_refused(tmp_path):
    result = CliRunner().invoke(simulate, ["pinhole", "--compare", str(tmp_path / "c.pdf")])
    assert ".jpeg, .html" in str(result.exception)


def test_what_takes_long_says_what_it_does(monkeypatch):
    """Steps are told as they begin, those of one pass at once; the terminal decides when."""
    told = []
    monkeypatch.setattr(ProgressLine, "__call__", lambda _, name: told.append(name))
    ran = json.loads(invoke("landscape", "--json"))["ran"]
    assert told[0] == "reading"
    assert ", ".join(told[1:]) == ", ".join(ran)


IDLE = {
    "dark_current": ('dark_current = "3 e-/s"\nfull_well = "1000 e-"', "shutter"),
    "velocity": ('velocity = ["3 px/s", "0 px/s"]', "shutter or row_time"),
    "row_time": ('row_time = "1 us"', "something that moves"),
    "flat_field": ("flat_field = true", "vignetting"),
}


@pytest.mark.parametrize("setting", IDLE)
def test_a_setting_that_does_nothing_is_named(setting, tmp_path):
    path, (camera, need) = tmp_path / "still.toml", IDLE[setting]
    path.write_text(f"[scene]\nwidth = 8\nheight = 6\n[camera]\n{camera}\n", "utf-8")
    said = CliRunner().invoke(simulate, [str(path)]).output
    assert f"{setting} does nothing without {need}" in said
    assert json.loads(invoke(str(path), "--json"))["idle"] == {setting: need}


def test_a_setting_that_does_something_is_not_named():
    assert json.loads(invoke("landscape", "--json"))["idle"] == {}


def test_a_broken_promise_is_said_with_exit_code_1(monkeypatch):
    monkeypatch.setattr(import_module("quizgen.camera.simulation"), "is_within", lambda *_: False)
    result = CliRunner().invoke(simulate, ["pinhole", "--everything"])
    assert result.exit_code == 1
    assert "broken" in result.stderr


def test_errors_are_one_line_and_exit_code_2(tmp_path):
    (tmp_path / "bad.toml").write_text("[camera]\nk3 = 1\n", "utf-8")
    for arguments in (
        ["bad.toml"],
        ["nowhere.toml"],
        ["pinhole", "--budget", "x"],
        ["pinhole", "--asks", "x"],
    ):
        run = subprocess.run(
            [sys.executable, "-m", "quizgen", "simulate", *arguments],
            cwd=tmp_path, capture_output=True, text=True, check=False,
            env={"PYTHONPATH": str(Path(__file__).parents[2]), "PATH": ""},
        )  # fmt: skip
        assert run.returncode == 2
        assert len(run.stderr.splitlines()) == 1, run.stderr
        assert "Traceback" not in run.stderr


@pytest.mark.parametrize("scene", ["portrait", "landscape"])
def test_the_table_of_the_page_fits_a_phone(browser, tmp_path, scene):
    page_file = tmp_path / "page.html"
    invoke(scene, "--compare", str(page_file))
    page = browser.new_page(viewport={"width": 400, "height": 800})
    page.goto(page_file.as_uri())
    assert page.locator(".table").evaluate("box => box.scrollWidth <= box.clientWidth")
    assert page.evaluate("document.documentElement.scrollWidth") == 400
    page.close()

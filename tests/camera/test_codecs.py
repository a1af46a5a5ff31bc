"""Photographs in files, against OpenCV and Pillow."""

import io
import json
import struct
import zlib

import cv2
import numpy as np
import pytest
from click.testing import CliRunner
from PIL import ExifTags, Image, ImageOps
from sweep import together

from quizgen.camera import SceneError
from quizgen.camera.pixels import codecs
from quizgen.camera.scene_file import load_scene
from quizgen.cli.simulate import simulate


def smooth(height=24, width=40):
    rows, columns = np.mgrid[0:height, 0:width]
    return np.stack([rows * 9, columns * 6, 255 - rows * 4], axis=2).astype(np.uint8)


def held(how, kind):
    exif, stream = Image.Exif(), io.BytesIO()
    exif[0x0112] = how
    Image.fromarray(smooth()).save(
        stream, kind, exif=exif, **({"quality": 95} if kind == "JPEG" else {})
    )
    return stream.getvalue()


@together("how", range(1, 9))
@together("kind", ["JPEG", "PNG"])
def test_photographs_stand_upright(how, kind):
    data = held(how, kind)
    theirs = ImageOps.exif_transpose(Image.open(io.BytesIO(data)))
    assert np.array_equal(codecs.decode_photo(data), np.asarray(theirs))
    if kind == "JPEG":
        opencv = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)[..., ::-1]
        assert np.abs(codecs.decode_photo(data).astype(int) - opencv).max() <= 4


@pytest.mark.parametrize("mode", ["L", "CMYK"])
def test_other_colours_of_jpeg_are_read(mode):
    stream, image = io.BytesIO(), Image.fromarray(smooth()).convert(mode)
    image.save(stream, "JPEG", quality=95)
    read = codecs.decode_photo(stream.getvalue())
    assert read.shape == (24, 40, 1 if mode == "L" else 3)
    expected = np.asarray(image.convert("L" if mode == "L" else "RGB")).reshape(read.shape)
    assert np.abs(read.astype(int) - expected).mean() < 3


def test_broken_photographs_are_refused():
    data = held(1, "JPEG")
    for broken in (data[:20], data[:100], data[:-400], data[:2] + b"\xff" + data[60:]):
        with pytest.raises(ValueError, match="a broken JPEG file"):
            codecs.decode_photo(broken)


def test_huge_photographs_are_refused_before_they_are_unpacked():
    data = bytearray(held(1, "JPEG"))
    frame = data.index(b"\xff\xc0")
    data[frame + 5 : frame + 9] = (20_000).to_bytes(2, "big") * 2
    with pytest.raises(ValueError, match="more than 24 megapixels"):
        codecs.decode_photo(bytes(data))


@pytest.mark.parametrize(("ending", "most"), [(".png", 0), (".jpg", 6), (".JPEG", 6)])
def test_the_ending_says_how_a_picture_is_written(tmp_path, ending, most):
    """From a photograph to a file through a camera that changes nothing but back to sRGB."""
    (tmp_path / "photo.jpg").write_bytes(held(6, "JPEG"))
    scene, out = tmp_path / "scene.toml", tmp_path / f"out{ending}"
    scene.write_text('[scene]\nimage = "photo.jpg"\n[camera]\ngamma = "srgb"\n', "utf-8")
    result = CliRunner().invoke(
        simulate, [str(scene), "--json", "--budget", "0", "--out", str(out)]
    )
    assert result.exit_code == 0
    assert json.loads(result.stdout)["ran"] == ["gamma"]
    with Image.open(out) as file:
        assert file.format == ("PNG" if ending == ".png" else "JPEG")
        written = np.asarray(file).astype(int)
    assert written.shape == (40, 24, 3)
    assert np.abs(written - codecs.decode_photo(held(6, "JPEG"))).max() <= most
    assert load_scene(scene)[0].width == 24


def test_another_ending_is_refused_before_anything_is_made(tmp_path):
    out = tmp_path / "out.gif"
    result = CliRunner().invoke(simulate, ["pinhole", "--out", str(out)])
    assert "cannot write" in str(result.exception)
    assert ".png, .jpg, .jpeg" in str(result.exception)
    assert not out.exists()


def photograph(tmp_path, camera, **said):
    """A scene of a JPEG whose EXIF says something, by Pillow's names of the tags."""
    exif = Image.Exif()
    exif.get_ifd(0x8769).update({getattr(ExifTags.Base, name): x for name, x in said.items()})
    Image.fromarray(smooth()).save(tmp_path / "photo.jpg", exif=exif)
    path = tmp_path / "s.toml"
    path.write_text(f'[scene]\nimage = "photo.jpg"\n[camera]\nexif = true\n{camera}', "utf-8")
    return path


SAID = {"FocalLength": 35.0, "FNumber": 2.8, "ExposureTime": 1 / 250, "ISOSpeedRatings": 400}


def test_a_photograph_says_how_it_was_taken(tmp_path):
    path = photograph(tmp_path, 'sensor_width = "23.6 mm"\nshutter = "1/60 s"', **SAID)
    scene, camera = load_scene(path)
    assert scene.exif == pytest.approx({"f_number": 2.8, "focal_length": 0.035})
    assert camera.given["f_number"] == pytest.approx(2.8)
    assert camera.given["shutter"] == pytest.approx(1 / 60)  # the scene's own
    assert "iso" not in camera.given
    told = CliRunner().invoke(simulate, [str(path), "--json"])
    assert json.loads(told.stdout)["exif"] == dict(scene.exif)
    assert "from the photograph's file: f_number 2.8, focal_length 0.035" in CliRunner().invoke(simulate, [str(path)]).output  # fmt: skip


def test_iso_is_taken_beside_a_light_value_and_the_f_number_beside_a_pitch(tmp_path):
    bright = 'sensor_width = "23.6 mm"\nlight_value = 12'
    assert load_scene(photograph(tmp_path, bright, **SAID))[1].given["iso"] == 400
    assert set(load_scene(photograph(tmp_path, "", **SAID))[0].exif) == {"focal_length", "shutter"}


def test_without_asking_nothing_is_taken(tmp_path):
    path = photograph(tmp_path, "", **SAID)
    path.write_text('[scene]\nimage = "photo.jpg"\n', "utf-8")
    scene, camera = load_scene(path)
    assert scene.exif == camera.given == {}


def test_what_a_file_does_not_say_is_told(tmp_path):
    with pytest.raises(SceneError, match=r"s\.toml:4: photo\.jpg does not say how it was taken"):
        load_scene(photograph(tmp_path, "", FNumber=0.0))
    path = tmp_path / "s.toml"
    path.write_text("[camera]\nexif = true", "utf-8")
    with pytest.raises(SceneError, match=r"s\.toml:2: exif needs an image"):
        load_scene(path)


def png_file(header, rows):
    """A PNG file put together by hand, from the fields of its header and its filtered rows."""
    contents = {
        b"IHDR": struct.pack(">IIBBBBB", *header),
        b"IDAT": zlib.compress(rows),
        b"IEND": b"",
    }
    chunks = [
        struct.pack(">I", len(content))
        + name
        + content
        + struct.pack(">I", zlib.crc32(name + content))
        for name, content in contents.items()
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def of_16_bits(kind, pixels):
    """By hand: no other package here writes grey with alpha in 16 bits."""
    height, width = pixels.shape[:2]
    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in pixels)
    return png_file((width, height, 16, kind, 0, 0, 0), rows)


@pytest.mark.parametrize(("kind", "channels"), [(0, 1), (2, 3), (4, 2), (6, 4)])
def test_sixteen_bits_keep_all_of_them(kind, channels):
    deep = np.random.default_rng(2).integers(0, 65536, (6, 5, channels)).astype(np.uint16)
    read = codecs.decode_photo(of_16_bits(kind, deep))
    assert read.dtype == np.uint16
    assert np.array_equal(read, deep)


@pytest.mark.parametrize("strategy", range(5))
def test_sixteen_bits_written_by_opencv_are_read(strategy):
    deep = np.random.default_rng(2).integers(0, 65536, (6, 5, 3)).astype(np.uint16)
    _, data = cv2.imencode(".png", deep[..., ::-1], [cv2.IMWRITE_PNG_STRATEGY, strategy])
    assert np.array_equal(codecs.decode_photo(data.tobytes()), deep)


@pytest.mark.parametrize("mode", ["L", "LA", "RGB", "RGBA"])
def test_eight_bits_written_by_pillow_are_read(mode):
    rgba = np.random.default_rng(1).integers(0, 256, (3, 8, 4), np.uint8)
    image = Image.fromarray(rgba).convert(mode)
    stream = io.BytesIO()
    image.save(stream, "PNG")
    read = codecs.decode_photo(stream.getvalue())
    assert read.dtype == np.uint8
    assert np.array_equal(read, np.asarray(image).reshape(3, 8, -1))


def test_broken_files_are_refused():
    data = held(1, "PNG")
    cut = (data[:20], data[:40], data[:60], data[:-30], data.replace(b"IDAT", b"IDOT"))
    for broken in (b"GIF89a", b"", *cut):
        with pytest.raises(ValueError, match="PNG"):
            codecs.decode_photo(broken)


@pytest.mark.parametrize(("mode", "plain"), [("1", "L"), ("P", "RGBA")])
def test_palettes_and_few_bits_become_colours(mode, plain):
    image = Image.fromarray(smooth()).convert(mode)
    stream = io.BytesIO()
    image.save(stream, "PNG")
    expected = np.asarray(image.convert(plain))
    assert np.array_equal(codecs.decode_photo(stream.getvalue()), expected.reshape(24, 40, -1))


ADAM7 = (
    (0, 0, 8, 8),
    (0, 4, 8, 8),
    (4, 0, 8, 4),
    (0, 2, 4, 4),
    (2, 0, 4, 2),
    (0, 1, 2, 2),
    (1, 0, 2, 1),
)
"""First row and column of each pass, and its steps (PNG specification, section 8.2)."""


@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
def test_interlaced_files_are_read(kind):
    codes = np.random.default_rng(4).integers(0, 1 << 8 * kind().itemsize, (11, 13, 3)).astype(kind)
    rows = b"".join(
        b"\0" + row.astype(row.dtype.newbyteorder(">")).tobytes()
        for top, left, down, across in ADAM7
        for row in codes[top::down, left::across]
    )
    header = (13, 11, 8 * kind().itemsize, 2, 0, 0, 1)
    assert np.array_equal(codecs.decode_photo(png_file(header, rows)), codes)


def test_huge_pngs_are_refused_before_they_are_unpacked():
    with pytest.raises(ValueError, match="more than 24 megapixels"):
        codecs.decode_photo(png_file((10_000, 5_001, 8, 2, 0, 0, 0), b""))


@pytest.mark.parametrize("shape", [(24, 40), (24, 40, 3), (24, 40, 4)])
def test_a_photograph_is_written_without_loss(shape):
    codes = np.random.default_rng(3).integers(0, 256, shape, np.uint8)
    data = codecs.encode_photo(codes)
    assert np.array_equal(np.asarray(Image.open(io.BytesIO(data))), codes)

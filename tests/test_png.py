"""PNG files: bytes that never vary, and what others write is read."""

import io
import struct
import zlib

import cv2
import numpy as np
import pytest
from PIL import Image

from quizgen import png


def pictures():
    source = np.random.default_rng(1)
    smooth = np.add.outer(np.arange(40), np.arange(30))[..., None] * [1, 2, 3] % 256
    return [
        smooth.astype(np.uint8),
        source.integers(0, 256, (7, 5, 3), np.uint8),
        source.integers(0, 256, (9, 4), np.uint8),
        np.zeros((1, 1, 3), np.uint8),
        source.integers(0, 256, (3, 8, 4), np.uint8),
    ]


def in_colour(codes):
    """Shape (H, W, 3); grey is written with one channel or three."""
    return np.broadcast_to(codes.reshape(*codes.shape[:2], -1), (*codes.shape[:2], 3))


def by_others(data):
    return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))


@pytest.mark.parametrize("write", [png.encode, png.compact])
@pytest.mark.parametrize("number", range(4))
def test_what_is_written_is_read_by_others_and_by_ourselves(number, write):
    codes = pictures()[number]
    data = write(codes)
    assert np.array_equal(by_others(data), in_colour(codes))
    assert np.array_equal(in_colour(png.decode(data)), in_colour(codes))


def test_opacity_is_kept_even_where_three_channels_are_alike():
    grey = np.repeat(np.arange(12, dtype=np.uint8).reshape(3, 4, 1) * 20, 4, axis=2)
    for codes in (grey, np.random.default_rng(2).integers(0, 256, (3, 4, 4)).astype(np.uint8)):
        read = Image.open(io.BytesIO(png.encode(codes)))
        assert read.mode == "RGBA"
        assert np.array_equal(np.asarray(read), codes)


@pytest.mark.parametrize("number", range(4))
def test_small_pictures_are_read_by_others(number):
    codes = pictures()[number]
    assert np.array_equal(by_others(png.small(codes)), in_colour(codes))


def test_a_small_picture_takes_the_shortest_way():
    """Few colours, one channel in three, and steps to the left or above: each shows in the size."""
    noise = np.random.default_rng(4).integers(0, 2, (60, 90), np.uint8)
    few = np.array([[9, 200, 31], [250, 3, 77]], np.uint8)[noise]
    grey = noise[..., None].repeat(3, axis=2) * np.uint8(255)
    ramp = np.add.outer(np.arange(100), np.arange(150)).astype(np.uint8)
    steep = ramp[..., None] * np.array([1, 2, 3], np.uint8)
    for codes, most in ((few, 1100), (grey, 1100), (ramp, 400), (steep, 1200)):
        assert len(png.small(codes)) < most, len(png.small(codes))
        assert np.array_equal(by_others(png.small(codes)), in_colour(codes))


def test_the_bytes_of_small_pictures_are_pinned():
    """They stand in papers, which must come out the same everywhere."""
    ramp = (np.arange(48 * 3, dtype=np.uint8) // 7).reshape(6, 8, 3)
    assert zlib.crc32(png.encode(ramp)) == PINNED_COLOURS
    indices = np.repeat(np.arange(4, dtype=np.uint8), 30).reshape(10, 12)
    palette = [(0, 0, 0), (255, 0, 0), (0, 128, 0), (255, 255, 255)]
    assert (
        zlib.crc32(png.indexed(indices.shape, png.index_data(indices), palette)) == PINNED_PALETTE
    )


PINNED_COLOURS = 789310612
PINNED_PALETTE = 649943326


def of_16_bits(kind, channels, pixels):
    """A file of 16 bits put together by hand: no other package here writes grey with alpha."""

    def chunk(name, content):
        body = name + content
        return struct.pack(">I", len(content)) + body + struct.pack(">I", zlib.crc32(body))

    height, width = pixels.shape[:2]
    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in pixels)
    header = struct.pack(">IIBBBBB", width, height, 16, kind, 0, 0, 0)
    parts = chunk(b"IHDR", header), chunk(b"IDAT", zlib.compress(rows)), chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


@pytest.mark.parametrize(("kind", "channels"), [(0, 1), (2, 3), (4, 2), (6, 4)])
def test_sixteen_bits_keep_all_of_them(kind, channels):
    deep = np.random.default_rng(2).integers(0, 65536, (6, 5, channels)).astype(np.uint16)
    read = png.decode(of_16_bits(kind, channels, deep))
    assert read.dtype == np.uint16
    assert np.array_equal(read, deep)


@pytest.mark.parametrize("strategy", range(5))
def test_sixteen_bits_written_by_opencv_are_read(strategy):
    deep = np.random.default_rng(2).integers(0, 65536, (6, 5, 3)).astype(np.uint16)
    _, data = cv2.imencode(".png", deep[..., ::-1], [cv2.IMWRITE_PNG_STRATEGY, strategy])
    assert np.array_equal(png.decode(data.tobytes()), deep)


@pytest.mark.parametrize("mode", ["L", "LA", "RGB", "RGBA"])
def test_eight_bits_written_by_pillow_are_read(mode):
    image = Image.fromarray(pictures()[4]).convert(mode)
    stream = io.BytesIO()
    image.save(stream, "PNG")
    read = png.decode(stream.getvalue())
    assert read.dtype == np.uint8
    assert np.array_equal(read, np.asarray(image).reshape(3, 8, -1))


def test_broken_files_are_refused():
    data = png.encode(pictures()[1])
    cut = (data[:20], data[:40], data[:60], data[:-30], data.replace(b"IDAT", b"IDOT"))
    for broken in (b"GIF89a", b"", *cut):
        with pytest.raises(ValueError, match="PNG"):
            png.decode(broken)


@pytest.mark.parametrize(("mode", "plain"), [("1", "L"), ("P", "RGBA")])
def test_palettes_and_few_bits_become_colours(mode, plain):
    image = Image.fromarray(pictures()[1]).convert(mode)
    stream = io.BytesIO()
    image.save(stream, "PNG")
    expected = np.asarray(image.convert(plain))
    assert np.array_equal(png.decode(stream.getvalue()), expected.reshape(7, 5, -1))


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

    def chunk(name, content):
        body = name + content
        return struct.pack(">I", len(content)) + body + struct.pack(">I", zlib.crc32(body))

    header = struct.pack(">IIBBBBB", 13, 11, 8 * kind().itemsize, 2, 0, 0, 1)
    parts = chunk(b"IHDR", header), chunk(b"IDAT", zlib.compress(rows)), chunk(b"IEND", b"")
    assert np.array_equal(png.decode(b"\x89PNG\r\n\x1a\n" + b"".join(parts)), codes)


def test_huge_pictures_are_refused_before_they_are_unpacked():
    data = png.encode(pictures()[1])
    huge = data[:16] + struct.pack(">II", 10_000, 5_001) + data[24:]
    with pytest.raises(ValueError, match="more than 24 megapixels"):
        png.decode(huge)


@pytest.mark.parametrize("run", [*range(1, 14), 257, 258, 259, 260, 261, 516, 517, 600])
def test_inflate_reads_every_run_length(run):
    data = np.repeat(np.array([0, 7, 143, 144, 255, 0], np.uint8), run)
    assert zlib.decompress(png.deflate(data)) == data.tobytes()


def test_indexed_pictures_are_read_by_pillow():
    rng = np.random.default_rng(3)
    indices = rng.integers(0, 256, (17, 31), dtype=np.uint8)
    palette = [tuple(map(int, colour)) for colour in rng.integers(0, 256, (256, 3))]
    file = png.indexed(indices.shape, png.index_data(indices), palette)
    picture = np.asarray(Image.open(io.BytesIO(file)).convert("RGB"))
    assert (picture == np.array(palette)[indices]).all()


@pytest.mark.parametrize("count", [1, 3, 4, 258, 259, 260, 261, 262, 517, 519, 2000])
def test_runs_of_any_length_are_inflated_by_zlib(count):
    data = np.concatenate([np.full(count, byte, np.uint8) for byte in (0, 200, 143, 144, 0)])
    assert zlib.decompress(png.deflate(data)) == data.tobytes()

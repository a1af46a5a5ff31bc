"""PNG files in figures: bytes that depend on nothing but the picture, read by all others."""

import io
import zlib

import numpy as np
import pytest
from PIL import Image
from sweep import together

from quizgen.figures.svg import encode_png


def noise(*shape):
    return np.random.default_rng(1).integers(0, 256, shape, np.uint8)


SMOOTH = (np.add.outer(np.arange(40), np.arange(30))[..., None] * [1, 2, 3] % 256).astype(np.uint8)


def read_by_pillow(data):
    return np.asarray(Image.open(io.BytesIO(data)))


@pytest.mark.parametrize(
    "codes", [SMOOTH, noise(7, 5, 3), noise(9, 4), noise(3, 8, 4), np.zeros((1, 1), np.uint8)]
)
def test_what_is_written_is_read_by_others(codes):
    assert np.array_equal(read_by_pillow(encode_png(codes)), codes)


def test_three_equal_channels_are_stored_as_one():
    grey = noise(6, 5)
    assert np.array_equal(read_by_pillow(encode_png(grey[..., None].repeat(3, axis=2))), grey)


def test_opacity_is_kept_even_where_three_channels_are_alike():
    grey = np.arange(12, dtype=np.uint8).reshape(3, 4, 1).repeat(4, axis=2) * np.uint8(20)
    assert np.array_equal(read_by_pillow(encode_png(grey)), grey)


def test_indices_become_the_colours_of_the_palette():
    indices = noise(17, 31)
    palette = [tuple(map(int, colour)) for colour in noise(256, 3)]
    file = Image.open(io.BytesIO(encode_png(indices, palette)))
    assert file.mode == "P"
    assert np.array_equal(np.asarray(file.convert("RGB")), np.array(palette)[indices])


def test_the_bytes_are_pinned():
    """They stand in papers, which must come out the same everywhere."""
    ramp = (np.arange(48 * 3, dtype=np.uint8) // 7).reshape(6, 8, 3)
    assert zlib.crc32(encode_png(ramp)) == 789310612
    indices = np.repeat(np.arange(4, dtype=np.uint8), 30).reshape(10, 12)
    palette = [(0, 0, 0), (255, 0, 0), (0, 128, 0), (255, 255, 255)]
    assert zlib.crc32(encode_png(indices, palette)) == 649943326


@together("run", [*range(1, 14), *range(257, 264), 516, 517, 518, 519, 600, 2000])
def test_runs_of_any_length_are_read(run):
    """Deflate repeats 3 to 258 bytes at a time; bytes from 144 on take 9 bits instead of 8."""
    row = np.repeat(np.array([0, 7, 143, 144, 255, 0], np.uint8), run)[None]
    palette = [(shade, shade, shade) for shade in range(256)]
    read = read_by_pillow(encode_png(row, palette))
    assert np.array_equal(read, row)

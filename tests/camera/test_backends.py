"""With and without OpenCV: the same pictures within the stated bound, the same plans."""

import subprocess
import sys

import cv2
import numpy as np
import pytest
import scenes_at_random as at_random
from scipy.ndimage import convolve

from quizgen.camera import (
    Camera,
    PreparedScene,
    Scene,
    SceneError,
)
from quizgen.camera.pixels import filters, hsv, tiles, tone_curve
from quizgen.camera.pixels.kernels import disc_kernel, motion_kernel
from quizgen.camera.simulation import run_plan

AGREEMENT = 2e-5
"""Largest difference of OpenCV and NumPy, relative to the largest value."""


@pytest.fixture(params=["opencv", "numpy"])
def backend(request, monkeypatch):
    if request.param == "numpy":
        without(monkeypatch)
    return request.param


def without(monkeypatch):
    filters._opencv_remap_is_exact.cache_clear()
    monkeypatch.setattr(filters, "load_opencv", lambda: None)
    monkeypatch.setattr(hsv, "load_opencv", lambda: None)


@pytest.fixture(autouse=True)
def forget():
    yield
    filters._opencv_remap_is_exact.cache_clear()


def picture(height=70, width=90, seed=0):
    return np.random.default_rng(seed).random((height, width, 3), np.float32)


@pytest.mark.parametrize(
    "kernel",
    [
        disc_kernel(0.4),
        disc_kernel(3.0),
        disc_kernel(9.5),
        disc_kernel(12.0),
        disc_kernel(40.0),
        motion_kernel(7.0, 3.0),
        motion_kernel(0.0, 30.0),
    ],
)
def test_convolution_is_a_weighted_sum(kernel, backend):
    """Against the plain definition in double precision."""
    image = picture()
    rows, columns = (side // 2 for side in kernel.shape)
    wide = np.pad(image.astype(float), ((rows, rows), (columns, columns), (0, 0)), mode="edge")
    for y, x in ((0, 0), (35, 44), (69, 89), (3, 60)):
        expected = (kernel[..., None] * wide[y : y + 2 * rows + 1, x : x + 2 * columns + 1]).sum(
            (0, 1)
        )
        assert filters.convolve(image, kernel)[y, x] == pytest.approx(expected, abs=AGREEMENT)


@pytest.mark.parametrize("size", [(5, 7), (3, 90), (40, 2), (1, 6)])
@pytest.mark.parametrize(
    "kernel", [disc_kernel(61.0), motion_kernel(50.0, 3.0), motion_kernel(0.0, 30.0)]
)
def test_a_blur_wider_than_the_picture_reads_its_edges(backend, size, kernel):
    """Against the plain sum over a picture continued as far as the kernel goes."""
    image = picture(*size)
    rows, columns = (side // 2 for side in kernel.shape)
    wide = np.pad(image.astype(float), ((rows, rows), (columns, columns), (0, 0)), mode="edge")
    blurred = filters.convolve(image, kernel)
    assert blurred.shape == image.shape
    for y, x in ((0, 0), (size[0] - 1, size[1] // 2), (size[0] // 2, size[1] - 1)):
        part = wide[y : y + 2 * rows + 1, x : x + 2 * columns + 1]
        expected = (kernel[..., None] * part).sum((0, 1))
        assert blurred[y, x] == pytest.approx(expected, abs=AGREEMENT)


def test_work_is_limited_to_the_picture(monkeypatch):
    seen = []
    monkeypatch.setattr(
        cv2, "filter2D", lambda image, _, kernel, **__: seen.append(kernel) or image
    )
    filters.convolve(picture(4, 5), disc_kernel(700.0))
    assert seen[0].shape == (7, 9)
    assert seen[0].sum() == pytest.approx(1.0)


@pytest.mark.parametrize(
    "kernel", [disc_kernel(12.0), motion_kernel(20.0, 10.0), motion_kernel(9.0, 40.0)]
)
def test_slabs_and_bands_leave_no_seams(kernel):
    """Several bands of rows and slabs of the kernel against OpenCV's own transform."""
    assert filters.is_direct_sum_faster(kernel)
    image = picture(height=301, width=64)
    whole = cv2.filter2D(image, -1, kernel, borderType=cv2.BORDER_REPLICATE)
    assert np.abs(filters.convolve(image, kernel) - whole).max() < 2e-6


def test_pieces_do_not_change_a_bit():
    """2.9 million values are encoded in pieces; row by row they come out the same."""
    image = picture(height=900, width=1070)
    image[0, :4, 0] = (0.0, 1.0, 0.0031308, 1e-40)

    def encode(light):
        return tiles.apply_tilewise(light, [tone_curve.encode_piecewise("srgb")])[0]

    whole = encode(image)
    assert np.array_equal(whole, np.stack([encode(row) for row in image]))
    knee = np.where(image <= 0.0031308, 12.92 * image.astype(float), 0.0)
    curve = 1.055 * np.maximum(image, 1e-9).astype(float) ** (1 / 2.4) - 0.055
    assert np.abs(whole - np.where(knee > 0, knee, curve * (image > 0))).max() < 3e-7


def test_threads_do_not_change_a_bit():
    """OpenCV warps and blurs on all cores, whatever their number."""
    image = picture(height=300, width=400)
    camera = Camera(0.05, 5e-6, f_number=2.0, focus_distance=3.0, k1=-20.0, hue=0.3, gamma="srgb")
    scene = Scene(400, 300, image=image, depth=3.3)
    shots, before = [], cv2.getNumThreads()
    try:
        for threads in (1, 3):
            cv2.setNumThreads(threads)
            shots.append(run_plan(PreparedScene(scene, camera)))
    finally:
        cv2.setNumThreads(before)
    assert {"distortion", "defocus", "hsv edit"} <= set(shots[0].times)
    assert np.array_equal(shots[0].values, shots[1].values)


def test_sampling_is_bilinear(backend):
    image, source = picture(), np.random.default_rng(1)
    x = source.uniform(-3, 93, (20, 30)).astype(np.float32)
    y = source.uniform(-3, 73, (20, 30)).astype(np.float32)
    found = filters.sample_bilinear(image, x, y)
    for place in ((0, 0), (5, 7), (19, 29), (11, 3)):
        column, row = float(np.clip(x[place], 0, 89)), float(np.clip(y[place], 0, 69))
        left, top = min(int(column), 88), min(int(row), 68)
        a, b = column - left, row - top
        corner = image[top : top + 2, left : left + 2].astype(float)
        expected = (
            corner[0, 0] * (1 - a) * (1 - b) + corner[0, 1] * a * (1 - b)
            + corner[1, 0] * (1 - a) * b + corner[1, 1] * a * b
        )  # fmt: skip
        assert found[place] == pytest.approx(expected, abs=AGREEMENT)


def test_coarse_remapping_is_noticed(monkeypatch):
    """OpenCV 4 rounds positions to 1/32 px; then NumPy samples."""

    class Coarse:
        INTER_LINEAR = cv2.INTER_LINEAR

        @staticmethod
        def remap(image, x, y, flags):
            return cv2.remap(image, np.round(x * 32) / 32, y, flags)

    monkeypatch.setattr(filters, "load_opencv", lambda: Coarse)
    filters._opencv_remap_is_exact.cache_clear()
    assert not filters._opencv_remap_is_exact()
    edge = np.repeat(np.float32([[0, 1], [0, 1]])[..., None], 3, axis=2)
    at = np.full((1, 1), 0.01, np.float32)
    assert filters.sample_bilinear(edge, at, at)[0, 0, 0] == pytest.approx(0.01, abs=1e-6)


def test_whole_photographs_agree(monkeypatch):
    photos = []
    for use in ("opencv", "numpy"):
        if use == "numpy":
            without(monkeypatch)
        for seed in range(60):
            source = np.random.default_rng([seed, 3])
            prepared = PreparedScene(at_random.scene(source), at_random.camera(source, noise=False))
            if {"bit_depth", "blooming"} & prepared.given.camera.given.keys():
                continue  # a rounding difference may flip a code there
            try:
                photos.append((use, seed, run_plan(prepared)))
            except SceneError:
                continue  # the picture folds over
    half = len(photos) // 2
    assert half > 20
    for (_, seed, one), (_, _, other) in zip(photos[:half], photos[half:], strict=True):
        gain = 13 if "gamma" in one.times else 1
        largest = max(1.0, float(np.abs(one.values).max()))
        assert np.abs(one.values - other.values).max() < 10 * gain * AGREEMENT * largest, seed


@pytest.mark.parametrize("speed", [0.0, 3.0, 1e8, 3e9, 1e12])
@pytest.mark.parametrize("down", [0.0, -1.0])
def test_rows_read_far_outside_show_the_edge(backend, speed, down):
    """Row by row: the picture moved by speed times the row's time, its edges repeated."""
    image = picture(9, 12)
    scene = Scene(12, 9, image=image)
    camera = Camera(velocity=(speed, speed * down), row_time=1.0)
    rolled = run_plan(PreparedScene(scene, camera)).values
    for row in range(9):
        shift = speed * (row - 4)
        columns = np.clip(np.arange(12) - shift, 0, 11).astype(int)
        source = int(np.clip(row - shift * down, 0, 8))
        assert np.array_equal(rolled[row], image[source, columns]), (row, shift)


def test_hue_agrees(monkeypatch):
    image = picture()
    with_it = hsv.edit_hsv(image, 77.0, 1.2, 0.9)
    without(monkeypatch)
    assert np.abs(hsv.edit_hsv(image, 77.0, 1.2, 0.9) - with_it).max() < AGREEMENT


def test_the_camera_imports_numpy_only():
    code = (
        "import sys; import quizgen.camera, quizgen.camera.picture_sets, quizgen.camera.scene_file;"
        "heavy = {'cv2', 'scipy', 'matplotlib', 'sympy', 'PIL', 'rich', 'click'} & set(sys.modules);"
        "assert not heavy, heavy"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.parametrize("diameter", [1.5, 6.1, 14.2, 70.0])
@pytest.mark.parametrize("at", [(0, 0), (20, 30), (39, 59)])
def test_a_thing_in_the_dark_is_blurred_as_by_scipy(diameter, at):
    image = np.zeros((48, 64, 3), np.float32)
    image[at[0] : at[0] + 9, at[1] : at[1] + 5] = (0.9, 0.4, 0.1)
    kernel = disc_kernel(diameter)
    expected = convolve(image, kernel[..., None], mode="nearest")
    with filters.numpy_only():
        assert np.abs(filters.convolve(image, kernel) - expected).max() < 2e-6

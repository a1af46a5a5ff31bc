"""Questions about programs: what is printed on the page is run, its options are tried out."""

from __future__ import annotations

import contextlib
import io
import re
import warnings
from fractions import Fraction
from typing import Any

import cv2
import numpy as np
from by_hand import solves
from printed_numbers import numbers
from printed_page import Page

cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)


def run(program: str, known: dict[str, Any] | None = None) -> tuple[str, dict[str, Any]]:
    """What a program prints, and the names it leaves."""
    out, names = io.StringIO(), {"__name__": "printed", **(known or {})}
    with contextlib.redirect_stdout(out), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        exec(compile(program, "page", "exec"), names)
    return out.getvalue(), names


@solves("channel-exchange", "channel-exchange-of-views", "image-array-shape", "imread-16-bit-grey",
        "pixel-coordinates-in-python", "point-projection-in-python")  # fmt: skip
def as_printed(page: Page) -> dict[str, Any]:
    """The program's output itself."""
    return {"a": run(page.programs[0])[0]}


@solves("opencv-hue-shift", "opencv-stored-hue", "uint8-difference", "uint8-hue-shift",
        "uint8-mean", "uint8-neighbour-mean", "uint8-product", "uint8-sum",
        "flat-field-correction-output", "opencv-add-and-subtract",
        "salt-and-pepper-thresholds")  # fmt: skip
def numbers_printed(page: Page) -> dict[str, Any]:
    """The numbers in the program's output."""
    found = re.findall(r"-?\d+(?:\.\d+)?", run(page.programs[0])[0])
    return {"a": tuple(Fraction(one) for one in found)}


@solves("add-noise-to-uint8-order")
def noise_added(page: Page) -> dict[str, Any]:
    """The pixel goes through the four steps in the right order."""
    value, noise = numbers(page.parts["b"].text.replace("uint8", "").replace("x[0, 0]", ""))
    stored = np.round(np.clip(float(value) + float(noise), 0, 255)).astype(np.uint8)
    return {"b": str(stored)}


@solves("uint8-sum-repair")
def repaired(page: Page) -> dict[str, Any]:
    """Each expression is evaluated."""
    _, known = run(page.programs[0])
    return {"a": page.parts["a"].those(lambda text: _value(text, known) == 255)}


def _value(expression: str, known: dict[str, Any]) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return eval(expression, dict(known))[0]
        except (OverflowError, ValueError) as error:
            return type(error).__name__


@solves("opencv-image-in-matplotlib")
def same_array(page: Page) -> dict[str, Any]:
    """Each expression is compared with the array on a picture of chance."""
    image = np.random.default_rng(5).integers(0, 256, (6, 6, 3), dtype=np.uint8)
    known = {"cv2": cv2, "np": np, "image": image, "rgb": cv2.cvtColor(image, cv2.COLOR_BGR2RGB)}
    return {"b": page.parts["b"].those(
        lambda text: np.array_equal(eval(text, dict(known)), known["rgb"])
    )}  # fmt: skip


@solves("red-of-bgr-pixel")
def which_channel(page: Page) -> dict[str, Any]:
    """A picture of one colour is written, read and converted as the page says."""
    colours = {
        ("red", "লাল"): (255, 0, 0),
        ("green", "সবুজ"): (0, 255, 0),
        ("blue", "নীল"): (0, 0, 255),
    }
    question = page.stem.rpartition("]")[2]
    r, g, b = next(rgb for words, rgb in colours.items() if any(w in question for w in words))
    file = cv2.imencode(".png", np.array([[[b, g, r]]], np.uint8))[1]
    image = cv2.imdecode(file, cv2.IMREAD_COLOR)
    if "COLOR_BGR2RGB" in page.stem:
        image = cv2.cvtColor(image, cv2.COLOR_BGR2RGB)
    place = image[0, 0].tolist().index(255)
    words = (("the first", "প্রথম"), ("the second", "দ্বিতীয়"), ("the third", "তৃতীয়"))[place]
    return {"a": page.parts["a"].saying(*words)}


@solves("opencv-bayer-constant")
def bayer_constant(page: Page) -> dict[str, Any]:
    """A mosaic of a red scene is made and converted with each constant."""
    tile = re.search(r"([RGB]) ([RGB]) / ([RGB]) ([RGB])", page.stem)
    view = re.search(r"raw\[(\d?:), ?(\d?:)\]", page.stem)
    assert tile
    raw = np.tile(
        np.array([[255 * (c == "R") for c in tile.groups()[i : i + 2]] for i in (0, 2)], np.uint8),
        (8, 8),
    )
    part = eval(view[0], {"raw": raw}) if view else raw
    part = np.ascontiguousarray(part[: part.shape[0] // 2 * 2, : part.shape[1] // 2 * 2])

    def red(option: str) -> bool:
        return cv2.cvtColor(part, eval(option, {"cv2": cv2}))[4, 4].tolist() == [0, 0, 255]

    return {"a": page.parts["a"].those(red)}


@solves("pixel-indexing-outcome")
def indexing(page: Page) -> dict[str, Any]:
    """The next line is run on a picture whose pixels hold their places."""
    width, height, *_ = map(int, numbers(page.stem))
    _, known = run(page.programs[0])
    assert known["image"].shape == (height, width, 3)
    places = np.moveaxis(np.indices((height, width)), 0, -1)
    line = re.search(r"value = [^.।]*\]", page.stem.rpartition("y = ")[2])
    assert line
    try:
        value = run(line[0], {**known, "image": places})[1]["value"]
    except IndexError:
        words = ("IndexError", "IndexError")
    else:
        same = value.reshape(-1, 2).tolist() == [[known["y"], known["x"]]]
        words = (("wanted", "সেটাই") if same else ("in another", "অন্য জায়গার") if value.size
                 else ("without any pixel", "ixel-হীন"))  # fmt: skip
    return {"a": page.parts["a"].saying(*words)}


@solves("imread-missing-file")
def missing_file(page: Page) -> dict[str, Any]:
    """The next line is run."""
    line = re.search(r"(?:program is|লাইন) (.*?)(?:\. What|।)", page.stem)
    assert line
    try:
        run(page.programs[0] + "\n" + line[1])
    except (AttributeError, TypeError, cv2.error) as error:
        name = "cv2.error" if isinstance(error, cv2.error) else type(error).__name__
        return {"a": page.parts["a"].saying(name)}
    return {"a": page.parts["a"].saying("without any error", "কোনো error ছাড়াই")}


def told(call: str, setup: str) -> str:
    """What happens in a call: the type of its error, or its value."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return str(eval(call, run(setup)[1]))
    except Exception as error:  # noqa: BLE001  (whatever it is, is the answer)
        return type(error).__name__


@solves("demosaic-at-border")
def at_border(page: Page) -> dict[str, Any]:
    """Each call is made."""
    (part,) = page.parts.values()
    found = [told(call, page.programs[0]) for call in part.options]
    return {"a": _matched(found, part.targets)}


def _matched(found: list[str], targets: tuple[str, ...]) -> dict[str, int]:
    whole = [re.compile(rf"(?<![\d.-]){re.escape(one)}(?!\d)") for one in found]
    places = [[n for n, text in enumerate(targets, 1) if one.search(text)] for one in whole]
    return {mark: place for mark, (place,) in zip("ABCDEFGH", places, strict=False)}


OPTIMISED = "python -O"


@solves("projection-non-positive-depth")
def odd_depths(page: Page) -> dict[str, Any]:
    """Each call is made, without its assert where Python is told to leave it out."""
    (part,) = page.parts.values()
    found = [_odd_depth(option, page) for option in part.options]
    return {"a": _matched(found, part.targets)}


def _odd_depth(option: str, page: Page) -> str:
    program = page.programs[0]
    if OPTIMISED in option:
        program = re.sub(r"\n\s*assert.*", "", program)
    call = re.match(r"\((?:[^()]|\([^()]*\))*\)", option)
    assert call
    point, focal = call[0], page["f"]
    result = told(f"project_pinhole({point}, {int(focal)})", program)
    return next((word for word in ("nan", "inf") if word in result), result)


@solves("noise-function-return-types")
def types_and_ranges(page: Page) -> dict[str, Any]:
    """Each expression is evaluated on a picture with every value."""
    image = np.resize(np.arange(256, dtype=np.uint8), (512, 512))
    _, known = run(page.programs[0], {"image": image})
    (part,) = page.parts.values()
    found = [_type_and_range(eval(one, known)) for one in part.options]
    return {"a": _matched(found, tuple(map(_spoken, part.targets)))}


def _type_and_range(values: Any) -> str:
    if values.dtype == bool:
        return "bool"
    low, high = values.min(), values.max()
    if values.dtype.kind == "f" and low < -0.01 and high > 1.01:
        return "float64 open"
    return f"{values.dtype} {int(low)} {int(high)}"


def _spoken(target: str) -> str:
    """A type and a range in words, as numbers."""
    name, _, said = target.partition(",")
    if name == "bool":
        return name
    beyond = any(word in said for word in ("below", "কম"))
    return f"{name} open" if beyond else " ".join([name, *map(str, numbers(said))])

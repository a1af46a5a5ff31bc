"""Figures that move, in a browser: what they show is what the solvers say, at every place."""

from __future__ import annotations

import importlib
import math

import numpy as np
import pytest
import sympy
from fingers import Screen, between
from keys import Keys
from playwright.sync_api import expect
from sweep import sample

from quizgen.numerics.luminosity import DAY, NIGHT, luminous_efficiency

pytestmark = pytest.mark.browser

SHEET = {
    "aperture-ring": "F32", "clamped-histogram": "F13", "distortion-grid": "F20",
    "eye-and-filter": "F03", "focus-distance": "F33", "gaussian-tails": "F18",
    "hsv-sliders": "F23", "pinhole-point": "F05",
}  # fmt: skip
NUMBERS = (1, 1.4, 2, 2.8, 4, 5.6, 8, 11, 16, 22, 32)
DISTANCES = (0.5, 0.6, 0.8, 1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10, 12, 15, 20, 30, 50, 100)


def solved(solver: str, **given: float) -> dict[str, float]:
    """Every step of a solver's model, at some numbers, computed by SymPy."""
    model = importlib.import_module(f"solvers.{solver}").MODEL
    known = {symbol: sympy.Float(given[symbol.name]) for symbol in model.given}
    for step in model.steps:
        known[step.symbol] = sympy.N(step.expr.subs(known))
    return {symbol.name: float(value) for symbol, value in known.items()}


class Moving:
    """A figure that moves beside a formula of the sheet, opened and at its start."""

    def __init__(self, page, formula: str) -> None:
        self.page, self.figure = page, page.locator(f"#moving-{formula}")
        fold = page.locator(f"#{formula} .moving")
        if fold.get_attribute("open") is None:
            fold.locator("summary").click()
        page.locator(f"#moving-{formula}[data-ready]").wait_for()
        self.figure.locator("[data-back]").click()

    def slider(self, name: str):
        return self.figure.locator(f"[data-set={name}]")

    def put(self, **places: float) -> None:
        """Move sliders as a pointer does."""
        for name, place in places.items():
            self.slider(name).evaluate(
                "(one, to) => { one.value = to; one.dispatchEvent(new Event('input', {bubbles: true})); }",
                str(place),
            )

    def shown(self, name: str) -> list[float]:
        """The numbers of a value that is shown."""
        text = self.figure.locator(f"[data-out={name}]").inner_text()
        return [read(part) for part in text.strip("()").split(";")]

    @property
    def said(self) -> str:
        return self.figure.locator(".moving-said").inner_text()


def read(text: str) -> float:
    """A number as the figures write it: 1/8.16, 4.55 %, 5.7 × 10⁻⁵, −6."""
    plain = text.strip().replace("−", "-").replace("\u202f", "").partition("\u00a0")[0]
    if plain == "∞":
        return math.inf
    front, _, power = plain.partition(" × 10")
    if power:
        return float(front) * 10.0 ** int(
            power.translate(str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-"))
        )
    over, _, under = plain.rpartition("/")
    return float(over) / float(under) if over else float(under)


@pytest.fixture(scope="module")
def sheet(browser, served):
    """The page of formulas under the server's own security policy; nothing may be wrong on it."""
    wrong = []
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    context.on("console", lambda said: wrong.append(said.text))
    context.on("weberror", lambda error: wrong.append(str(error.error)))
    page = context.new_page()
    page.goto(served.entrance)
    page.goto(served.address + "/formulas")
    yield page
    context.close()
    assert wrong == []


def near(value: float, digits: int = 4):
    """What a value is rounded to when it is shown."""
    return pytest.approx(value, rel=0.6 * 10.0 ** (1 - digits), abs=1e-12)


def test_the_aperture(sheet):
    one = Moving(sheet, SHEET["aperture-ring"])
    for stop in (0, 3, 6, 10):
        one.put(N=stop)
        told = solved("aperture.f_number_change", f=50, N_1=2.8, N_2=NUMBERS[stop], r=125)
        way = 1 if NUMBERS[stop] <= 2.8 else -1
        assert one.shown("hole") == [near(told["D_2"])]
        assert one.shown("blur") == [near(told["q"] ** way, 3)]
        assert one.shown("light") == [near(told["e"] ** way, 3)]
        assert one.shown("stops") == [near(way * told["k"], 3)]
        assert one.shown("time") == [near(told["t_2"], 3)]
    one.put(N=NUMBERS.index(8))
    assert "exactly, the light changes by the factor 1/8." in one.said
    one.slider("keep").uncheck()
    assert one.shown("time") == [1 / 125]
    assert "too dark" in one.said


def test_the_depth_of_field(sheet):
    one = Moving(sheet, SHEET["focus-distance"])
    for stop, distance, f in ((3, 9, 50), (8, 12, 85), (10, 15, 24), (0, 0, 200)):
        one.put(N=stop, s=distance, f=f)
        told = solved(
            "optics.depth_of_field", f=f / 1000, N=NUMBERS[stop], c=30e-6, s=DISTANCES[distance]
        )
        assert one.shown("hyperfocal") == [near(told["H"])]
        assert one.shown("near") == [near(told["z_n"])]
        endless = DISTANCES[distance] >= told["H"]
        assert one.shown("far") == [math.inf if endless else near(told["z_f"])]
        assert one.shown("depth") == [math.inf if endless else near(told["T"])]
        assert ("infinity" in one.said) == endless


def test_the_blur_of_a_point(sheet):
    """As wide as the solver says, of a point that is imaged where the thin lens equation says."""
    told = solved("optics.blur_disc", f=50, N_1=2.8, N_2=4, p=1,
                  **{"z'_s": 1 / (1 / 50 - 1 / 4000), "z'_p": 1 / (1 / 50 - 1 / 1500)})  # fmt: skip
    disc = sheet.evaluate(
        "import('/static/moving/focus-distance.js').then((m) => m.disc(50, 2.8, 4000, 1500))"
    )
    assert disc == pytest.approx(told["c"], rel=1e-9)


def test_the_grid(sheet):
    one = Moving(sheet, SHEET["distortion-grid"])
    for k1, k2 in ((-0.2, 0), (0.25, 0.05), (-0.4, 0.1), (0, 0), (0.3, -0.1)):
        one.put(k_1=k1, k_2=k2)
        told = solved("distortion.radial_point", k_1=k1, k_2=k2, x=0.75, y=0.5)
        assert one.shown("to") == [near(told["x_d"]), near(told["y_d"])]
        assert one.shown("factor") == [near(told["L"])]
        assert one.shown("share") == [pytest.approx(100 * told["q"], rel=1e-3, abs=1e-9)]
    one.put(k_1=-0.2, k_2=0)
    assert (
        f"Beyond the radius {solved('distortion.fold_over', k_1=-0.2, r_c=1)['r_f']:.4g} "
        in one.said
    )


def test_the_pinhole(sheet):
    one = Moving(sheet, SHEET["pinhole-point"])
    for y, z, f in ((9, 3, 2), (-15, 12, 6), (0, 5, 1), (4.5, 0.5, 3.5), (6, -4, 2)):
        one.put(p_y=y, p_z=z, f=f)
        told = solved("projection.perspective", p_x=0, p_y=y, p_z=z, f=f)
        assert one.shown("image") == [near(told["p'_y"])]
        assert one.shown("turned") == [near(-told["p'_y"])]
        assert ("behind the camera" in one.said) == (z < 0)
    one.put(p_z=0)
    assert one.figure.locator("[data-out=image]").inner_text() == "–"
    assert "there is no image" in one.said


@pytest.mark.parametrize("hand", ["mouse", "finger"])
def test_the_point_is_dragged(opened, served, hand):
    page = opened(viewport={"width": 390, "height": 844}, has_touch=hand == "finger")
    page.goto(served.address + "/formulas")
    one = Moving(page, SHEET["pinhole-point"])
    one.figure.scroll_into_view_if_needed()
    point = one.figure.locator("[data-part=target]").bounding_box()
    x, y = point["x"] + point["width"] / 2, point["y"] + point["height"] / 2
    pixels, scrolled = one.figure.locator("svg").bounding_box()["width"] / 320, "scrollY"
    before = page.evaluate(scrolled)
    way = between((x, y), (x - 3 * 16 * pixels, y + 4 * 6 * pixels))  # 3 deep, 4 high
    if hand == "finger":
        Screen(page).finger(way)
    else:
        page.mouse.move(x, y)
        page.mouse.down()
        for place in way:
            page.mouse.move(*place)
        page.mouse.up()
        page.mouse.move(x, y)  # lets go of nothing
    assert [one.slider(name).input_value() for name in ("p_z", "p_y")] == ["5", "6"]
    assert page.evaluate(scrolled) == before


def test_the_histogram(sheet):
    one = Moving(sheet, SHEET["clamped-histogram"])
    for low, high, value in ((0, 255, 300), (16, 235, 124), (64, 200, -20), (200, 40, 50)):
        one.put(I_min=low, I_max=high, I=value)
        told = solved("normalisation.clamped_normalisation", I=value, I_min=low, I_max=high)
        assert one.shown("plain") == [near(told["t"])]
        assert one.shown("stored") == [near(told["N_c"])]
        pixels = sheet.evaluate(
            "import('/static/moving/clamped-histogram.js').then((m) => m.PIXELS)"
        )
        lost = sum(n for at, n in zip(range(-40, 330, 10), pixels, strict=True) if not min(low, high) <= at <= max(low, high))  # fmt: skip
        assert one.shown("lost") == [near(100 * lost / sum(pixels), 3)]
    assert "exchanged" in one.said
    one.slider("clamp").uncheck()
    one.put(I_min=0, I_max=255, I=300)
    assert one.shown("stored") == [near(300 / 255)]
    one.put(I_max=0)
    assert "no width" in one.said


def test_the_tails(sheet):
    one = Moving(sheet, SHEET["gaussian-tails"])
    for sigma, k in ((2, 1), (0.5, 3), (8, 2.5), (5, 6), (2, 0)):
        one.put(sigma=sigma, k=k)
        told = solved("noise.gaussian_tails", sigma=sigma, t_1=k * sigma, t_2=k * sigma, M=1e6)
        outside = float(sympy.erfc(sympy.Float(k, 30) / sympy.sqrt(2)))
        assert one.shown("peak") == [near(told["g_0"])]
        assert one.shown("inside") == [near(100 * told["p_1"], 6)]
        assert one.shown("outside") == [near(100 * outside)]
        assert one.shown("side") == [near(50 * outside)]
        assert one.shown("pixels") == [near(1e6 * outside)]


def test_the_share_beyond_is_right_to_the_last_digits(sheet):
    got = sheet.evaluate(
        "import('/static/moving/gaussian-tails.js').then((m) => [...Array(60).keys()].map((i) => m.erfc(i / 10)))"
    )
    assert got == pytest.approx([math.erfc(i / 10) for i in range(60)], rel=1e-12)


@pytest.mark.parametrize(
    ("night", "curve", "peak", "lumens"), [(False, DAY, 555, 683), (True, NIGHT, 507, 1700)]
)
def test_the_eye(sheet, night, curve, peak, lumens):
    one = Moving(sheet, SHEET["eye-and-filter"])
    one.slider("night").set_checked(night)

    def area(low: float, high: float) -> float:
        middles = low + (high - low) * (np.arange(40_000) + 0.5) / 40_000
        return float(np.mean(luminous_efficiency(middles, curve))) * (high - low)

    for nm, width in ((555, 100), (650, 60), (400, 200), (700, 10), (505, 0)):
        one.put(**{"lambda": nm, "width": width})
        there = float(luminous_efficiency(nm, curve))
        told = solved("eye.luminous_flux_ratio", P_1=1, P_2=1, V_1=1, V_2=there)
        low, high = max(380, nm - width / 2), min(780, nm + width / 2)
        share = area(low, high) / area(380, 780)
        assert one.shown("efficiency") == [near(there)]
        assert one.shown("lumens") == [near(lumens * there)]
        assert one.shown("power") == [near(100 * (high - low) / 400)]
        assert one.shown("brightness") == [pytest.approx(100 * share, rel=1e-3, abs=1e-9)]
        watts = one.said.partition("as bright as ")[2].partition(" at ")[0]
        assert read(watts) == near(1 / told["r"], 3)
        assert f"at {peak}\u00a0nm" in one.said


def test_the_colours(sheet):
    one = Moving(sheet, SHEET["hsv-sliders"])
    for hue, saturation, value in (
        (0, 1, 1),
        (95, 0.4, 0.7),
        (210, 0.05, 0.3),
        (359, 0.9, 0.6),
        (120, 0, 0.5),
        (40, 1, 0),
    ):
        one.put(H=hue, S=saturation, V=value)
        told = solved("colour.hsv_to_rgb", H=hue, S=saturation, V=value)
        assert one.shown("now") == [near(told[channel], 3) for channel in "RGB"]
    back = sheet.evaluate(
        "import('/static/moving/hsv-sliders.js').then((m) => m.toHsv([0.25, 0.75, 0.6]))"
    )
    told = solved("colour.rgb_to_hsv", R=0.25, G=0.75, B=0.6)
    assert back == pytest.approx([told[name] for name in "HSV"])


def test_the_picture_is_edited_as_its_balloon_is(sheet):
    one = Moving(sheet, "F24")
    one.put(S=0)
    paints = one.figure.locator("svg [fill^='#']").evaluate_all(
        "all => all.map((one) => one.getAttribute('fill'))"
    )
    assert len(paints) > 40
    assert all(code[1:3] == code[3:5] == code[5:7] for code in paints)
    assert "a grey" in one.said


@pytest.mark.parametrize("formula", SHEET.values(), ids=SHEET)
def test_each_is_moved_by_keys_and_says_its_values(opened, served, formula):
    page = opened()
    page.goto(f"{served.address}/formulas#{formula}")
    page.locator(f"#{formula} .moving summary").focus()
    page.keyboard.press("Enter")
    figure = page.locator(f"#moving-{formula}[data-ready]")
    figure.wait_for()
    sliders = figure.locator("input[type=range]")
    keys = Keys(page)
    for slider in sliders.all():
        keys.on(slider)
        page.keyboard.press("Home")
        least = slider.get_attribute("aria-valuetext")
        page.keyboard.press("ArrowRight")
        now = slider.get_attribute("aria-valuetext")
        assert now != least
        assert figure.locator(f"output[for='{slider.get_attribute('id')}']").inner_text() == now
        page.keyboard.press("Enter")  # hands in nothing
        assert page.url.endswith(f"/formulas#{formula}")
    expect(figure.locator("[role=status]")).to_have_text(
        figure.locator(".moving-said").inner_text()
    )
    keys.on(figure.locator("[data-back]"))
    page.keyboard.press("Enter")
    assert figure.evaluate("one => JSON.stringify(one.values) === JSON.stringify(one.start)")


@pytest.mark.parametrize(
    ("lang", "scheme", "width"), sample([("bn", "dark", 390), ("en", "light", 1280)], 1)
)
def test_nothing_keeps_people_out(opened, served, barriers, lang, scheme, width):
    page = opened(viewport={"width": width, "height": 844}, color_scheme=scheme, bypass_csp=True)
    token = page.locator("[name=token]").first.input_value()
    settings = {"token": token, "lang": lang, "back": "/"}
    page.request.post(served.address + "/settings", form=settings)
    page.goto(f"{served.address}/formulas")
    for formula in SHEET.values():
        Moving(page, formula)
    assert barriers(page) == []
    page.request.post(served.address + "/settings", form={**settings, "lang": "en"})


def test_it_comes_with_the_end_of_a_question_and_not_before(opened, served):
    page = opened()
    token = page.locator("[name=token]").first.input_value()
    asked = {"token": token, "template": "point-to-image-plane"}
    page.goto(page.request.post(served.address + "/practice", form=asked).url)
    for field in page.locator("section.part input[type=text]").all():
        field.fill("0.123")
    page.locator("section.part button.main").click()
    expect(page.locator(".verdict")).to_be_visible()
    expect(page.locator(".moving")).to_have_count(0)
    page.get_by_role("button", name="Solution").or_(page.get_by_role("button", name="Show")).click()
    page.locator(".moving summary").click()
    figure = page.locator("moving-figure[data-ready]")
    figure.wait_for()
    f, y, z = (
        read(figure.locator(f"output[for=moving-{name}]").inner_text())
        for name in ("f", "p_y", "p_z")
    )
    answer = figure.locator("[data-out=image]").inner_text()
    assert read(answer) == solved("projection.perspective", p_x=0, p_y=y, p_z=z, f=f)["p'_y"]
    assert answer in page.locator(".result").inner_text()


def test_without_scripts_there_is_no_fold_and_the_sketch_stays(opened, served):
    page = opened(java_script_enabled=False)
    page.goto(f"{served.address}/formulas")
    expect(page.locator(".moving").first).to_be_hidden()
    expect(page.locator("#F05 .sketch svg")).to_be_visible()


def test_nothing_moves_by_itself(opened, served):
    page = opened(reduced_motion="reduce")
    page.goto(f"{served.address}/formulas")
    for formula in SHEET.values():
        one = Moving(page, formula)
        timed = "all => all.some((one) => { const s = getComputedStyle(one); return s.transitionDuration !== '0s' || s.animationName !== 'none'; })"
        assert not one.figure.locator("*").evaluate_all(timed)

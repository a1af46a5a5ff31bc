"""The question which effects to simulate: what its key leaves out really changes too little."""

from __future__ import annotations

from sweep import together

from quizgen.bank.variant import draw_variant
from quizgen.camera import Camera, Length, PreparedScene, Scene, SceneObject, run_plan
from quizgen.camera.simulation import measure_difference
from quizgen.question.part_context import ask_part

EFFECTS = {
    "defocus": "defocus",
    "distortion": "distortion",
    "rolling": "rolling shutter",
    "noise": "read noise",
}
SEEDS = 150


def _scene(given) -> Scene:
    width, height, depth = int(given["W"]), int(given["H"]), given["z"]
    speed = given["f"] * 1e-3 * given["v"] / (depth * given["p"] * 1e-6)  # px/s
    low, step = 0.3, given["G"] / 255
    bright = (low + step,) * 3
    thing = SceneObject(
        "box", width=Length(width / 4), height=Length(height), depth=depth, colour=bright,
        velocity=(Length(speed), Length(0.0)),
    )  # fmt: skip
    return Scene(width, height, (thing,), (low,) * 3, background_depth=depth)


def _camera(given) -> Camera:
    return Camera(
        focal_length=given["f"] * 1e-3,
        pixel_pitch=given["p"] * 1e-6,
        f_number=given["N"],
        focus_distance=given["s"],
        k1=given["k_1"],
        row_time=given["t_r"] * 1e-6,
        full_well=given["F"],
        read_noise=given["sigma"],
        shot_noise=False,
    )


@together("seed", range(0, SEEDS, 5))
def test_what_the_key_leaves_out_changes_no_more_than_two_levels(bank, seed):
    drawn = draw_variant(bank.template("which-effects-to-simulate"), seed)
    given = {name: float(value) for name, value in drawn.shown.items()}
    prepared = PreparedScene(_scene(given), _camera(given))
    names = [effect.name for effect in prepared.present]
    whole = run_plan(prepared)
    for _, name in ask_part(drawn, 4).right:
        if EFFECTS[name] != "read noise":  # which is asked by its deviation, not its tail
            without = run_plan(prepared, [other for other in names if other != EFFECTS[name]])
            assert measure_difference(without, whole) <= 2.0, name


def test_every_number_of_effects_occurs(bank):
    template = bank.template("which-effects-to-simulate")
    sizes = {len(ask_part(draw_variant(template, seed), 4).right) for seed in range(SEEDS)}
    assert sizes == {1, 2, 3}

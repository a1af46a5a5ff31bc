"""Gradient of nine pixels by the Sobel kernels: x to the right, y downward, not divided.

Source: Gonzalez & Woods, Digital Image Processing, 4th ed. (2018), section 10.2.
"""

from sympy import atan2, evaluate, pi, symbols

from quizgen.maths.model import Model, Step

F = symbols("f_1:10", integer=True)
G_x, G_y, theta = symbols("G_x G_y theta", real=True)
f_1, f_2, f_3, f_4, _, f_6, f_7, f_8, f_9 = F

with evaluate(False):
    MODEL = Model(
        given=dict.fromkeys(F, ""),
        steps=(
            Step(G_x, (f_3 + 2 * f_6 + f_9) - (f_1 + 2 * f_4 + f_7)),
            Step(G_y, (f_7 + 2 * f_8 + f_9) - (f_1 + 2 * f_2 + f_3)),
            Step(theta, 180 / pi * atan2(G_y, G_x), "deg"),
        ),
        traps={
            "prewitt": (
                Step(G_x, (f_3 + f_6 + f_9) - (f_1 + f_4 + f_7)),
                Step(G_y, (f_7 + f_8 + f_9) - (f_1 + f_2 + f_3)),
            ),
            "exchanged": (
                Step(G_x, (f_7 + 2 * f_8 + f_9) - (f_1 + 2 * f_2 + f_3)),
                Step(G_y, (f_3 + 2 * f_6 + f_9) - (f_1 + 2 * f_4 + f_7)),
            ),
            "turned": (
                Step(G_x, (f_1 + 2 * f_4 + f_7) - (f_3 + 2 * f_6 + f_9)),
                Step(G_y, (f_1 + 2 * f_2 + f_3) - (f_7 + 2 * f_8 + f_9)),
            ),
            "along-the-edge": Step(theta, 180 / pi * atan2(G_x, -G_y)),
            "upside-down": Step(theta, 180 / pi * atan2(G_x, G_y)),
            "radians": Step(theta, atan2(G_y, G_x)),
            "wrong-quadrant": Step(theta, 180 / pi * atan2(-G_y, -G_x)),
        },
    )

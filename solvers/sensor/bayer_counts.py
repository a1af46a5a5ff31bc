"""How many red, green and blue photosites a Bayer sensor has, odd sizes included.

Source: Burger & Burge, Digital Image Processing, 2nd ed. (2016), section 12.1; plain counting.
"""

from sympy import evaluate, floor, symbols

from quizgen.maths.model import Model, Step

W, H = symbols("W H", integer=True)
x_r, y_r = symbols("x_R y_R", integer=True)
w_0, w_1, h_0, h_1, R, B, G = symbols("W_R W_B H_R H_B R B G", integer=True)

with evaluate(False):
    MODEL = Model(
        given={W: "", H: "", x_r: "", y_r: ""},
        steps=(
            Step(w_0, floor((W + 1 - x_r) / 2)),
            Step(h_0, floor((H + 1 - y_r) / 2)),
            Step(w_1, W - w_0),
            Step(h_1, H - h_0),
            Step(R, w_0 * h_0),
            Step(B, w_1 * h_1),
            Step(G, W * H - R - B),
        ),
        traps={
            "equal-thirds": (
                Step(R, W * H / 3),
                Step(B, W * H / 3),
                Step(G, W * H / 3),
            ),
            "odd-size-ignored": (
                Step(R, floor(W / 2) * floor(H / 2)),
                Step(B, floor(W / 2) * floor(H / 2)),
                Step(G, 2 * floor(W / 2) * floor(H / 2)),
            ),
            "quarter-half": (
                Step(R, W * H / 4),
                Step(B, W * H / 4),
                Step(G, W * H / 2),
            ),
            "corner-exchanged": (Step(R, w_1 * h_1), Step(B, w_0 * h_0)),
        },
    )

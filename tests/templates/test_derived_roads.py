"""Roads that people take through the derivations of the bank, each with the points that an examiner gives.

The numbers are those of the notes (the reference draw). None means that the answer is asked back.
"""

from __future__ import annotations

import pytest

from quizgen.bank.variant import reference_variant
from quizgen.kinds.grade import grade_answer
from quizgen.question.part_context import ask_part

ROADS: dict[str, list[tuple[int, str, float | None]]] = {
    "derive-perspective-projection": [
        (0, "tan(alpha) = p_y/p_z\ntan(alpha)=p'_y/f\np'_y = f p_y/p_z", 3),
        (0, "t = p_y/p_z\nt = p'_y/f\np'_y = f t = f p_y/p_z", 3),
        (0, "lambda p_z = f\nlambda = f/p_z\np'_y = lambda p_y = f p_y/p_z", 3),
        (0, "p'_y : f = p_y : p_z\np'_y = f*p_y/p_z", 3),
        (0, "p'_y = f·(p_y ÷ p_z)", 1),
        (0, "f/p_z = p'_y/p_y = tan a", None),
        (0, "1/f = 1/z + 1/z'", None),
        (0, "p'_y/f = p_y/p_z\n=> p'_y = p_y/p_z * f", 3),
    ],
    "derive-blur-disc": [
        (0, "c/2 = (D/2) (z'_p - z'_s)/z'_p\nc = D (z'_p - z'_s)/z'_p", 3),
        (0, "c/(z'_p - z'_s) = D/z'_p\nc = D(1 - z'_s/z'_p)", 3),
        (0, "c/D = |z'_s - z'_p|/z'_p\nc = D·|z'_s − z'_p|/z'_p", 3),
        (0, "c = D(z'_s - z'_p)/z'_p", 0),
        (0, "c/D = (z'_p-z'_s)/z'_s\nc = D (z'_p-z'_s)/z'_s", 1),
        (0, "y = D/2 (1 - z'_s/z'_p)\nc = 2y\nc = D (z'_p - z'_s)/z'_p", None),
    ],
    "derive-pixel-coordinates": [
        (0, "p'_x = f p_x/p_z\nu = m_x p'_x + o_x\nu = m_x f p_x/p_z + o_x", 3),
        (0, "f_x = m_x f\nu = f_x p_x/p_z + o_x", 2),
        (0, "u = m_x f p_x/p_z + o_x", 1),
        (0, "u = f p_x/p_z", 0),
        (0, "u = m_x(f p_x/p_z + o_x)", 0),
        (1, "v = o_y - m_y f p_y/p_z", 1),
        (1, "v = o_y + m_y f p_y/p_z", 0),
    ],
    "show-shot-noise-snr": [
        (0, "Var = N\nsigma = sqrt(Var)\nSNR = N/sqrt(N)\nSNR = sqrt(N)", 3),
        (0, "sigma² = N\nSNR = N/sigma = N/sqrt(N) = sqrt(N)", 3),
        (0, "SNR² = N²/N = N\nSNR = sqrt N", 2),
        (1, "q = sqrt(4N)/sqrt(N) = 2", 1),
        (1, "q=2", 1),
        (1, "q=4", 0),
        (1, "SNR = 2 sqrt(N)", 0),
    ],
    "show-lens-becomes-pinhole": [
        (0, "1/50 = 1/z + 1/z'\n1/z' = 1/50 - 1/z = (z-50)/(50z)\nz' = 50z/(z-50)", 2),
        (0, "1/f = 1/z+1/z'\n1/z'=1/f-1/z\nz' = f z/(z-f)", 1),
        (0, "z' = 1/(1/50 - 1/z)", 1),
        (0, "z' = 50/(1 - 50/z)", 1),
        (0, "z' = 50 z/(z-50)", 1),
        (0, "z'(z - 50) = 50 z\nz' = 50z/(z-50)", 2),
    ],
    "derive-weak-perspective-error": [
        (0, "s = f/(Z-d)\ne = (s-w)/s\n= 1 - w/s = 1 - (Z-d)/Z\n= d/Z", 3),
        (0, "e = (f/(Z-d) - f/Z)/(f/(Z-d)) = d/Z", 1.5),
        (0, "e = d/Z", 1.5),
        (0, "s = f/(Z-d)\ne = s - w = f/(Z-d) - f/Z", 2.5),
        (1, "e = 0.01", 1),
        (1, "e = 1 %", 1),
        (1, "e = 1/100 = 1%", 1),
        (1, "e=2%", 0),
    ],
    "show-isotropic-case": [
        (
            0,
            "k = sigma^2*sigma^2 = sigma^4\nsqrt(k) = sigma^2\nq = (x^2+y^2)/sigma^2\np = 1/(2 pi sigma^2) e^(-(x^2+y^2)/(2 sigma^2))",
            3,
        ),
        (0, "p = 1/(2 pi sigma^2) exp(-(x^2+y^2)/(2 sigma^2))", 1),
        (
            0,
            "k = σ^4\nq = x²/σ² + y²/σ²\np = 1/(sqrt(2π)σ) exp(-x²/(2σ²)) * 1/(sqrt(2π)σ) exp(-y²/(2σ²))\n= 1/(2πσ²) exp(-(x²+y²)/(2σ²))",
            3,
        ),
        (0, "p = 1/(2 pi sigma^4) exp(-(x^2+y^2)/(2 sigma^2))", 0),
        (1, "p_0 = 0.0796", 1),
        (1, "p_0 = 1/(4 pi) = 0.08", 1),
        (1, "p_0=0.2", 0),
    ],
    "derive-normalisation": [
        (0, "50a + b = 0\n200a+b=1\n150a = 1\na = 1/150\nb = -1/3\nN = I/150 - 1/3", 3),
        (0, "N = (I - 50)/(200 - 50)", 1),
        (0, "a = 1/150\nN = (I-50)/150", 3),
        (0, "N = I/150", 0),
        (0, "a = 0.00667\nN = 0.00667 (I - 50)", 2),
        (0, "N = (I-50)/200", 0),
    ],
    "derive-stops-and-time": [
        (0, "D_1 = f/2\nD_2 = f/8\nq = (D_1/D_2)^2 = 16\n16 = 2^4\nn = 4", 4),
        (0, "D = f/N", None),
        (0, "q = (8/2)^2 = 16\nn = log2(16) = 4", 3),
        (0, "q = 4\nn = 2", 1),
        (0, "t_2/t_1 = 16", None),
        (0, "q = D_1²/D_2² = (f/2)²/(f/8)² = 64/4 = 16\nn=4", 4),
    ],
    "show-a-line-bends": [
        (
            0,
            "r² = 0.25 + y²\nx' = 0.5(1 - 0.2 r²)\nx' = 0.5 (1 - 0.2 (0.25 + y²))\n= 0.475 - 0.1 y²",
            2,
        ),
        (0, "x' = 0.475 - 0.1y^2", 1),
        (0, "x' = 0.5(1-0.2 r)", 0),
        (1, "q_0 = 0.475\nq_1=0.45\nq_2 = 0.375", 2),
        (1, "q_0 = 0.5(1-0.2*0.25) = 0.475; q_1 = 0.45; q_2 = 0.38", 2),
    ],
    "show-gamma-mismatch": [
        (
            0,
            "(0.2+0.8)/2 = 0.5\ng = 0.5^(1/2.2) = 0.730\n0.2^(1/2.2) = 0.481\n0.8^(1/2.2)=0.904\nm = 0.692\nm < g",
            3,
        ),
        (0, "g=0.73\nm=0.69\n0.69<0.73", 3),
        (0, "g = 0.218", 0),
    ],
    "prove-hsv-not-linear": [
        (
            0,
            "V_a = max(0.5,0.1,0) = 0.5\nV_b = 0.45\nV_s = max(0.55, 0.55, 0) = 0.55\n0.55 < 0.95",
            3,
        ),
        (0, "V_a=0.5; V_b=0.45; V_s=0.55\nV_a + V_b = 0.95 ≠ 0.55", 3),
        (0, "V_s = 0.55\nV_a + V_b = 0.95\nV_s < V_a+V_b", 2),
        (0, "V_s = 0.95", 0),
    ],
    "derive-even-powers": [
        (
            0,
            "M = 1 - a_1 r + a_2 r^2 - a_3 r^3\nL = M\n2 a_1 r + 2 a_3 r^3 = 0\na_1 = 0\na_3 = 0\nL = 1 + a_2 r^2",
            4,
        ),
        (0, "L(-r) = L(r)", None),
        (0, "M = L\na_1 = a_3 = 0\nL = 1 + a_2 r²", 3),
        (0, "L - M = 0\nL = 1+a_2 r^2", 2),
    ],
    "derive-width-of-gaussian": [
        (0, "exp(-x^2/(2 sigma^2)) = 1/2\n-x^2/(2 sigma^2) = ln(1/2)\nx = sigma sqrt(2 ln 2)", 4),
        (0, "e^(-x²/(2σ²)) = 0.5\nx² = -2σ² ln 0.5\nx = 1.177 σ", 4),
        (0, "x = sigma*sqrt(ln 2)", 0),
        (1, "w = 2*1.177*2 = 4.71", 1),
        (1, "w = 2.35", 0),
    ],
    "show-radial-line-stays-straight": [
        (0, "r² = 1.25 x²\nx' = x(1+k_1 r²)\ny' = 0.5 x (1+k_1 r²)\ny' = 0.5 x'", 3),
        (0, "y'/x' = y/x = 1/2\ny' = x'/2", 3),
        (0, "y' = 0.5x", 0),
    ],
    "derive-distance-from-two-pictures": [
        (0, "h_1 = fY/Z\nh_2 = fY/(Z+d)\nh_1/h_2 = 1 + d/Z\nZ = d/(h_1/h_2 - 1)", 4),
        (0, "fY = h_1 Z = h_2 (Z+d)\nZ(h_1-h_2) = h_2 d\nZ = h_2 d/(h_1-h_2)", 4),
        (1, "Z = 12", 1),
        (1, "Z = 16", 0),
    ],
    "derive-dolly-zoom": [
        (0, "h_1 = f Y/Z\nh_2 = f_2 Y/(2Z)\nh_1 = h_2\nf_2 = 2f", 3),
        (0, "f_2/(2Z) = f/Z\nf_2 = 2 f", 3),
        (0, "f_2 = f/2", 0),
        (1, "w_1 = f W/(5Z)\nw_2 = f_2 W/(6Z)\nm = 10/6", 2),
        (1, "m = 2", 0),
    ],
    "derive-flat-field": [
        (0, "W - D = v L_0\n(R-D)/(W-D) = L/L_0\nL = L_0 (R-D)/(W-D)", 4),
        (0, "v = (W-D)/L_0\nL = (R-D)/v\nL = L_0 (R-D)/(W-D)", 4),
        (0, "L = L_0 R/W", 0),
    ],
    "show-saturation-under-light": [
        (0, "S = (M-m)/M\nS' = (kM - km)/(kM) = k(M-m)/(kM)\nS' = S", 3),
        (0, "S = 1 - m/M\nS' = 1 - km/(kM) = 1 - m/M = S", 3),
    ],
    "derive-noise-of-a-mean": [
        (0, "V = n σ²\ns = sqrt(V)/n = sqrt(n) σ/n\ns = σ/√n", 4),
        (0, "V = n^2 sigma^2\ns = sqrt(V)/n = sigma", 2),
        (1, "n = 16", 1),
    ],
    "derive-quantisation-error": [
        (0, "n = 2^b\nd = A/(2^b-1)\ne = d/2 = A/(2(2^b-1))", 4),
        (0, "n = 2^b\nd = A/n\ne = d/2\ne = A/2^(b+1)", 3),
    ],
}
"""Template to part, what is typed, and its points."""


@pytest.mark.parametrize("name", ROADS)
def test_each_road_gets_its_points(bank, name):
    drawn = reference_variant(bank.template(name))
    found = []
    for part, typed, _ in ROADS[name]:
        spec = ask_part(drawn, part).spec
        verdict = grade_answer(spec, typed)
        points = float(verdict.credit * spec.total) if verdict.is_graded else None
        found.append((part, typed, points))
    assert found == ROADS[name]

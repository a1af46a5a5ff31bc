"""Reference values: the textbook formulas in mpmath, at whatever precision settles 45 digits.

Nothing here computes with the code under test (the table of V(lambda) is read from it). ``reference(name, args)`` takes doubles, reads them as the
binary numbers they are, and returns an ``mpf`` with at least 45 correct digits.
"""

# ruff: noqa: N803, E741 - mathematics and tables of inputs

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import mpmath as mp
from mpmath import mpf

from quizgen.arrays.cie1924 import FIRST_NM, STEP_NM, V


def reference(name, args, digits=45):
    """Raise the precision until two results agree to ``digits`` digits."""
    formula = FORMULAS[name]
    before = None
    for precision in (60, 120, 240, 480, 960, 1920, 3840):
        with mp.workdps(precision):
            result = formula(*[mpf(float(arg)) for arg in args])
            settled = before is not None and _agree(before, result, digits)
            if settled and (result != 0 or precision > 900):
                return result
            before = result
    raise ArithmeticError(f"{name}{args} does not settle")


def _agree(a, b, digits):
    if a == b:
        return True
    if mp.isinf(a) or mp.isinf(b):
        return False
    return abs(a - b) <= abs(b) * mpf(10) ** (-digits)


def upper_tail(k):
    if abs(k) > 1000:
        return mpf(k < 0)
    return mp.erfc(k / mp.sqrt(2)) / 2


def log_tail(k):
    if k > 1000:
        series = sum((-1) ** n * mp.fac2(2 * n - 1) / k ** (2 * n) for n in range(40))
        return -k * k / 2 - mp.log(k * mp.sqrt(2 * mp.pi)) + mp.log(series)
    return mp.log(upper_tail(k)) if k > 0 else mp.log1p(-upper_tail(-k))


def pdf(x, mu, sigma):
    return mp.exp(-(((x - mu) / sigma) ** 2) / 2) / (mp.sqrt(2 * mp.pi) * sigma)


def interval(a, b):
    if a > 0:
        return upper_tail(a) - upper_tail(b)
    return upper_tail(-b) - upper_tail(-a)


def inverse_tail(p):
    """Newton on ln Q, in extended precision."""
    if p == mpf(1) / 2:
        return mpf(0)
    if p > mpf(1) / 2:
        return -inverse_tail(1 - p)
    k = mp.sqrt(-2 * mp.log(2 * p)) if p < mpf(2) / 5 else (mpf(1) / 2 - p) * mp.sqrt(2 * mp.pi)
    for _ in range(200):
        q = upper_tail(k)
        step = mp.log(q / p) * q * mp.sqrt(2 * mp.pi) * mp.exp(k * k / 2)
        k += step
        if abs(step) <= abs(k) * mpf(10) ** (5 - mp.mp.dps):
            return k
    raise ArithmeticError("no convergence")


def stops(a, b):
    return 2 * mp.log(b / a) / mp.log(2)


def far_limit(f, N, c, s):
    gap = f * f - N * c * (s - f)
    return f * f * s / gap if gap > 0 else mp.inf


def near_limit(f, N, c, s):
    return f * f * s / (f * f + N * c * (s - f))


def total_depth(f, N, c, s):
    far = far_limit(f, N, c, s)
    return far if mp.isinf(far) else far - near_limit(f, N, c, s)


def image_distance(f, z):
    return mp.inf if z == f else f * z / (z - f)


def focus_shift(f, z):
    return mp.inf if z == f else f * z / (z - f) - f


def blur_disc(f, N, s, z):
    """D |z'_s - z'_p|/z'_p with 1/z' = 1/f - 1/z."""
    at_s, at_z = f * s / (s - f), 1 / (1 / f - 1 / z) if z != f else mp.inf
    if mp.isinf(at_z):
        return f / N
    return f / N * abs(at_s - at_z) / abs(at_z)


def fold_radius(k1, k2):
    roots = []
    if k2 == 0:
        if k1 < 0:
            roots = [-1 / (3 * k1)]
    else:
        inside = 9 * k1 * k1 - 20 * k2
        if inside >= 0:
            roots = [(-3 * k1 + sign * mp.sqrt(inside)) / (10 * k2) for sign in (1, -1)]
    roots = [u for u in roots if u > 0]
    return mp.sqrt(min(roots)) if roots else mp.inf


def inverse_radius(d, k1, k2):
    """Bisection up to the fold, then Newton."""
    if d == 0:
        return mpf(0)
    fold = fold_radius(k1, k2)
    low, high = mpf(0), fold
    if mp.isinf(fold):
        high = d
        while high * (1 + k1 * high**2 + k2 * high**4) < d:
            high *= 2
    for _ in range(int(3.4 * mp.mp.dps) + 40):
        middle = (low + high) / 2
        if middle * (1 + k1 * middle**2 + k2 * middle**4) < d:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def distort(x, y, k1, k2):
    r2 = x * x + y * y
    return x * (1 + k1 * r2 + k2 * r2 * r2)


def hue(R, G, B):
    top, low = max(R, G, B), min(R, G, B)
    if top == R:
        turn = (G - B) / (top - low)
    elif top == G:
        turn = 2 + (B - R) / (top - low)
    else:
        turn = 4 + (R - G) / (top - low)
    return 60 * turn % 360


def saturation(R, G, B):
    top = max(R, G, B)
    return mpf(0) if top == min(R, G, B) else (top - min(R, G, B)) / top


def channel(n):
    """One channel of HSV to RGB in the closed form f(n) = V - V S max(0, min(k, 4 - k, 1))."""

    def formula(H, S, V):
        k = (n + H / 60) % 6
        return V - V * S * max(mpf(0), min(k, 4 - k, mpf(1)))

    return formula


def normalise(I, low, high, new_low, new_high):
    return new_low + (I - low) / (high - low) * (new_high - new_low)


def as_decimal(value):
    """The decimal of at most 15 digits whose nearest double this is, or else the double."""
    text = f"{value:.15g}"
    return Fraction(text) if float(text) == value else Fraction(value)


def pixel(*args):
    """On the decimals that these doubles stand for, with fractions."""
    f, pitch, x, z, o = (as_decimal(float(arg)) for arg in args)
    u = o + f * x / (pitch * z)
    return mpf(u.numerator) / u.denominator


def snr(N, sigma):
    return mpf(0) if N == 0 else N / mp.sqrt(N + sigma * sigma)


def snr_loss(N, sigma):
    return 1 - snr(N, sigma) / mp.sqrt(N)


def photons_for(S, sigma):
    return (S * S + S * mp.sqrt(S * S + 4 * sigma * sigma)) / 2


def poisson_pmf(k, lam):
    if lam == 0:
        return mpf(k == 0)
    return mp.exp(k * mp.log(lam) - lam - mp.loggamma(k + 1))


def poisson_upper(k, lam):
    """P(X >= k): the regularised lower incomplete gamma function of k at lam."""
    return mpf(1) if k == 0 else _regularised(k, lam, lower=True)


def poisson_lower(k, lam):
    """P(X <= k)."""
    return _regularised(k + 1, lam, lower=False)


def _regularised(a, x, *, lower):
    """Sum the terms of the smaller side one by one."""
    if x == 0:
        return mpf(0) if lower else mpf(1)
    start = mp.exp(a * mp.log(x) - x - mp.loggamma(a + 1))
    if x < a + 1:
        term, total, n = start, start, a
        while term > total * mpf(10) ** (-mp.mp.dps):
            n += 1
            term *= x / n
            total += term
        return total if lower else 1 - total
    term = start * a / x
    total, n = term, a
    while n > 1 and term > total * mpf(10) ** (-mp.mp.dps):
        n -= 1
        term *= n / x
        total += term
    return 1 - total if lower else total


def encode(x):
    return x ** (mpf(5) / 11) if x else mpf(0)


def decode(x):
    return x ** (mpf(11) / 5) if x else mpf(0)


def gap(a, b):
    return encode((a + b) / 2) - (encode(a) + encode(b)) / 2


def srgb_encode(x):
    if x <= mpf("0.0031308"):
        return x * mpf("12.92")
    return mpf("1.055") * x ** (mpf(5) / 12) - mpf("0.055")


def srgb_decode(x):
    if x <= mpf("0.04045"):
        return x / mpf("12.92")
    return ((x + mpf("0.055")) / mpf("1.055")) ** (mpf(12) / 5)


def cos4(r, f):
    return 1 / (1 + (r / f) ** 2) ** 2


def table():
    """V(lambda) of CIE 1924, read as the decimals of the table: wavelength and value."""
    return [(mpf(FIRST_NM + STEP_NM * i), mpf(repr(v))) for i, v in enumerate(V)]


def segments():
    return pairwise(table())


def photopic(wavelength):
    for (x0, v0), (x1, v1) in segments():
        if x0 <= wavelength <= x1:
            return v0 + (v1 - v0) * (wavelength - x0) / (x1 - x0)
    return mpf(0)


def band_flux(power, low, high):
    if low == high:
        return power * 683 * photopic(low)
    total = mpf(0)
    for (x0, _), (x1, _) in segments():
        a, b = max(low, x0), min(high, x1)
        if a < b:
            total += (b - a) * (photopic(a) + photopic(b)) / 2
    return power * 683 * total / (high - low)


def line_flux(power, centre, fwhm):
    """Closed form on each straight piece."""
    if fwhm == 0:
        return power * 683 * photopic(centre)
    sigma, total = fwhm / mp.sqrt(8 * mp.log(2)), mpf(0)
    for (x0, v0), (x1, v1) in segments():
        a, b, slope = (x0 - centre) / sigma, (x1 - centre) / sigma, (v1 - v0) / (x1 - x0)
        line = v0 + slope * (centre - x0)
        total += line * interval(a, b) + slope * sigma * (mp.npdf(a) - mp.npdf(b))
    return power * 683 * total


def photon_energy(wavelength):
    return mpf("6.62607015e-34") * 299792458 / wavelength


def photon_energy_ev(wavelength):
    return photon_energy(wavelength * mpf("1e-9")) / mpf("1.602176634e-19")


def planck_factor(wavelength, temperature):
    x = photon_energy(wavelength * mpf("1e-9")) / (mpf("1.380649e-23") * temperature)
    return mpf(0) if x > 10**6 else 1 / mp.expm1(x)


FORMULAS = {
    "gaussian.pdf": pdf,
    "gaussian.upper_tail": upper_tail,
    "gaussian.two_sided_tail": lambda k: mp.erfc(k / mp.sqrt(2)) if k > 0 else mpf(1),
    "gaussian.log_tail": log_tail,
    "gaussian.inverse_tail": inverse_tail,
    "gaussian.interval": interval,
    "gaussian.expected_beyond": lambda M, k: M * mp.erfc(k / mp.sqrt(2)),
    "gaussian.determinant": lambda a, b, rho: (a * b) ** 2 * (1 - rho * rho),
    "gaussian.peak_2d": lambda a, b, rho: 1 / (2 * mp.pi * a * b * mp.sqrt(1 - rho * rho)),
    "thin_lens.image_distance": image_distance,
    "thin_lens.focus_shift": focus_shift,
    "thin_lens.magnification": lambda f, z: image_distance(f, z) / z,
    "blur.blur_disc": blur_disc,
    "depth_of_field.hyperfocal": lambda f, N, c: f * f / (N * c) + f,
    "depth_of_field.near_limit": near_limit,
    "depth_of_field.far_limit": far_limit,
    "depth_of_field.total_depth": total_depth,
    "stops.stops": stops,
    "stops.light_ratio": lambda a, b: (b / a) ** 2,
    "distortion.distort_x": distort,
    "distortion.inverse_radius": inverse_radius,
    "distortion.displacement": lambda r, k1, k2: r - r * (1 + k1 * r**2 + k2 * r**4),
    "distortion.correction": lambda d, k1, k2: inverse_radius(d, k1, k2) - d,
    "distortion.fold_radius": fold_radius,
    "hsv.hue": hue,
    "hsv.saturation": saturation,
    "hsv.red": channel(5),
    "hsv.green": channel(3),
    "hsv.blue": channel(1),
    "normalise.normalise": normalise,
    "projection.project_x": lambda f, x, z: f * x / z,
    "projection.pixel": pixel,
    "weak_perspective.scale_error": lambda z, zbar: (1 / z - 1 / zbar) * z,
    "weak_perspective.scale_error_of_weak": lambda z, zbar: (1 / z - 1 / zbar) * zbar,
    "snr.snr": snr,
    "snr.snr_loss": snr_loss,
    "snr.photons_for": photons_for,
    "poisson.pmf": poisson_pmf,
    "poisson.upper": poisson_upper,
    "poisson.lower": poisson_lower,
    "gamma.encode": encode,
    "gamma.decode": decode,
    "gamma.gap": gap,
    "gamma.srgb_encode": srgb_encode,
    "gamma.srgb_decode": srgb_decode,
    "luminosity.photopic": photopic,
    "luminosity.band_flux": band_flux,
    "luminosity.line_flux": line_flux,
    "luminosity.photon_energy": photon_energy,
    "luminosity.photon_energy_ev": photon_energy_ev,
    "luminosity.planck_factor": planck_factor,
    "vignetting.cos4": cos4,
    "vignetting.falloff": lambda r, f: 1 - cos4(r, f),
}

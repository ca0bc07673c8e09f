#!/usr/bin/env python3
"""Computes resonances of the one-mode equation, and solutions very close to them, with 40 digits (needs python3-mpmath).

    python3 make_resonance.py > resonance.csv

Tapers and equation are those of make_one_mode.py (model mode, c = 800 m/s), here with the end clamped wherever it is:
    linear       J_mu(k s) Y_mu(k s_end) - Y_mu(k s) J_mu(k s_end), or J_mu(k s) if the surface ends at its apex
    exponential  (K_(i nu)(z) Re I_(i nu)(z_end) - Re I_(i nu)(z) K_(i nu)(z_end)) / sqrt(W)
A resonance is a frequency at which v(0) of the lossless mode is zero. Columns: taper, slope (or decay length in m), W0 and
length in m, Q (0: lossless), the resonance in Hz, and then for each of seven frequencies near it: the frequency in Hz,
ln of the gain |v| at the last maximum over |v(0)|, the position of the last maximum in m, and the conditioning,
hypot(|v(0)|, |v'(0)|/k) / |v(0)| with the lossless k. The seven relative distances are 1e-3, 1e-6, -1e-9, 1e-9, 1e-11,
1e-12 and -1e-13, rounded so that each frequency is a double.
"""
from mpmath import mp, mpf, mpc, pi, sqrt, besselj, bessely, besseli, besselk, log, exp, diff, findroot, hypot

mp.dps = 40
C = mpf(800)


def solution(taper, slope, w0, length, k, f):
    """Returns v(x) for the complex wavenumber k."""
    if taper == "linear":
        mu, apex = sqrt((pi / (2 * slope)) ** 2 + pi**2 / 6), w0 / slope
        end = apex - length
        if end <= apex * mpf("1e-12"):
            return lambda x: besselj(mu, k * (apex - x))
        y_end, j_end = bessely(mu, k * end), besselj(mu, k * end)
        return lambda x: besselj(mu, k * (apex - x)) * y_end - bessely(mu, k * (apex - x)) * j_end
    order = mpc(0, 1) * sqrt((k * slope) ** 2 - (pi**2 / 6 - mpf(1) / 4))
    z = lambda x: pi * slope / (2 * w0) * exp(x / slope)
    regular = lambda t: (besseli(order, t) + besseli(-order, t)) / 2
    k_end, i_end = besselk(order, z(length)), regular(z(length))
    return lambda x: exp(x / (2 * slope)) * (besselk(order, z(x)) * i_end - regular(z(x)) * k_end)


def wavenumber(f, q):
    k = 2 * pi * f / C
    return k if q == 0 else k * mpc(1, -mpf(1) / (2 * q))


def last_maximum(v, start, k, real):
    """Returns the outermost maximum of |v| inside of `start`."""
    square = (lambda x: mp.re(v(x)) ** 2) if real else (lambda x: abs(v(x)) ** 2)
    step, x = mpf("0.05") / k, start
    here = square(x)
    while x > 0:
        inner = square(x - step)
        if inner < here:
            rise = (lambda t: mp.re(diff(v, t) / v(x))) if real else (lambda t: diff(square, t) / here)
            return findroot(rise, (x - step, min(x + step, start)), solver="anderson", tol=mpf("1e-50"), maxsteps=60)
        x, here = x - step, inner
    raise ValueError("no last maximum")


def row(taper, slope, w0, length, near, q):
    slope, w0, length, near = (mpf(float(value)) for value in (slope, w0, length, near))
    at_drive = lambda f: mp.re(solution(taper, slope, w0, length, wavenumber(f, 0), f)(mpf(0)))
    step, f = near / 400, near
    while at_drive(f) * at_drive(f + step) > 0:
        f += step
    unit = abs(at_drive(f))
    resonance = findroot(lambda t: at_drive(t) / unit, (f, f + step), solver="anderson", tol=mpf("1e-60"), maxsteps=100)
    cells = [taper] + [repr(float(value)) for value in (slope, w0, length, q)] + [mp.nstr(resonance, 20)]
    for distance in ("1e-3", "1e-6", "-1e-9", "1e-9", "1e-11", "1e-12", "-1e-13"):
        f = mpf(float(resonance * (1 + mpf(distance))))
        k = 2 * pi * f / C
        v = solution(taper, slope, w0, length, wavenumber(f, q), f)
        wide = C / (4 * f)
        turning = (w0 - wide) / slope if taper == "linear" else slope * log(w0 / wide)
        peak = mp.re(last_maximum(v, min(turning, length), k, q == 0))
        drive, tilt = abs(v(mpf(0))), abs(diff(v, mpf(0))) / k
        cells += [repr(float(f)), mp.nstr(log(abs(v(peak)) / drive), 17), mp.nstr(peak, 17),
                  mp.nstr(hypot(drive, tilt) / drive, 17)]
    print(",".join(cells), flush=True)


if __name__ == "__main__":
    for q in (0, 1e12, 1e9):
        row("linear", 0.1, 0.03, 0.3, 19500, q)
        row("linear", 0.1, 0.03, 0.3, 44000, q)
        row("linear", 0.01, 0.012, 0.9, 22400, q)  # clamped before the apex
        row("linear", 0.1, 0.02, 0.09, 22400, q)  # clamped before the turning point
        row("linear", 0.5, 0.05, 0.1, 30000, q)
        row("exponential", 0.1, 0.02, 0.14, 22400, q)
        row("exponential", 0.1, 0.02, 0.08, 22400, q)  # clamped just before the turning point

#!/usr/bin/env python3
"""Computes what tones can make of desired profiles (needs python3-mpmath, python3-numpy and python3-scipy).

    python3 make_profile.py > profile.csv

The surface is a linear taper (c = 800 m/s, W0 = 30 mm, slope 0.1, clamped at 270 mm); fields are those of make_resonance.py.
For each candidate frequency, SciPy's non-negative least squares has one column of |v|^2. Rows:
    surface  Q (0: lossless), lowest frequency, highest frequency and spacing in Hz
    tone     frequency in Hz, then |v|^2 at x = 1, 6, 11, ... mm for v(0) = 1
    target   residual of the best fit (rms of the difference, relative to the rms of the target), then the squared amplitudes
The lowest frequency of the second surface is within 1e-9 of a resonance.
"""
import numpy as np
from mpmath import mp, mpf, findroot
from scipy.optimize import nnls
from make_resonance import solution, wavenumber

W0, SLOPE, LENGTH = (mpf(float(t)) for t in (0.03, 0.1, 0.27))


def line(f, q):
    return solution("linear", SLOPE, W0, LENGTH, wavenumber(mpf(f), q), mpf(f))


def resonance(near):
    at_drive = lambda f: mp.re(line(f, 0)(mpf(0)))
    f = mpf(near)
    while at_drive(f) * at_drive(f + 20) > 0:
        f += 20
    unit = abs(at_drive(f))
    return findroot(lambda t: at_drive(t) / unit, (f, f + 20), solver="anderson", tol=mpf("1e-50"), maxsteps=100)


if __name__ == "__main__":
    x = 0.001 + 0.005 * np.arange(54)
    ramp, step = np.clip(1 - x / 0.25, 0, None), (x < 0.2) * 1.0
    # a target that lies almost completely where no tone of the band moves the surface
    tail = np.exp(-((x - 0.262) / 0.004) ** 2)
    for q, low, high, spacing in ((60, 8e3, 45e3, 1e3), (0, float(resonance(12e3) * (1 + mpf("1e-9"))), 44.9e3, 1370.0)):
        print(f"surface,{float(q)!r},{low!r},{high!r},{spacing!r}")
        columns = []
        for i in range(int((high - low) / spacing * (1 + 1e-12)) + 1):
            f = low + i * spacing
            v = line(f, q)
            unit = abs(v(mpf(0)))
            column = [(abs(v(mpf(float(t)))) / unit) ** 2 for t in x]
            print(f"tone,{f!r}," + ",".join(mp.nstr(c, 12) for c in column), flush=True)
            columns.append(np.array([float(c / max(column)) for c in column]))
        for target in (ramp, step, tail):
            residual = nnls(np.array(columns).T, target, maxiter=10000)[1] / np.linalg.norm(target)
            print(f"target,{residual:.9f}," + ",".join("%.12g" % t for t in target))

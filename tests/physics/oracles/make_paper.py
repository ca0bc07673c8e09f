#!/usr/bin/env python3
"""Computes the 1998 paper's two profiles of its figures with 30 digits (needs python3-mpmath).

    python3 make_paper.py > paper.csv

Columns: index of the figure and of its panel, index of the point (of 1201 along the surface), then equation 11 of the
paper, sqrt(s) J_mu(k s) with mu^2 = (pi/2d)^2 + 1/4, and its Airy profile Ai(k0 (x - x0)) with k0^3 = 4 d k^3/pi, each
divided by its last maximum.
"""
from mpmath import mp, mpf, airyai, besselj, cbrt, findroot, diff, pi, sqrt

mp.dps = 30


def profiles(w0, d, c, f):
    k, apex = 2 * pi * f / c, w0 / d
    mu, k0, x0 = sqrt((pi / (2 * d)) ** 2 + mpf(1) / 4), cbrt(4 * d * k**3 / pi), apex - pi / (2 * k * d)
    exact = lambda x: sqrt(apex - x) * besselj(mu, k * (apex - x)) if x < apex else mpf(0)
    near = lambda x: airyai(k0 * (x - x0))
    top = mpf("-1.0187929716474710890173")
    peak = findroot(lambda x: diff(exact, x), (x0 + (top - mpf("0.12")) / k0, x0 + (top - mpf("0.05")) / k0), solver="anderson")
    return lambda x: (exact(x) / exact(peak), near(x) / airyai(top))


brass = (mpf("0.03"), mpf("0.1"), sqrt(mpf("5.12e9") / 8110))
rubber = (mpf("0.05"), mpf("0.1"), mpf("4.2"))
for figure, panel, surface, f in ((0, 0, brass, 19600), (1, 1, brass, 40000), (2, 0, rubber, 30), (2, 1, rubber, 40),
                                  (3, 0, brass, 8000), (3, 1, brass, 45000)):
    both = profiles(*surface, f)
    for at in (0, 200, 500, 800, 1100):
        values = both(surface[0] / surface[1] * at / 1200)
        print(figure, panel, at, *(mp.nstr(one, 12) for one in values), sep=",")

#!/usr/bin/env python3
"""Writes forced_choice_table.hpp: the proportion correct of an unbiased observer, by numerical integration with
mpmath. It needs python3-mpmath; the result is checked in.

m intervals: the integral of phi(x - d') Phi(x)^(m - 1). ABX: integrals over the observations themselves, without the
closed forms of Macmillan & Creelman (2005) that the program uses.
"""
import mpmath as mp

mp.mp.dps = 30
INF = mp.inf


def phi(x, mean=0):
    return mp.npdf(x, mean, 1)


def largest(d, m):
    return mp.quad(lambda x: phi(x, d) * mp.ncdf(x) ** (m - 1), [-12, -4, 0, d, d + 4, d + 12])


def differencing(d):
    """X and A come from the same distribution, with mean 0, B from that with mean d: |X - A| < |X - B|. Given A and B,
    X must lie on A's side of their middle."""
    def given(a, b):
        middle = mp.ncdf((a + b) / 2)
        return middle if a < b else 1 - middle
    def inner(a):
        f = lambda b: phi(b, d) * given(a, b)
        return phi(a) * mp.quad(f, sorted([d - 9, a, d + 9]))
    with mp.workdps(12):
        return mp.quad(inner, [-8, 0, 8])


def independent(d):
    """A and B: the order of the larger and the smaller. X: above or below the middle between both means."""
    with mp.workdps(12):
        order = mp.quad(lambda a: phi(a) * (1 - mp.ncdf(a - d)), [-9, 0, 9])
        side = mp.quad(lambda x: phi(x), [-12, 0, d / 2])
        return order * side + (1 - order) * (1 - side)


print("// Written by make_forced_choice.py: d', then the proportion correct of 2, 3 and 4 intervals, and of ABX by")
print("// independent observations and by differencing.")
print("#pragma once\n\nconstexpr double kForcedChoice[][6] = {")
for d in ("0", "0.25", "0.5", "1", "1.5", "2", "3", "4"):
    d = mp.mpf(d)
    row = [d] + [largest(d, m) for m in (2, 3, 4)] + [independent(d), differencing(d)]
    print("    {" + ", ".join(mp.nstr(x, 11, strip_zeros=False) for x in row) + "},")
print("};")

#!/usr/bin/env python3
"""Computes the coefficients of the odd minimax polynomials for sin(2 pi r), |r| <= 1/4 (station/audio/sine.hpp).

Uses Remez's exchange algorithm on the absolute error, with mpmath. Prints the coefficients as hexadecimal doubles,
and the largest error of the polynomial.
Usage: sine_coefficients.py [terms ...]   (default 8 and 5 terms: degrees 15 and 9)
"""
import sys
from mpmath import mp, mpf, pi, sin, cos, lu_solve, matrix

mp.dps = 60


def remez(terms):
    nodes = [mpf(1) / 4 * sin(pi / 2 * mpf(k + 1) / (terms + 1)) for k in range(terms + 1)]
    for _ in range(12):
        a, b = matrix(terms + 1, terms + 1), matrix(terms + 1, 1)
        for row, r in enumerate(nodes):
            for k in range(terms):
                a[row, k] = r ** (2 * k + 1)
            a[row, terms] = (-1) ** row
            b[row] = sin(2 * pi * r)
        solution = lu_solve(a, b)
        c = [solution[k] for k in range(terms)]

        def error(r):
            return sum(c[k] * r ** (2 * k + 1) for k in range(terms)) - sin(2 * pi * r)

        grid = [mpf(k) / 16000 for k in range(1, 4001)]
        values = [error(r) for r in grid]
        extrema = [k for k in range(1, len(grid) - 1)
                   if abs(values[k]) >= abs(values[k - 1]) and abs(values[k]) >= abs(values[k + 1])]
        nodes = [grid[k] for k in extrema] + [mpf(1) / 4]
        if len(nodes) != terms + 1:
            raise SystemExit(f"the error has {len(nodes)} extrema, expected {terms + 1}")
    return c, max(abs(v) for v in values)


for count in [int(a) for a in sys.argv[1:]] or [8, 5]:
    coefficients, worst = remez(count)
    print(f"{count} terms, error {mp.nstr(worst, 3)} ({mp.nstr(20 * mp.log10(worst), 5)} dB)")
    for value in coefficients:
        print(f"    {float(value).hex()},  // {mp.nstr(value, 20)}")

#!/usr/bin/env python3
"""Computes the exact first mode of a wedge, J_nu(k r) cos(nu theta) with nu = pi / (2 atan d) (needs python3-mpmath).

    python3 make_wedge.py > wedge.csv

The half-width at the drive edge is 30 mm, and c^2 = 5.12e9/8110. Columns: slope d; frequency f; 24 values along the
drive edge at y = 30 mm sqrt(t_i) with t_i = (1 + cos(pi (i + 1/2)/24))/2, i = 0 ... 23; 40 values on the centre line
at i/40 of the length, i = 0 ... 39.
"""
from mpmath import mp, mpf, atan, atan2, besselj, cos, hypot, nstr, pi, sqrt

mp.dps = 30
C = sqrt(mpf("5.12e9") / 8110)
W0 = mpf("0.03")
for d in ("0.05", "0.1", "0.5"):
    for f in (8000, 19600, 45000):
        slope = mpf(float(d))
        k, nu, apex = 2 * pi * f / C, pi / (2 * atan(slope)), W0 / slope
        cells = [d, str(f)]
        for i in range(24):
            y = W0 * sqrt((1 + cos(pi * (i + mpf(1) / 2) / 24)) / 2)
            cells.append(nstr(besselj(nu, k * hypot(apex, y)) * cos(nu * atan2(y, apex)), 16))
        for i in range(40):
            cells.append(nstr(besselj(nu, k * apex * (1 - mpf(i) / 40)), 16))
        print(",".join(cells))

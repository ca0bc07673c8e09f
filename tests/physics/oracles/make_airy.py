#!/usr/bin/env python3
"""Prints reference values of the Airy function, computed with 50 digits (needs python3-mpmath).

Columns: t, Ai(t) exp(-l), Ai'(t) exp(-l), l. The scale l is -2/3 t^(3/2) for t > 5, otherwise 0.

    python3 make_airy.py > airy.csv
"""
from mpmath import mp, mpf, airyai, exp, nstr

mp.dps = 50
for i in list(range(-400, 401, 5)) + [-9999, -1234, 999, 2500, 5000]:
    t = mpf(float(i) / 16)
    l = -mpf(2) / 3 * t ** mpf(1.5) if t > 5 else mpf(0)
    ai, dai = airyai(t), airyai(t, derivative=1)
    print(",".join([repr(float(t)), nstr(ai * exp(-l), 18), nstr(dai * exp(-l), 18), nstr(l, 18)]))

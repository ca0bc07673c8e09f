#!/usr/bin/env python3
"""Writes first_passage.csv: the probability that a Wiener process with drift has left (-1, 1) at its upper end by a
given time.

The process has unit variance. The probability is computed by two independent series, for short and for long times
(Feller 1968, XIV.6; Navarro & Fuss 2009), which must agree to 1e-20. Needs python3-mpmath.
"""
from mpmath import mp, mpf, pi, exp, sin, sqrt, erfc

mp.dps = 40


def long_times(drift, start, t):
    """Probability of passing the upper end by time t from `start` in (-1, 1), by the series for long times. The
    series is for the lower end, so the process is mirrored."""
    v, a, w = -drift, mpf(2), (1 - start) / 2
    total = upper_ever(drift, start)
    s = mpf(0)
    for k in range(1, 400):
        rate = (v * v + (k * pi / a) ** 2) / 2
        s += k * sin(pi * k * w) * exp(-rate * t) / rate
    return total - pi / a**2 * exp(-v * a * w) * s


def upper_ever(drift, start):
    if drift == 0:
        return (1 + mpf(start)) / 2
    return (1 - exp(-2 * drift * (1 + start))) / (1 - exp(-4 * drift))


def short_times(drift, start, t):
    """The same probability by the series for short times: a sum over images k at the distances 1 - start + 4k, each
    integrated in closed form."""
    s = mpf(0)
    for k in range(-60, 61):
        d = 1 - start + 4 * k
        # One term of the series is the integral of d / sqrt(2 pi u^3) exp(drift (1 - start) -
        # drift^2 u / 2 - d^2 / (2 u)) over u from 0 to t.
        sign, b = (1, d) if d > 0 else (-1, -d)
        m = abs(drift)
        one = exp(-m * b) * erfc((b - m * t) / sqrt(2 * t)) / 2
        two = exp(m * b) * erfc((b + m * t) / sqrt(2 * t)) / 2
        s += sign * (one + two)
    return exp(drift * (1 - start)) * s


print("# drift,start,time,upper; written by make_first_passage.py")
for drift in (mpf(0), mpf("0.35"), mpf("0.9"), mpf("1.8"), mpf(4)):
    for start in (mpf(0), mpf("-0.4")):
        for t in ("0.05", "0.1", "0.2", "0.35", "0.5", "0.7", "1", "1.5", "2.5", "4"):
            one, two = long_times(drift, start, mpf(t)), short_times(drift, start, mpf(t))
            assert abs(one - two) < mpf(10) ** -20, (drift, start, t, one, two)
            print(f"{mp.nstr(drift, 3)},{mp.nstr(start, 3)},{t},{mp.nstr(two, 15)}")

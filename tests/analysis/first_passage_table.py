#!/usr/bin/env python3
"""first_passage_table.py [SETS [SEED]]: prints densities, distributions, tails and survival of the diffusion between two
boundaries at random parameters, computed with mpmath in 60 to 400 digits (package python3-mpmath), as C++ rows. The test
test_first_passage.cpp has 500 of them. One row in 25 is also compared with the integral of the density.

The columns: drift, boundary, start, time, then the natural logarithms of the density at the lower boundary, of its
distribution, of its tail, and of the survival; below -1e5 a logarithm is written as -1e9.

first_passage_table.py varied [SETS [SEED]] prints rows with variability: drift, boundary, start, time, standard deviation of
the drift, range of the delay, then the same four logarithms. The averages over drifts and delays are taken by quadrature,
twice with different steps; the test has 19 rows. "extended" prints such rows much faster, by sums of sines in 80 bits; the
test reads rows from the file that TURNPOINT_VARIED_ROWS names.
"""
import random
import sys

import numpy as np
from mpmath import mp, mpf, erfc, exp, inf, log, pi, quad, sin, sqrt

PI = np.longdouble("3.14159265358979323846264338327950288")


def density(v, a, w, t):
    u = t / a**2
    if u > mpf("0.3"):
        total, k = mpf(0), 1
        while True:
            term = k * sin(k * pi * w) * exp(-k * k * pi**2 * u / 2)
            total += term
            if k * k * exp(-(k * k - 1) * pi**2 * u / 2) < mpf(10) ** (-mp.dps):
                break
            k += 1
        f = pi * total
    else:
        f = sum((w + 2 * k) * exp(-((w + 2 * k) ** 2) / (2 * u)) for k in range(-60, 61)) / sqrt(2 * pi * u**3)
    return exp(-v * a * w - v * v * t / 2) * f / a**2


def ever(v, a, w):
    if v == 0:
        return 1 - w
    return (exp(-2 * v * a) - exp(-2 * v * a * w)) / (exp(-2 * v * a) - 1)


def tail_by_sines(v, a, w, t):
    u, total, k = t / a**2, mpf(0), 1
    while True:
        rate = v * v / 2 + (k * pi / a) ** 2 / 2
        total += k * sin(k * pi * w) / rate * exp(-rate * t)
        if (k * k - 1) * pi**2 * u / 2 > mp.dps * 2.4:
            break
        k += 1
    return pi / a**2 * exp(-v * a * w) * total


def distribution_by_images(v, a, w, t):
    upper = lambda x: erfc(x / sqrt(mpf(2))) / 2  # noqa: E731
    total = mpf(0)
    for k in range(0, 400):
        r = k * a + (a * w if k % 2 == 0 else a * (1 - w))
        term = exp(-v * r) * upper((r - v * t) / sqrt(t)) + exp(v * r) * upper((r + v * t) / sqrt(t))
        total += -term if k % 2 else term
        if k > 2 and abs(term) < abs(total) * mpf(10) ** (-mp.dps + 10):
            break
    return exp(-v * a * w) * total


def both(v, a, w, t):
    """Distribution and tail at the lower boundary."""
    if t / a**2 > mpf("0.02"):
        tail = tail_by_sines(v, a, w, t)
        below = ever(v, a, w) - tail
        if t / a**2 < 1:
            below = distribution_by_images(v, a, w, t)
        return below, tail
    below = distribution_by_images(v, a, w, t)
    return below, ever(v, a, w) - below


def written(x):
    value = log(x) if x > 0 else mpf(-inf)
    if abs(value) < mpf(10) ** -300:
        return "-0.0"
    return "-1e9" if value < -1e5 else mp.nstr(value, 17)


def main(sets=500, seed=20):
    draw = random.Random(seed)
    for i in range(int(sets)):
        hard = i % 5 == 0
        v = draw.choice([0.0, draw.uniform(-6, 6), draw.uniform(-6, 6), draw.uniform(-30, 30) if hard else draw.gauss(0, 2)])
        a = 10 ** draw.uniform(-0.7, 0.9)
        w = draw.choice([0.5, draw.uniform(0.05, 0.95), 10 ** draw.uniform(-4, -1) if hard else 0.5])
        if hard and draw.random() < 0.3:
            w = 1 - w
        t = 10 ** draw.uniform(-4, 2) if hard else a * a * 10 ** draw.uniform(-1.7, 0.9)
        mp.dps = 60
        v, a, w, t = (mpf(float(repr(float(x)))) for x in (v, a, w, t))
        need = 60 + int(abs(v) * a + v * v * t / 2 + a * a / t)
        mp.dps = min(need, 1200)
        f = density(v, a, w, t)
        below, tail = both(v, a, w, t)
        _, other = both(-v, a, 1 - w, t)
        if i % 25 == 0 and below > mpf(10) ** -30:
            mp.dps = 30
            integral = quad(lambda s: density(v, a, w, s), [0, t / 8, t / 4, t / 2, t])
            assert abs(integral / below - 1) < mpf(10) ** -9, (v, a, w, t, integral, below)
        print("    {" + ", ".join([repr(float(x)) for x in (v, a, w, t)] + [written(x) for x in (f, below, tail, tail + other)]) + "},")


def nodes(edges, count=24):
    """Places and weights of Gauss-Legendre's rule between these edges."""
    x, w = np.polynomial.legendre.leggauss(count)
    for low, high in zip(edges, edges[1:]):
        for one, weight in zip(x, w):
            yield low + (high - low) * (mpf(float(one)) + 1) / 2, mpf(float(weight)) * (high - low) / 2


def averaged(v, a, w, t, sd, delay, panels):
    """Density, distribution and tail at the lower boundary, and survival, averaged over drifts and delays."""
    drifts = [(v, mpf(1))]
    if sd > 0:
        reach = sd * (9 + 2 * sd * a)
        drifts = [(x, weight * exp(-((x - v) / sd) ** 2 / 2) / (sd * sqrt(2 * pi)))
                  for x, weight in nodes([v - reach + 2 * reach * i / panels for i in range(panels + 1)])]
    times = [(t, mpf(1))]
    if delay > 0:
        low = max(t - delay, mpf(0))
        first = low if low > 0 else t / 10**4
        edges = [first * (t / first) ** (mpf(i) / panels) for i in range(panels + 1)]
        times = [(x, weight / delay) for x, weight in nodes(([mpf(0)] if low == 0 else []) + edges)]
    sums = [mpf(0)] * 4
    for drift, by_drift in drifts:
        if delay > t:
            before = by_drift * (delay - t) / delay
            sums[2] += before * ever(drift, a, w)
            sums[3] += before
        for time, by_time in times:
            below, tail = both(drift, a, w, time)
            _, other = both(-drift, a, 1 - w, time)
            for i, value in enumerate((density(drift, a, w, time), below, tail, tail + other)):
                sums[i] += by_drift * by_time * value
    return sums


def varied(sets=60, seed=21):
    draw = random.Random(seed)
    mp.dps = 28
    for i in range(int(sets)):
        kind = "both" if i % 25 == 24 else "drift" if i % 2 == 0 else "delay"
        wide = i % 4 >= 2
        v, a = draw.uniform(-10, 10) if wide else draw.uniform(-4, 4), 10 ** draw.uniform(-0.7 if wide else -0.3, 0.9 if wide else 0.5)
        w = draw.choice([0.5, draw.uniform(0.1, 0.9)] + ([10 ** draw.uniform(-3, -1), 1 - 10 ** draw.uniform(-3, -1)] if wide else []))
        t = a * a * 10 ** draw.uniform(-1.2, 0.7)
        sd = 0.0 if kind == "delay" else 10 ** draw.uniform(-1.5, 0.3 if wide else 0.1)
        delay = 0.0 if kind == "drift" else t * 10 ** draw.uniform(-1.5, 0.3)
        panels = {"drift": 24, "delay": 6, "both": 4}[kind]
        values = [mpf(x) for x in (v, a, w, t, sd, delay)]
        sums = averaged(*values, panels)
        again = averaged(*values, panels + (panels // 2 if kind != "both" else 1))
        if any(abs(one / other - 1) > mpf(10) ** -9.5 for one, other in zip(sums, again)):
            print("quadrature not exact enough:", kind, *(float(x) for x in values), file=sys.stderr, flush=True)
            continue
        print("    {" + ", ".join([repr(x) for x in (v, a, w, t, sd, delay)] + [written(x) for x in again]) + "},", flush=True)


def extended(sets=500, seed=22):
    """Rows as varied() prints them, by Gauss-Legendre quadrature of the sums of sines in 80 bits, in a second or less each. What
    cancels to less than 9 digits is "nan"."""
    draw = random.Random(seed)
    one, places = np.longdouble(1), [np.longdouble(x) for x in np.polynomial.legendre.leggauss(24)]

    def rule(edges):
        half, middle = (edges[1:] - edges[:-1]) / 2, (edges[1:] + edges[:-1]) / 2
        return (middle[:, None] + half[:, None] * places[0]).ravel(), (half[:, None] * places[1]).ravel()

    def sums(v, a, w, times, by_time, drifts, by_drift, before):
        """Weighted means of density, distribution and tail, and the largest sizes of what was summed for each."""
        terms_needed = 8 + int(4 * a / np.sqrt(times.min()))
        if terms_needed > 3000:
            return np.full(3, np.nan), np.ones(3)
        k = np.arange(1, terms_needed + 1) * one
        sines, pi = k * np.sin(k * PI * w), PI
        totals, sizes = np.zeros(3, np.longdouble), np.zeros(3, np.longdouble)
        ever = np.where(np.abs(drifts) * a < 1e-12, 1 - w, np.expm1(-2 * drifts * a * (1 - w)) * np.exp(-2 * drifts * a * w)
                        / np.where(drifts == 0, 1, np.expm1(-2 * drifts * a)))
        for t, weight in zip(times, by_time):
            terms = sines * np.exp(-((k * pi / a) ** 2) * t / 2)
            factor = pi / a**2 * np.exp(-drifts * a * w - drifts**2 * t / 2) * by_drift
            inverse = 1 / (drifts[:, None] ** 2 / 2 + (k * pi / a) ** 2 / 2)
            f, tail = terms.sum() * factor, (inverse * terms).sum(1) * factor
            f_size, tail_size = np.abs(terms).sum() * factor, (inverse * np.abs(terms)).sum(1) * factor
            for which, (value, size) in enumerate(((f, f_size), (ever * by_drift - tail, ever * by_drift + tail_size), (tail, tail_size))):
                totals[which] += weight * value.sum()
                sizes[which] += weight * size.sum()
        early = before * (ever * by_drift).sum()
        return totals + [0, 0, early], sizes + [0, 0, early]

    for i in range(int(sets)):
        kind = "both" if i % 5 == 4 else "drift" if i % 2 == 0 else "delay"
        v, a = draw.uniform(-30, 30) if i % 7 == 0 else draw.uniform(-10, 10), 10 ** draw.uniform(-0.7, 0.9)
        w = draw.choice([0.5, draw.uniform(0.1, 0.9), 10 ** draw.uniform(-2, -1), 1 - 10 ** draw.uniform(-2, -1)])
        t = a * a * 10 ** draw.uniform(-1.5, 0.7)
        sd = 0.0 if kind == "delay" else 10 ** draw.uniform(-1.5, 0.5 if i % 3 else 1.3)
        delay = 0.0 if kind == "drift" else t * 10 ** draw.uniform(-2, 0.3)
        v_, a_, w_, t_, sd_, delay_ = (np.longdouble(x) for x in (v, a, w, t, sd, delay))
        results = []
        for panels in (40, 56):
            drifts, by_drift = np.array([v_]), np.array([one])
            if sd > 0:
                reach = sd_ * (10 + sd_ * a_)
                # those who have not arrived by t are slow, so the drifts that count are nearer to 0
                ends = min(v_, v_ / (1 + sd_**2 * t_)) - reach, max(v_, v_ / (1 + sd_**2 * t_)) + reach
                drifts, by_drift = rule(ends[0] + (ends[1] - ends[0]) * np.arange(panels + 1) / panels)
                by_drift = by_drift * np.exp(-((drifts - v_) / sd_) ** 2 / 2) / (sd_ * np.sqrt(2 * PI))
            times, by_time, before = np.array([t_]), np.array([one]), 0 * one
            if delay > 0:
                low = max(t_ - delay_, (a_ * min(w_, 1 - w_)) ** 2 / 300)
                times, by_time = rule(low * (t_ / low) ** (np.arange(panels // 4 + 1) * one / (panels // 4)))
                by_time, before = by_time / delay_, max(delay_ - t_, 0 * one) / delay_
                if delay_ > t_ - low:  # between the beginning and `low` nothing has arrived
                    before = (low - (t_ - delay_)) / delay_
            lower = sums(v_, a_, w_, times, by_time, drifts, by_drift, before)
            upper = sums(-v_, a_, 1 - w_, times, by_time, -drifts, by_drift, before)
            values, sizes = lower
            values, sizes = np.append(values, values[2] + upper[0][2]), np.append(sizes, sizes[2] + upper[1][2])
            results.append((values, sizes))
        (values, sizes), again = results[1], results[0][0]
        with np.errstate(all="ignore"):
            good = (values > 1e-9 * sizes) & (np.abs(again / values - 1) < 1e-10)
            logs = np.where(good, np.log(np.abs(values)), np.nan)
        print("    {" + ", ".join([repr(x) for x in (v, a, w, t, sd, delay)] + [f"{x:.17g}" for x in logs]) + "},", flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] == ["varied"]:
        varied(*sys.argv[2:])
    elif sys.argv[1:2] == ["extended"]:
        extended(*sys.argv[2:])
    else:
        main(*sys.argv[1:])

#!/usr/bin/env python3
"""Prints fits of the normal model to ratings (test_rating_fit.cpp), with SciPy: a search without derivatives, followed
by one with numerical derivatives, over mean, log SD and log distances between criteria. The standard errors come from
the expected information, with numerical derivatives of the probabilities by mean, SD and criteria."""
import numpy as np
from scipy import optimize, stats

EXAMPLES = {"six ratings": ([174, 172, 104, 92, 41, 8], [46, 57, 66, 101, 154, 173]),
            "a rating that was never given": ([30, 22, 0, 10, 5], [6, 11, 0, 21, 29])}


def shares(mean, sd, criteria):
    edges = np.concatenate(([-np.inf], criteria, [np.inf]))
    return np.diff(stats.norm.cdf(edges)), np.diff(stats.norm.cdf((edges - mean) / sd))


def unpacked(x, free):
    mean, sd, rest = (x[0], np.exp(x[1]), x[2:]) if free else (x[0], 1.0, x[1:])
    return mean, sd, rest[0] + np.concatenate(([0], np.cumsum(np.exp(rest[1:]))))


def fit(noise, signal, free):
    used = (noise + signal) > 0
    noise, signal = noise[used], signal[used]

    def cost(x):
        p, q = shares(*unpacked(x, free))
        if np.any(p <= 0) or np.any(q <= 0):
            return 1e9
        return -(noise @ np.log(p) + signal @ np.log(q))

    x = np.concatenate(([1.0], [0.0] if free else [], [-0.5], np.full(len(noise) - 2, -0.5)))
    for method in ("Nelder-Mead", "BFGS", "Nelder-Mead"):
        x = optimize.minimize(cost, x, method=method,
                              options={"maxiter": 200000, "xatol": 1e-11, "fatol": 1e-13} if method != "BFGS"
                              else {"gtol": 1e-9}).x
    mean, sd, criteria = unpacked(x, free)
    at = np.concatenate(([mean, sd], criteria))

    def both(v):
        return np.concatenate(shares(v[0], v[1], v[2:]))

    columns = [i for i in range(len(at)) if free or i != 1]
    step = 1e-5
    slopes = np.array([(both(at + step * np.eye(len(at))[i]) - both(at - step * np.eye(len(at))[i])) / (2 * step)
                       for i in columns])
    weights = np.concatenate((np.full(len(noise), noise.sum()), np.full(len(signal), signal.sum()))) / both(at)
    covariance = np.linalg.inv(slopes * weights @ slopes.T)
    root = np.sqrt((1 + sd ** 2) / 2)
    turn = np.zeros(len(columns))
    turn[0] = 1 / root
    if free:
        turn[1] = -mean * sd / (2 * root ** 3)
    print(f"  {'unequal' if free else 'equal'}: mean {mean:.7f} sd {sd:.7f} sensitivity {mean / root:.7f} "
          f"+- {1.959963984540054 * np.sqrt(turn @ covariance @ turn):.7f} area {stats.norm.cdf(mean / root / np.sqrt(2)):.7f} "
          f"log likelihood {-cost(x):.7f}\n    criteria {np.round(criteria, 6).tolist()}"
          + (f"\n    se of sd {np.sqrt(covariance[1, 1]):.7f}" if free else ""))


for name, (noise, signal) in EXAMPLES.items():
    print(name)
    for free in (False, True):
        fit(np.array(noise, float), np.array(signal, float), free)

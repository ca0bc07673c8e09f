#!/usr/bin/env python3
"""Writes dependence_table.hpp: sessions with their effects of the trial before, by other means than the program's. It
needs python3-numpy and python3-scipy; the result is checked in.

Two choices: the penalised likelihood is written down as such and maximised by Nelder and Mead, then by Powell's method,
without derivatives; ends of intervals are roots of the profile (Brent). Numbers: the normal equations by pseudo-inverse.
"""
import numpy as np
from scipy import optimize, stats

RANDOM = np.random.default_rng(20261129)
STARTS = np.random.default_rng(7)
CRITICAL = stats.chi2.ppf(0.95, 1)


def penalised(b, x, y):
    z = x @ b
    p = 1 / (1 + np.exp(-z))
    sign, log_det = np.linalg.slogdet(x.T @ (x * (p * (1 - p))[:, None]))
    return -np.sum(y * z - np.logaddexp(0, z)) - log_det / 2 if sign > 0 else np.inf


def climb(function, start):
    start = optimize.minimize(function, start, method="Nelder-Mead",
                              options={"xatol": 1e-10, "fatol": 1e-13, "maxiter": 20000, "maxfev": 20000}).x
    return optimize.minimize(function, start, method="Powell", options={"xtol": 1e-10, "ftol": 1e-14}).x


def least(function, start):
    if len(start) == 0:
        return start, function(start)
    # a profile may have several maxima, if few answers came after an error
    starts = [start] + [start + s for s in STARTS.standard_normal((5, len(start))) * 3]
    best = min((climb(function, s) for s in starts), key=function)
    for _ in range(3):
        best = climb(function, best)
    return best, function(best)


def logistic(x, y, wanted):
    """The first `wanted` coefficients with the ends of their intervals."""
    best, lowest = least(lambda b: penalised(b, x, y), np.zeros(x.shape[1]))
    found = []
    for k in range(wanted):
        rest = np.delete(best, k)

        def fallen(value):
            return 2 * (least(lambda b: penalised(np.insert(b, k, value), x, y), rest)[1] - lowest) - CRITICAL
        width = 1.0 / np.std(x[:, k])
        low = optimize.brentq(fallen, best[k] - 6 * width, best[k], xtol=1e-8)
        high = optimize.brentq(fallen, best[k], best[k] + 6 * width, xtol=1e-8)
        found.append((best[k], low, high))
    return found


def linear(x, y):
    inverse = np.linalg.pinv(x.T @ x)
    b = inverse @ x.T @ y
    freedom = len(y) - np.linalg.matrix_rank(x)
    half = stats.t.ppf(0.975, freedom) * np.sqrt(np.sum((y - x @ b) ** 2) / freedom * np.diag(inverse))
    return list(zip(b, b - half, b + half))


def choices(trials, slope, before, habit, error):
    """Stimuli on two sides of 0; the trials, and what the regression says."""
    x = RANDOM.choice([-3, -2, -1, 1, 2, 3], trials) * 0.5
    answers = []
    for n in range(trials):
        z = 0.2 + slope * x[n]
        if n > 0:
            wrong = (answers[-1] == 1) != (x[n - 1] > 0)
            z += before * x[n - 1] + habit * (answers[-1] - 0.5) + error * wrong * x[n]
        answers.append(int(RANDOM.random() < 1 / (1 + np.exp(-z))))
    a = np.array(answers)
    wrong = (a == 1) != (x > 0)
    # the error itself may shift the answer, whatever the stimulus
    predictors = np.column_stack([x[1:], x[:-1], a[:-1] - 0.5, wrong[:-1] * x[1:], wrong[:-1] * 1.0,
                                  np.ones(trials - 1)])
    return x, a, logistic(predictors, a[1:], 4)


def magnitudes(trials):
    """Numbers in proportion to five stimuli."""
    x = RANDOM.choice([1.0, 2.0, 4.0, 8.0, 16.0], trials)
    logs = []
    for n in range(trials):
        last = 0.15 * np.log10(x[n - 1]) + 0.2 * logs[-1] if n > 0 else 0
        logs.append(0.8 * np.log10(x[n]) + last + 0.1 * RANDOM.standard_normal())
    y = np.log10(np.round(10 ** np.array(logs), 4))
    levels = [(x[1:] == level) * 1.0 for level in np.unique(x)]
    predictors = np.column_stack([np.log10(x[:-1]), y[:-1]] + levels)
    return x, np.round(10 ** y, 4), linear(predictors, y[1:])[:2]


def numbers(values):
    return "{" + ", ".join(repr(float(v)) for v in values) + "}"


print("// Written by make_dependence.py: levels, answers, and for each effect the estimate and the ends of its interval.")
print("#pragma once\n#include <vector>\n")
print("struct DependenceCase {\n  bool choices;\n  std::vector<double> levels, answers;\n  std::vector<std::vector<double>> effects;\n};\n")
print("// clang-format off\ninline const std::vector<DependenceCase> kDependence{")
for made in [choices(60, 2.0, 0.0, 0.0, 0.0), choices(150, 1.0, 0.4, 0.8, 0.0), choices(120, 4.0, -0.3, 0.5, -1.0)]:
    print("    {true, " + numbers(made[0]) + ",\n     " + numbers(made[1]) + ",\n     {" +
          ", ".join("{" + ", ".join("%.8f" % v for v in e) + "}" for e in made[2]) + "}},")
made = magnitudes(120)
print("    {false, " + numbers(made[0]) + ",\n     " + numbers(made[1]) + ",\n     {" +
      ", ".join("{" + ", ".join("%.10f" % v for v in e) + "}" for e in made[2]) + "}},")
print("};\n// clang-format on")

#!/usr/bin/env python3
"""Prints the most probable curve of sensitivity over time and its 95 % profile intervals (test_response_signal.cpp),
with NumPy and SciPy on a grid of its own. The criterion at each lag takes its best value."""
import numpy as np
from scipy.optimize import minimize_scalar
from scipy.stats import norm

TIMES_S = [0.42, 0.52, 0.67, 0.92, 1.32, 1.92]
HITS, FALSE_ALARMS, EACH = [19, 23, 21, 17, 21, 22], [7, 7, 9, 5, 5, 4], 28
DROP = 2.1

distances = np.linspace(0, 8, 1601)
tables = []
for hits, false_alarms in zip(HITS, FALSE_ALARMS):
    def worse(criterion, d):
        return -(hits * norm.logcdf(d / 2 - criterion) + (EACH - hits) * norm.logcdf(criterion - d / 2)
                 + false_alarms * norm.logcdf(-d / 2 - criterion) + (EACH - false_alarms) * norm.logcdf(d / 2 + criterion))
    tables.append([-minimize_scalar(worse, bounds=(-6, 6), method="bounded", args=(d,)).fun for d in distances])

grids = {"asymptote": np.linspace(0, 8, 401), "log rate": np.linspace(np.log(0.3), np.log(40), 201),
         "intercept": np.linspace(0, max(TIMES_S), 301)}
asymptotes, log_rates, intercepts = grids.values()
best = {name: np.full(len(grid), -np.inf) for name, grid in grids.items()}
for i, intercept in enumerate(intercepts):
    height = -0.5 * ((asymptotes[:, None] / 1.8) ** 2 + ((log_rates[None, :] - np.log(3)) / 1.5) ** 2)
    for time, table in zip(TIMES_S, tables):
        d_prime = np.outer(asymptotes, 1 - np.exp(-np.exp(log_rates) * max(0, time - intercept)))
        height = height + np.interp(d_prime, distances, table)
    best["asymptote"] = np.maximum(best["asymptote"], height.max(axis=1))
    best["log rate"] = np.maximum(best["log rate"], height.max(axis=0))
    best["intercept"][i] = height.max()
for name, grid in grids.items():
    inside = np.nonzero(best[name] > best[name].max() - DROP)[0]
    low, mode, high = grid[inside[0]], grid[best[name].argmax()], grid[inside[-1]]
    shown = np.exp([low, mode, high]) if name == "log rate" else np.array([low, mode, high])
    ends = " (the low end is that of the range)" * int(inside[0] == 0) + " (the high end is that of the range)" * int(inside[-1] == len(grid) - 1)
    print(name, *(f"{x:.4f}" for x in shown), ends)

#!/usr/bin/env python3
"""Prints medians and 95 % intervals of a curve of sensitivity over time (test_response_signal.cpp), by importance
sampling from the prior with NumPy and SciPy. The criterion at each lag is integrated over a flat prior; the station
takes the best criterion instead."""
import numpy as np
from scipy.stats import norm

TIMES_S = [0.42, 0.52, 0.67, 0.92, 1.32, 1.92]
HITS, FALSE_ALARMS, EACH = [19, 23, 21, 17, 21, 22], [7, 7, 9, 5, 5, 4], 28

generator = np.random.default_rng(1)
draws = 400_000
asymptote = generator.uniform(0, 6, draws)
rate = np.exp(generator.uniform(np.log(0.3), np.log(40), draws))
intercept = generator.uniform(0, max(TIMES_S), draws)
criteria, distances = np.linspace(-3, 3, 121), np.linspace(0, 6, 601)

log_weight = np.zeros(draws)
for time, hits, false_alarms in zip(TIMES_S, HITS, FALSE_ALARMS):
    half = distances[:, None] / 2
    log_likelihood = (hits * norm.logcdf(half - criteria) + (EACH - hits) * norm.logcdf(criteria - half)
                      + false_alarms * norm.logcdf(-half - criteria) + (EACH - false_alarms) * norm.logcdf(half + criteria))
    most = log_likelihood.max()
    table = np.log(np.exp(log_likelihood - most).sum(axis=1))
    d_prime = np.where(time > intercept, asymptote * (1 - np.exp(-rate * (time - intercept))), 0)
    log_weight += np.interp(d_prime, distances, table)
weight = np.exp(log_weight - log_weight.max())
weight /= weight.sum()

for name, values in (("asymptote", asymptote), ("rate", rate), ("intercept", intercept)):
    order = np.argsort(values)
    shares = np.cumsum(weight[order])
    print(name, *(f"{values[order][np.searchsorted(shares, p)]:.4f}" for p in (0.025, 0.5, 0.975)))

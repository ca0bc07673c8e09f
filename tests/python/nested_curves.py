"""nested_curves.py [SETS [FIRST]]: how often the nested models of analysis.compare_curves() are rejected, beside tests of its
own without priors on the same answers.

The criterion was written down before the first run: where two conditions share a parameter, its model is rejected in at most
6.5 % of 1000 pairs of sessions; where they do not, at least 90 % as often as by a likelihood-ratio test without priors whose
limit is its own 95 % quantile where nothing differs, so that both have the same size. "oracle" knows all parameters but the
tested one: no test can find much more.

56 trials at each of six lags from 0.1 to 1.6 s in each of two conditions, criteria that change from lag to lag."""
import sys

import numpy as np
from scipy.optimize import minimize
from scipy.special import log_ndtr, ndtr
from turnpoint import analysis

LAGS_S, LATENCY_S, PER_LAG = np.array([0.1, 0.2, 0.35, 0.6, 1.0, 1.6]), 0.25, 56
TIMES_S, CRITERIA = LAGS_S + LATENCY_S, np.linspace(-0.2, 0.3, 6)
BASE = np.array([2.5, np.log(4), 0.3])  # asymptote, log rate, intercept
OTHERS = {"nothing": BASE, "asymptote 1.5": np.array([1.5, np.log(4), 0.3]), "asymptote 1.2": np.array([1.2, np.log(4), 0.3]),
          "rate 10 per s": np.array([2.5, np.log(10), 0.3]), "intercept 0.5 s": np.array([2.5, np.log(4), 0.5])}
NAMES = ("asymptote", "rate", "intercept")


def height(parameters):
    return parameters[0] * -np.expm1(-np.exp(parameters[1]) * np.maximum(TIMES_S - parameters[2], 0))


def counts(rng, parameters):
    """Hits of 28 and false alarms of 28 at each lag."""
    d = height(parameters)
    return rng.binomial(PER_LAG // 2, ndtr(d / 2 - CRITERIA)), rng.binomial(PER_LAG // 2, ndtr(-d / 2 - CRITERIA))


def cost(parameters, counted, criteria=None):
    """Negative log likelihood; each lag's criterion takes its best value (Newton's method), unless it is known."""
    hits, alarms = counted
    n, d = PER_LAG // 2, height(parameters)
    c = CRITERIA.copy() if criteria is None else criteria

    def terms(c):
        return ((d / 2 - c, hits, -1), (c - d / 2, n - hits, 1), (-d / 2 - c, alarms, -1), (d / 2 + c, n - alarms, 1))

    if criteria is None:
        for _ in range(12):
            slope, bend = 1e-12 * c, np.full(6, 1e-9)
            for x, count, sign in terms(c):
                mills = np.exp(-0.5 * x * x - log_ndtr(x)) / np.sqrt(2 * np.pi)
                slope = slope + sign * count * mills
                bend = bend + count * mills * (x + mills)
            c = np.clip(c + np.clip(slope / bend, -1, 1), -6, 6)
    return -sum((count * log_ndtr(x)).sum() for x, count, _ in terms(c))


def split(free, which):
    """Two curves that share parameter `which`, from five numbers."""
    a = np.insert(free[:2], which, free[4])
    b = np.insert(free[2:4], which, free[4])
    return a, b


def inside(p):
    return 0 <= p[0] <= 8 and -1.2 <= p[1] <= 3.7 and 0 <= p[2] <= TIMES_S[-1]


def ratios(first, second):
    """Twice the log likelihood ratio of each nested model, without priors."""
    bounded = lambda p, counted: cost(p, counted) if inside(p) else 1e9  # noqa: E731
    alone = []
    for counted in (first, second):
        starts = [BASE, np.array([1.3, np.log(4), 0.3]), np.array([3.5, np.log(3), 0.25]), np.array([2.5, np.log(10), 0.35])]
        fits = [minimize(bounded, start, (counted,), method="Nelder-Mead", options={"xatol": 1e-4, "fatol": 1e-5, "maxfev": 3000})
                for start in starts]
        alone.append(min(fits, key=lambda fit: fit.fun))
    found = []
    for which in range(3):
        joint = lambda free: sum(bounded(p, counted) for p, counted in zip(split(free, which), (first, second)))  # noqa: B023,E731
        best = np.inf
        for shared in (alone[0].x[which], alone[1].x[which], 0.5 * (alone[0].x[which] + alone[1].x[which])):
            start = np.concatenate([np.delete(alone[0].x, which), np.delete(alone[1].x, which), [shared]])
            fit = minimize(joint, start, method="Nelder-Mead", options={"xatol": 1e-4, "fatol": 1e-5, "maxfev": 6000})
            best = min(best, fit.fun)
        found.append(max(0.0, 2 * (best - alone[0].fun - alone[1].fun)))
    return found


def oracle(first, second, other):
    """The same for a test that knows criteria and all parameters but the tested one."""
    found = []
    for which in range(3):
        grid = np.linspace((0, -1.2, 0)[which], (8, 3.7, 1.2)[which], 400)
        heights = []
        for counted, truth in ((first, BASE), (second, other)):
            heights.append([cost(np.concatenate([truth[:which], [x], truth[which + 1:]]), counted, CRITERIA) for x in grid])
        heights = np.array(heights)
        found.append(2 * (heights.sum(0).min() - heights.min(1).sum()))
    return found


def ours(first, second):
    times_s, lags_s, signal, yes, condition = [], [], [], [], []
    for where, (hits, alarms) in enumerate((first, second)):
        for lag in range(6):
            for has, count in ((1, hits[lag]), (0, alarms[lag])):
                n = PER_LAG // 2
                times_s += [TIMES_S[lag]] * n
                lags_s += [LAGS_S[lag]] * n
                signal += [has] * n
                yes += [1] * count + [0] * (n - count)
                condition += [where] * n
    (pair,) = analysis.compare_curves(analysis.response_signal(times_s, lags_s, signal, yes, condition=condition, task="sides"))
    return [pair.asymptote_p, pair.rate_p, pair.intercept_p]


def main(sets=100, first=0):
    limits = None
    for label, other in OTHERS.items():
        p, plain, known = [], [], []
        for i in range(first, first + sets):
            rng = np.random.default_rng([45, i])
            a, b = counts(rng, BASE), counts(rng, other)
            p.append(ours(a, b)), plain.append(ratios(a, b)), known.append(oracle(a, b, other))
        p, plain, known = np.array(p), np.array(plain), np.array(known)
        if limits is None:
            limits = np.quantile(plain, 0.95, axis=0), np.quantile(known, 0.95, axis=0)
        for k, name in enumerate(NAMES):
            print(f"{label} differs: one {name} rejected in {100 * (p[:, k] < 0.05).mean():.1f} %, by a test without priors "
                  f"{100 * (plain[:, k] > 3.841).mean():.1f} % (of equal size {100 * (plain[:, k] > limits[0][k]).mean():.1f} %), "
                  f"by one that knows all else {100 * (known[:, k] > limits[1][k]).mean():.1f} %; {sets} pairs", flush=True)


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))

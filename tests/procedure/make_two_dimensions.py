"""Runs of QUEST+ over two dimensions and with a free criterion, for test_two_dimensions.cpp.

    python3 -m pip install questplus scipy
    python3 make_two_dimensions.py > two_dimensions.csv

The first run comes from the package questplus. The others come from the class below, which computes every
probability and every entropy directly; it shares no code with the station. Of equal entropies (within 1e-10) it takes
the first in the order of level and second dimension.

Rows: run, trial, level, second, answer; then for the run's end: run, "end", parameter, mean, standard deviation.
"""
import itertools
import warnings

import numpy as np
import questplus
from scipy.stats import norm

warnings.simplefilter("ignore")
NAMES = ["threshold", "gradient", "floor", "slope", "criterion", "guess", "lapse"]


class BruteForce:
    def __init__(self, levels, seconds, grids, probability, priors=None, nuisance=()):
        self.stimuli = list(itertools.product(levels, seconds))
        self.points = np.array(list(itertools.product(*[grids[name] for name in NAMES])))
        columns = dict(zip(NAMES, self.points.T))
        self.p = np.array([probability(level, second, **columns) for level, second in self.stimuli])
        self.weights = np.ones(len(self.points))
        for name, (mean, sd) in (priors or {}).items():
            self.weights *= np.exp(-0.5 * ((columns[name] - mean) / sd) ** 2)
        self.weights /= self.weights.sum()
        kept = [i for i, name in enumerate(NAMES) if name not in nuisance]
        _, self.group = np.unique(self.points[:, kept], axis=0, return_inverse=True)
        self.group = self.group.ravel()

    def entropy(self, weights):
        sums = np.bincount(self.group, weights)
        sums = sums[sums > 0]
        return -(sums * np.log(sums)).sum()

    def best(self):
        expected = []
        for p in self.p:
            one, zero = self.weights * p, self.weights * (1 - p)
            expected.append(one.sum() * self.entropy(one / one.sum()) + zero.sum() * self.entropy(zero / zero.sum()))
        expected = np.array(expected)
        return int(np.flatnonzero(expected <= expected.min() + 1e-10)[0])

    def update(self, stimulus, one):
        self.weights = self.weights * (self.p[stimulus] if one else 1 - self.p[stimulus])
        self.weights /= self.weights.sum()

    def estimates(self):
        for i, name in enumerate(NAMES):
            if len(np.unique(self.points[:, i])) > 1:
                mean = (self.weights * self.points[:, i]).sum()
                yield name, mean, np.sqrt((self.weights * (self.points[:, i] - mean) ** 2).sum())


def run(name, method, trials, truth, probability, seed):
    draws = np.random.default_rng(seed)
    for trial in range(trials):
        best = method.best()
        level, second = method.stimuli[best]
        one = draws.random() < probability(level, second, **{key: np.array([value]) for key, value in truth.items()})[0]
        method.update(best, one)
        print(f"{name},{trial},{level!r},{second!r},{int(one)}")
    for parameter, mean, sd in method.estimates():
        print(f"{name},end,{parameter},{mean:.12g},{sd:.12g}")


def contrast_sensitivity():
    """Watson (2017), Example 4, but for 300 trials."""
    draws = np.random.default_rng(4)
    quest = questplus.QuestPlus(
        stim_domain=dict(contrast=np.arange(-50.0, 2, 2), spatial_freq=np.arange(0.0, 42, 2), temporal_freq=0),
        param_domain=dict(min_thresh=np.arange(-50.0, -28, 2), c0=np.arange(-60.0, -38, 2), cf=np.array([0.8, 1.0, 1.2, 1.4, 1.6]),
                          cw=0, slope=3, lower_asymptote=0.5, lapse_rate=0.01),
        outcome_domain=dict(response=["Correct", "Incorrect"]), func="csf", stim_scale="dB")
    for trial in range(300):
        stimulus = quest.next_stim
        level, second = float(stimulus["contrast"]), float(stimulus["spatial_freq"])
        threshold = max(-38.0, -52.0 + 1.2 * second)
        one = draws.random() < 0.99 - 0.49 * np.exp(-(10 ** (3 * (level - threshold) / 20)))
        quest.update(stim=stimulus, outcome=dict(response="Correct" if one else "Incorrect"))
        print(f"contrast-sensitivity,{trial},{level!r},{second!r},{int(one)}")
    for name, key in (("threshold", "c0"), ("gradient", "cf"), ("floor", "min_thresh")):
        weights = quest.marginal_posterior[key].ravel()
        values = np.asarray(quest.param_domain[key], float).ravel()
        mean = (weights * values).sum()
        print(f"contrast-sensitivity,end,{name},{mean:.12g},{np.sqrt((weights * (values - mean) ** 2).sum()):.12g}")


def yes(level, second, threshold, gradient, floor, slope, criterion, guess, lapse):
    d_prime = (level / threshold) ** slope
    return lapse + (1 - 2 * lapse) * norm.cdf(d_prime - criterion)


def yes_on_surface(level, second, threshold, gradient, floor, slope, criterion, guess, lapse):
    at = np.maximum(floor, threshold * 10 ** (gradient * (second - 150) / 20))
    return yes(level, second, at, gradient, floor, slope, criterion, guess, lapse)


def spread(level, second, threshold, gradient, floor, slope, criterion, guess, lapse):
    return guess + (1 - guess - lapse) * norm.cdf((level - threshold - gradient * second) / slope)


none = np.array([0.0])
print(f"# questplus {questplus.__version__}, numpy {np.__version__}")
contrast_sensitivity()
run("criterion",
    BruteForce([0, 0.01, 0.015, 0.02, 0.03, 0.045, 0.07, 0.1, 0.15, 0.2, 0.3], [0],
               dict(threshold=[0.02, 0.03, 0.045, 0.07, 0.1, 0.15, 0.2], gradient=none, floor=none, slope=[0.5, 1, 1.5, 2, 3],
                    criterion=[-0.5, 0, 0.5, 1, 1.5, 2], guess=none, lapse=[0.005, 0.02]), yes),
    300, dict(threshold=0.08, gradient=0, floor=0, slope=1.3, criterion=0.8, guess=0, lapse=0.01), yes, 1)
run("criterion-surface",
    BruteForce([0, 0.02, 0.045, 0.1, 0.2, 0.4], [120, 135, 150, 165, 180],
               dict(threshold=[0.03, 0.05, 0.08, 0.12, 0.2], gradient=[-0.2, -0.1, 0, 0.1, 0.2], floor=[0.04, 0.06], slope=[1, 2],
                    criterion=[0, 0.7, 1.4], guess=none, lapse=[0.005, 0.03]), yes_on_surface,
               priors=dict(threshold=(0.1, 0.05), criterion=(0.7, 1.0)), nuisance=("lapse", "slope")),
    300, dict(threshold=0.08, gradient=0.1, floor=0.05, slope=1.5, criterion=0.5, guess=0, lapse=0.01), yes_on_surface, 2)
run("shifting-mean",
    BruteForce([float(x) for x in range(-20, 21, 2)], [-20, -10, 0, 10, 20],
               dict(threshold=[-8.0, -4.0, 0.0, 4.0, 8.0], gradient=[-0.4, -0.2, 0, 0.2, 0.4], floor=none, slope=[2, 4, 8],
                    criterion=none, guess=[0.02], lapse=[0.02, 0.05]), spread),
    300, dict(threshold=2.0, gradient=0.15, floor=0, slope=4, criterion=0, guess=0.02, lapse=0.02), spread, 3)

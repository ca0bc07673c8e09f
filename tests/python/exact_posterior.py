"""exact_posterior.py [SETS [FIRST]]: widths of the intervals of analysis.diffusion() beside those of the exact posterior.

The exact one is sampled by a program of its own: the likelihood of test_analysis.py (series in plain numpy, late answers as
such, the mixture), the priors of station/analysis/diffusion.hpp, and 40 walkers with stretch moves (Goodman & Weare 2010).
Each data set: 40 trials of each of two drifts (1 and 3 per s, s = 1), boundary 1.2, time outside 0.35 s, deadline 0.9 s, 3 %
of the answers at random. Prints the ratio of widths, its median over the sets, and the largest distance of an end in posterior
standard deviations."""
import sys

import numpy as np

sets = [int(word) for word in sys.argv[1:]]
sys.argv = ["test_analysis.py", "turnpoint", "fit_rtdists.R"]
from test_analysis import own_log_likelihood, sampled  # noqa: E402
from turnpoint import analysis  # noqa: E402

S, DEADLINE_S, WALKERS, STEPS, BURNT = 0.1, 0.9, 40, 700, 200


def data_set(rng):
    times_s, correct, difficulty = [], [], []
    for i, v in enumerate((1.0, 3.0)):
        t, upper = sampled(rng, 40, v, 1.2, 0.35, step_s=1e-3)
        random = rng.random(40) < 0.03
        times_s.append(np.where(random, rng.uniform(0.1, 0.9, 40), t))
        correct.append(np.where(random, rng.random(40) < 0.5, upper)), difficulty.append(np.full(40, i))
    times_s, correct, difficulty = (np.concatenate(each) for each in (times_s, correct, difficulty))
    times_s[times_s > DEADLINE_S] = np.nan
    return times_s, correct, difficulty


def log_posterior(p, times_s, correct, difficulty):
    """p as in own_log_likelihood(): logarithms of boundary and time outside, logit of the contaminants, drifts."""
    share = 1 / (1 + np.exp(-p[2]))
    if not (-3 < p[0] < 3 and -6 < p[1] < 0 and 1e-9 < share < 0.9 and np.abs(p[3:]).max() < 30):
        return -np.inf
    prior = p[1] + np.log(share) + 19 * np.log1p(-share) - (p[3:] ** 2).sum() / 200
    with np.errstate(all="ignore"):
        value = own_log_likelihood(p, times_s, correct, difficulty, DEADLINE_S) + prior
    return value if np.isfinite(value) else -np.inf


def walked(rng, start, spread, of):
    at = start + 0.5 * spread * rng.standard_normal((WALKERS, len(start)))
    value, kept = np.array([of(p) for p in at]), []
    for step in range(STEPS):
        for k in range(WALKERS):
            other = at[(k + rng.integers(1, WALKERS)) % WALKERS]
            z = (1 + rng.random()) ** 2 / 2  # density of 1/sqrt(z) on [1/2, 2]
            to = other + z * (at[k] - other)
            there = of(to)
            if np.log(rng.random()) < (len(start) - 1) * np.log(z) + there - value[k]:
                at[k], value[k] = to, there
        if step >= BURNT:
            kept.append(at.copy())
    return np.concatenate(kept)


def main(count=10, first=0):
    ratios, ends = [], []
    for i in range(first, first + count):
        rng = np.random.default_rng([46, i])
        times_s, correct, difficulty = data_set(rng)
        fit = analysis.diffusion(times_s, correct, difficulty=difficulty, deadline_s=DEADLINE_S)
        start = np.array([np.log(fit.boundary.value / S), np.log(fit.nondecision_s.value), np.log(fit.contaminants.value)]
                         + [drift.value / S for drift in fit.drift])
        spread = np.array([0.1, 0.05, 0.5, 0.5, 0.5])
        exact = walked(rng, start, spread, lambda p: log_posterior(p, times_s, correct, difficulty))  # noqa: B023
        numbers = [S * np.exp(exact[:, 0]), np.exp(exact[:, 1]), S * exact[:, 3], S * exact[:, 4]]
        for ours, theirs in zip((fit.boundary, fit.nondecision_s, *fit.drift), numbers):
            low, high = np.quantile(theirs, (0.025, 0.975))
            ratios.append((ours.high - ours.low) / (high - low))
            ends.append(max(abs(ours.low - low), abs(ours.high - high)) / theirs.std())
        print(f"set {i}: ratios of widths (boundary, time outside, drifts) " + " ".join(f"{one:.3f}" for one in ratios[-4:]),
              flush=True)
    print(f"{count} sets: median ratio {np.median(ratios):.3f}, from {min(ratios):.3f} to {max(ratios):.3f}; an end differs by "
          f"{max(ends):.2f} standard deviations at most")


if __name__ == "__main__":
    main(*sets)

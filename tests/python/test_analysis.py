"""test_analysis.py TURNPOINT FIT_RTDISTS: turnpoint.analysis against the report, a likelihood of its own, and R's rtdists.

TURNPOINT_RTDISTS_PEOPLE=17 TURNPOINT_RTDISTS_STARTS=5 compares the fits of all people of speed_acc."""
import csv
import inspect
import itertools
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import turnpoint
from turnpoint import analysis

TURNPOINT, FIT_RTDISTS = sys.argv.pop(1), sys.argv.pop(1)
S = 0.1  # scale of drifts and boundaries


def sampled(rng, count, drift, boundary, ter_s, start=0.5, step_s=2e-4):
    """Decisions of a diffusion (s = 1) by steps of 0.2 ms, with the probability of a crossing between two steps."""
    x, time_s = np.full(count, start * boundary), np.zeros(count)
    done, upper = np.zeros(count, bool), np.zeros(count, bool)
    while not done.all():
        at = np.flatnonzero(~done)
        before = x[at]
        after = before + drift * step_s + math.sqrt(step_s) * rng.standard_normal(len(at))
        chance = rng.random((2, len(at)))
        high = (after >= boundary) | (chance[0] < np.exp(-2 * (boundary - before) * np.maximum(boundary - after, 0) / step_s))
        low = (after <= 0) | (chance[1] < np.exp(-2 * before * np.maximum(after, 0) / step_s))
        x[at], time_s[at] = after, time_s[at] + step_s
        done[at], upper[at] = high | low, high
    return time_s + ter_s, upper


def density(t, upper, v, a, w):
    """Density of the first passage (s = 1) by both series with 60 terms; a program of its own, without logarithms."""
    v, w = np.where(upper, -v, v), np.where(upper, 1 - w, w)
    u, k = np.maximum(t, 1e-9)[:, None] / a**2, np.arange(-60, 61)
    short = ((w[:, None] + 2 * k) * np.exp(-((w[:, None] + 2 * k) ** 2) / (2 * u))).sum(1) / np.sqrt(2 * np.pi * u[:, 0] ** 3)
    k = np.arange(1, 61)
    long = np.pi * (k * np.sin(k * np.pi * w[:, None]) * np.exp(-(k * np.pi) ** 2 * u / 2)).sum(1)
    f = np.where(u[:, 0] < 0.2, short, long) * np.exp(-v * a * w - v * v * t / 2) / a**2
    return np.where(t > 0, f, 0)


def survival(t, v, a, w):
    """Probability of no passage by t > 0, by the series of sines with 4000 terms."""
    k = np.arange(1, 4001)
    rate = v * v / 2 + (k * np.pi / a) ** 2 / 2
    tail = lambda v, w: np.pi / a**2 * np.exp(-v * a * w) * np.sum(k * np.sin(k * np.pi * w) / rate * np.exp(-rate * t))  # noqa
    return tail(v, w) + tail(-v, 1 - w)


def own_log_likelihood(p, times_s, correct, difficulty, deadline_s):
    """p: logarithms of boundary and time outside, logit of contaminants, drifts; s = 1. NaN in times_s: too late."""
    a, ter, share, drifts = math.exp(p[0]), math.exp(p[1]), 1 / (1 + math.exp(-p[2])), p[3:]
    window, total = 2 * deadline_s, 0.0
    for i, v in enumerate(drifts):
        right = 1 / (1 + math.exp(-v * a))
        here = difficulty == i
        t, c = times_s[here], correct[here]
        late = np.isnan(t)
        f = density(t[~late] - ter, c[~late], v, a, np.full((~late).sum(), 0.5))
        guess = (0.25 + 0.5 * np.where(c[~late], right, 1 - right)) / window
        total += np.log((1 - share) * f + share * guess).sum()
        total += late.sum() * math.log((1 - share) * survival(deadline_s - ter, v, a, 0.5) + share * (1 - deadline_s / window))
    return total


class Diffusion(unittest.TestCase):
    def test_mixture_and_censoring_agree_with_another_likelihood(self):
        rng = np.random.default_rng(5)
        times_s, correct, difficulty = [], [], []
        for i, v in enumerate((1.0, 3.0)):
            t, upper = sampled(rng, 250, v, 1.2, 0.35)
            slow = rng.random(250) < 0.05
            t = np.where(slow, rng.uniform(0.1, 1.4, 250), t)
            times_s.append(t), correct.append(np.where(slow, rng.random(250) < 0.5, upper)), difficulty.append(np.full(250, i))
        times_s, correct, difficulty = (np.concatenate(each) for each in (times_s, correct, difficulty))
        times_s[times_s > 0.7] = np.nan
        fit = analysis.diffusion(times_s, correct, difficulty=difficulty, deadline_s=0.7, method="likelihood")
        self.assertGreater(np.isnan(times_s).sum(), 50)
        logit = lambda p: math.log(p / (1 - p))  # noqa: E731
        place = lambda which: np.array(  # noqa: E731
            [math.log(getattr(fit.boundary, which) / S), math.log(getattr(fit.nondecision_s, which)),
             logit(getattr(fit.contaminants, which))] + [getattr(drift, which) / S for drift in fit.drift])
        best, error = place("value"), (place("high") - place("low")) / (2 * 1.959964)
        own = lambda p: own_log_likelihood(p, times_s, correct, difficulty, 0.7)  # noqa: E731
        self.assertAlmostEqual(own(best), fit.log_likelihood, delta=1e-7 * abs(fit.log_likelihood))
        size, step = len(best), 0.05 * error
        unit = np.eye(size) * step
        slope = np.array([(own(best + unit[k]) - own(best - unit[k])) / (2 * step[k]) for k in range(size)])
        bend = np.array([[(own(best + unit[i] + unit[k]) - own(best + unit[i] - unit[k]) - own(best - unit[i] + unit[k])
                           + own(best - unit[i] - unit[k])) / (4 * step[i] * step[k]) for k in range(size)] for i in range(size)])
        covariance = np.linalg.inv(-bend)
        # from here Newton's step to the maximum of the other likelihood, and its standard errors
        self.assertLess(np.abs(covariance @ slope / error).max(), 0.01)
        self.assertLess(np.abs(np.sqrt(np.diag(covariance)) / error - 1).max(), 0.02)
        # negative control: the late answers left out move the boundary by more than its error
        kept = ~np.isnan(times_s)
        without = analysis.diffusion(times_s[kept], correct[kept], difficulty=difficulty[kept], method="likelihood")
        self.assertLess(without.boundary.high, fit.boundary.value)

    def test_variability_is_the_mean_over_drifts_and_delays(self):
        # The functions without variability are compared with mpmath in test_analysis; here numpy averages them.
        # TURNPOINT_VARIED_SETS=300 for more.
        draws, sets = np.random.default_rng(5), int(os.environ.get("TURNPOINT_VARIED_SETS", "25"))
        nodes, weights = np.polynomial.legendre.leggauss(40)
        compared = 0
        for i in range(2 * sets):
            by_delay, upper = i % 2 == 1, bool(draws.integers(2))
            what = str(draws.choice(["density", "distribution", "tail"]))
            boundary = np.exp(draws.uniform(np.log(0.3 if by_delay else 0.1), np.log(4)))  # for s = 1
            edge = 10 ** draws.uniform(-6, -1)
            start = draws.uniform(0.03, 0.97) if by_delay else draws.choice([draws.uniform(0.03, 0.97), edge, 1 - edge])
            drift, sd = draws.uniform(-8, 8), draws.uniform(0.02, 2)
            time_s = boundary ** 2 * np.exp(draws.uniform(np.log(0.02), np.log(8)))
            common = {"boundary": 0.1 * boundary, "start": start, "what": what}
            if by_delay:
                range_s = np.exp(draws.uniform(np.log(0.005), 0))
                edges = np.geomspace(max(time_s - range_s, 1e-6 * time_s), time_s, 120)
                half, middle = (edges[1:] - edges[:-1]) / 2, (edges[1:] + edges[:-1]) / 2
                at = (middle[:, None] + half[:, None] * nodes).ravel()
                given = dict(drift=0.1 * drift, drift_sd=0.1 * sd, **common)
                values = np.exp(analysis.first_passage(at, upper, **given))
                mean = (values * (half[:, None] * weights).ravel()).sum()
                if what == "tail" and time_s < range_s:  # the process has not begun
                    mean += (range_s - time_s + edges[0]) * np.exp(analysis.first_passage([1e-300], upper, **given))[0]
                mean /= range_s
                found = analysis.first_passage([time_s], upper, delay_range_s=range_s, **given)[0]
            else:
                away = 10 * sd + 1.2 * sd * sd * boundary + 1
                drifts = np.linspace(drift - away, drift + away, 801)
                values = [analysis.first_passage([time_s], upper, drift=0.1 * v, **common)[0] for v in drifts]
                normal = np.exp(-0.5 * ((drifts - drift) / sd) ** 2) / (sd * np.sqrt(2 * np.pi))
                mean = (np.exp(values) * normal).sum() * (drifts[1] - drifts[0])
                found = analysis.first_passage([time_s], upper, drift=0.1 * drift, drift_sd=0.1 * sd, **common)[0]
            self.assertFalse(np.isnan(found))
            if mean > 1e-30:
                compared += 1
                self.assertAlmostEqual(np.exp(found) / mean, 1, delta=1e-8, msg=f"{what}, {upper}, {drift}, {sd}, {time_s}, {common}")
        self.assertGreater(compared, sets)

    def test_start_and_variabilities_are_found_again(self):
        rng = np.random.default_rng(7)
        t, upper = sampled(rng, 4000, 1.5, 1.3, 0.3, start=0.35, step_s=1e-3)
        t += rng.uniform(0, 0.15, len(t))
        fit = analysis.diffusion(t, upper, start="fitted", contaminants=False, nondecision_varies=True, method="likelihood")
        for found, truth in ((fit.start, 0.35), (fit.boundary, 0.13), (fit.nondecision_range_s, 0.15), (fit.drift[0], 0.15)):
            self.assertLess(abs(found.value - truth), 3.5 * (found.high - found.low) / 3.92)
        self.assertEqual((fit.drift_sd.value, fit.contaminants.value), (0, 0))
        fixed = analysis.diffusion(t, upper, contaminants=False, method="likelihood")
        self.assertGreater(fit.log_likelihood, fixed.log_likelihood + 50)

    def test_fits_of_published_data_are_not_worse_than_those_of_rtdists(self):
        people = os.environ.get("TURNPOINT_RTDISTS_PEOPLE", "2")  # the second one has an answer of 0.24 s, far before all others
        starts = os.environ.get("TURNPOINT_RTDISTS_STARTS", "1")
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(["Rscript", FIT_RTDISTS, folder, people, starts], check=True)
            with open(Path(folder, "trials.csv"), encoding="utf-8") as file:
                trials = [row for row in csv.DictReader(file) if row["set"] == "speed_acc"]
            with open(Path(folder, "fits.csv"), encoding="utf-8") as file:
                fits = list(csv.DictReader(file))
        self.assertEqual(len(fits), 2 * int(people))
        worst, farthest = -math.inf, 0.0
        for theirs in fits:
            cell = [row for row in trials if (row["id"], row["condition"]) == (theirs["id"], theirs["condition"])]
            t, upper, level = (np.array([float(row[name]) for row in cell]) for name in ("time_s", "upper", "difficulty"))
            ours = analysis.diffusion(t, upper, difficulty=level, start="fitted", contaminants=False, method="likelihood")
            number = {name: float(theirs[name]) for name in theirs if name not in ("id", "condition")}

            def likelihood(boundary, ter_s, start, drifts):
                return sum(analysis.first_passage(t[level == i] - ter_s, upper[level == i], drift=v, boundary=boundary,
                                                  start=start).sum() for i, v in enumerate(drifts))

            mine = likelihood(ours.boundary.value, ours.nondecision_s.value, ours.start.value, [d.value for d in ours.drift])
            other = likelihood(S * number["boundary"], number["nondecision_s"], number["start"],
                               [S * number["drift_0"], S * number["drift_1"]])
            self.assertAlmostEqual(mine, ours.log_likelihood, delta=1e-6)
            worst = max(worst, other - mine)
            for found, value in ((ours.boundary, S * number["boundary"]), (ours.nondecision_s, number["nondecision_s"]),
                                 (ours.start, number["start"]), (ours.drift[0], S * number["drift_0"]),
                                 (ours.drift[1], S * number["drift_1"])):
                farthest = max(farthest, abs(found.value - value) / ((found.high - found.low) / 3.92))
        print(f"rtdists: {len(fits)} fits; ours is lower in log likelihood by {worst:.1e} at most; "
              f"estimates differ by {farthest:.4f} standard errors at most")
        self.assertLess(worst, 1e-4)
        self.assertLess(farthest, 0.01)


class Report(unittest.TestCase):
    def test_the_numbers_are_those_of_the_report(self):
        with tempfile.TemporaryDirectory() as folder:
            database = str(Path(folder, "lab.sqlite"))
            subprocess.run([TURNPOINT, "run", "protocols/speed-accuracy.toml", "--rig", "deploy/rigs/simulated.toml",
                            "--participant", "P01", "--seed", "3", "--db", database, "--headless", "--observer", "sim"],
                           check=True, stdout=subprocess.DEVNULL)
            report = json.loads(subprocess.run([TURNPOINT, "report", "--db", database, "--participant", "P01", "--json"],
                                               check=True, capture_output=True, text=True).stdout)
            trials = turnpoint.read(database).trials
        trials = trials[(trials.trial_type == "experimental") & trials.outcome.isin(["answered", "timeout", "anticipation"])]
        printed = {one["instruction"]: one for one in report["instructions"]}
        fit = analysis.speed_accuracy(trials.response_time, trials.correct, trials.instruction,
                                      difficulty=trials.level.abs(), deadline_s=trials.deadline, earliest_s=0.15,
                                      order=list(printed), mad=3.5, seed=3)
        self.assertEqual([one.condition for one in fit.conditions], list(printed))

        def same(found, there, name):
            for value, other in ((found.value, there["value"]), (found.low, there["interval"]["low"]),
                                 (found.high, there["interval"]["high"])):
                self.assertAlmostEqual(value, other, places=12, msg=name)

        for one in fit.conditions:
            there = printed[one.condition]
            self.assertEqual([one.presented, one.answered, one.late, one.early, one.excluded],
                             [there[name] for name in ("presented", "answered", "timeouts", "anticipations", "excluded")])
            for name in ("boundary", "nondecision_s", "contaminants", "drift", "lisas_s"):
                same(getattr(one, name), there[name], name)
            for cell, shown in zip(one.cells, there["difficulties"], strict=True):
                same(cell.drift, shown["drift"], "drift")
        self.assertEqual(fit.model_p, report["model_p"])
        shown = [one for one in fit.differences if one.measure != "inverse efficiency"]  # as the protocol decides
        told = [one for one in report["differences"] if one["measure"] != "d'"]  # needs to know the task
        for one, there in zip(shown, told, strict=True):
            self.assertEqual((one.first, one.second, one.measure), (there["first"], there["second"], there["measure"]))
            same(one.estimate, there["estimate"], one.measure)
            self.assertAlmostEqual(one.p, there["p"], places=12, msg=one.measure)


    def test_scales_are_those_of_the_report(self):
        with tempfile.TemporaryDirectory() as folder:
            for protocol, factors in (("friction-pairs", ["first_dB", "second_dB"]),
                                      ("friction-triads", ["first_dB", "second_dB", "third_dB"])):
                database = str(Path(folder, protocol + ".sqlite"))
                subprocess.run([TURNPOINT, "run", f"protocols/{protocol}.toml", "--rig", "deploy/rigs/simulated.toml",
                                "--participant", "P01", "--seed", "4", "--db", database, "--headless", "--observer", "sim:threshold=3"],
                               check=True, stdout=subprocess.DEVNULL)
                report = json.loads(subprocess.run([TURNPOINT, "report", "--db", database, "--participant", "P01", "--json"],
                                                   check=True, capture_output=True, text=True).stdout)
                trials = turnpoint.read(database).trials
                trials = trials[trials.outcome == "answered"]
                found = analysis.scale(trials[factors].astype(float), trials.response == "second")[0]
                there = report["scales"][0]
                self.assertEqual(found.stimuli, [one["stimulus"] for one in there["stimuli"]])
                for value, one in zip(found.values, there["stimuli"], strict=True):
                    self.assertEqual((value.value, value.low, value.high), (one["value"]["value"], *one["value"]["interval"].values()))
                for name in ("deviance", "deviance_p", "runs", "runs_p", "six_points_p", "triples", "consistence"):
                    self.assertEqual(getattr(found, name), there[name], name)


class Others(unittest.TestCase):
    def test_detection_and_ratings(self):
        signal = [1] * 50 + [0] * 50
        yes = [1] * 40 + [0] * 10 + [1] * 5 + [0] * 45
        found = analysis.detection(signal, yes)[-1]
        z = lambda p: math.sqrt(2) * _inverse_erf(2 * p - 1)  # noqa: E731
        self.assertAlmostEqual(found.d_prime.value, z(40.5 / 51) - z(5.5 / 51), delta=1e-9)
        self.assertEqual((found.hits, found.misses, found.false_alarms, found.correct_rejections), (40, 10, 5, 45))
        by_level = analysis.detection(signal, yes, level=[1] * 25 + [2] * 25 + [0] * 50, condition=["a"] * 100)
        self.assertEqual([one.level for one in by_level][-1], None)
        rated = analysis.ratings([40, 25, 20, 15], [10, 20, 30, 40])
        self.assertLess(rated.sensitivity.low, rated.sensitivity.value)
        self.assertEqual(len(rated.criteria), 3)
        self.assertLess(abs(analysis.area([40, 25, 20, 15], [10, 20, 30, 40]).value - rated.area.value), 0.03)
        with self.assertRaises(analysis.NotDetermined):
            analysis.ratings([10, 0], [0, 10])

    def test_scale(self):
        # Bradley and Terry by their own equations: wins = sum of n / (1 + exp(other - own)), without a penalty, which 300
        # trials of each pair hardly change
        rng = np.random.default_rng(4)
        truth = np.array([-1.2, -0.3, 0.4, 1.1])
        pairs = np.array([(a, b) for a in range(4) for b in range(4) if a != b for _ in range(150)])
        second = rng.random(len(pairs)) < 1 / (1 + np.exp(truth[pairs[:, 0]] - truth[pairs[:, 1]]))
        wins = np.bincount(np.where(second, pairs[:, 1], pairs[:, 0]), minlength=4)
        values = np.zeros(4)
        for _ in range(2000):
            values += (wins - [sum(300 / (1 + math.exp(values[b] - values[a])) for b in range(4) if b != a)
                               for a in range(4)]) / 900
        found = analysis.scale(10.0 * pairs, second)[0]
        self.assertEqual(found.stimuli, [0, 10, 20, 30])
        for value, own in zip(found.values, values - values.mean()):
            self.assertLess(abs(value.value - own), 0.01)
        self.assertEqual((found.triples, found.circular, found.consistence), (4, 0, 1))
        self.assertTrue(found.favours_second.low < 0 < found.favours_second.high)
        thurstone = analysis.scale(pairs, second, model="thurstone")[0]
        self.assertLess(abs(np.corrcoef([v.value for v in thurstone.values], values)[0, 1] - 1), 1e-3)
        scale = np.array([0, 0.1, 0.25, 0.6, 1.0])
        triads = np.array([t for a in range(5) for b in range(a) for c in range(b) for t in ((c, b, a), (a, b, c))] * 20)
        felt = np.abs(np.diff(scale[triads])) @ [-1, 1] + 0.2 * rng.standard_normal(len(triads))
        found = analysis.scale(triads, felt > 0, condition=["x"] * len(triads))[0]
        self.assertTrue(found.noise.low < 0.2 < found.noise.high)
        self.assertLess(max(abs(v.value - s) for v, s in zip(found.values, scale)), 0.1)
        # the middle stimulus of a triad need not lie between the others
        any_order = np.array([t for t in itertools.permutations(range(5), 3)] * 20)
        felt_so = np.abs(np.diff(scale[any_order])) @ [-1, 1] + 0.2 * rng.standard_normal(len(any_order))
        mixed = analysis.scale(any_order, felt_so > 0)[0]
        self.assertTrue(mixed.noise.low < 0.2 < mixed.noise.high)
        self.assertLess(max(abs(v.value - s) for v, s in zip(mixed.values, scale)), 0.1)
        self.assertIsNone(analysis.scale([[1, 2], [3, 4]], [1, 0])[0].values)
        self.assertIsNone(analysis.scale(triads, felt > 0, sessions=0)[0].deviance_p)
        with self.assertRaisesRegex(ValueError, "sessions"):
            analysis.scale(triads, felt > 0, sessions=-1)
        with self.assertRaisesRegex(ValueError, "model"):
            analysis.scale(pairs, second, model="differences")
        with self.assertRaisesRegex(ValueError, "two, three or four"):
            analysis.scale([1, 2], [1, 0])

    def test_psychometric(self):
        rng = np.random.default_rng(2)
        level = np.repeat(np.arange(-3.0, 3.5), 60)
        p = 1 / (1 + np.exp(-(level - 0.4) * 1.5))
        positive = rng.random(len(level)) < p
        fit = analysis.psychometric(level, positive, function="logistic", guess="lapse")
        self.assertTrue(fit.threshold.low < 0.4 < fit.threshold.high)
        counted = [positive[level == x].sum() for x in np.unique(level)]
        same = analysis.psychometric(np.unique(level), counted, [60] * 7, function="logistic", guess="lapse")
        self.assertEqual((fit.threshold.value, fit.slope.low), (same.threshold.value, same.slope.low))
        medians = analysis.psychometric(level, positive, function="logistic", guess="lapse", adaptive_range=(-3, 3))
        self.assertLess(abs(medians.threshold.value - fit.threshold.value), 0.1)
        with self.assertRaises(analysis.NotDetermined):
            analysis.psychometric(level, [True] * len(level))

    def test_response_signal(self):
        rng = np.random.default_rng(4)
        lag_s, signal = np.repeat([0.1, 0.2, 0.35, 0.6, 1.0, 1.6], 400), np.tile([0, 1], 1200)
        d = 2.5 * (1 - np.exp(-4 * np.maximum(lag_s + 0.25 - 0.3, 0)))
        yes = rng.standard_normal(2400) + d * (signal - 0.5) > 0
        (curve,) = analysis.response_signal(lag_s + 0.25, lag_s, signal, yes)
        for found, truth in ((curve.asymptote, 2.5), (curve.rate_per_s, 4), (curve.intercept_s, 0.3)):
            self.assertTrue(found.low < truth < found.high, found)

    def test_nested_curves_and_holm(self):
        rng = np.random.default_rng(6)
        lag_s, signal = np.repeat([0.1, 0.2, 0.35, 0.6, 1.0, 1.6], 800), np.tile([0, 1], 2400)
        where = np.tile([0, 0, 1, 1], 1200)
        d = np.where(where, 1.2, 2.5) * (1 - np.exp(-4 * np.maximum(lag_s + 0.25 - 0.3, 0)))
        yes = rng.standard_normal(4800) + d * (signal - 0.5) > 0
        (pair,) = analysis.compare_curves(analysis.response_signal(lag_s + 0.25, lag_s, signal, yes, condition=where))
        self.assertEqual((pair.first, pair.second), ("0", "1"))
        self.assertLess(pair.asymptote.high, -0.8)
        self.assertLess(pair.asymptote_p, 0.02)
        self.assertGreater(min(pair.rate_p, pair.intercept_p), 0.02)
        np.testing.assert_allclose(analysis.holm([0.01, 0.04, np.nan, 0.03]), [0.03, 0.06, np.nan, 0.06])
        np.testing.assert_allclose(analysis.holm([0.01, 0.04, 0.03], family=["a", "b", "a"]), [0.02, 0.04, 0.03])
        with self.assertRaisesRegex(ValueError, "from 0 to 1"):
            analysis.holm([0.5, 1.5])

    def test_wrong_arrays_are_refused(self):
        t, c = [0.5] * 20, [1] * 20
        for said, call in (
                ("20 trials", lambda: analysis.diffusion(t, c[1:])),
                ("above 0", lambda: analysis.diffusion([0.5, -1] * 10, c)),
                ("NaN if", lambda: analysis.diffusion([0.5, math.nan] * 10, c)),
                ("neither true", lambda: analysis.diffusion(t, [2] * 20)),
                ("half-way", lambda: analysis.diffusion(t, c, start="left")),
                ("deadline", lambda: analysis.diffusion(t, c, deadline_s=0.2, earliest_s=0.3)),
                ("confidence", lambda: analysis.diffusion(t, c, confidence=95)),
                ("boundary", lambda: analysis.first_passage(t, c, drift=0, boundary=0)),
                ("condition", lambda: analysis.speed_accuracy(t, c, ["a"])),
                ("whole numbers", lambda: analysis.ratings([1, 2], [3])),
                ("infinite", lambda: analysis.psychometric([math.inf] * 20, c))):
            with self.assertRaisesRegex(ValueError, said):
                call()
        with self.assertRaisesRegex(analysis.NotDetermined, "10"):
            analysis.diffusion(t[:5], c[:5])

    def test_every_function_explains_its_parameters(self):
        for name in analysis.__all__:
            thing = getattr(analysis, name)
            self.assertTrue(thing.__doc__, name)
            if inspect.isfunction(thing):
                for parameter in inspect.signature(thing).parameters:
                    if parameter not in ("seed", "confidence"):
                        self.assertRegex(thing.__doc__, rf"\b{parameter}\b", f"{name}: {parameter}")


def _inverse_erf(x):
    low, high = -6.0, 6.0
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if math.erf(middle) < x else (low, middle)
    return low


if __name__ == "__main__":
    unittest.main()

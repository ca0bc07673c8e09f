#!/usr/bin/env python3
"""Every figure of the reports, computed again from the exported CSV alone: protocols of each kind of task with random
parameters and simulated people whose parameters are known; SciPy computes the figures of the report of a session and of
the study from trials.csv, and this program compares them.

    tests/report/corpus.py TURNPOINT [--each NUMBER] [--first SEED] [KIND...]

NUMBER protocols of each kind (default 1). With more than two, the posterior of the diffusion model is sampled and study.R
is run as well, which takes longer. Figures that are not computed again are counted and named at the end. As a
negative control, the CSV of one session is changed in one answer, which must be noticed.
"""
import collections
import csv
import json
import math
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

import numpy
from scipy import optimize, special, stats

ROOT = pathlib.Path(__file__).resolve().parents[2]
RIG = ROOT / "deploy/rigs/simulated.toml"
SCRIPT = ROOT / "station/report/scripts/study.py"
Z95 = 1.959963984540054

# ---------------------------------------------------------------------------------------------------- protocols

HEAD = """format = "friction-protocol/1"
[protocol]
id = "corpus"
version = "1.0.0"
title = "Corpus"
languages = ["en"]
[random]
seed = SEED
"""
TWO_SCENES = """[[factor]]
name = "amount"
range = [-0.8, 0.8]
[scene.reference]
boundary_mm = 185.0
edge = "p50"
displacement_um = 1.0
[scene.comparison]
base = "reference"
displacement_um = "1 - amount"
"""
TIMES = '[timing]\nresponse_zero = "ZERO"\ndeadline_s = 6.0\niti_s = { uniform = [0.8, 1.2] }\n'
CHOICES = 'choices = [ { id = "first", label = { en = "1" } }, { id = "second", label = { en = "2" } } ]\n'
QUESTION = 'device = "either"\nquestion = { en = "?" }\n'


def choices(names):
    return "choices = [ " + ", ".join(f'{{ id = "{n}", label = {{ en = "{n}" }} }}' for n in names) + " ]\n"


def constant(values, repeats, more="", level="amount"):
    return (f'[[procedure]]\nname = "levels"\nkind = "constant-stimuli"\nlevel = "{level}"\nvalues = {values}\n'
            f'repeats = {repeats}\n{more}[[block]]\nname = "main"\nprocedures = ["levels"]\n')


def single(correct, zero="go_cue"):
    return ('[task]\nkind = "single-interval"\nintervals = ["comparison"]\n' + QUESTION + CHOICES +
            f"correct = {correct}\n" + TIMES.replace("ZERO", zero) + "explore_s = 4.0\n")


def geometric(draw, low, high, count):
    values = [low * (high / low) ** (i / (count - 1)) for i in range(count)]
    return sorted({round(v * draw.uniform(0.95, 1.05), 3) for v in values})


class Kind:
    """A protocol with random parameters. `observers` are those of three people; `fit` says which function the report fits."""

    def __init__(self, name, seed):
        self.draw = random.Random(f"{name} {seed}")
        self.name, self.seed, self.fit, self.positive, self.level = name, seed, None, "right", "amount"
        self.design, self.models = "binary", []
        body = getattr(self, name.replace("-", "_"))()
        self.text = HEAD.replace("SEED", str(5000 + seed)) + body

    def people(self, **ranges):
        self.observers = ["sim:" + ",".join(f"{key}={self.draw.uniform(*ends):.4g}" for key, ends in ranges.items())
                          for _ in range(3)]

    def signed(self, most=0.6):
        half = geometric(self.draw, 0.08, most, self.draw.randint(3, 4))
        return [-v for v in reversed(half)] + half

    def pse(self):
        self.people(threshold=(0.1, 0.3), bias=(-0.1, 0.1), lapse=(0, 0.04))
        self.fit = {"function": "normal", "guess": "tied"}
        self.positive = "second"
        return TWO_SCENES + single('{ first = "amount < 0", second = "amount > 0" }') + \
            constant(self.signed(), self.draw.randint(8, 14))

    def bisection(self):
        cut = self.draw.choice([0.2, 0.3])
        self.people(threshold=(0.05, 0.2), lapse=(0, 0.04))
        self.fit, self.positive = {"function": "normal", "guess": "tied"}, "second"
        values = sorted({round(cut + v, 3) for v in (-0.2, -0.12, -0.05, 0.05, 0.12, 0.2)})
        return TWO_SCENES + single(f'{{ first = "amount < {cut}", second = "amount > {cut}" }}') + \
            constant(values, self.draw.randint(8, 14))

    def choice(self):
        """Two answers, none of them right."""
        self.people(threshold=(0.1, 0.3), bias=(-0.1, 0.1))
        self.fit, self.positive = {"function": "normal", "guess": "tied"}, "second"
        return TWO_SCENES + single("").replace("correct = \n", "") + constant(self.signed(), self.draw.randint(8, 14))

    def pse_2ifc(self):
        self.people(threshold=(0.1, 0.3), bias=(-0.1, 0.1))
        self.fit, self.positive = {"function": "normal", "guess": "tied"}, "comparison"
        return TWO_SCENES + '[task]\nkind = "2ifc"\nintervals = ["reference", "comparison"]\nduration_s = 0.6\ngap_s = 0.4\n' + \
            QUESTION + CHOICES + 'correct = { comparison = "amount > 0", reference = "amount < 0" }\n' + \
            TIMES.replace("ZERO", "interval_off") + constant(self.signed(), self.draw.randint(8, 14))

    def threshold_2ifc(self):
        self.people(threshold=(0.1, 0.3), slope=(0.8, 2.5), lapse=(0, 0.04))
        self.fit = {"function": "weibull", "guess": 0.5}
        zero = self.draw.choice(["interval_off", "first_contact", "lift_off"])
        return TWO_SCENES + '[task]\nkind = "2ifc"\nintervals = ["reference", "comparison"]\nduration_s = 0.6\ngap_s = 0.4\n' + \
            QUESTION + CHOICES + 'correct = "comparison"\n' + TIMES.replace("ZERO", zero) + \
            constant(geometric(self.draw, 0.05, 0.7, self.draw.randint(4, 6)), self.draw.randint(12, 20))

    def unforced(self):
        """People who may say that they would only guess, and mostly do."""
        body = self.threshold_2ifc()
        self.people(threshold=(0.1, 0.3), slope=(0.8, 2.5), unsure=(0.5, 1))
        return body.replace("correct = ", 'unsure = { en = "?" }\ncorrect = ')

    def interval(self, kind, names, alternatives):
        self.people(threshold=(0.1, 0.3), slope=(0.8, 2.0), lapse=(0, 0.04))
        self.fit = {"function": "weibull", "guess": 1 / alternatives}
        return TWO_SCENES + f'[task]\nkind = "{kind}"\nstandard = "reference"\ntarget = "comparison"\nduration_s = 0.6\n' + \
            "gap_s = 0.4\n" + QUESTION.replace("either", "touch") + choices(names) + TIMES.replace("ZERO", "interval_off") + \
            constant(geometric(self.draw, 0.05, 0.7, self.draw.randint(4, 6)), self.draw.randint(12, 18))

    def mafc(self):
        count = self.draw.choice([3, 4])
        self.models = [("largest of m", count)]
        return self.interval(f"{count}ifc", [str(i) for i in range(1, count + 1)], count)

    def abx(self):
        self.models = [("independent observations", 2), ("differencing", 2)]
        return self.interval("abx", ["first", "second"], 2)

    def match_to_sample(self):
        self.models = [("independent observations", 2), ("differencing", 2)]
        return self.interval("match-to-sample", ["second", "third"], 2)

    def oddity(self):
        return self.interval("oddity", ["1", "2", "3"], 3)

    def same_different(self):
        self.people(threshold=(0.1, 0.3), criterion=(0.3, 1.0))
        self.positive = "different"
        self.fit = {"function": "weibull", "guess": "false alarms"}
        return TWO_SCENES + '[task]\nkind = "same-different"\nstandard = "reference"\ntarget = "comparison"\nduration_s = 0.6\n' + \
            "gap_s = 0.4\n" + QUESTION + choices(["same", "different"]) + TIMES.replace("ZERO", "interval_off") + \
            constant(geometric(self.draw, 0.05, 0.7, 4), self.draw.randint(16, 24))

    def yes_no(self):
        self.people(threshold=(0.1, 0.3), criterion=(0.3, 1.0), slope=(0.8, 1.5))
        self.positive, self.detection = "yes", "shared"
        self.fit = {"function": "weibull", "guess": "false alarms"}
        signals = geometric(self.draw, 0.05, 0.7, self.draw.randint(3, 5))
        body = single('{ yes = "amount > 0", no = "amount == 0" }').replace(CHOICES, choices(["yes", "no"]))
        return TWO_SCENES + body + constant([0.0] * self.draw.randint(1, 3) + signals, self.draw.randint(12, 20))

    def confusion(self):
        self.design = "confusion"
        count = self.draw.randint(3, 5)
        values = [round(0.15 * (i + 1), 2) for i in range(count)]
        self.people(threshold=(0.08, 0.3), lapse=(0, 0.05))
        names = [str(i) for i in range(count)]
        correct = "{ " + ", ".join(f'{n} = "amount == {v}"' for n, v in zip(names, values)) + " }"
        body = single(correct).replace(CHOICES, choices(names)).replace("either", "touch")
        return TWO_SCENES + body + constant(values, self.draw.randint(12, 20))

    def rating(self):
        self.design = "ratings"
        self.points = self.draw.randint(4, 7)
        self.people(threshold=(0.1, 0.3), criterion=(0.3, 1.0))
        signals = geometric(self.draw, 0.08, 0.5, self.draw.randint(2, 4))
        return TWO_SCENES + '[task]\nkind = "single-interval"\nintervals = ["comparison"]\ndevice = "touch"\n' \
            'question = { en = "?" }\npresent = "amount > 0"\n[task.rating]\n' + \
            f'points = {self.points}\nlabels = [ {{ at = 1, text = {{ en = "no" }} }}, {{ at = {self.points}, text = {{ en = "yes" }} }} ]\n' + \
            TIMES.replace("ZERO", "go_cue") + "explore_s = 4.0\n" + \
            constant([0.0] * self.draw.randint(1, 3) + signals, self.draw.randint(14, 22))

    def magnitude(self):
        self.design, self.level = "numbers", "strength_um"
        self.people(slope=(0.5, 1.2), scatter=(0.05, 0.2), threshold=(0.3, 0.6))
        return self.strength() + "[task.number]\nlow = 0.1\nhigh = 1000\ndecimals = 1\n" + TIMES.replace("ZERO", "go_cue") + \
            "explore_s = 4.0\n" + constant([0.1, 0.2, 0.4, 0.8, 1.4][:self.draw.randint(3, 5)], self.draw.randint(5, 12), "", "strength_um")

    def line(self):
        self.design, self.level = "line", "strength_um"
        self.people(slope=(0.5, 1.2), threshold=(0.3, 0.6))
        return self.strength() + '[task.rating]\nline = [0, 100]\ndecimals = 0\nlabels = [ { at = 0, text = { en = "no" } }, ' \
            '{ at = 100, text = { en = "yes" } } ]\n' + TIMES.replace("ZERO", "go_cue") + "explore_s = 4.0\n" + \
            constant([0.1, 0.2, 0.4, 0.8, 1.4][:self.draw.randint(3, 5)], self.draw.randint(5, 12), "", "strength_um")

    def strength(self):
        return '[[factor]]\nname = "strength_um"\nrange = [0.1, 1.4]\n[scene.strip]\nboundary_mm = 185.0\nedge = "p50"\n' \
            'displacement_um = "strength_um"\n[task]\nkind = "single-interval"\nintervals = ["strip"]\ndevice = "touch"\n' \
            'question = { en = "?" }\n'

    def setting(self):
        self.design, self.level = "settings", "strength_um"
        self.people(threshold=(0.03, 0.12), bias=(-0.1, 0.1))
        towards = self.draw.random() < 0.5
        self.equal = round(self.draw.uniform(0.6, 1.1), 2) if towards else None
        scenes = f"{self.equal}" if towards else "0.7"
        task = 'intervals = [["standard", "strip"]]\nforeperiod_s = { uniform = [1.0, 1.5] }\ntransition_ms = 50\n' if towards \
            else 'intervals = ["strip"]\n'
        return '[[factor]]\nname = "strength_um"\nrange = [0.1, 1.4]\n[scene.standard]\nboundary_mm = 185.0\nedge = "p50"\n' + \
            f'displacement_um = {scenes}\n[scene.strip]\nbase = "standard"\ndisplacement_um = "strength_um"\n' + \
            '[task]\nkind = "adjustment"\nadjusts = "strength_um"\nstep = 0.01\n' + task + \
            'device = "touch"\nquestion = { en = "?" }\nchoices = [ { id = "done", label = { en = "Done" } } ]\n' + \
            TIMES.replace("ZERO", self.draw.choice(["change", "go_cue"]) if towards else
                          self.draw.choice(["go_cue", "first_contact"])).replace("6.0", "30.0") + "explore_s = 26.0\n" + \
            '[[procedure]]\nname = "levels"\nkind = "adjustment"\nlevel = "strength_um"\nstart_below = [0.2]\nstart_above = [1.3]\n' + \
            f'repeats = {self.draw.randint(4, 8)}\n[[block]]\nname = "main"\nprocedures = ["levels"]\n'

    def staircase(self):
        self.people(threshold=(0.1, 0.3), slope=(0.8, 2.0))
        self.fit = {"function": "weibull", "guess": 0.5, "posterior": True}
        self.n_down, self.reversals = self.draw.randint(1, 3), self.draw.randint(6, 12)
        self.steps = self.draw.choice([[0.1, 0.05], [0.08, 0.04, 0.02], [0.05]])
        self.start = 0.6
        return TWO_SCENES + '[task]\nkind = "2ifc"\nintervals = ["reference", "comparison"]\nduration_s = 0.6\ngap_s = 0.4\n' + \
            QUESTION + CHOICES + 'correct = "comparison"\n' + TIMES.replace("ZERO", "interval_off") + \
            f'[[procedure]]\nname = "track"\nkind = "up-down"\nlevel = "amount"\nstart = {self.start}\nmin = 0.02\nmax = 0.8\n' \
            f'step = {self.steps}\nn_down = {self.n_down}\nstop = {{ reversals = {self.reversals}, trials = 90, rule = "or" }}\n' \
            '[[block]]\nname = "main"\nprocedures = ["track"]\n'

    def quest_plus(self):
        self.people(threshold=(0.1, 0.3), slope=(0.8, 2.0))
        self.fit = {"function": "weibull", "guess": 0.5, "posterior": True}
        self.grid = {"threshold": list(numpy.geomspace(0.03, 0.7, 21)), "slope": [0.7, 1.0, 1.4, 2.0, 2.8], "lapse": [0.01, 0.03]}
        return TWO_SCENES + '[task]\nkind = "2ifc"\nintervals = ["reference", "comparison"]\nduration_s = 0.6\ngap_s = 0.4\n' + \
            QUESTION + CHOICES + 'correct = "comparison"\n' + TIMES.replace("ZERO", "interval_off") + \
            '[[procedure]]\nname = "quest"\nkind = "quest-plus"\nfunction = "weibull"\nlevel = "amount"\nscale = "log10"\n' \
            "stimuli = { log_from = 0.03, log_to = 0.7, count = 21 }\ngrid.threshold = { log_from = 0.03, log_to = 0.7, count = 21 }\n" \
            "grid.slope = { values = [0.7, 1.0, 1.4, 2.0, 2.8] }\ngrid.guess = { values = [0.5] }\ngrid.lapse = { values = [0.01, 0.03] }\n" \
            f'stop = {{ trials = {self.draw.randint(40, 80)} }}\n[[block]]\nname = "main"\nprocedures = ["quest"]\n'

    def response_signal(self):
        self.design = "binary"
        self.people(threshold=(0.08, 0.2), bound=(1.0, 1.4))
        self.fit, self.positive = {"function": "normal", "guess": "tied"}, "second"
        lags = [0.1, 0.25, 0.5, 1.0, 1.8]
        body = TWO_SCENES.replace("[scene.reference]", f'[[factor]]\nname = "lag_s"\nlevels = {lags}\n[scene.reference]') + \
            single('{ first = "amount < 0", second = "amount > 0" }').replace('intervals = ["comparison"]', 'intervals = [["reference", "comparison"]]\nforeperiod_s = { uniform = [1.0, 1.5] }\ntransition_ms = 20')
        body = body.replace("deadline_s = 6.0\n", 'response_signal = { after_s = "lag_s", window_s = 0.5 }\n').replace('"go_cue"', '"change"').replace("explore_s = 4.0", "explore_s = 6.0")
        self.curve = True
        return body + constant([-0.2, 0.2], 5 * self.draw.randint(5, 9), 'balance = ["lag_s"]\n')

    def diffusion(self):
        self.people(threshold=(0.1, 0.25), bound=(0.7, 1.1), residual=(0.3, 0.4))
        self.fit, self.positive = {"function": "normal", "guess": "tied"}, "second"
        self.trade = True
        half = geometric(self.draw, 0.06, 0.4, 3)
        deadlines = round(self.draw.uniform(0.9, 1.2), 2), 3.0
        return TWO_SCENES.replace("[scene.reference]", '[[factor]]\nname = "instruction"\nlevels = ["speed", "accuracy"]\n[scene.reference]') + \
            single('{ first = "amount < 0", second = "amount > 0" }').replace("deadline_s = 6.0\n", "anticipation_s = 0.150\n") + \
            f'[[procedure]]\nname = "levels"\nkind = "constant-stimuli"\nlevel = "amount"\nvalues = {[-v for v in reversed(half)] + half}\n' \
            f'repeats = {self.draw.randint(12, 16)}\n[instructions.speed]\ntext = {{ en = "fast" }}\ndeadline_s = {deadlines[0]}\n' \
            f'late_message = {{ en = "late" }}\n[instructions.accuracy]\ntext = {{ en = "careful" }}\ndeadline_s = {deadlines[1]}\n' \
            'late_message = { en = "late" }\n[[sequence]]\nname = "main"\ndesign = "latin-square"\nover = "instruction"\n' \
            'block = { procedures = ["levels"], feedback = "none" }\n[analysis]\nby = "instruction"\ndifficulty = "abs(amount)"\n' \
            'show = ["psychometric", "ez", "bis", "lisas", "caf"]\nresponse_time_exclude = { below_s = 0.150, mad = 3.5 }\n'


KINDS = ["pse", "bisection", "choice", "pse_2ifc", "threshold_2ifc", "unforced", "mafc", "abx", "match_to_sample", "oddity",
         "same_different", "yes_no", "confusion", "rating", "magnitude", "line", "setting", "staircase", "quest_plus",
         "response_signal", "diffusion"]

# ------------------------------------------------------------------------------------------------ computed again


def wilson(k, n):
    interval = stats.binomtest(int(k), int(n)).proportion_ci(0.95, "wilson")
    return {"low": interval.low, "high": interval.high}


def clopper_pearson(k, n):
    interval = stats.binomtest(int(k), int(n)).proportion_ci(0.95, "exact")
    return {"low": interval.low, "high": interval.high}


def proportion(k, n):
    return {"right": k, "trials": n, "proportion": k / n, "interval": clopper_pearson(k, n)}


def student_mean(values):
    if len(values) < 3:
        return None
    mean, half = numpy.mean(values), stats.t.ppf(0.975, len(values) - 1) * stats.sem(values)
    return {"value": mean, "interval": {"low": mean - half, "high": mean + half}}


def student_proportion(values):
    """The same for proportions, on the logit scale by the delta method."""
    plain = student_mean(values)
    if plain is None or not 0 < plain["value"] < 1:
        return plain
    mean = plain["value"]
    half = (plain["interval"]["high"] - mean) / (mean * (1 - mean))
    low, high = (float(special.expit(special.logit(mean) + side * half)) for side in (-1, 1))
    return {"value": mean, "interval": {"low": low, "high": high}}


def scatter(values):
    if len(values) < 3 or numpy.ptp(values) == 0:
        return None
    n, sd = len(values), numpy.std(values, ddof=1)
    return {"value": sd, "interval": {"low": sd * math.sqrt((n - 1) / stats.chi2.ppf(0.975, n - 1)),
                                      "high": sd * math.sqrt((n - 1) / stats.chi2.ppf(0.025, n - 1))}}


def welch(a, b):
    if len(a) < 3 or len(b) < 3:
        return None
    va, vb = numpy.var(a, ddof=1) / len(a), numpy.var(b, ddof=1) / len(b)
    if va + vb == 0:
        return None
    freedom = (va + vb) ** 2 / (va ** 2 / (len(a) - 1) + vb ** 2 / (len(b) - 1))
    gap, half = numpy.mean(a) - numpy.mean(b), stats.t.ppf(0.975, freedom) * math.sqrt(va + vb)
    return {"value": gap, "interval": {"low": gap - half, "high": gap + half}}


def slope(x, y):
    line = stats.linregress(x, y)
    half = stats.t.ppf(0.975, len(x) - 2) * line.stderr
    return {"value": line.slope, "interval": {"low": line.slope - half, "high": line.slope + half}}


def log_linear(k, n):
    return (k + 0.5) / (n + 1)


def detection(hits, misses, false_alarms, rejections, scale=1.0):
    h, f = log_linear(hits, hits + misses), log_linear(false_alarms, false_alarms + rejections)
    z = stats.norm.ppf([h, f])
    variance = sum(p * (1 - p) / (n + 1) / stats.norm.pdf(at) ** 2
                   for p, n, at in ((h, hits + misses, z[0]), (f, false_alarms + rejections, z[1])))
    d, c, half = scale * (z[0] - z[1]), -(z[0] + z[1]) / 2, Z95 * math.sqrt(variance)
    return {"hits": hits, "misses": misses, "false_alarms": false_alarms, "correct_rejections": rejections,
            "d_prime": {"value": d, "interval": {"low": d - scale * half, "high": d + scale * half}},
            "criterion": {"value": c, "interval": {"low": c - half / 2, "high": c + half / 2}}}


def share_right(model, d, intervals):
    x = numpy.linspace(-10, 10, 2001)
    if model == "largest of m":
        return numpy.trapz(stats.norm.pdf(x) * stats.norm.cdf(x + d) ** (intervals - 1), x)
    first, second = d / math.sqrt(2), d / 2 if model == "independent observations" else d / math.sqrt(6)
    return stats.norm.cdf(first) * stats.norm.cdf(second) + stats.norm.cdf(-first) * stats.norm.cdf(-second)


def d_prime_of(model, share, intervals):
    if model != "largest of m" and share <= 0.5:
        return 0.0
    if share in (0, 1):
        return None
    return optimize.brentq(lambda d: share_right(model, d, intervals) - share, -12 if model == "largest of m" else 0, 12, xtol=1e-12)


def core(function, z):
    return -numpy.expm1(-numpy.exp(numpy.minimum(z, 700))) if function == "weibull" else stats.norm.cdf(z)


class Function:
    """A psychometric function of counts: parameters are the threshold on its axis, the log rate, lapse and guess."""

    def __init__(self, spec, levels, trials, positive, log_scale):
        self.name, self.guess, self.log = spec["function"], spec["guess"], log_scale
        self.weight = 1.0  # how often each answer counts
        self.n, self.k = numpy.array(trials, float), numpy.array(positive, float)
        self.u = numpy.array([-numpy.inf if level is None else self.axis(level) for level in levels])
        signal = self.u[numpy.isfinite(self.u)]
        self.low, self.range = signal.min(), signal.max() - signal.min()
        free = self.guess == "false alarms"
        self.bounds = [(self.low - self.range, self.low + 2 * self.range),
                       (math.log(0.1 / self.range), math.log(80 / self.range)), (0, 0.06)] + ([(0, 0.9)] if free else [])

    def axis(self, level):
        return (20 if self.name == "weibull" else 1) * math.log10(level) if self.log else level

    def rate(self, slope_):
        return math.log(10) / 20 * slope_ if self.name == "weibull" else 1 / slope_

    def theta(self, threshold, slope_, lapse, guess):
        return [self.axis(threshold), math.log(self.rate(slope_)), lapse] + ([guess] if self.guess == "false alarms" else [])

    def probability(self, theta, u):
        guess = theta[2] if self.guess == "tied" else theta[3] if self.guess == "false alarms" else self.guess
        with numpy.errstate(over="ignore"):
            z = numpy.where(numpy.isfinite(u), numpy.exp(theta[1]) * (numpy.where(numpy.isfinite(u), u, 0) - theta[0]), -numpy.inf)
        return numpy.clip(guess + (1 - guess - theta[2]) * core(self.name, z), 1e-12, 1 - 1e-12)

    def nll(self, theta):
        p = self.probability(theta, self.u)
        return -numpy.sum(self.k * numpy.log(p) + (self.n - self.k) * numpy.log1p(-p))

    def best(self, fixed=None):
        """The lowest -log likelihood; `fixed` maps indices of theta to values."""
        fixed = fixed or {}
        free = [i for i in range(len(self.bounds)) if i not in fixed]

        def whole(part):
            theta = numpy.empty(len(self.bounds))
            theta[free] = part
            for i, value in fixed.items():
                theta[i] = value
            return theta
        low, high = numpy.array(self.bounds).T
        starts = []
        for share in (0.35, 0.5, 0.65):
            for log_rate in (math.log(2 / self.range), math.log(6 / self.range), math.log(20 / self.range)):
                starts.append([self.low + share * self.range, log_rate, 0.01, 0.2][:len(self.bounds)])
        if 1 in fixed:  # a steep function has a maximum between each pair of levels
            starts = [[u, fixed[1], 0.01, 0.2][:len(self.bounds)] for u in numpy.linspace(self.low, self.low + self.range, 25)]
            starts = sorted(starts, key=lambda start: self.nll(whole(numpy.array(start)[free])))[:5]
        if 0 in fixed:  # and a threshold at a level may be best with the steepest one
            more = [[fixed[0], rate, 0.01, 0.2][:len(self.bounds)] for rate in numpy.linspace(*self.bounds[1], 25)]
            starts += sorted(more, key=lambda start: self.nll(whole(numpy.array(start)[free])))[:3]
        found = [optimize.minimize(lambda part: self.nll(whole(part)), numpy.array(start)[free], method=method,
                                   bounds=[self.bounds[i] for i in free]) for start in starts for method in ("L-BFGS-B", "Nelder-Mead")]
        best = min(found, key=lambda result: result.fun)
        return best.fun, whole(best.x)

    def weigh(self, theta, unsure):
        """Quasi-likelihood: the variance of forced answers, divided by what is left of it without the admitted guesses."""
        p = self.probability(theta, self.u)
        spared = unsure * self.guess * (1 - self.guess) / numpy.sum(self.n * p * (1 - p)) if unsure else 0
        self.weight = 1 / max(1 - spared, 0.05)

    def saturated(self):
        return -numpy.sum(special.xlogy(self.k, self.k / self.n) + special.xlogy(self.n - self.k, (self.n - self.k) / self.n))


def falling(x, low, high, share):
    """The density of a prior that is flat in the middle and falls to 0 over `share` of the range at both ends."""
    width = share * (high - low)
    return numpy.clip(numpy.minimum(x - low, high - x) / width, 0, 1)


def weighted_quantile(values, weights, share):
    order = numpy.argsort(values)
    sums = numpy.cumsum(weights[order])
    return numpy.interp(share * sums[-1], sums - 0.5 * weights[order], values[order])


def within_groups(samples):
    groups = collections.defaultdict(list)
    for group, index, value in samples:
        groups[group].append((index, value))
    freedom = len(samples) - len(groups) - 1
    if len(samples) < 20 or freedom < 10:
        return None
    x, y = numpy.concatenate([numpy.array(g) - numpy.mean(g, axis=0) for g in groups.values()]).T
    b = numpy.sum(x * y) / numpy.sum(x * x)
    error = math.sqrt(max(0, numpy.sum(y * y) - b * numpy.sum(x * y)) / freedom / numpy.sum(x * x))
    return {"per_100_trials": 100 * b, "interval": {"low": 100 * (b - Z95 * error), "high": 100 * (b + Z95 * error)}}


def keep(times, below, mad):
    late = times[times >= below]
    low, high = below, math.inf
    if mad and len(late):
        median = numpy.median(late)
        reach = mad * 1.4826 * numpy.median(numpy.abs(late - median))
        if reach > 0:
            low, high = max(low, median - reach), median + reach
    return (times >= low) & (times <= high)


# ------------------------------------------------------------------------------------------------- the first passage


def passage(t, v, a):
    """Density of the first passage at the lower boundary at time t, from the middle, with s = 0.1."""
    v, a = v / 0.1, a / 0.1
    tt = t / a ** 2
    out = numpy.zeros_like(t)
    small = tt < 0.3
    k = numpy.arange(-4, 5)[:, None]
    with numpy.errstate(all="ignore"):
        ts = tt[small]
        w = 0.5 + 2 * k
        out[small] = numpy.sum(w * numpy.exp(-w ** 2 / (2 * ts)), axis=0) / numpy.sqrt(2 * math.pi * ts ** 3)
        k = numpy.arange(1, 12)[:, None]
        tl = tt[~small]
        out[~small] = numpy.sum(math.pi * k * numpy.exp(-(k * math.pi) ** 2 * tl / 2) * numpy.sin(k * math.pi / 2), axis=0)
    return numpy.maximum(out, 0) / a ** 2 * numpy.exp(-v * a / 2 - v ** 2 * t / 2)


class Diffusion:
    """Posterior of one condition; every trial is (difficulty, time, +1 right, -1 wrong, 0 late or early)."""

    def __init__(self, answers, late, early, deadline, anticipation):
        self.names = sorted({a[0] for a in answers})
        self.cells = [numpy.array([[a[1], a[2]] for a in answers if a[0] == name]) for name in self.names]
        self.late = [late.get(name, 0) for name in self.names]
        self.early = [early.get(name, 0) for name in self.names]
        self.deadline, self.anticipation = deadline, anticipation
        self.shortest = min(cell[:, 0].min() for cell in self.cells)

    def log_posterior(self, p):
        log_a, ter, c, drifts = p[0], p[1], p[2], p[3:]
        if not (0 < ter) or not (0 < c < 1) or not -6 < log_a < 1:
            return -math.inf
        a, span = math.exp(log_a), 2 * self.deadline
        total = stats.beta.logpdf(c, 1, 19) - 0.5 * numpy.sum(numpy.square(drifts))
        grid = numpy.linspace(1e-4, 1, 400)
        for v, cell, late, early in zip(drifts, self.cells, self.late, self.early):
            def cdf(until, toward):
                if until <= 0:
                    return 0.0
                t = grid * until
                return numpy.trapz(passage(t, toward * v, a), t)
            up = 1 / (1 + math.exp(-v * a / 0.01))
            share = numpy.where(cell[:, 1] > 0, up, 1 - up)
            t = cell[:, 0] - ter
            density = numpy.zeros(len(t))
            ok = t > 0
            for sign in (1, -1):
                mine = ok & (cell[:, 1] == sign)
                density[mine] = passage(t[mine], -sign * v, a)
            total += numpy.sum(numpy.log((1 - c) * density + c * (0.25 + 0.5 * share) / span + 1e-300))
            done = cdf(self.deadline - ter, 1) + cdf(self.deadline - ter, -1)
            if late:
                total += late * math.log(max(1e-300, (1 - c) * max(0, 1 - done) + c * (1 - self.deadline / span)))
            if early:
                begun = cdf(self.anticipation - ter, 1) + cdf(self.anticipation - ter, -1)
                total += early * math.log(max(1e-300, (1 - c) * begun + c * self.anticipation / span))
        return total

    def draws(self, count):
        start = numpy.array([math.log(0.12), 0.8 * self.shortest, 0.03] + [0.1] * len(self.names))
        found = optimize.minimize(lambda p: min(1e9, -self.log_posterior(p)), start, method="Nelder-Mead",
                                  options={"maxiter": 1500, "xatol": 1e-4, "fatol": 1e-3})
        draw = numpy.random.default_rng(1)
        now, height = found.x, -found.fun
        scale = numpy.array([0.05, 0.02, 0.02] + [0.03] * len(self.names))
        chain = []
        cov = numpy.diag(scale ** 2)
        for i in range(count + 1500):
            if i in (500, 1000, 1500):
                cov = numpy.cov(numpy.array(chain[-400:]).T) + 1e-8 * numpy.eye(len(now))
            step = now + draw.multivariate_normal(numpy.zeros(len(now)), 2.4 ** 2 / len(now) * cov * (0.3 if i < 500 else 1))
            new = self.log_posterior(step)
            if math.log(draw.random()) < new - height:
                now, height = step, new
            chain.append(now)
        return numpy.array(chain[1500:])

# ------------------------------------------------------------------------------------------------------ comparison


def leaves(value, path=""):
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from leaves(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            yield from leaves(inner, f"{path}[{i}]")
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield path, value


class Compared:
    """Numbers of a JSON document that were computed again, and those that were not."""

    def __init__(self, document, where):
        self.document, self.where, self.wrong, self.seen = document, where, [], set()
        self.numbers = dict(leaves(document))

    def same(self, path, mine, tolerance=1e-6, width=None):
        """Compares a number, or all numbers of nested dictionaries and lists. With `width`, the tolerance is a share of it."""
        if isinstance(mine, dict):
            for key, inner in mine.items():
                self.same(f"{path}.{key}" if path else key, inner, tolerance, width)
            return
        if isinstance(mine, (list, tuple, numpy.ndarray)):
            for i, inner in enumerate(mine):
                self.same(f"{path}[{i}]", inner, tolerance, width)
            return
        theirs = self.numbers.get(path)
        if mine is None:
            if theirs is not None:
                self.wrong.append(f"{self.where}: {path} is {theirs}, expected none")
            return
        self.seen.add(path)
        allowed = tolerance * (width if width is not None else max(1.0, abs(mine)))
        if theirs is None or not abs(theirs - mine) <= allowed:
            self.wrong.append(f"{self.where}: {path} is {theirs}, expected {mine:.9g} (within {allowed:.3g})")

    def check(self, path, holds, why):
        self.seen.add(path)
        if not holds:
            self.wrong.append(f"{self.where}: {path} = {self.numbers.get(path)}: {why}")

    def left(self):
        return [re.sub(r"\[\d+\]", "[]", path) for path in self.numbers if path not in self.seen]


def number(text):
    return None if text in ("n/a", "") else float(text)


class Session:
    """What trials.csv says of one session."""

    def __init__(self, kind, rows):
        self.kind = kind
        self.all = [r for r in rows if r["trial_type"] not in ("warmup",) and r["practice"] == "0"]
        self.rows = [r for r in self.all if r["trial_type"] == "experimental"]
        self.answered = [r for r in self.rows if r["outcome"] == "answered"]
        self.conditions = list(dict.fromkeys(r["instruction"] for r in self.rows))
        if kind.name == "diffusion":
            self.conditions = ["speed", "accuracy"]

    def of(self, condition, rows=None):
        return [r for r in (self.answered if rows is None else rows) if r["instruction"] == condition]

    def level(self, row):
        return float(row["level"])

    def side_positive(self, row):
        """Whether the answer was the one whose share grows with the level."""
        kind = self.kind
        if kind.name == "pse_2ifc":
            # the comparison was in the interval that is right if the level is positive
            right = row["correct_response"] == row["response"]
            return right == (self.level(row) > 0)
        return row["response"] == kind.positive


def compare_counts(report, session):
    rows = session.all
    report.same("trials", {"presented": len(rows), **{name: sum(r["outcome"] == one for r in rows) for name, one in (
        ("answered", "answered"), ("timeouts", "timeout"), ("anticipations", "anticipation"), ("aborted", "aborted"), ("faults", "fault"))}})
    report.same("trials.unsure", sum(r["response"] == "unsure" for r in rows))
    timed = [((r["level"], r["instruction"]), int(r["trial_index"]), float(r["response_time"])) for r in session.answered]
    report.same("trend_response_time_s", within_groups(timed))
    scored = [((r["level"], r["instruction"]), int(r["trial_index"]), float(r["correct"])) for r in session.answered if r["correct"] != "n/a"]
    report.same("trend_proportion_correct", within_groups(scored))


def compare_binary_bias(report, session):
    names = report.document["choices"]
    rows = [r for r in session.answered if r["response"] in names]
    if len(names) > 2 or not rows:
        return
    second = sum(r["response"] == names[1] for r in rows)
    report.same("bias.share_second", second / len(rows))
    report.same("bias.interval", wilson(second, len(rows)))
    known = [r for r in rows if r["correct_response"] in names]
    if known:
        counts = collections.Counter((r["correct_response"] == names[1], r["response"] == names[1]) for r in known)
        found = detection(counts[True, True], counts[True, False], counts[False, True], counts[False, False])
        report.same("bias.criterion", found["criterion"]["value"])


def difficulty(row):
    return abs(float(row["level"]))


def trade_measures(cells, session_times, session_error):
    """Accuracy, median, LISAS and inverse efficiency of one condition."""
    times = numpy.concatenate([c[:, 0] for c in cells])
    right = numpy.concatenate([c[c[:, 1] > 0, 0] for c in cells])
    p = len(right) / len(times)
    sd_error = math.sqrt(session_error * (1 - session_error))
    mean = numpy.mean(right) if len(right) else math.nan
    lisas = mean if sd_error == 0 else mean + (1 - p) * numpy.std(session_times, ddof=1) / sd_error
    return p, numpy.median(times), lisas, mean / p if p else math.nan


QUANTILES = {"low": (".interval.low", 0.025), "value": (".value", 0.5), "high": (".interval.high", 0.975)}
REPLICATES = 1000  # of the report's bootstrap


def effective(values):
    """How many independent draws a chain is worth: its length over the sum of its autocorrelations until they fall below 0.05."""
    deviations = values - values.mean()
    spectrum = numpy.fft.rfft(deviations, 2 * len(values))
    correlation = numpy.fft.irfft(numpy.abs(spectrum) ** 2)[:len(values)]
    correlation /= correlation[0]
    end = int(numpy.argmax(correlation < 0.05))
    return len(values) / (1 + 2 * correlation[1:max(1, end)].sum())


def same_quantiles(report, path, values, draws, names=tuple(QUANTILES)):
    """Quantiles of the report's `draws` draws and of those of this program. How many draws lie below the true quantile is a
    binomial number, in both; so the report's lies between two other quantiles of this program's draws, except in one case of
    50 000."""
    values = values[numpy.isfinite(values)]
    both = int(1 / (1 / draws + 1 / effective(values))) if numpy.ptp(values) > 0 else draws
    for name, share in (QUANTILES[name] for name in names):
        low, high = numpy.quantile(values, [stats.binom.ppf(1e-5, both, share) / both, stats.binom.isf(1e-5, both, share) / both])
        theirs = report.numbers.get(path + name)
        report.check(path + name, theirs is not None and low - 1e-9 <= theirs <= high + 1e-9,
                     f"expected between {low:.6g} and {high:.6g}, of {both} draws")


def unnoticed_changes():
    """Negative control of same_quantiles(): numbers that are moved by half an SD, or an interval of half or twice the width."""
    values, unnoticed = stats.norm.rvs(size=4000, random_state=5), []
    for what, shift, stretch, wrong in (("nothing", 0, 1, False), ("moved", 0.5, 1, True), ("narrow", 0, 0.5, True), ("wide", 0, 2, True)):
        numbers = {"value": shift, "interval": {"low": shift - stretch * Z95, "high": shift + stretch * Z95}}
        report = Compared({"x": numbers}, "control")
        same_quantiles(report, "x", values, 600)
        if bool(report.wrong) != wrong:
            unnoticed.append(f"negative control of quantiles: {what}: {report.wrong}")
    return unnoticed


def compare_trade(report, session, deep):
    mad, below = (3.5, 0.15) if session.kind.name == "diffusion" else (None, 0.0)
    groups, raw = [], []
    for at, condition in enumerate(session.conditions):
        path = f"instructions[{at}]"
        rows = session.of(condition, session.rows)
        scored = [r for r in session.of(condition) if r["correct"] != "n/a"]
        times = numpy.array([float(r["response_time"]) for r in scored])
        kept = keep(times, below, mad)
        names = sorted({difficulty(r) for r in scored})
        cell_of = {n: numpy.array([[float(r["response_time"]), float(r["correct"])] for r in scored if difficulty(r) == n]) for n in names}
        kept_of = {n: numpy.array([[float(r["response_time"]), float(r["correct"])] for r, k in zip(scored, kept) if k and difficulty(r) == n]).reshape(-1, 2)
                   for n in names}
        raw.append([cell_of[n] for n in names])
        groups.append([kept_of[n] for n in names])
        report.same(path, {"presented": len(rows), "answered": len(scored), "excluded": int(numpy.sum(~kept)),
                           "timeouts": sum(r["outcome"] == "timeout" for r in rows),
                           "anticipations": sum(r["outcome"] == "anticipation" for r in rows)})
        if not len(times):
            continue
        all_kept, right = times[kept], sum(int(c[:, 1].sum()) for c in groups[-1])
        report.same(path + ".proportion_correct", {"value": right / len(all_kept), "interval": wilson(right, len(all_kept))})
        report.same(path + ".deciles_s", [numpy.quantile(all_kept, q / 10) for q in range(1, 10)])
        seen = 0
        for name, cell in zip(names, groups[-1]):
            if not len(cell):
                continue
            good = cell[cell[:, 1] > 0, 0]
            report.same(f"{path}.difficulties[{seen}]", {"difficulty": name, "answered": len(cell), "correct": len(good),
                        "interval": wilson(len(good), len(cell)), "mean_correct_s": numpy.mean(good) if len(good) else None})
            seen += 1
        order = numpy.argsort(all_kept, kind="stable")
        scores = numpy.array([float(r["correct"]) for r in scored])[kept]
        bins = len(report.document["instructions"][at]["caf"])
        for b in range(bins):
            mine = order[b * len(order) // bins:(b + 1) * len(order) // bins]
            report.same(f"{path}.caf[{b}]", {"mean_time_s": numpy.mean(all_kept[mine]), "trials": len(mine),
                        "correct": int(scores[mine].sum()), "interval": wilson(scores[mine].sum(), len(mine))})
        gaps = []
        run = session.rows
        good = [r["outcome"] == "answered" and r["correct"] == "1" for r in run]
        bad = [r["outcome"] == "answered" and r["correct"] == "0" for r in run]
        for i in range(2, len(run) - 1):
            if good[i - 2] and good[i - 1] and bad[i] and good[i + 1] and all(r["instruction"] == condition for r in run[i - 2:i + 2]) \
                    and run[i - 2]["block_index"] == run[i + 1]["block_index"]:
                gaps.append(float(run[i + 1]["response_time"]) - float(run[i - 1]["response_time"]))
        report.same(path + ".post_error_slowing_s", student_mean(gaps))
        deadlines = {r["deadline"] for r in rows}  # one only if all trials have the same
        report.same(path + ".deadline_s", float(deadlines.pop()) if len(deadlines) == 1 and deadlines != {"n/a"} else None)
        pairs = [(a["response"], b["response"], b["correct_response"]) for a, b in following(session)
                 if a["instruction"] == b["instruction"] == condition and "n/a" not in (a["correct_response"], b["correct_response"])]
        known = [(now == before) - (right == before) for before, now, right in pairs if "unsure" not in (before, now)]
        report.same(path + ".repetition", student_mean(known) if len(known) >= 20 else None)

    def measured(of):
        times = numpy.concatenate([c[:, 0] for g in of for c in g])
        scores = numpy.concatenate([c[:, 1] for g in of for c in g])
        right = times[scores > 0]
        return [trade_measures(g, right, 1 - scores.mean()) for g in of]

    def kept_again(cells):
        pooled = numpy.concatenate([c[:, 0] for c in cells])
        kept, at, result = keep(pooled, below, mad), 0, []
        for cell in cells:
            result.append(cell[kept[at:at + len(cell)]])
            at += len(cell)
        return result
    found = measured(groups)
    draw = numpy.random.default_rng(7)
    again = numpy.array([measured([kept_again([c[draw.integers(len(c), size=len(c))] for c in g]) for g in raw])
                         for _ in range(400)])
    names = {1: "median_response_time_s", 2: "lisas_s", 3: "inverse_efficiency_s"}
    for at in range(len(groups)):
        for which, name in names.items():
            path = f"instructions[{at}].{name}"
            if f"{path}.value" not in report.numbers:
                continue
            report.same(path + ".value", found[at][which])
            same_quantiles(report, path, again[:, at, which], REPLICATES, ("low", "high"))
    gaps = {"proportion correct": 0, "median response time": 1, "LISAS": 2, "inverse efficiency": 3}
    for i, entry in enumerate(report.document["differences"]):
        if entry["measure"] not in gaps or entry["estimate"] is None:
            continue
        which, a, b = gaps[entry["measure"]], session.conditions.index(entry["first"]), session.conditions.index(entry["second"])
        path = f"differences[{i}].estimate"
        report.same(path + ".value", found[b][which] - found[a][which])
        if which == 0:
            shares = [report.document["instructions"][k]["proportion_correct"] for k in (a, b)]
            (p, ends_p), (q, ends_q) = [(s["value"], s["interval"]) for s in shares]
            gap = q - p
            report.same(path + ".interval", {"low": gap - math.hypot(q - ends_q["low"], ends_p["high"] - p),
                                             "high": gap + math.hypot(ends_q["high"] - q, p - ends_p["low"])})
        else:
            same_quantiles(report, path, again[:, b, which] - again[:, a, which], REPLICATES, ("low", "high"))
    for at, condition in enumerate(session.conditions):  # none with a response signal
        compare_predicted(report, session, at, condition, 0.150 if session.kind.name == "diffusion" else 0.0)
    if deep:
        compare_diffusion(report, session)


def following(session):
    """Pairs of answered trials of which the second was presented just after the first."""
    for a, b in zip(session.all, session.all[1:]):
        if int(b["trial_index"]) == int(a["trial_index"]) + 1 and a["block_index"] == b["block_index"]:
            if all(r["trial_type"] == "experimental" and r["outcome"] == "answered" for r in (a, b)):
                yield a, b


class Firth:
    """The maxima of a logistic likelihood with Firth's penalty, half the logarithm of the determinant of the information."""

    def __init__(self, rows, answers):
        self.unit = numpy.sqrt(numpy.mean(numpy.square(rows), axis=0))
        self.x, self.y = rows / self.unit, answers

    def cost(self, beta):
        logit = self.x @ beta
        p = special.expit(logit)
        sign, log_det = numpy.linalg.slogdet((self.x * (p * (1 - p))[:, None]).T @ self.x)
        return -(numpy.sum(self.y * logit - numpy.logaddexp(0, logit)) + 0.5 * log_det) if sign > 0 else 1e9

    def best(self, fixed=None):
        """The lowest cost, and where it is; `fixed` is the index of a coefficient and its value in the units of the rows."""
        free = [i for i in range(self.x.shape[1]) if not fixed or i != fixed[0]]

        def whole(part):
            beta = numpy.empty(self.x.shape[1])
            beta[free] = part
            if fixed:
                beta[fixed[0]] = fixed[1] * self.unit[fixed[0]]
            return beta
        found = [optimize.minimize(lambda part: self.cost(whole(part)), start, method="BFGS", options={"gtol": 1e-7})
                 for start in (numpy.zeros(len(free)), numpy.full(len(free), 1.0), numpy.full(len(free), -1.0))]
        best = min(found, key=lambda result: result.fun)
        return best.fun, whole(best.x) / self.unit


BEFORE = ("stimulus", "previous_stimulus", "previous_answer", "after_error")


def compare_before(report, session):
    """The effects of the trial before: its stimulus and its answer, beside the present stimulus."""
    kind, names = session.kind, report.document["choices"]
    model = {"ratings": "ratings", "line": "ratings", "numbers": "logarithms", "settings": "settings"}.get(kind.design)
    guess = kind.fit["guess"] if kind.fit else None
    if kind.design == "binary" and len(names) == 2:
        model = "sides" if kind.name == "pse_2ifc" or isinstance(guess, float) else "choices"
    entries = report.document["trial_before"]
    report.check("trial_before", [e["model"] for e in entries] == ([model] if model == "settings" else [model] * len(session.conditions) if model else []),
                 f"expected {model} for each condition")
    positive = names[1] if model == "sides" else kind.positive

    def seen(row):
        level = 0.0 if guess == "false alarms" and row["correct_response"] != positive else session.level(row)
        if model == "sides":
            return abs(level) if row["correct_response"] == positive else -abs(level), 0.5 if row["response"] == positive else -0.5
        if model == "choices":
            return level, 0.5 if row["response"] == positive else -0.5
        given = float(row["response"])
        return (math.log10(level), math.log10(given)) if model == "logarithms" else (level, given)
    for at, entry in enumerate(entries):
        pairs = [(seen(a), seen(b), a["correct"] == "0", b["instruction"]) for a, b in following(session)
                 if "unsure" not in (a["response"], b["response"]) and (model == "settings" or b["instruction"] == session.conditions[at])]
        report.same(f"trial_before[{at}].pairs", len(pairs))
        fewest = 50 if model in ("sides", "choices") else 10
        if len(pairs) < fewest or not any(entry[name] for name in BEFORE):
            report.check(f"trial_before[{at}]", bool(entry["statements"]), "no effects and no reason")
            continue
        means = {"ratings": lambda pair: pair[1][0], "logarithms": lambda pair: pair[1][0], "settings": lambda pair: pair[3]}.get(model, lambda pair: "")
        of = sorted({means(pair) for pair in pairs})
        columns = {"stimulus": [p[1][0] for p in pairs], "previous_stimulus": [p[0][0] for p in pairs], "previous_answer": [p[0][1] for p in pairs]}
        if model in ("ratings", "logarithms"):
            columns.pop("stimulus")
        columns = {name: values for name, values in columns.items() if len(set(values)) > 1}
        others = [[float(means(p) == one) for p in pairs] for one in of]
        if entry["after_error"]:
            columns["after_error"] = [p[1][0] * p[2] for p in pairs]
            others.append([float(p[2]) for p in pairs])
        rows, answers = numpy.array([*columns.values(), *others]).T, numpy.array([p[1][1] for p in pairs])
        report.check(f"trial_before[{at}]", [name for name in BEFORE if entry[name]] == list(columns), f"expected {list(columns)}")
        if model not in ("sides", "choices"):
            beta, freedom = numpy.linalg.lstsq(rows, answers, rcond=None)[0], len(rows) - rows.shape[1]
            error = numpy.sqrt(numpy.sum((answers - rows @ beta) ** 2) / freedom * numpy.diag(numpy.linalg.inv(rows.T @ rows)))
            for k, name in enumerate(columns):
                half = stats.t.ppf(0.975, freedom) * error[k]
                report.same(f"trial_before[{at}].{name}", {"value": beta[k], "interval": {"low": beta[k] - half, "high": beta[k] + half},
                            "p": 2 * stats.t.sf(abs(beta[k]) / error[k], freedom)})
            continue
        fit = Firth(rows, answers > 0)
        lowest, beta = fit.best()
        for k, name in enumerate(columns):
            path, ends = f"trial_before[{at}].{name}", entry[name]["interval"]
            wide = min(abs(beta[k] - end) for end in ends.values() if end is not None)
            report.same(path + ".value", beta[k], 1e-3, wide)
            report.same(path + ".p", stats.chi2.sf(2 * (fit.best((k, 0.0))[0] - lowest), 1), 1e-4)
            for end, value in ends.items():
                if value is not None:
                    drop = 2 * (fit.best((k, value))[0] - lowest)
                    report.check(f"{path}.interval.{end}", abs(drop - 3.8415) < 0.01, f"the likelihood ratio there is {drop:.4f}")


def compare_predicted(report, session, at, condition, anticipation):
    """What the diffusion with the reported medians predicts of each difficulty, and what was observed."""
    entry = report.document["instructions"][at]
    if not entry["predicted"]:
        return
    rows = [r for r in session.of(condition, session.rows) if r["outcome"] in ("answered", "timeout", "anticipation")]
    deadline = float(rows[0]["deadline"])
    a, ter, c = (entry[name]["value"] for name in ("boundary", "nondecision_s", "contaminants"))
    end = min(deadline, ter + 8 * deadline)
    t = numpy.linspace(0, end, 6001)
    names = sorted({difficulty(r) for r in session.of(condition) if r["correct"] != "n/a"})
    for i, name in enumerate(names):
        v = next(d["drift"]["value"] for d in entry["difficulties"] if d["difficulty"] == name)
        up = 1 / (1 + math.exp(-v * a / 0.01))
        for key, sign, score in (("right", 1, "1"), ("wrong", -1, "0")):
            path = f"instructions[{at}].predicted[{i}].{key}"
            times = numpy.sort([float(r["response_time"]) for r in session.of(condition) if difficulty(r) == name and r["correct"] == score])
            n = len(times)
            report.same(path, {"observed": n, "observed_mean_s": numpy.mean(times) if n else None})
            if n >= 5:
                quantiles = []
                for p in (0.1, 0.3, 0.5, 0.7, 0.9):
                    reach = Z95 * math.sqrt(n * p * (1 - p))
                    ranks = [min(max(rank, 0), n - 1) for rank in (math.floor(n * p - reach), math.ceil(n * p + reach))]
                    quantiles.append({"value": numpy.quantile(times, p), "interval": {"low": times[ranks[0]], "high": times[ranks[1]]}})
                report.same(path + ".observed_quantiles_s", quantiles)
            after = t - ter
            density = numpy.zeros(len(t))
            density[after > 0] = passage(after[after > 0], -sign * v, a)
            share = up if sign > 0 else 1 - up
            whole = (1 - c) * density + c * (0.25 + 0.5 * share) / (2 * deadline)
            sums = numpy.concatenate([[0], numpy.cumsum(0.5 * (whole[1:] + whole[:-1]) * numpy.diff(t))])
            first, total = numpy.interp(anticipation, t, sums), sums[-1]
            kept = t >= anticipation
            mean = numpy.trapz(numpy.where(kept, t * whole, 0), t) / (total - first)
            wanted = [numpy.interp(first + p * (total - first), sums, t) for p in (0.1, 0.3, 0.5, 0.7, 0.9)]
            report.same(path + ".predicted_proportion", total - first, 2e-3)
            report.same(path + ".predicted_mean_s", mean, 5e-3)
            report.same(path + ".predicted_quantiles_s", wanted, 0.02)


def compare_diffusion(report, session):
    draws = []
    for at, condition in enumerate(session.conditions):
        rows = session.of(condition, session.rows)
        answers = [(difficulty(r), float(r["response_time"]), 1 if r["correct"] == "1" else -1) for r in rows if r["outcome"] == "answered"]
        late = collections.Counter(difficulty(r) for r in rows if r["outcome"] == "timeout")
        early = collections.Counter(difficulty(r) for r in rows if r["outcome"] == "anticipation")
        model = Diffusion(answers, late, early, float(rows[0]["deadline"]), 0.150)
        chain = model.draws(20000)
        worth = report.document["instructions"][at]["effective_draws"]
        report.check(f"instructions[{at}].effective_draws", 30 <= worth <= 1000, "fewer draws would not be reported")
        named = {"boundary": numpy.exp(chain[:, 0]), "nondecision_s": chain[:, 1], "contaminants": chain[:, 2],
                 "drift": chain[:, 3:].mean(axis=1)}
        draws.append(named)
        for name, values in named.items():
            same_quantiles(report, f"instructions[{at}].{name}", values, worth)
        for i in range(len(model.names)):
            same_quantiles(report, f"instructions[{at}].difficulties[{i}].drift", chain[:, 3 + i], worth)
    names = {"boundary": "boundary", "time outside the decision": "nondecision_s", "drift": "drift"}
    for i, entry in enumerate(report.document["differences"]):
        if entry["measure"] in names and entry["estimate"]:
            a, b = session.conditions.index(entry["first"]), session.conditions.index(entry["second"])
            gap = draws[b][names[entry["measure"]]] - draws[a][names[entry["measure"]]]
            worth = [report.document["instructions"][k]["effective_draws"] for k in (a, b)]
            same_quantiles(report, f"differences[{i}].estimate", gap, min(worth))


def counted(session, condition, log_scale):
    """Levels (none for trials without a signal), trials and positive answers of the fit."""
    kind, table = session.kind, {}
    for r in session.of(condition):
        level = session.level(r)
        if kind.fit["guess"] == "tied":
            hit = session.side_positive(r)
        elif kind.fit["guess"] == "false alarms":
            hit = r["response"] == kind.positive
            level = level if r["correct_response"] == kind.positive else None
        else:
            hit = kind.fit["guess"] if r["response"] == "unsure" else r["correct"] == "1"
        entry = table.setdefault(level, [0, 0])
        entry[0] += 1
        entry[1] += hit
    order = sorted(table, key=lambda level: -math.inf if level is None else level)
    return order, [table[k][0] for k in order], [table[k][1] for k in order]


def compare_fits(report, session):
    fits = report.document["fits"]
    expected = session.conditions if len(session.conditions) > 1 else [session.conditions[0]]
    report.check("fits", len(fits) == len(expected), f"there are {len(fits)} fits, expected {len(expected)}")
    for at, fit in enumerate(fits):
        path = f"fits[{at}]"
        condition = expected[at]
        log_scale = session.kind.fit["function"] == "weibull"
        levels, trials, positive = counted(session, condition, log_scale)
        report.same(path + ".levels", [{"level": k, "trials": n, "positive": p} for k, n, p in zip(levels, trials, positive)])
        if fit["threshold"] is None:
            continue
        function = Function(session.kind.fit, levels, trials, positive, log_scale)
        if isinstance(session.kind.fit["guess"], float):
            report.same(path + ".guess", session.kind.fit["guess"])
        if fit["prior"] is None:
            theirs = reported_theta(fit, function)
            function.weigh(theirs, sum(r["response"] == "unsure" for r in session.of(condition)))
            compare_maximum(report, path, fit, function, theirs)
        else:
            compare_posterior(report, path, fit, function)


def reported_theta(fit, function):
    """The reported parameters. A slope that the answers do not determine is not reported; it lies at an end of its range."""
    if fit["slope"] is not None:
        return function.theta(fit["threshold"], fit["slope"], fit["lapse"], fit["guess"])
    theta = function.theta(fit["threshold"], 1.0, fit["lapse"], fit["guess"])
    return min(([theta[0], end, *theta[2:]] for end in function.bounds[1]), key=function.nll)


def compare_maximum(report, path, fit, function, theirs):
    mine, best = function.best()
    reported = function.nll(theirs)
    report.same(path + ".negative_log_likelihood", function.weight * reported, 1e-8)
    report.check(path + ".negative_log_likelihood", reported <= mine + 1e-4, f"SciPy finds {mine:.7f}")
    for name in ("threshold", "slope", "lapse", "guess"):
        report.check(f"{path}.{name}", reported <= mine + 1e-4, f"SciPy finds a higher likelihood at {best}")
    report.same(path + ".deviance", 2 * function.weight * (reported - function.saturated()), 1e-6)
    if fit.get("level_75") is not None:
        inside = (0.75 - (theirs[2] if function.guess == "tied" else theirs[3] if function.guess == "false alarms" else function.guess))
        guess = theirs[2] if function.guess == "tied" else theirs[3] if function.guess == "false alarms" else function.guess
        share = inside / (1 - guess - theirs[2])
        z = math.log(-math.log1p(-share)) if function.name == "weibull" else stats.norm.ppf(share)
        u = theirs[0] + z / math.exp(theirs[1])
        report.same(path + ".level_75", 10 ** (u / 20) if function.log else u, 1e-6)
    # Both ends of a profile interval have the same likelihood, at a critical value that is near chi squared's.
    for name, index in (("threshold", 0), ("slope", 1)):
        interval = fit[f"{name}_interval"]
        if interval is None:
            continue
        drops = []
        for end in ("low", "high"):
            if interval[end] is None or interval[f"touches_{end}"]:
                continue
            value = function.axis(interval[end]) if index == 0 else math.log(function.rate(interval[end]))
            drops.append(2 * function.weight * (function.best({index: value})[0] - reported))
            report.check(f"{path}.{name}_interval.{end}", 3.8 <= drops[-1] <= 9.0, f"the likelihood ratio there is {drops[-1]:.3f}")
        if len(drops) == 2:
            alike = abs(drops[0] - drops[1]) < 0.05 * max(drops)
            if not alike:  # where the likelihood falls off a cliff, the end is right to a hundredth of the interval
                ends = [function.axis(interval[end]) if index == 0 else math.log(function.rate(interval[end])) for end in ("low", "high")]
                steep = drops.index(max(drops))
                inside = ends[steep] + 0.01 * (ends[1 - steep] - ends[steep])
                alike = 2 * function.weight * (function.best({index: inside})[0] - reported) <= min(drops)
            report.check(f"{path}.{name}_interval.low", alike, f"likelihood ratios {drops}")


def compare_posterior(report, path, fit, function):
    prior = fit["prior"]

    def points(name, axis, count):
        entry = prior[name]
        ends = [axis(v) for v in (entry["falls_to_0_at"] or [entry["low"], entry["high"]])]
        flat = [axis(entry["low"]), axis(entry["high"])]
        low, high = sorted(ends)
        x = low + (numpy.arange(count) + 0.5) * (high - low) / count
        share = abs(min(flat) - low) / (high - low)
        return x, falling(x, low, high, share) if share > 0 else numpy.ones(count)
    u, of_u = points("threshold", function.axis, 161)
    log_rate, of_rate = points("slope", lambda s: math.log(function.rate(s)), 121)
    lapse = numpy.linspace(prior["lapse"]["low"], prior["lapse"]["high"], 13)
    guesses = [None] if function.guess != "false alarms" else numpy.linspace(0.005, 0.895, 60)
    sums = {"u": numpy.zeros(len(u)), "rate": numpy.zeros(len(log_rate)), "lapse": numpy.zeros(len(lapse))}
    values = []
    for g in guesses:
        for i, l in enumerate(lapse):
            guess = l if function.guess == "tied" else g if g is not None else function.guess
            total = numpy.zeros((len(u), len(log_rate)))
            for at, n, k in zip(function.u, function.n, function.k):
                z = numpy.exp(log_rate)[None, :] * (at - u)[:, None] if numpy.isfinite(at) else numpy.full(total.shape, -numpy.inf)
                p = numpy.clip(guess + (1 - guess - l) * core(function.name, z), 1e-12, 1 - 1e-12)
                total += k * numpy.log(p) + (n - k) * numpy.log1p(-p)
            end = 0.5 if i in (0, len(lapse) - 1) else 1.0
            values.append((i, end, total))
    top = max(v.max() for _, _, v in values)
    for i, end, total in values:
        weight = end * numpy.exp(total - top) * of_u[:, None] * of_rate[None, :]
        sums["u"] += weight.sum(axis=1)
        sums["rate"] += weight.sum(axis=0)
        sums["lapse"][i] += weight.sum()
    shares = {"low": 0.025, "value": 0.5, "high": 0.975}
    of = {name: {k: weighted_quantile(x, sums[name], q) for k, q in shares.items()} for name, x in (("u", u), ("rate", log_rate))}
    back = (lambda x: 10 ** (x / 20)) if function.log else (lambda x: x)
    slope_of = (lambda r: math.exp(r) / (math.log(10) / 20)) if function.name == "weibull" else (lambda r: 1 / math.exp(r))
    for name, key, to in (("threshold", "u", back), ("slope", "rate", slope_of)):
        ends = {k: to(v) for k, v in of[key].items()}
        if ends["low"] > ends["high"]:
            ends["low"], ends["high"] = ends["high"], ends["low"]
        width = ends["high"] - ends["low"]
        if fit[name] is not None:
            report.same(f"{path}.{name}", ends["value"], 0.04, width)
        if fit[f"{name}_interval"]:
            report.same(f"{path}.{name}_interval", {"low": ends["low"], "high": ends["high"]}, 0.06, width)


def compare_detection(report, session):
    kind, entries = session.kind, []
    rows = session.answered
    noise = [r for r in rows if r["correct_response"] != kind.positive]
    signal = [r for r in rows if r["correct_response"] == kind.positive]

    def counts(signals, noises):
        yes = lambda r: r["response"] == kind.positive
        return [sum(map(yes, signals)), sum(not yes(r) for r in signals), sum(map(yes, noises)), sum(not yes(r) for r in noises)]
    for level in sorted({difficulty(r) for r in signal}):
        its = noise if kind.detection == "shared" else [r for r in noise if difficulty(r) == level]
        entries.append({"level": level, **detection(*counts([r for r in signal if difficulty(r) == level], its))})
    entries.append(detection(*counts(signal, noise)))
    report.check("detection", len(entries) == len(report.document["detection"]), f"expected {len(entries)} entries")
    report.same("detection", entries)


def compare_discrimination(report, session):
    rows = session.answered
    levels = sorted({session.level(r) for r in rows})
    entries = report.document["discrimination"]
    report.check("discrimination", len(entries) == len(levels) + 1, f"expected {len(levels) + 1} entries")
    for at, level in enumerate(levels + [None]):
        mine = [r for r in rows if level is None or session.level(r) == level]
        k, n = sum(r["correct"] == "1" for r in mine), len(mine)
        path = f"discrimination[{at}]"
        report.same(path, {"level": level, "correct": proportion(k, n)})
        ends = clopper_pearson(k, n)
        for i, (model, intervals) in enumerate(session.kind.models):
            value = {"value": d_prime_of(model, log_linear(k, n), intervals),
                     "interval": {key: d_prime_of(model, p, intervals) for key, p in ends.items()}}
            report.same(f"{path}.d_prime[{i}]", value)


def compare_confusion(report, session):
    names = report.document["choices"]
    rows = []
    for i, name in enumerate(names):
        mine = [r for r in session.answered if r["correct_response"] == name]
        if mine:
            answers = [sum(r["response"] == n for r in mine) for n in names]
            rows.append({"answers": answers, "trials": len(mine), "correct": proportion(answers[i], len(mine))})
    report.same("confusion[0].rows", rows)
    report.same("confusion[0].correct", proportion(sum(r["correct"]["right"] for r in rows), sum(r["trials"] for r in rows)))


def rating_fit(noise, signal, equal):
    noise, signal = numpy.array(noise, float), numpy.array(signal, float)
    used = (noise + signal) > 0
    noise, signal = noise[used], signal[used]
    count = len(noise) - 1

    def nll(p):
        criteria = numpy.concatenate([[-numpy.inf], p[2] + numpy.concatenate([[0], numpy.cumsum(numpy.exp(p[3:]))]), [numpy.inf]])
        sd = 1 if equal else math.exp(p[1])
        a = numpy.diff(stats.norm.cdf(criteria))
        b = numpy.diff(stats.norm.cdf((criteria - p[0]) / sd))
        return -numpy.sum(special.xlogy(noise, numpy.maximum(a, 1e-300)) + special.xlogy(signal, numpy.maximum(b, 1e-300)))
    start = numpy.concatenate([[1, 0, -0.5], numpy.full(count - 1, math.log(0.5))])
    best = None
    for method in ("BFGS", "Nelder-Mead"):
        found = optimize.minimize(nll, start if best is None else best.x, method=method, options={"maxiter": 20000} if method == "Nelder-Mead" else None)
        best = found if best is None or found.fun < best.fun else best
    found = optimize.minimize(nll, best.x, method="BFGS")
    best = found if found.fun < best.fun else best
    sd = 1 if equal else math.exp(best.x[1])
    return best.fun, best.x[0], sd, best.x[2] + numpy.concatenate([[0], numpy.cumsum(numpy.exp(best.x[3:]))])


def compare_ratings(report, session):
    points = session.kind.points
    given = lambda r: int(float(r["response"])) - 1
    noise_rows = [r for r in session.answered if session.level(r) == 0]
    noise = [sum(given(r) == p for r in noise_rows) for p in range(points)]
    entries = report.document["roc"]
    levels = sorted({session.level(r) for r in session.answered} - {0.0})
    report.check("roc", len(entries) == len(levels) + 1, f"expected {len(levels) + 1} entries")
    for at, level in enumerate(levels + [None]):
        mine = [r for r in session.answered if session.level(r) != 0 and (level is None or session.level(r) == level)]
        signal = [sum(given(r) == p for r in mine) for p in range(points)]
        n, s = sum(noise), sum(signal)
        f = numpy.concatenate([[0], numpy.cumsum(noise[::-1]) / n])
        h = numpy.concatenate([[0], numpy.cumsum(signal[::-1]) / s])
        area = numpy.trapz(h, f)
        each = (n + s) / 2
        variance = lambda a: a * (1 - a) * (1 + (each - 1) * (1 - a) / (2 - a) + (each - 1) * a / (1 + a)) / (n * s)
        away = lambda a: (a - area) ** 2 - Z95 ** 2 * variance(a)
        ends = {"low": optimize.brentq(away, 1e-12, area - 1e-9) if area > 1e-8 else 0, "high": optimize.brentq(away, area + 1e-9, 1 - 1e-12) if area < 1 - 1e-8 else 1}
        path = f"roc[{at}]"
        report.same(path, {"level": level, "noise": noise, "signal": signal, "area": {"value": area, "interval": ends},
                           "points": [{"false_alarms": a, "hits": b} for a, b in zip(f, h)]})
        for name, equal in (("equal_variances", True), ("unequal_variances", False)):
            fit = entries[at].get(name)
            if not fit:
                continue
            best, mean, sd, criteria = rating_fit(noise, signal, equal)
            report.check(f"{path}.{name}.log_likelihood", fit["log_likelihood"] >= -best - 1e-3, f"SciPy finds {-best:.6f}")
            report.same(f"{path}.{name}.log_likelihood", -best, 2e-4)
            d = mean / math.sqrt((1 + sd * sd) / 2)
            report.same(f"{path}.{name}", {"mean": mean, "sd": {"value": sd}, "sensitivity": {"value": d},
                                          "area": {"value": stats.norm.cdf(d / math.sqrt(2))}, "criteria": criteria}, 1e-2)


def compare_judgements(report, session):
    entries = []
    numbers = session.kind.design == "numbers"
    for level in sorted({session.level(r) for r in session.answered}):
        given = numpy.array([float(r["response"]) for r in session.answered if session.level(r) == level])
        if numbers:
            mean = student_mean(numpy.log10(given))
            if mean:
                mean = {"value": 10 ** mean["value"], "interval": {k: 10 ** v for k, v in mean["interval"].items()}}
        else:
            mean = student_mean(given)
        entries.append({"level": level, "answers": len(given), "mean": mean, "median": numpy.median(given)})
    report.same("judgements[0].levels", entries)
    if numbers:
        report.same("judgements[0].exponent", slope([math.log10(session.level(r)) for r in session.answered],
                                                    [math.log10(float(r["response"])) for r in session.answered]))


def compare_settings(report, session):
    start = numpy.array([session.level(r) for r in session.answered])
    value = numpy.array([float(r["response"]) for r in session.answered])
    middle = 0.5 * (start.min() + start.max())
    below, above = value[start < middle], value[start > middle]
    report.same("settings[0]", {"settings": len(value), "mean": student_mean(value), "sd": scatter(value), "start_slope": slope(start, value),
                "from_below": {"settings": len(below), "mean": student_mean(below), "sd": scatter(below)},
                "from_above": {"settings": len(above), "mean": student_mean(above), "sd": scatter(above)},
                "side_difference": welch(below, above)})
    steps = (value - 0.1) / 0.01
    report.check("settings[0].settings", all(r["response"] == repr(round(float(r["response"]), 2)) or float(r["response"]) == int(float(r["response"]))
                                             for r in session.answered), "a setting is not a whole number of steps")
    report.check("settings[0].settings", numpy.allclose(steps, numpy.round(steps), atol=1e-6), "settings are off their steps")


def compare_track(report, session):
    """Replays the staircase from its start by its rule, and computes the mean of its reversals."""
    kind = session.kind
    level, run, direction, reversals, size = kind.start, 0, None, [], 0
    for r in session.answered:
        report.check("trials.presented", abs(session.level(r) - level) < 1e-9, f"level {r['level']} where {level} is due")
        run = run + 1 if r["correct"] == "1" else 0
        if r["correct"] == "1" and run < kind.n_down:
            continue
        turn = "down" if r["correct"] == "1" else "up"
        run = 0
        if direction and turn != direction:
            reversals.append(level)
            size = min(size + 1, len(kind.steps) - 1)
        direction = turn
        ladder = math.gcd(*[round(100 * s) for s in kind.steps]) / 100
        lowest = kind.start - math.floor((kind.start - 0.02) / ladder + 1e-6) * ladder
        highest = kind.start + math.floor((0.8 - kind.start) / ladder + 1e-6) * ladder
        level = min(max(level + (-1 if turn == "down" else 1) * kind.steps[size], lowest), highest)
    entries = report.document["estimates"]
    for i, entry in enumerate(entries):
        found = re.match(r"reversals (\d+) to (\d+) of (\d+)", entry["basis"])
        if entry["parameter"] == "reversals":
            report.same(f"estimates[{i}].mean", len(reversals))
        if entry["parameter"] == "threshold" and found:
            first, last, count = map(int, found.groups())
            report.check(f"estimates[{i}].mean", count == len(reversals), f"{count} reversals, replayed {len(reversals)}")
            mine = reversals[first - 1:last]
            report.same(f"estimates[{i}]", {"mean": numpy.mean(mine), "sd": numpy.std(mine, ddof=1)})


def compare_quest(report, session):
    grid = session.kind.grid
    t, s, l = numpy.meshgrid(grid["threshold"], grid["slope"], grid["lapse"], indexing="ij")
    log_weight = numpy.zeros(t.shape)
    for r in session.answered:
        p = 1 - l - (0.5 - l) * numpy.exp(-(session.level(r) / t) ** s)
        log_weight += numpy.log(p if r["correct"] == "1" else 1 - p)
    weight = numpy.exp(log_weight - log_weight.max())
    weight /= weight.sum()
    for i, entry in enumerate(report.document["estimates"]):
        x = {"threshold": numpy.log10(t), "slope": s, "lapse": l}[entry["parameter"]]
        mean = numpy.sum(weight * x)
        sd = math.sqrt(numpy.sum(weight * (x - mean) ** 2))
        if entry["parameter"] == "threshold":
            linear = numpy.sum(weight * t)
            if abs(entry["mean"] - linear) < 1e-6:
                mean, sd = linear, math.sqrt(numpy.sum(weight * (t - linear) ** 2))
            else:
                mean, sd = 10 ** mean, None
        report.same(f"estimates[{i}].mean", mean, 1e-6)
        if sd is not None:
            report.same(f"estimates[{i}].sd", sd, 1e-6)


def compare_curve(report, session):
    lags = collections.defaultdict(list)
    for r in session.answered:
        lags[float(r["lag_s"])].append(r)
    points = []
    for lag, rows in sorted(lags.items()):
        table = collections.Counter((r["correct_response"] == "second", r["response"] == "second") for r in rows)
        found = detection(table[True, True], table[True, False], table[False, True], table[False, False])
        points.append({"after_s": lag, "response_time_s": numpy.mean([float(r["response_time"]) for r in rows]),
                       **{k: found[k] for k in ("hits", "misses", "false_alarms", "correct_rejections", "d_prime")}})
    report.same("response_signal[0].lags", points)
    longest = max(p["response_time_s"] for p in points)
    d, c = numpy.linspace(0, 8, 801)[:, None], numpy.linspace(-4, 4, 801)[None, :]
    tables = [numpy.max(p["hits"] * stats.norm.logcdf(d / 2 - c) + p["misses"] * stats.norm.logcdf(c - d / 2) +
                        p["false_alarms"] * stats.norm.logcdf(-d / 2 - c) + p["correct_rejections"] * stats.norm.logcdf(d / 2 + c), axis=1)
              for p in points]

    def height(p):
        asymptote, log_rate, intercept = p
        if not (0 <= asymptote <= 8 and math.log(0.3) <= log_rate <= math.log(40) and 0 <= intercept <= longest):
            return 1e9
        total = 0.5 * ((log_rate - math.log(3)) / 1.5) ** 2 + 0.5 * (asymptote / 1.8) ** 2
        for point, table in zip(points, tables):
            t = point["response_time_s"] - intercept
            total -= numpy.interp(asymptote * -math.expm1(-math.exp(log_rate) * t) if t > 0 else 0, d[:, 0], table)
        return total
    def best(fixed=None):
        """The lowest height; `fixed` is the index of a parameter and its value."""
        free = [i for i in range(3) if not fixed or i != fixed[0]]

        def whole(part):
            p = numpy.empty(3)
            p[free] = part
            if fixed:
                p[fixed[0]] = fixed[1]
            return p
        starts = [[1.5, math.log(3), 0.1], [2.5, math.log(6), 0.3], [1, math.log(1.5), 0.02], [3, math.log(1), 0.05]]
        found = [optimize.minimize(lambda part: height(whole(part)), numpy.array(start)[free], method="Nelder-Mead",
                                   options={"maxiter": 900}) for start in starts]
        return min(found, key=lambda result: result.fun).fun
    lowest = best()
    entry = report.document["response_signal"][0]
    for index, (name, to) in enumerate((("asymptote", float), ("rate_per_s", math.log), ("intercept_s", float))):
        if not entry[name]:
            continue
        path = f"response_signal[0].{name}"
        above = best((index, to(entry[name]["value"]))) - lowest
        report.check(path + ".value", above < 0.05, f"a better curve has a height lower by {above:.3f}")
        for end, value in entry[name]["interval"].items():
            if value:  # the profile falls by 2.1 from the best curve to either end; the report finds it on a grid
                drop = best((index, to(value))) - lowest
                report.check(f"{path}.interval.{end}", 1.6 < drop < 2.8, f"the height there is lower by {drop:.3f}")


def compare_session(report, session, deep):
    kind = session.kind
    compare_counts(report, session)
    compare_before(report, session)
    if kind.design in ("binary", "confusion"):
        compare_binary_bias(report, session)
        if kind.name != "choice":  # no answer is right
            compare_trade(report, session, deep and getattr(kind, "trade", False))
    if kind.fit:
        compare_fits(report, session)
    if getattr(kind, "detection", None):
        compare_detection(report, session)
    if kind.models:
        compare_discrimination(report, session)
    if kind.design == "binary" and report.document["confusion"]:
        compare_confusion(report, session)
    for design, compare in (("confusion", compare_confusion), ("ratings", compare_ratings), ("ratings", compare_judgements), ("numbers", compare_judgements),
                            ("line", compare_judgements), ("settings", compare_settings)):
        if kind.design == design:
            compare(report, session)
    for name, compare in (("staircase", compare_track), ("quest_plus", compare_quest), ("response_signal", compare_curve)):
        if kind.name == name:
            compare(report, session)


def compare_study(study, sessions, reports):
    """The table of people from their trials, the means and the effects from the people's own figures."""
    document = study.document
    study.same("sessions.found", len(sessions))
    study.same("sessions.counted", len(sessions))
    study.same("sessions.superseded", 0)
    study.same("sessions.incomplete", 0)
    values = collections.defaultdict(dict)
    for at, (code, session) in enumerate(sessions.items()):
        path = f"participants[{at}]"
        rows, answered = session.rows, session.answered
        everyone = session.all
        study.same(path, {"presented": len(rows), "answered": len(answered),
                          "timeouts": sum(r["outcome"] == "timeout" for r in everyone) / len(everyone),
                          "anticipations": sum(r["outcome"] == "anticipation" for r in everyone) / len(everyone)})
        scored = [float(r["correct"]) for r in answered if r["correct"] != "n/a"]
        study.same(path + ".accuracy", numpy.mean(scored) if scored else None)
        study.same(path + ".median_time_s", numpy.median([float(r["response_time"]) for r in answered]))
        own = reports[code].document
        for i, entry in enumerate(document["participants"][at]["fits"]):
            mine = own["fits"][i]
            study.same(f"{path}.fits[{i}]", {k: mine[k] for k in ("threshold", "slope", "lapse")}, 1e-9)
            for name in ("threshold_interval", "slope_interval"):
                if entry[name] and mine[name]:  # a study makes fewer bootstrap replicates than a session
                    exact = own["fits"][i]["prior"] is not None
                    width = mine[name]["high"] - mine[name]["low"]
                    highest = max(abs(level["level"] or 0) for level in own["fits"][i]["levels"])
                    for end in ("low", "high"):  # an end beyond the levels is hardly determined
                        if exact or name == "threshold_interval" and abs(mine[name][end]) <= highest:
                            study.same(f"{path}.fits[{i}].{name}.{end}", mine[name][end], 1e-9 if exact else 0.4, width)
        for i, entry in enumerate(document["participants"][at]["estimates"]):
            study.same(f"{path}.estimates[{i}]", {k: own["estimates"][i][k] for k in ("mean", "sd")}, 1e-9)
        for i, entry in enumerate(document["participants"][at]["measures"]):
            values[entry["measure"], entry["condition"]][code] = entry["value"]
            mine = measure_of(entry, own, session)
            if mine is not None:
                study.same(f"{path}.measures[{i}].value", mine, 1e-9)
    for i, entry in enumerate(document["means"]):
        mine = [float(v) for v in values[entry["measure"], entry["condition"]].values()]
        study.same(f"means[{i}].participants", len(mine))
        proportion = entry["measure"].startswith("proportion correct") or entry["measure"] == "area under the ROC"
        study.same(f"means[{i}].mean", (student_proportion if proportion else student_mean)(mine))
        if len(mine) >= 3:
            study.same(f"means[{i}].sd", numpy.std(mine, ddof=1))
    for i, entry in enumerate(document["effects"]):
        first, second = (values[entry["measure"], entry[k]] for k in ("first", "second"))
        if entry["between_groups"]:
            continue
        gaps = [second[code] - first[code] for code in first if code in second]
        study.same(f"effects[{i}].participants", len(gaps))
        study.same(f"effects[{i}].difference", student_mean(gaps))
        if len(gaps) >= 3 and numpy.std(gaps) > 0:
            study.same(f"effects[{i}].standardised", numpy.mean(gaps) / numpy.std(gaps, ddof=1))


class Mixed:
    """The group's model: intercept and rate differ between people; the likelihood by Laplace's approximation."""

    def __init__(self, spec, people, lapse):
        self.name, self.people = spec["function"], people
        self.lapse, self.guess = lapse, lapse if spec["guess"] == "tied" else spec["guess"]

    def probability(self, z):
        return numpy.clip(self.guess + (1 - self.guess - self.lapse) * core(self.name, z), 1e-12, 1 - 1e-12)

    def log_likelihood(self, intercept, rate, intercept_sd, rate_sd, correlation):
        root = numpy.array([[intercept_sd, 0], [correlation * rate_sd, rate_sd * math.sqrt(max(0, 1 - correlation ** 2))]])
        total, self.modes = 0.0, []
        for u, n, k in self.people:
            design = numpy.column_stack([numpy.ones(len(u)), u])

            def minus(b):
                p = self.probability(design @ (numpy.array([intercept, rate]) + root @ b))
                return -numpy.sum(k * numpy.log(p) + (n - k) * numpy.log1p(-p)) + 0.5 * b @ b
            found = optimize.minimize(minus, numpy.zeros(2), method="BFGS", options={"gtol": 1e-8})
            effects = numpy.array([intercept, rate]) + root @ found.x
            z = design @ effects
            p, step = self.probability(z), 1e-5
            slope_ = (self.probability(z + step) - self.probability(z - step)) / (2 * step)
            information = (design.T * (n * slope_ ** 2 / (p * (1 - p)))) @ design
            total -= found.fun + 0.5 * math.log(numpy.linalg.det(root.T @ information @ root + numpy.eye(2)))
            self.modes.append(effects)
        return total


def compare_groups(study, sessions):
    document = study.document
    kind = next(iter(sessions.values())).kind
    if not kind.fit or kind.fit["guess"] == "false alarms" or kind.fit.get("posterior"):
        return
    log_scale = kind.fit["function"] == "weibull"
    for i, group in enumerate(document["groups"]):
        fit = group["fit"]
        if not fit:
            continue
        path, people, counts = f"groups[{i}].fit", [], []
        for session in sessions.values():
            condition = group["condition"] or session.conditions[0]
            levels, trials, positive = counted(session, condition, log_scale)
            function = Function(kind.fit, levels, trials, positive, log_scale)
            counts.append(function.n.sum())
            unsure = sum(r["response"] == "unsure" for r in session.of(condition))
            if unsure:
                function.weigh(function.best()[1], unsure)
            people.append((function.u, function.weight * function.n, function.weight * function.k))
        model = Mixed(kind.fit, people, fit["lapse"])
        names = ("intercept", "rate", "intercept_sd", "rate_sd", "correlation")
        at = [fit[name] for name in names]
        reported = model.log_likelihood(*at)
        study.same(path + ".log_likelihood", reported, 2e-4)
        modes = model.modes
        for j, (effects, person) in enumerate(zip(modes, people)):
            u = -effects[0] / effects[1]
            study.same(f"{path}.participants[{j}].trials", round(counts[j]))
            study.same(f"{path}.participants[{j}].threshold.value", 10 ** (u / 20) if function.log else u, 1e-3)
            study.same(f"{path}.participants[{j}].slope", math.exp(math.log(effects[1])) / (math.log(10) / 20) if log_scale else 1 / effects[1], 2e-3)
        u = -fit["intercept"] / fit["rate"]
        study.same(path + ".threshold.value", 10 ** (u / 20) if function.log else u, 1e-6)
        study.same(path + ".slope.value", fit["rate"] / (math.log(10) / 20) if log_scale else 1 / fit["rate"], 1e-6)
        # no parameters nearby are more likely
        for j, name in enumerate(names):
            best = reported
            for share in (0.97, 1.03):
                moved = list(at)
                moved[j] = max(-1, min(1, moved[j] * share)) if name == "correlation" else moved[j] * share
                best = max(best, model.log_likelihood(*moved))
            study.check(f"{path}.{name}", best <= reported + 2e-3, f"{name} times 0.97 or 1.03 is more likely by {best - reported:.5f}")


def compare_tables(study, folder):
    """Labels, signs and counts are the same in the JSON, in the tables, and in what study.py makes of them."""
    document = study.document
    with open(folder / "measures.csv", newline="") as file:
        listed = {(r["participant"], r["measure"], r["condition"]): r for r in csv.DictReader(file)}
    mine = {(p["participant"], m["measure"], m["condition"]): m for p in document["participants"] for m in p["measures"]}
    study.check("measures.csv", listed.keys() == mine.keys(), f"rows differ: {sorted(listed.keys() ^ mine.keys())[:3]}")
    for key in listed.keys() & mine.keys():
        study.check("measures.csv", math.isclose(float(listed[key]["value"]), mine[key]["value"], rel_tol=1e-9, abs_tol=1e-12)
                    and listed[key].get("unit", mine[key]["unit"]) == mine[key]["unit"], f"{key}: {listed[key]}, {mine[key]}")
    try:
        import pandas  # noqa: F401
    except ImportError:
        return
    printed = subprocess.run([sys.executable, SCRIPT, folder], capture_output=True, text=True, check=True).stdout
    lines = {tuple(row[:3]): row[3:] for row in csv.reader(printed.splitlines()) if row[0] != "accuracy" or row[1]}
    effects = {(e["measure"], e["first"], e["second"]): e for e in document["effects"] if e["participants"] > 0}
    study.check("study.py", lines.keys() == effects.keys(), f"rows differ: {sorted(lines.keys() ^ effects.keys())[:3]}")
    for key in lines.keys() & effects.keys():
        difference, _, participants = lines[key]
        study.check("study.py", int(participants) == effects[key]["participants"], f"{key}: {participants} participants")
        if effects[key]["difference"]:
            study.check("study.py", math.isclose(float(difference), effects[key]["difference"]["value"], rel_tol=2e-5, abs_tol=1e-9),
                        f"{key}: {difference}, {effects[key]['difference']}")


def compare_r(study, folder, kind):
    """study.R prints the labels, signs and figures of the report, and lme4 finds no better fit of a group."""
    if not shutil.which("Rscript"):
        return
    document = study.document
    printed = subprocess.run(["Rscript", SCRIPT.with_suffix(".R"), folder], capture_output=True, text=True, check=True).stdout
    lines = list(csv.reader(printed.splitlines()))
    groups = {group["condition"] or "all trials": group["fit"] for group in document["groups"] if group["fit"]}
    if kind.name == "unforced":
        groups = {}  # lme4 knows no answers that count as fractions
    for what in ("threshold", "rate", "log_likelihood"):
        study.check("study.R", [row[1] for row in lines if row[0] == what] == list(groups), f"{what}: {lines}, {list(groups)}")
    for name, fit in groups.items():
        found = {row[0]: (float(row[2] or "-inf"), float(row[3])) for row in lines if row[0] != "log_response_time" and row[1] == name}
        reported = {"threshold": -fit["intercept"] / fit["rate"], "rate": fit["rate"], "log_likelihood": fit["log_likelihood"]}
        for what, (theirs, ours) in found.items():
            study.check("study.R", math.isclose(ours, reported[what], rel_tol=1e-5, abs_tol=1e-9), f"{what}: {ours}, {reported[what]}")
        theirs, ours = found["log_likelihood"]
        shared = kind.fit and kind.fit["guess"] != "false alarms"  # lme4 has one guess rate for all
        study.check("study.R", not shared or theirs < ours + 0.02, f"{name}: lme4 finds a more likely fit: {theirs}, {ours}")
    effects = {(e["first"], e["second"]): e for e in document["effects"] if e["measure"] == "mean time of right answers"}
    for _, first, second, value, error in (row for row in lines if row[0] == "log_response_time"):
        effect = effects.get((first, second))
        study.check("study.R", effect is not None, f"log_response_time: {first}, {second}: no such effect in the report")
        if effect and effect["difference"] and abs(float(value)) > 5 * float(error):
            study.check("study.R", (float(value) > 0) == (effect["difference"]["value"] > 0), f"{first}, {second}: another sign")


def measure_of(entry, own, session):
    """The same number in the report of the session, which was compared with the trials; none if it has no such number."""
    name = entry["measure"]
    at = next((i for i, c in enumerate(session.conditions) if c == entry["condition"] or len(session.conditions) == 1), None)
    if at is None:
        return None
    if name in ("threshold", "PSE") and own["fits"]:
        return own["fits"][at]["threshold"]
    if name in ("slope", "spread") and own["fits"]:
        return own["fits"][at]["slope"]
    keys = {"proportion correct": "proportion_correct", "median response time": "median_response_time_s", "LISAS": "lisas_s",
            "inverse efficiency": "inverse_efficiency_s", "boundary": "boundary", "time outside the decision": "nondecision_s",
            "drift": "drift"}
    if name.startswith("mean rating at ") or name.startswith("geometric mean at ") or name.startswith("mean at "):
        level = float(re.search(r"at (\S+)", name).group(1).replace("\u2212", "-"))
        found = min(own["judgements"][0]["levels"], key=lambda entry: abs(entry["level"] - level))
        return found["mean"]["value"] if found["mean"] else None
    tables = {"area under the ROC": ("roc", "area"), "d' of ratings": ("roc", "equal_variances", "sensitivity"),
              "d_a of ratings": ("roc", "unequal_variances", "sensitivity"), "SD with a signal": ("roc", "unequal_variances", "sd"),
              "d'": ("detection", "d_prime"), "criterion c": ("detection", "criterion"), "mean setting": ("settings", "mean"),
              "scatter of settings": ("settings", "sd"), "settings from below minus from above": ("settings", "side_difference"),
              "asymptote of d'": ("response_signal", "asymptote"), "rate of d'": ("response_signal", "rate_per_s"),
              "intercept of d'": ("response_signal", "intercept_s"), "exponent": ("judgements", "exponent")}
    if name == "d'" and at < len(own["instructions"]) and not own["detection"]:
        found = own["instructions"][at]["d_prime"]
        return found["value"] if found else None
    if name in tables:
        found = own[tables[name][0]][-1]
        for key in tables[name][1:]:
            found = found[key]
        return found["value"]
    if name.startswith("d' ("):
        return next(d["value"] for d in own["discrimination"][-1]["d_prime"] if f"d' ({d['model']})" == name)
    if name == "mean time of right answers":
        mad, below = (3.5, 0.15) if session.kind.name == "diffusion" else (None, 0.0)
        rows = [r for r in session.of(session.conditions[at]) if r["correct"] != "n/a"]
        times = numpy.array([float(r["response_time"]) for r in rows])
        return numpy.mean(times[keep(times, below, mad) & numpy.array([r["correct"] == "1" for r in rows])])
    if name == "post-error slowing":
        found = own["instructions"][at]["post_error_slowing_s"]
        return found["value"] if found else None
    if name in keys and at < len(own["instructions"]):
        found = own["instructions"][at][keys[name]]
        return found["value"] if found else None
    return None


# ------------------------------------------------------------------------------------------------------------- runs


def call(turnpoint, *arguments):
    done = subprocess.run([turnpoint, *map(str, arguments)], capture_output=True, text=True, timeout=600)
    if done.returncode != 0:
        raise RuntimeError(f"{arguments[0]}: status {done.returncode}: {done.stderr.strip()[-400:]}")
    return done.stdout


def one(turnpoint, name, seed, deep, spoil=False):
    kind = Kind(name, seed)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        path, database = folder / "corpus.toml", folder / "lab.sqlite"
        path.write_text(kind.text)
        codes = [f"P0{i + 1}" for i in range(len(kind.observers))]
        for code, observer in zip(codes, kind.observers):
            call(turnpoint, "run", path, "--rig", RIG, "--participant", code, "--db", database, "--headless", "--observer", observer)
        call(turnpoint, "export", "--db", database, "--out", folder / "csv")
        with open(next((folder / "csv").rglob("trials.csv")), newline="") as file:
            rows = list(csv.DictReader(file))
        if spoil:
            row = next(r for r in rows if r["trial_type"] == "experimental" and r["correct"] in ("0", "1"))
            row["correct"] = "1" if row["correct"] == "0" else "0"
        sessions, reports = {}, {}
        for code in codes:
            document = json.loads(call(turnpoint, "report", "--db", database, "--participant", code, "--json"))
            for part in ("facts", "station"):
                document.pop(part)
            reports[code] = Compared(document, f"{name} {seed} {code}")
            sessions[code] = Session(kind, [r for r in rows if r["participant_id"] == code])
        if kind.fit and kind.design == "confusion":
            kind.fit = None
        compare_session(reports[codes[0]], sessions[codes[0]], deep)
        document = json.loads(call(turnpoint, "report", "--study", "--mode", "simulated", "--db", database, "--json", "--tables", folder / "tables"))
        study = Compared(document, f"{name} {seed} study")
        compare_study(study, sessions, reports)
        compare_tables(study, folder / "tables")
        if deep:
            compare_r(study, folder / "tables", kind)
        compare_groups(study, sessions)
        return reports[codes[0]], study


def main():
    arguments = sys.argv[1:]
    each, first, turnpoint = 1, 0, arguments.pop(0)
    kinds = []
    while arguments:
        word = arguments.pop(0)
        if word == "--each":
            each = int(arguments.pop(0))
        elif word == "--first":
            first = int(arguments.pop(0))
        else:
            kinds.append(word)
    wrong, left, numbers, compared = [], collections.Counter(), 0, 0
    for name in kinds or KINDS:
        for seed in range(first, first + each):
            for part in one(turnpoint, name, seed, deep=each > 2):
                wrong += part.wrong
                numbers += len(part.numbers)
                compared += len(part.seen & set(part.numbers))
                left.update(part.left())
        print(f"{name}: {each} protocols, {len(wrong)} differences so far", flush=True)
    wrong += unnoticed_changes()
    if not one(turnpoint, "pse", first, deep=False, spoil=True)[0].wrong:
        wrong.append("negative control: a changed answer was not noticed")
    for line in wrong:
        print(line)
    print("not computed again: " + ", ".join(f"{path} ({count})" for path, count in left.most_common(40)))
    print(f"{len(kinds or KINDS)} kinds of task, {each} protocols each: {compared} of {numbers} figures computed again, {len(wrong)} differ")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()

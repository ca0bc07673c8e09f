#!/usr/bin/python3
"""proportions.py [STUDIES]: how often the 95 % interval of a group's mean proportion correct holds the mean of the
population: Student's t as it is, and on the logit scale, which the reports use (analysis/student.hpp). The participants'
proportions follow a beta distribution; each has 60 trials."""
import sys

import numpy
from scipy import special, stats

studies = int(sys.argv[1]) if len(sys.argv) > 1 else 20000
random = numpy.random.default_rng(1)
print("participants, population: t holds it, t leaves 0 to 1, t on the logit scale holds it")
for persons in (5, 10, 20):
    for truth, concentration in ((0.75, 20), (0.9, 20), (0.97, 40)):
        own = random.beta(truth * concentration, (1 - truth) * concentration, (studies, persons))
        correct = random.binomial(60, own) / 60
        mean = correct.mean(1)
        half = stats.t.ppf(0.975, persons - 1) * correct.std(1, ddof=1) / numpy.sqrt(persons)
        inside = numpy.clip(mean, 1e-9, 1 - 1e-9)
        wide = half / (inside * (1 - inside))
        low, high = special.expit(special.logit(inside) - wide), special.expit(special.logit(inside) + wide)
        print(f"{persons:3}, {truth:.2f}: {100 * (abs(mean - truth) <= half).mean():.1f} %, "
              f"{100 * (mean + half > 1).mean():.1f} %, {100 * ((low <= truth) & (truth <= high)).mean():.1f} %")

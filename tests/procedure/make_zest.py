"""Levels and estimates of ZEST and best PEST, computed with questplus (Python) as an independent posterior.

    python3 -m pip install questplus
    python3 make_zest.py > zest.csv

Each row: procedure, answers so far, next level, posterior mean and standard deviation of the threshold.
"""
import warnings

import numpy as np
import questplus

warnings.simplefilter("ignore")
STIMULI = np.arange(-40.0, 0.25, 0.5)
THRESHOLDS = np.arange(-40.0, 0.25, 0.5)
ANSWERS = "1111001111101101110110111101"


def course(kind):
    prior = None
    if kind == "zest":
        weights = np.exp(-0.5 * ((THRESHOLDS + 15) / 8) ** 2)
        prior = {"threshold": weights / weights.sum()}
    quest = questplus.QuestPlus(stim_domain={"intensity": STIMULI}, func="weibull", stim_scale="dB",
                                param_domain={"threshold": THRESHOLDS, "slope": [3.5], "lower_asymptote": [0.5], "lapse_rate": [0.02]},
                                prior=prior, outcome_domain={"response": ["Correct", "Incorrect"]})
    for i in range(len(ANSWERS) + 1):
        marginal = quest.marginal_posterior["threshold"].ravel()
        mean = float((marginal * THRESHOLDS).sum())
        sd = float(np.sqrt((marginal * (THRESHOLDS - mean) ** 2).sum()))
        likeliest = THRESHOLDS[marginal >= marginal.max() * (1 - 1e-9)].mean()
        wanted = mean if kind == "zest" else likeliest
        level = float(STIMULI[np.argmin(np.abs(STIMULI - wanted))])
        print(f"{kind},{ANSWERS[:i]},{level:g},{mean:.9g},{sd:.9g}")
        if i < len(ANSWERS):
            quest.update(stim={"intensity": level}, outcome={"response": "Correct" if ANSWERS[i] == "1" else "Incorrect"})


print(f"# questplus {questplus.__version__}, numpy {np.__version__}")
print("procedure,answers,next,mean,sd")
course("zest")
course("best-pest")

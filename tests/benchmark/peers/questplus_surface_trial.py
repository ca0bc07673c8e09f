# Measures how long one trial of QUEST+ over two dimensions (the contrast sensitivity function of Watson 2017, Example 4)
# takes in the Python package questplus. Arguments: the grid's numbers of contrasts, frequencies, thresholds,
# gradients and floors. Prints "version median slowest", times in milliseconds.
import sys
import time
from importlib.metadata import version

import numpy as np
import questplus

contrasts, frequencies, thresholds, gradients, floors = map(int, sys.argv[1:])
quest = questplus.QuestPlus(
    stim_domain=dict(contrast=np.linspace(-50, 0, contrasts), spatial_freq=np.linspace(0, 40, frequencies), temporal_freq=0),
    param_domain=dict(min_thresh=np.linspace(-50, -30, floors), c0=np.linspace(-60, -40, thresholds),
                      cf=np.linspace(.8, 1.6, gradients), cw=0, slope=3, lower_asymptote=.5, lapse_rate=.01),
    outcome_domain=dict(response=['Y', 'N']), func='csf', stim_scale='dB')
times = []
for i in range(8):
    start = time.perf_counter()
    stimulus = quest.next_stim
    quest.update(stim=stimulus, outcome=dict(response='N' if i % 4 == 3 else 'Y'))
    times.append(1e3 * (time.perf_counter() - start))
print(version('questplus'), np.median(times), max(times))

# Measures how long one trial of QUEST+ takes in the Python package questplus. Arguments: the grid's
# numbers of stimuli, thresholds, slopes and lapse rates. Prints "version median slowest", times in
# milliseconds.
import sys
import time
from importlib.metadata import version

import numpy as np
import questplus

stimuli, thresholds, slopes, lapses = map(int, sys.argv[1:])
quest = questplus.QuestPlus(
    stim_domain=dict(intensity=np.linspace(-40, 0, stimuli)),
    param_domain=dict(threshold=np.linspace(-40, 0, thresholds), slope=np.linspace(.5, 5, slopes),
                      lower_asymptote=[.5], lapse_rate=np.linspace(.005, .04, lapses)),
    outcome_domain=dict(response=['Y', 'N']), func='weibull', stim_scale='dB')
times = []
for i in range(8):
    start = time.perf_counter()
    stimulus = quest.next_stim
    quest.update(stim=stimulus, outcome=dict(response='N' if i % 4 == 3 else 'Y'))
    times.append(1e3 * (time.perf_counter() - start))
print(version('questplus'), np.median(times), max(times))

# Times physics.evaluate() for 1000 points of the 1998 paper's brass membrane. Arguments: the folder of the
# Python package, the frequency, Q and the budget in seconds. Prints the shortest time of a call in seconds.
import sys
import time
sys.path.insert(0, sys.argv[1])
import numpy as np
from turnpoint import physics
membrane = physics.seed_brass()
membrane.quality_factor = float(sys.argv[3])
tones = [physics.Tone(frequency_Hz=float(sys.argv[2]))]
x_m = np.linspace(0, membrane.length_m, 1000)
best, end = float("inf"), time.perf_counter() + float(sys.argv[4])
while best == float("inf") or time.perf_counter() < end:
    start = time.perf_counter()
    physics.evaluate(membrane, tones, x_m, "mode", "peak")
    best = min(best, time.perf_counter() - start)
print(best)

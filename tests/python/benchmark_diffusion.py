"""benchmark_diffusion.py: processor time of one density of the diffusion, in turnpoint, in R's rtdists and in pyddm (if it is
installed), one after another in one run. The parameters: drift 2 per s, boundary 1.2 (s = 1), start half-way, 1000 times from
0.05 to 2 s; with a standard deviation of the drift of 0.8, and with a range of the delay of 0.2 s. For pyddm, the error is
the largest relative one where the density exceeds 1e-3 per s."""
import subprocess
import time

import numpy as np
from turnpoint import analysis

TIMES_S = np.linspace(0.05, 2, 1000)
KINDS = {"no variability": {}, "drift varies": {"drift_sd": 0.08}, "delay varies": {"delay_range_s": 0.2},
         "both vary": {"drift_sd": 0.08, "delay_range_s": 0.2}}


def ours(kind):
    return analysis.first_passage(TIMES_S, np.ones(1000), drift=0.2, boundary=0.12, **KINDS[kind])


def per_density_us(call, repeats):
    call()
    start = time.process_time()
    for _ in range(repeats):
        call()
    return (time.process_time() - start) / repeats / len(TIMES_S) * 1e6


R = """suppressMessages(library(rtdists))
t <- seq(0.05, 2, length.out = 1000)
for (kind in list(c(0, 0), c(0.8, 0), c(0, 0.2), c(0.8, 0.2))) {
  call <- function() ddiffusion(t, "upper", a = 1.2, v = 2, t0 = 0, z = 0.6, sv = kind[1], st0 = kind[2])
  call(); start <- proc.time(); for (i in 1:20) call()
  used <- proc.time() - start
  cat(sum(used[1:2]) / 20 / 1000 * 1e6, "\\n")
}"""
theirs = [float(line) for line in subprocess.run(["Rscript", "-e", R], check=True, capture_output=True, text=True).stdout.split()]
for kind, other in zip(KINDS, theirs):
    mine = per_density_us(lambda: ours(kind), 20)  # noqa: B023
    print(f"{kind}: turnpoint {mine:.2f} us, rtdists {other:.2f} us a density, {other / mine:.1f} times")
try:
    import pyddm
except ImportError:
    print("pyddm is not installed")
else:
    for dt in (0.01, 0.001, 0.0001):
        model = pyddm.Model(drift=pyddm.DriftConstant(drift=2), bound=pyddm.BoundConstant(B=0.6), noise=pyddm.NoiseConstant(noise=1),
                            T_dur=2, dt=dt, dx=0.005)
        solution = model.solve()
        at, found = model.t_domain(), solution.pdf("correct")
        exact = np.exp(analysis.first_passage(np.maximum(at, 1e-9), np.ones(len(at)), drift=0.2, boundary=0.12))
        large = exact > 1e-3
        error = np.abs(found[large] / exact[large] - 1).max()
        start = time.process_time()
        for _ in range(20):
            model.solve()
        used_us = (time.process_time() - start) / 20 * 1e6
        mine_us = len(at) * per_density_us(lambda: ours("no variability"), 20)
        print(f"pyddm, steps of {dt} s: {used_us:.0f} us for {len(at)} times, turnpoint {mine_us:.0f} us ({used_us / mine_us:.1f} "
              f"times); error {error:.1e}")

# Solves the one-mode equation with SciPy, for a comparison of speed and accuracy. Arguments: real
# and imaginary part of k2, b, c, w0, slope, decay, length, number of points, order of the Bessel
# function. The points are evenly spaced from the drive edge to the end, ends included. Each printed
# line is "name;setting;seconds;re im re im ...".
import sys
import time, numpy as np
from scipy.integrate import solve_ivp
from scipy.special import jv
from scipy import __version__ as version
re, im, b, c, w0, slope, decay, length, points, order = map(float, sys.argv[1:])
n = int(points)
k2 = complex(re, im) if im else re
x = np.linspace(0, length, n)
W = (lambda x: w0 * np.exp(-x / decay)) if decay else (lambda x: w0 - slope * x)
W1 = (lambda x: -W(x) / decay) if decay else (lambda x: -slope)
q = lambda x: k2 - (b + c * W1(x) ** 2) / W(x) ** 2
grid = np.linspace(0, length * (1 - 2.5e-3), 400)
local = np.sqrt(np.maximum(0, -np.real(q(grid)))) * (grid[1] - grid[0])
total = np.cumsum(local)
deep = np.flatnonzero(total > 36)
start = grid[deep[0]] if len(deep) else length
def ivp(rtol):
    g1 = 1e-16 * np.sqrt(-q(start) + 0j) if len(deep) else 1e-16 / length
    first = np.array([1e-16 if len(deep) else 0, g1 if np.iscomplexobj(k2) else g1.real])
    inside = x < start
    s = solve_ivp(lambda u, y: [y[1], -q(start - u) * y[0]], [0, start], first, 'DOP853',
                  start - x[inside][::-1], rtol=rtol, atol=rtol * 1e-16)
    v = np.zeros(n, complex)
    v[inside] = s.y[0][::-1] / np.sqrt(W(x[inside]))
    return v
def bessel(_):
    return jv(order, np.sqrt(k2) * np.maximum(0, w0 / slope - x))
jobs = [('SciPy DOP853', '%.0e, %s' % (r, version), ivp, r) for r in (1e-5, 1e-8, 1e-11)]
if not decay: jobs.append(('SciPy jv', version, bessel, 0))
for name, setting, work, argument in jobs:
    best = 1e9
    for _ in range(3):
        a = time.perf_counter(); v = work(argument); best = min(best, time.perf_counter() - a)
    v = v.astype(complex)
    print(name, setting, best, ' '.join('%r %r' % (float(z.real), float(z.imag)) for z in v), sep=';')

#include "station/benchmark/scipy.hpp"

#include <fmt/format.h>

#include <sstream>

#include "station/benchmark/scripts.hpp"

namespace turnpoint::benchmark {

namespace {

/// What the program begins with: the problem's numbers, exactly.
std::string numbers(const OneModeProblem& p) {
  return fmt::format(
      "k2 = complex({}, {}); b = {}; c = {}; w0 = {}; slope = {}; decay = {}; length = {}; n = {}; order = "
      "{}\n",
      p.k_squared.real(), p.k_squared.imag(), p.b, p.c, p.w0, p.slope, p.decay_m, p.length_m, p.x_m.size(),
      p.wedge() ? p.bessel_order() : 0.0);
}

/// Points are n equal steps from the drive edge to the end, both included. Each line that it prints is
/// name;setting;seconds;re im re im ...
constexpr const char* kProgram = R"(
import time, numpy as np
from scipy.integrate import solve_ivp
from scipy.special import jv
from scipy import __version__ as version
if k2.imag == 0: k2 = k2.real
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
)";

}  // namespace

std::vector<ScipyRun> run_scipy(const OneModeProblem& problem) {
  std::vector<ScipyRun> runs;
  for (const auto& line : run_python(numbers(problem) + kProgram)) {
    std::istringstream stream(line);
    ScipyRun run;
    std::string seconds, values;
    if (!std::getline(stream, run.name, ';') || !std::getline(stream, run.setting, ';') ||
        !std::getline(stream, seconds, ';') || !std::getline(stream, values))
      continue;
    run.seconds = std::stod(seconds);
    std::istringstream list(values);
    for (double re = 0, im = 0; list >> re >> im;) run.v.emplace_back(re, im);
    if (run.v.size() == problem.x_m.size()) runs.push_back(std::move(run));
  }
  return runs;
}

}  // namespace turnpoint::benchmark

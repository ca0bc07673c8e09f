#include "physics/bench.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "physics/bench_peers.hpp"
#include "physics/boundary_map.hpp"
#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/field.hpp"

namespace turnpoint::physics {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int points = 1000;

// Best time of as many runs as fit the budget, three at least.
template <class Work>
double best_time(double budget_s, Work work) {
  double best = std::numeric_limits<double>::infinity(), spent = 0;
  for (int i = 0; i < 3 || (spent < budget_s && i < 1000); ++i) {
    const auto start = Clock::now();
    work();
    const double took = std::chrono::duration<double>(Clock::now() - start).count();
    best = std::min(best, took);
    spent += took;
  }
  return best;
}

struct Scene {
  std::string name;
  Surface surface;
  double frequency_Hz;
};

std::vector<Scene> scenes() {
  Surface lossless = seed_brass(), lossy = lossless, curved = lossless, plate = aluminium_plate();
  lossy.quality_factor = 60;
  curved.taper = ExponentialTaper{0.03, 0.12};
  curved.quality_factor = 60;
  return {
      {"seed brass 19.6 kHz, lossless", lossless, 19600},  {"seed brass 45 kHz, lossless", lossless, 45000},
      {"seed brass 19.6 kHz, Q = 60", lossy, 19600},       {"seed brass 45 kHz, Q = 60", lossy, 45000},
      {"exponential taper 30 kHz, Q = 60", curved, 30000}, {"aluminium plate 30 kHz, Q = 60", plate, 30000}};
}

// |v| at the points, last maximum at one.
std::vector<double> amplitudes(const CentreLine& line, const std::vector<double>& x) {
  const auto peak = line.last_peak_m();
  const double unit = line.value(peak.value_or(0)).ln_magnitude();
  std::vector<std::complex<double>> v(x.size());
  std::vector<double> ln(x.size());
  line.evaluate(x, 1.0, unit, v, ln);
  for (double& one : ln) one = std::exp(std::min(one, 300.0));
  return ln;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0, most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, std::abs(a[i] - b[i]));
    most = std::max(most, std::abs(b[i]));
  }
  return worst / most;
}

void bench_rungs(const Scene& scene, double budget_s, std::vector<BenchRow>& rows) {
  const std::vector<double> x = linspace_points(scene.surface, points);
  const auto truth = amplitudes(*make_centre_line(scene.surface, scene.frequency_Hz, Model::modes), x);
  std::vector<std::complex<double>> v(x.size());
  std::vector<double> ln(x.size());
  for (const Model model : all_models) {
    if (model == Model::edge) continue;
    try {
      const double error = largest_difference(
          amplitudes(*make_centre_line(scene.surface, scene.frequency_Hz, model), x), truth);
      const double took = best_time(budget_s, [&] {
        make_centre_line(scene.surface, scene.frequency_Hz, model)->evaluate(x, 1.0, 0.0, v, ln);
      });
      rows.push_back(
          {scene.name, std::string(name(model)), "modes", points, took, model == Model::modes ? -1 : error});
    } catch (const std::domain_error&) {  // this rung does not exist here
    }
  }
}

// `mode` and the peers against the same equation solved another way.
void bench_peers(const Scene& scene, double budget_s, std::vector<BenchRow>& rows) {
  const auto& taper = std::get<LinearTaper>(scene.surface.taper);
  const std::vector<double> x = linspace_points(scene.surface, points);
  PeerProblem problem;
  problem.k_per_m = wavenumber_per_m(scene.surface, scene.frequency_Hz);
  const double m = std::numbers::pi / (2 * taper.slope);
  problem.mu = std::sqrt(m * m + std::numbers::pi * std::numbers::pi / 6);
  for (const double one : x) problem.s_m.push_back((taper.half_width_m - taper.slope * one) / taper.slope);
  problem.s_m.back() = 1e-9;
  const auto exact = amplitudes(*make_centre_line(scene.surface, scene.frequency_Hz, Model::mode), x);
  const auto peak_index =
      static_cast<std::size_t>(std::max_element(exact.begin(), exact.end()) - exact.begin());
  for (const Peer& peer : peers()) {
    std::vector<double> v = peer.solve(problem);
    const double factor = exact[peak_index] / std::abs(v[peak_index]);
    for (double& one : v) one = std::abs(one) * factor;
    const double error = largest_difference(v, exact);
    rows.push_back(
        {scene.name, peer.name, "mode", points, best_time(budget_s, [&] { peer.solve(problem); }), error});
  }
}

}  // namespace

std::vector<BenchRow> bench(double budget_s) {
  std::vector<BenchRow> rows;
  const auto all = scenes();
  const double share = budget_s / (9.0 * static_cast<double>(all.size()));
  for (const Scene& scene : all) {
    bench_rungs(scene, share, rows);
    if (std::isinf(scene.surface.quality_factor)) bench_peers(scene, share, rows);
  }
  const BoundaryMap map(seed_brass(), {Edge::percent(0.5), {}, {}, {}});
  constexpr int lookups = 10000;
  double sum = 0;
  const double took = best_time(share, [&] {
    for (int i = 0; i < lookups; ++i) sum += map.boundary_m(8000 + i).value_or(0);
  });
  rows.push_back({"seed brass, p50 map", "edge", "", lookups, sum > 0 ? took : 0, -1});
  return rows;
}

std::string format(const std::vector<BenchRow>& rows) {
  std::string text =
      "scene                              solver                      points   us/run      ns/point  error\n";
  for (const BenchRow& row : rows) {
    char line[200];
    std::snprintf(line, sizeof line, "%-34s %-27s %6d  %9.2f  %9.2f  ", row.scene.c_str(), row.solver.c_str(),
                  row.points, row.seconds * 1e6, row.seconds * 1e9 / row.points);
    text += line;
    if (row.error >= 0) {
      std::snprintf(line, sizeof line, "%.1e of %s", row.error, row.against.c_str());
      text += line;
    }
    text += '\n';
  }
  return text;
}

}  // namespace turnpoint::physics

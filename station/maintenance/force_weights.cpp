#include "station/maintenance/force_weights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "station/core/limits.hpp"
#include "station/core/number.hpp"
#include "station/core/texts.hpp"
#include "station/core/usage_error.hpp"
#include "station/maintenance/calibrate.hpp"
#include "station/maintenance/panel_latency.hpp"
#include "station/rig/apply.hpp"
#include "station/sensing/tap.hpp"

namespace turnpoint::maintenance {

namespace {

using core::phrase, core::plain;

constexpr double kRatedLoad_N = 10;
// largest allowed change and SD of the zero reading; sessions use the same limits before a trial
constexpr double kMoved_N = 20e-3, kRestless_N = 2e-3;
// refuse a reading whose SD is this many times that of the first reading
constexpr double kRestlessShare = 10;
constexpr double kRipple = 1e-4;  // SD that remains after demodulation, as a fraction of the reading
// a cell does not respond if it changes by less than this share of the others
constexpr double kDeaf_share = 0.01;
constexpr double kOutlier = 4;  // ask again for a weight whose sensing::deviations() is larger than this
constexpr std::size_t kMostRepeats = 4, kFewest = 8;
constexpr int kMostTaps = 3;  // how often a tap that shows no resonance is asked for
// Residuals larger than this multiple of the errors of places, masses and pulley show that something else is
// wrong.
constexpr double kMostMisfit = 20;

constexpr std::array<const char*, 3> kCells{"a", "b", "lateral"};

double newtons(double grams) { return 1e-3 * grams * kGravity_m_s2; }

/// Grams and place of a weight, and the grams that pull if there are any.
std::vector<core::Phrase> values_of(const WeightStep& step) {
  std::vector<core::Phrase> values{core::plain(core::number(step.mass_g)),
                                   core::plain(core::number(step.position_mm, 4))};
  if (step.pull_g != 0) values.push_back(core::plain(core::number(std::abs(step.pull_g))));
  return values;
}

/// The reading with one weight, and the reading without a weight (tare) before it.
struct Weighed {
  WeightStep step;
  BridgeReading with, without;

  double in_phase(std::size_t cell) const { return with.ratio[cell] - without.ratio[cell]; }
  double across(std::size_t cell) const { return with.quadrature[cell] - without.quadrature[cell]; }
};

/// Returns the phase of each bridge's signal (rad), from the weight that changes the signal most.
std::array<double, 3> rotations(const std::vector<Weighed>& all) {
  std::array<double, 3> rotation{}, largest{};
  for (std::size_t cell = 0; cell < 3; ++cell)
    for (const auto& one : all) {
      const double size = std::hypot(one.in_phase(cell), one.across(cell));
      if (size <= largest[cell]) continue;
      largest[cell] = size;
      // a bridge may be connected with either polarity, so the phase is found modulo pi
      rotation[cell] = std::atan(one.across(cell) / one.in_phase(cell));
    }
  const double most = *std::max_element(largest.begin(), largest.end());
  for (std::size_t cell = 0; cell < 3; ++cell)
    if (!(largest[cell] > kDeaf_share * most))
      throw core::Refusal(phrase("weights.no_response", {plain(kCells[cell])}));
  return rotation;
}

sensing::Readings rotated(const Weighed& one, const std::array<double, 3>& rotation) {
  sensing::Readings readings{};
  for (std::size_t cell = 0; cell < 3; ++cell)
    readings[cell] =
        one.in_phase(cell) * std::cos(rotation[cell]) + one.across(cell) * std::sin(rotation[cell]);
  return readings;
}

/// Returns the reading of each cell at its rated load, scaled up from the weight that loads the cell most.
std::array<double, 3> rated_ratios(const std::vector<sensing::DeadWeight>& weights) {
  std::array<double, 3> rated{};
  double most_N = 0, most_pull_N = 0;
  for (const auto& weight : weights) {
    most_N = std::max(most_N, std::abs(weight.normal_N));
    most_pull_N = std::max(most_pull_N, std::abs(weight.lateral_N));
    for (std::size_t cell = 0; cell < 3; ++cell)
      rated[cell] = std::max(rated[cell], std::abs(weight.readings[cell]));
  }
  for (std::size_t cell = 0; cell < 3; ++cell)
    rated[cell] *= kRatedLoad_N / (cell == 2 ? most_pull_N : most_N);
  return rated;
}

/// The phases of the bridges, and the weights with their readings, in the order in which they were weighed.
struct Fitted {
  std::array<double, 3> rotation_rad{};
  std::vector<sensing::DeadWeight> weights;
};

Fitted fitted(const std::vector<Weighed>& all) {
  Fitted made{rotations(all), {}};
  for (const auto& one : all)
    made.weights.push_back({newtons(one.step.mass_g), newtons(one.step.pull_g), one.step.position_mm,
                            rotated(one, made.rotation_rad)});
  return made;
}

/// Returns the readings of the cells under a load. Inverts the matrix `k` by Cramer's rule.
sensing::Readings readings_under(const sensing::ForceCalibration::Matrix& k,
                                 const std::array<double, 3>& load) {
  const auto determinant = [](const sensing::ForceCalibration::Matrix& m) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  };
  sensing::Readings readings{};
  for (std::size_t row = 0; row < 3; ++row) {
    auto with = k;
    with[row] = load;
    readings[row] = determinant(with) / determinant(k);
  }
  return readings;
}

sensing::WeightFit fit_of(const std::vector<sensing::DeadWeight>& weights) {
  try {
    return sensing::fit_weights(weights);
  } catch (const core::UsageError&) {
    throw core::Refusal(phrase("weights.not_apart"));
  }
}

/// Asks the operator for each step of the calibration, and keeps the readings.
class Weighing {
 public:
  Weighing(BridgeReader& bridges, const std::function<bool(const WeightStep&)>& ready,
           const std::function<bool(const core::Phrase&)>& failed)
      : bridges_(bridges), ready_(ready), failed_(failed) {}

  void take(const WeightStep& step) {
    const auto reading = read(step);
    if (!reading) return;
    if (step.tare)
      tares_.push_back(*reading);
    else if (tares_.empty())
      throw core::Refusal(phrase("weights.first_step"));
    else
      all_.push_back({step, *reading, tares_.back()});
  }

  /// Asks the operator to weigh again each weight that does not agree with the others.
  void repeat_outliers() {
    while (true) {
      enough();
      const auto weights = fitted(all_).weights;
      static_cast<void>(fit_of(weights));
      const auto deviations = sensing::deviations(weights);
      const auto worst = std::max_element(deviations.begin(), deviations.end());
      if (!(*worst > kOutlier)) return;
      const auto index = static_cast<std::size_t>(worst - deviations.begin());
      auto step = all_[index].step;
      const auto found = found_without(weights, index);
      if (!step.remark.empty() || repeated_.size() == kMostRepeats)
        throw core::Refusal(phrase("weights.still_disagrees", {step.name(), found}));
      step.remark = core::phrase("weights.disagrees", {step.name(), found});
      repeated_.push_back(step);
      all_.erase(all_.begin() + static_cast<std::ptrdiff_t>(index));
      take({true, 0, 0, 0, step.remark});
      take(step);
    }
  }

  /// Asks for a tap. Returns the frequency with which the plate rings, or nothing if the step was left out.
  std::optional<double> tap(Tap where) {
    if (!bridges_.notices_taps()) return std::nullopt;
    WeightStep step;
    step.tap = where;
    for (int k = 0; k < kMostTaps && ready_(step); ++k) try {
        if (const auto found_Hz = bridges_.tapped_Hz(where)) return found_Hz;
        if (!failed_(phrase("weights.no_ring"))) return std::nullopt;
      } catch (const std::runtime_error& error) {
        if (!failed_(core::phrase_of(error))) throw;
      }
    return std::nullopt;
  }

  const std::vector<Weighed>& all() const { return all_; }
  const std::vector<BridgeReading>& tares() const { return tares_; }
  const std::vector<WeightStep>& repeated() const { return repeated_; }

 private:
  void enough() const {
    if (all_.size() < kFewest) throw core::Refusal(phrase("weights.too_few", {plain(kFewest)}));
  }

  std::optional<BridgeReading> read(const WeightStep& step) {
    while (ready_(step)) try {
        const auto reading = bridges_.read(step);
        rests(reading);
        return reading;
      } catch (const core::UsageError&) {
        throw;
      } catch (const std::runtime_error& error) {
        if (!failed_(core::phrase_of(error))) throw;
      }
    return std::nullopt;
  }

  void rests(const BridgeReading& reading) const {
    if (tares_.empty()) return;
    for (std::size_t cell = 0; cell < 3; ++cell) {
      const double before = tares_.front().sd[cell];
      if (reading.sd[cell] > kRestlessShare * before + kRipple * std::abs(reading.ratio[cell]))
        throw core::Failure(
            phrase("weights.restless",
                   {plain(kCells[cell]), plain(fmt::format("{:.0f}", reading.sd[cell] / before))}));
    }
  }

  /// Returns the load that a calibration with the other weights finds for weight `index`, as text.
  static core::Phrase found_without(std::vector<sensing::DeadWeight> weights, std::size_t index) {
    const auto readings = weights[index].readings;
    weights.erase(weights.begin() + static_cast<std::ptrdiff_t>(index));
    const auto force = sensing::fit_weights(weights).calibration.force(readings);
    const auto tenths = [](double value) {
      return core::plain(core::number(std::round(10 * value) / 10 + 0.0, 5));
    };
    const auto grams = [&](double force_N) { return tenths(1e3 * force_N / kGravity_m_s2); };
    return core::phrase("weights.found", {grams(force.normal_N), tenths(force.moment_Nmm / force.normal_N),
                                          grams(force.lateral_N)});
  }

  BridgeReader& bridges_;
  const std::function<bool(const WeightStep&)>& ready_;
  const std::function<bool(const core::Phrase&)>& failed_;
  std::vector<Weighed> all_;
  std::vector<BridgeReading> tares_;
  std::vector<WeightStep> repeated_;
};

/// Throws if the weights do not agree with each other, or if the readings without a weight vary or drift too
/// much.
void check(const ForceResult& made, const std::vector<BridgeReading>& tares) {
  constexpr std::array<const char*, 3> loads{"weights.normal", "weights.pull", "weights.place"};
  for (std::size_t k = 0; k < 3; ++k)
    if (!(made.misfit[k] < kMostMisfit))
      throw core::Refusal(
          phrase("weights.misfit", {phrase(loads[k]), plain(core::number(made.misfit[k], 2))}));
  double shaken_N = 0;
  for (const auto& tare : tares)
    for (std::size_t cell = 0; cell < 3; ++cell)
      shaken_N = std::max(shaken_N, kRatedLoad_N * tare.sd[cell] / made.cells.rated_ratio[cell]);
  if (shaken_N > kRestless_N)
    throw core::Refusal(phrase("weights.unsteady", {plain(core::number(1e3 * shaken_N, 2)),
                                                    plain(core::number(1e3 * kRestless_N, 2))}));
  if (made.zero_moved_mN > 1e3 * kMoved_N)
    throw core::Refusal(phrase("weights.zero_moved", {plain(core::number(made.zero_moved_mN, 3))}));
}

}  // namespace

core::Phrase WeightStep::name() const {
  if (pull_g == 0) return core::phrase("weights.weight", values_of(*this));
  return core::phrase(pull_g > 0 ? "weights.weight_narrow" : "weights.weight_wide", values_of(*this));
}

core::Phrase WeightStep::text() const {
  if (tare) return core::phrase("weights.clear");
  if (tap == Tap::from_above) return core::phrase("weights.tap_above");
  if (tap == Tap::along) return core::phrase("weights.tap_along");
  if (pull_g == 0) return core::phrase("weights.put", values_of(*this));
  return core::phrase(pull_g > 0 ? "weights.pull_narrow" : "weights.pull_wide", values_of(*this));
}

std::vector<WeightStep> weight_steps(double length_mm) {
  std::vector<WeightStep> steps;
  for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    steps.push_back({true, 0, 0, 0});
    for (const double mass_g : {20, 50, 100, 200}) steps.push_back({false, mass_g, share * length_mm, 0});
  }
  for (const double share : {0.3, 0.7}) {
    steps.push_back({true, 0, 0, 0});
    for (const double sign : {1, -1})
      for (const double pull_g : {20, 50, 100})
        steps.push_back({false, 200, share * length_mm, sign * pull_g});
  }
  return steps;
}

std::optional<double> ringing_of(const std::array<std::vector<double>, 3>& readings, double rate_Hz) {
  const std::vector<double>* most = nullptr;
  double deflection = 0;
  for (const auto& cell : readings) {
    const auto [low, high] = std::minmax_element(cell.begin(), cell.end());
    if (low != cell.end() && *high - *low > deflection) most = &cell, deflection = *high - *low;
  }
  return most != nullptr ? sensing::ringing_Hz(*most, rate_Hz) : std::nullopt;
}

ForceResult weigh(const rig::Rig& rig, BridgeReader& bridges,
                  const std::function<bool(const WeightStep&)>& ready,
                  const std::function<bool(const core::Phrase&)>& failed) {
  Weighing weighing(bridges, ready, failed);
  for (const auto& step : weight_steps(1e3 * rig.surface.length_m)) weighing.take(step);
  weighing.repeat_outliers();
  const auto [rotation_rad, weights] = fitted(weighing.all());
  const auto fit = fit_of(weights);
  ForceResult made;
  for (const auto& one : weighing.all()) made.steps.push_back(one.step);
  made.repeated = weighing.repeated();
  made.residuals = fit.residuals;
  made.misfit = fit.misfit;
  made.cells.rotation_rad = rotation_rad;
  made.cells.matrix = fit.calibration.matrix();
  made.cells.changes = fit.calibration.changes();
  const auto& tares = weighing.tares();
  made.cells.reference_amplitude = tares.front().reference;
  if (tares.front().reference > 0) made.cells.carrier_Hz = core::kForceCarrier_Hz;
  made.cells.rated_ratio = rated_ratios(weights);
  const double middle_Nmm = 0.5 * 0.5e3 * rig.surface.length_m;
  made.sd = fit.calibration.sd(readings_under(made.cells.matrix, {0.5, 0.25, middle_Nmm}));
  for (std::size_t k = 1; k < tares.size(); ++k) {
    const auto moved = fit.calibration.force(rotated({{}, tares[k], tares[k - 1]}, rotation_rad));
    made.zero_moved_mN =
        std::max(made.zero_moved_mN, 1e3 * std::max(std::abs(moved.normal_N), std::abs(moved.lateral_N)));
  }
  check(made, tares);
  const auto above_Hz = weighing.tap(Tap::from_above), along_Hz = weighing.tap(Tap::along);
  if (above_Hz && along_Hz) {
    made.resonance_Hz = std::min(*above_Hz, *along_Hz);
    made.cells.usable_Hz = sensing::kUsableShare * *made.resonance_Hz;
  }
  return made;
}

std::string write_forces(const rig::Rig& rig, const rig::ForceCells& cells, const std::string& path) {
  auto made = known_calibration(rig, path);
  made.forces = cells;
  const auto out = path.empty() ? rig::file_for(rig.path, rig::today()) : path;
  write_calibration(made, rig, out);
  return out;
}

}  // namespace turnpoint::maintenance

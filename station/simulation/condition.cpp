#include "station/simulation/condition.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "station/simulation/delay.hpp"

namespace turnpoint::simulation {

namespace {

double amount_of(const Fault& fault) {
  if (fault.amount) return *fault.amount;
  switch (fault.kind) {
    case FaultKind::resonance_off:
    case FaultKind::frequency_off:
      return 0.03;
    case FaultKind::drive_late:
      return 0.005;
    case FaultKind::clip:
      return 0.5;
    case FaultKind::gap:
      return 480;
    case FaultKind::warmer:
      return 10;
    case FaultKind::sounding:
      return 0.05;
    default:
      return 0;
  }
}

[[noreturn]] void refuse(const std::string& why) { throw std::invalid_argument("plant: " + why); }

void check_channel(int channel, int count, const std::string& what) {
  if (channel < 0 || channel >= count)
    refuse(what + ": there is no channel " + std::to_string(channel) + ", only 0 to " +
           std::to_string(count - 1));
}

void check_capture(const Setup& setup) {
  std::vector<int> used;
  const auto use = [&](int channel, const std::string& what) {
    check_channel(channel, setup.capture.count, what);
    if (std::find(used.begin(), used.end(), channel) != used.end())
      refuse(what + ": capture channel " + std::to_string(channel) + " is used twice");
    used.push_back(channel);
  };
  if (setup.capture.reference) use(*setup.capture.reference, "reference");
  if (setup.capture.bridge_a) use(*setup.capture.bridge_a, "bridge a");
  if (setup.capture.bridge_b) use(*setup.capture.bridge_b, "bridge b");
  if (setup.capture.lateral) use(*setup.capture.lateral, "lateral bridge");
  if (setup.capture.marker) use(*setup.capture.marker, "marker");
  for (const auto& pickup : setup.pickups) use(pickup.channel, "pick-up");
}

constexpr std::array<std::string_view, 13> kNames{
    "transducer dead", "transducer half", "resonance off", "frequency off", "drive late", "clip",
    "broken bridge",   "no reference",    "finger lifts",  "gap",           "warmer",     "sounding",
    "dead bridge"};

}  // namespace

std::string_view name(FaultKind kind) { return kNames.at(static_cast<std::size_t>(kind)); }

std::optional<FaultKind> find_fault(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<FaultKind>(found - kNames.begin());
}

Condition condition_at(const Setup& setup, const std::vector<Fault>& faults, std::int64_t frame) {
  Condition c;
  c.transducer_gain.fill(1);
  c.warmth_K = setup.temperature_C - setup.surface_temperature_C;
  for (const auto& fault : faults) {
    if (frame < fault.from_frame || frame >= fault.to_frame) continue;
    const double amount = amount_of(fault);
    const auto index = static_cast<std::size_t>(fault.index);
    switch (fault.kind) {
      case FaultKind::transducer_dead:
        c.transducer_gain[index] = 0;
        break;
      case FaultKind::transducer_half:
        c.transducer_gain[index] *= 0.5;
        break;
      case FaultKind::resonance_off:
        c.resonance *= 1 + amount;
        break;
      case FaultKind::frequency_off:
        c.frequency *= 1 + amount;
        break;
      case FaultKind::drive_late:
        c.late_frames += std::llround(amount * setup.rate_Hz);
        break;
      case FaultKind::clip:
        c.clip = std::min(c.clip, amount);
        break;
      case FaultKind::broken_bridge:
        c.bridge_open[index] = true;
        break;
      case FaultKind::dead_bridge:
        c.bridge_dead[index] = true;
        break;
      case FaultKind::no_reference:
        c.no_reference = true;
        break;
      case FaultKind::finger_lifts:
        c.lifted = true;
        break;
      case FaultKind::gap:
        break;
      case FaultKind::warmer:
        c.warmth_K += amount;
        break;
      case FaultKind::sounding:
        c.sounding_um += amount;
        break;
    }
  }
  // A plate's resonance frequencies are proportional to sqrt(E / rho) h / W^2 (modulus, density, thickness,
  // half-width). When the plate warms up, all lengths grow, and the density falls with the third power of the
  // lengths.
  c.resonance *= 1 + 0.5 * (setup.expansion_per_K + setup.modulus_per_K) * c.warmth_K;
  return c;
}

std::int64_t frames_lost(const Fault& fault) {
  return fault.kind == FaultKind::gap ? std::llround(amount_of(fault)) : 0;
}

void validate(const Setup& setup, const std::vector<Fault>& faults) {
  if (setup.rate_Hz < 8000) refuse("rate_Hz must be at least 8000");
  if (!(setup.surface.quality_factor < 1e6)) refuse("the surface needs a finite quality factor");
  if (!(setup.loop_delay_frames >= 0)) refuse("loop_delay_frames must not be negative");
  if (setup.transducers.size() > kMostTransducers)
    refuse("at most " + std::to_string(kMostTransducers) + " transducers");
  for (const auto& t : setup.transducers) check_channel(t.channel, setup.playback_channels, "transducer");
  if (const auto c = setup.wires.carrier_channel) check_channel(*c, setup.playback_channels, "carrier");
  if (const auto c = setup.marker_channel) check_channel(*c, setup.playback_channels, "marker");
  check_capture(setup);

  const double whole = std::floor(setup.loop_delay_frames);
  double left = whole - (setup.loop_delay_frames != whole ? Delay::kLeast : 0);
  double late_s = 0;
  for (const auto& fault : faults) {
    const bool of_a_cell = fault.kind == FaultKind::broken_bridge || fault.kind == FaultKind::dead_bridge;
    const int count = of_a_cell ? 3 : static_cast<int>(setup.transducers.size());
    if (fault.index < 0 || fault.index >= std::max(count, 1))
      refuse("the fault's index must be below " + std::to_string(count));
    const double amount = amount_of(fault);
    const bool factor = fault.kind == FaultKind::resonance_off || fault.kind == FaultKind::frequency_off;
    if (factor && !(std::abs(amount) < 0.5))
      refuse("a frequency or a resonance can be off by less than a half");
    if (!factor && fault.kind != FaultKind::warmer && !(amount >= 0))
      refuse("a fault's amount must not be negative");
    if (fault.kind == FaultKind::drive_late) late_s += amount;
    left -= static_cast<double>(frames_lost(fault));
  }
  if (left < 0)
    refuse("the loop delay must exceed the frames that gaps lose, by " + std::to_string(Delay::kLeast) +
           " frames if it has a fraction");
  if (late_s > 1) refuse("the drive can be late by at most 1 s");
}

Setup validated(const Setup& setup) {
  validate(setup, {});
  return setup;
}

}  // namespace turnpoint::simulation

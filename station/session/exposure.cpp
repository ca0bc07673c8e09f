#include "station/session/exposure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "station/core/limits.hpp"

namespace turnpoint::session {

Exposure::Exposure(const ExposureLimits& limits, double session_start_s, const std::vector<Exposed>& history)
    : limits_(limits), session_start_s_(session_start_s) {
  if (!(limits.displacement_m > 0 && limits.continuous_s > 0 && limits.session_s > 0 && limits.duty > 0 &&
        limits.duty <= 1))
    throw std::invalid_argument(
        fmt::format("limits of {} m, {} s continuous, duty {}, {} s a session; all must be above 0, and the "
                    "duty at most 1",
                    limits.displacement_m, limits.continuous_s, limits.duty, limits.session_s));
  for (const Exposed& exposed : history) add(exposed);
}

void Exposure::add(const Exposed& exposed) {
  if (!(exposed.end_s >= exposed.start_s) || (!recent_.empty() && exposed.start_s < recent_.back().start_s))
    throw std::invalid_argument(
        fmt::format("an exposure from {} to {} s is not in order of time", exposed.start_s, exposed.end_s));
  recent_.push_back(exposed);
  const double kept = window_s + limits_.continuous_s;
  while (recent_.front().end_s < exposed.start_s - kept) recent_.pop_front();
}

double Exposure::on_time_s(double from_s, double to_s) const {
  double sum = 0;
  for (const Exposed& e : recent_)
    sum += std::max(0.0, std::min(e.end_s, to_s) - std::max(e.start_s, from_s));
  return sum;
}

void Exposure::check(double displacement_m, double length_s) const {
  if (!(displacement_m <= limits_.displacement_m))
    throw LimitExceeded(fmt::format("displacement of {:.3f} um; the rig allows {:.3f} um",
                                    displacement_m * 1e6, limits_.displacement_m * 1e6));
  if (!(length_s <= limits_.continuous_s))
    throw LimitExceeded(fmt::format("stimulus of {:.3f} s; the rig allows {:.3f} s without a rest", length_s,
                                    limits_.continuous_s));
  if (!(length_s <= limits_.duty * window_s))
    throw LimitExceeded(fmt::format("stimulus of {:.3f} s; the rig allows {:.3f} s in any {} s", length_s,
                                    limits_.duty * window_s, window_s));
}

// Only the time window that ends with this stimulus needs to be checked, because the duty cycle is largest
// there.
bool Exposure::fits(double start_s, double length_s) const {
  constexpr double rounding_s = 1e-9;
  const double end_s = start_s + length_s;
  if (on_time_s(end_s - window_s, start_s) + length_s > limits_.duty * window_s + rounding_s) return false;
  double run_start_s = start_s;
  for (auto e = recent_.rbegin(); e != recent_.rend() && run_start_s - e->end_s < rest_s - rounding_s; ++e)
    run_start_s = e->start_s;
  return end_s - run_start_s <= limits_.continuous_s + rounding_s;
}

double Exposure::earliest_start_s(double wanted_s, double length_s) const {
  check(0, length_s);
  double start_s = recent_.empty() ? wanted_s : std::max(wanted_s, recent_.back().end_s);
  if (!fits(start_s, length_s)) {
    // If a stimulus may begin at some time, it may also begin at any later time. Therefore bisection finds
    // the earliest time. `late_s` is always allowed: by then, all earlier stimuli have left the window.
    double too_soon_s = start_s, late_s = start_s + window_s + rest_s;
    for (int k = 0; k < 60; ++k) {
      const double middle_s = 0.5 * (too_soon_s + late_s);
      (fits(middle_s, length_s) ? late_s : too_soon_s) = middle_s;
    }
    start_s = late_s;
  }
  if (start_s + length_s > session_start_s_ + limits_.session_s)
    throw LimitExceeded(fmt::format("the session's time of {:.1f} min is used up", limits_.session_s / 60));
  return start_s;
}

// If any stimulus of the trial has to wait, the whole trial waits, because the gaps between its stimuli are
// part of the design.
double Exposure::earliest_start_s(double wanted_s, std::span<const Exposed> trial) const {
  constexpr int most_tries = 1000;
  double start_s = wanted_s;
  for (int k = 0; k < most_tries; ++k) {
    Exposure account = *this;
    double late_s = 0;
    for (const Exposed& part : trial) {
      const double wish_s = start_s + part.start_s, length_s = part.end_s - part.start_s;
      late_s = account.earliest_start_s(wish_s, length_s) - wish_s;
      if (late_s > 1e-6) break;
      account.add({wish_s, wish_s + length_s});
    }
    if (late_s <= 1e-6) return start_s;
    start_s += late_s;
  }
  throw LimitExceeded(
      "the intervals of a trial are together too long for the rig's limits, however long the pauses are; "
      "shorten them");
}

namespace {

/// Returns the first measured level at or above the frequency. Returns end() if the frequency lies outside
/// the measured range.
auto measured_from(double frequency_Hz, const std::vector<SoundLevel>& measured) {
  const auto above = std::find_if(measured.begin(), measured.end(), [=](const SoundLevel& level) {
    return level.frequency_Hz >= frequency_Hz;
  });
  const bool outside =
      above == measured.begin() && above != measured.end() && above->frequency_Hz > frequency_Hz;
  return outside ? measured.end() : above;
}

}  // namespace

bool sound_measured(double frequency_Hz, const std::vector<SoundLevel>& measured) {
  return measured_from(frequency_Hz, measured) != measured.end();
}

std::optional<core::Phrase> sound_problem(double frequency_Hz, double amplitude,
                                          const std::vector<SoundLevel>& measured) {
  using core::phrase, core::plain;
  if (!(amplitude > 0)) return std::nullopt;
  const auto tone_Hz = plain(fmt::format("{:.1f}", frequency_Hz));
  const auto above = measured_from(frequency_Hz, measured);
  if (above == measured.end()) {
    if (frequency_Hz >= core::kAudible_Hz) return std::nullopt;
    return phrase("refusal.sound_not_measured", {tone_Hz, plain(fmt::format("{}", core::kAudible_Hz))});
  }
  double full_scale_dB = above->level_dB;
  if (above->frequency_Hz != frequency_Hz) {
    const SoundLevel& below = *(above - 1);
    // Between two measured frequencies use the louder level: resonances make interpolation unreliable.
    full_scale_dB = std::max(below.level_dB, above->level_dB);
  }
  const double level_dB = full_scale_dB + 20 * std::log10(amplitude);
  const double allowed_dB = core::allowed_sound_dB(frequency_Hz);
  if (level_dB <= allowed_dB) return std::nullopt;
  return phrase("refusal.too_loud",
                {tone_Hz, plain(fmt::format("{:.1f}", level_dB)), plain(fmt::format("{}", allowed_dB))});
}

}  // namespace turnpoint::session

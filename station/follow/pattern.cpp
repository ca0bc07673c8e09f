#include "station/follow/pattern.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "station/follow/need.hpp"

namespace turnpoint::follow {
namespace {

constexpr double release_share = 0.8, release_m = 0.3e-3;

/// A raised cosine from 0 at -1/2 to 1 at 1/2.
double raised_cosine(double u) {
  if (u <= -0.5) return 0;
  if (u >= 0.5) return 1;
  return 0.5 + 0.5 * std::sin(std::numbers::pi * u);
}

double table_value(const Pattern& pattern, const Part& part, double cycle) {
  const double at = cycle * part.table_count;
  const int i = std::min(static_cast<int>(at), part.table_count - 1);
  const int next = i + 1 < part.table_count ? i + 1 : 0;
  const auto sample = [&](int k) {
    return static_cast<double>(pattern.table[static_cast<std::size_t>(part.table_first + k)]);
  };
  return sample(i) + (at - i) * (sample(next) - sample(i));
}

/// The part's share of its range: 0 for `from`, 1 for `to`.
double share_of(const Pattern& pattern, const Part& part, double place_m, double time_s) {
  const double from_place = place_m - part.place_m;
  switch (part.shape) {
    case Shape::constant:
      return 1;
    case Shape::gradient:
      return std::clamp((place_m - part.begin_m) / (part.end_m - part.begin_m), 0.0, 1.0);
    case Shape::bump:
      return raised_cosine(0.5 - 2 * std::abs(from_place) / part.width_m);
    case Shape::edge:
      return part.width_m > 0 ? raised_cosine(from_place / part.width_m) : from_place >= 0;
    default:
      break;
  }
  const double u = part.cycles_per_m * from_place + part.cycles_per_s * time_s + part.phase_cycles;
  const double cycle = u - std::floor(u);
  switch (part.shape) {
    case Shape::sine:
      return 0.5 + 0.5 * std::sin(2 * std::numbers::pi * cycle);
    case Shape::square:
      return cycle < 0.5 ? 1 : 0;
    case Shape::triangle:
      return 1 - std::abs(2 * cycle - 1);
    default:
      return table_value(pattern, part, cycle);
  }
}

bool acts(const Trigger& trigger, const PatternState& state, std::size_t i, double time_s) {
  if (trigger.event == Event::none) return true;
  const double begin_s = state.since_s[i] + trigger.delay_s;
  return state.active[i] && time_s >= begin_s && time_s < begin_s + trigger.lasts_s;
}

double density_at(std::span<const SpectrumPoint> spectrum, double cycles_per_m) {
  for (std::size_t i = 1; i < spectrum.size(); ++i) {
    const auto &a = spectrum[i - 1], &b = spectrum[i];
    if (cycles_per_m < a.cycles_per_m || cycles_per_m > b.cycles_per_m) continue;
    const double t = (cycles_per_m - a.cycles_per_m) / (b.cycles_per_m - a.cycles_per_m);
    return a.density + t * (b.density - a.density);
  }
  return 0;
}

}  // namespace

void add(Pattern& pattern, const Part& part) {
  need(pattern.part_count < kMostParts, "pattern: more than 8 parts");
  for (const double value : {part.from, part.to, part.cycles_per_m, part.cycles_per_s, part.phase_cycles,
                             part.place_m, part.width_m, part.trigger.threshold, part.trigger.delay_s})
    need(std::isfinite(value), "pattern: a value is not finite");
  need(part.begin_m < part.end_m, "pattern: begin_m is not below end_m");
  need(part.trigger.delay_s >= 0 && part.trigger.lasts_s > 0,
       "pattern: delay_s below 0, or lasts_s not above 0");
  need(part.width_m >= 0 && (part.shape != Shape::bump || part.width_m > 0),
       "pattern: the width must be above 0");
  if (part.shape == Shape::gradient)
    need(std::isfinite(part.begin_m) && std::isfinite(part.end_m),
         "pattern: a gradient needs begin_m and end_m");
  if (part.shape == Shape::sine || part.shape == Shape::square || part.shape == Shape::triangle ||
      part.shape == Shape::table)
    need(part.cycles_per_m != 0 || part.cycles_per_s != 0,
         "pattern: a texture needs cycles_per_m or cycles_per_s");
  if (part.shape == Shape::table)
    need(part.table_first >= 0 && part.table_count >= 2 &&
             part.table_first + part.table_count <= pattern.table_used,
         "pattern: the section is not in the table");
  pattern.parts[static_cast<std::size_t>(pattern.part_count++)] = part;
}

Section add_table(Pattern& pattern, std::span<const double> samples) {
  need(samples.size() >= 2, "pattern: a table needs two or more samples");
  need(samples.size() <= static_cast<std::size_t>(kTableSamples - pattern.table_used),
       "pattern: all tables together have more than 2048 samples");
  const Section section{pattern.table_used, static_cast<int>(samples.size())};
  for (const double sample : samples)
    need(sample >= 0 && sample <= 1, "pattern: a sample is not from 0 to 1");
  for (const double sample : samples)
    pattern.table[static_cast<std::size_t>(pattern.table_used++)] = static_cast<float>(sample);
  return section;
}

Section add_noise(Pattern& pattern, std::span<const SpectrumPoint> spectrum, double length_m, int count,
                  const core::DrawKey& key) {
  need(std::isfinite(length_m) && length_m > 0, "pattern: the length of noise must be above 0");
  need(count >= 8 && count <= kTableSamples, "pattern: noise needs 8 to 2048 samples");
  for (std::size_t i = 0; i < spectrum.size(); ++i) {
    need(spectrum[i].density >= 0 && std::isfinite(spectrum[i].density), "pattern: a density is below 0");
    need(i == 0 || spectrum[i].cycles_per_m > spectrum[i - 1].cycles_per_m,
         "pattern: the spectrum does not ascend");
  }
  core::Draws draws(key);
  std::vector<double> samples(static_cast<std::size_t>(count), 0.0);
  double power = 0;
  for (int k = 1; k <= count / 4; ++k) {
    const double amplitude = std::sqrt(density_at(spectrum, k / length_m));
    const double phase = 2 * std::numbers::pi * draws.uniform();  // drawn also without power
    if (amplitude == 0) continue;
    power += 0.5 * amplitude * amplitude;
    for (int i = 0; i < count; ++i)
      samples[static_cast<std::size_t>(i)] +=
          amplitude * std::sin(2 * std::numbers::pi * (static_cast<double>(k) * i / count) + phase);
  }
  need(power > 0, "pattern: the spectrum has no power between 1/length and count/(4 length)");
  for (double& sample : samples) sample = std::clamp(0.5 + sample / (6 * std::sqrt(power)), 0.0, 1.0);
  return add_table(pattern, samples);
}

void note(const Pattern& pattern, PatternState& state, const Situation& now) noexcept {
  for (std::size_t i = 0; i < static_cast<std::size_t>(pattern.part_count); ++i) {
    const Trigger& trigger = pattern.parts[i].trigger;
    double quantity = 0, threshold = trigger.threshold, release = release_share * trigger.threshold;
    switch (trigger.event) {
      case Event::none:
        continue;
      case Event::contact:
        quantity = now.contact ? 1 : 0, threshold = 1, release = 1;
        break;
      case Event::force:
        quantity = now.normal_N;
        break;
      case Event::place:
        quantity = now.place_m, release = trigger.threshold - release_m;
        break;
      case Event::speed:
        quantity = std::abs(now.speed_m_s);
        break;
    }
    if (!now.contact) {
      state.active[i] = state.below[i] = false;
      if (trigger.event != Event::place) state.below[i] = true;
      continue;
    }
    if (quantity < release) {
      state.below[i] = true;
      if (trigger.until == Until::released) state.active[i] = false;
    }
    if (state.below[i] && quantity >= threshold) {
      state.below[i] = false;
      if (!state.active[i]) state.since_s[i] = now.time_s;
      state.active[i] = true;
    }
  }
}

double asked_at(const Pattern& pattern, const PatternState& state, double place_m, double time_s) noexcept {
  double value = pattern.base;
  for (std::size_t i = 0; i < static_cast<std::size_t>(pattern.part_count); ++i) {
    const Part& part = pattern.parts[i];
    if (!(place_m >= part.begin_m && place_m < part.end_m) || !acts(part.trigger, state, i, time_s)) continue;
    const double own = part.from + (part.to - part.from) * share_of(pattern, part, place_m, time_s);
    value = part.combine == Combine::replace ? own : value + own;
  }
  return value;
}

}  // namespace turnpoint::follow

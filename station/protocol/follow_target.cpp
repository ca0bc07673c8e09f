#include "station/protocol/follow_target.hpp"

#include <algorithm>
#include <cmath>

namespace turnpoint::protocol {

namespace {

constexpr double kSamplesPerCycle = 8;
constexpr int kFewestSamples = 16;

double value_of(const std::optional<Linear>& expression, const Factors& factors, double otherwise) {
  return expression ? evaluate(*expression, factors) : otherwise;
}

follow::Trigger trigger_of(const FollowEvent& event, const Factors& factors) {
  follow::Trigger trigger;
  trigger.event = event.event;
  const double unit = event.event == follow::Event::force ? 1 : 1e-3;
  trigger.threshold = unit * value_of(event.threshold, factors, 0);
  trigger.until = event.until;
  trigger.delay_s = value_of(event.delay_s, factors, 0);
  trigger.lasts_s = value_of(event.lasts_s, factors, trigger.lasts_s);
  return trigger;
}

void add_part(const FollowPart& from, const Factors& factors, double unit, follow::Pattern& pattern) {
  follow::Part part;
  part.shape = from.shape, part.combine = from.combine;
  part.to = unit * value_of(from.to, factors, 0);
  part.from = from.from ? unit * evaluate(*from.from, factors) : part.to;
  part.begin_m = from.begin_mm ? 1e-3 * evaluate(*from.begin_mm, factors) : part.begin_m;
  part.end_m = from.end_mm ? 1e-3 * evaluate(*from.end_mm, factors) : part.end_m;
  const double period_m = from.period_mm ? 1e-3 * evaluate(*from.period_mm, factors) : 0;
  if (period_m > 0) part.cycles_per_m = 1 / period_m;
  part.cycles_per_s = value_of(from.frequency_Hz, factors, 0);
  part.phase_cycles = value_of(from.phase_deg, factors, 0) / 360;
  part.place_m = 1e-3 * value_of(from.place_mm, factors, 0);
  part.width_m = 1e-3 * value_of(from.width_mm, factors, 0);
  part.trigger = trigger_of(from.event, factors);
  if (!from.samples.empty()) {
    const auto section = follow::add_table(pattern, from.samples);
    part.table_first = section.first, part.table_count = section.count;
  }
  if (from.noise) {
    core::DrawKey key;
    key.seed = static_cast<std::uint64_t>(std::llround(value_of(from.noise->instance, factors, 1)));
    key.stream = core::Stream::masking_noise;
    const auto section =
        follow::add_noise(pattern, from.noise->spectrum, period_m, noise_samples(*from.noise, period_m), key);
    part.table_first = section.first, part.table_count = section.count;
  }
  follow::add(pattern, part);
}

bool has_power(const Noise& noise, double cycles_per_m) {
  for (std::size_t i = 1; i < noise.spectrum.size(); ++i) {
    const auto &a = noise.spectrum[i - 1], &b = noise.spectrum[i];
    if (cycles_per_m < a.cycles_per_m || cycles_per_m > b.cycles_per_m) continue;
    return (a.density > 0 && cycles_per_m < b.cycles_per_m) ||
           (b.density > 0 && cycles_per_m > a.cycles_per_m);
  }
  return false;
}

}  // namespace

int noise_samples(const Noise& noise, double length_m) {
  double highest = 0;
  for (const auto& point : noise.spectrum) highest = std::max(highest, point.cycles_per_m);
  const double wanted = std::ceil(kSamplesPerCycle * length_m * highest);
  if (!(wanted <= follow::kTableSamples)) return 0;
  const int samples = std::max(kFewestSamples, static_cast<int>(wanted));
  for (int k = 1; k <= samples / 4; ++k)  // the cycles of which add_noise() makes the noise
    if (has_power(noise, k / length_m)) return samples;
  return 0;
}

scene::FollowTarget follow_target(const Follow& follow, const Factors& factors,
                                  const std::optional<std::pair<double, double>>& speed_mm_s) {
  scene::FollowTarget target;
  target.unit = follow.unit, target.control = follow.control, target.resting_gain = follow.resting_gain;
  if (follow.resting_friction) target.resting_friction = value_of(follow.resting_friction, factors, 1);
  const double unit = follow.unit == scene::FollowUnit::relative       ? target.resting_friction.value_or(1)
                      : follow.unit == scene::FollowUnit::displacement ? 1e-6
                                                                       : 1;
  auto& pattern = target.pattern;
  pattern.asked =
      follow.unit == scene::FollowUnit::displacement ? follow::Asked::displacement : follow::Asked::friction;
  pattern.base = unit * evaluate(follow.base, factors);
  for (const auto& part : follow.parts) add_part(part, factors, unit, pattern);
  if (speed_mm_s) target.speeds_m_s = std::pair{1e-3 * speed_mm_s->first, 1e-3 * speed_mm_s->second};
  return target;
}

std::vector<const Linear*> expressions_of(const Follow& follow) {
  std::vector<const Linear*> all{&follow.base};
  const auto add = [&](const std::optional<Linear>& expression) {
    if (expression) all.push_back(&*expression);
  };
  add(follow.resting_friction);
  for (const auto& part : follow.parts) {
    for (const auto* expression : {&part.from, &part.to, &part.begin_mm, &part.end_mm, &part.period_mm,
                                   &part.frequency_Hz, &part.phase_deg, &part.place_mm, &part.width_mm,
                                   &part.event.threshold, &part.event.delay_s, &part.event.lasts_s})
      add(*expression);
    if (part.noise) add(part.noise->instance);
  }
  return all;
}

std::vector<std::optional<double>> followed_numbers(const scene::FollowTarget& target) {
  std::vector<std::optional<double>> numbers{target.pattern.base, target.resting_friction,
                                             target.resting_gain};
  const auto add = [&](double value) {
    numbers.push_back(std::isfinite(value) ? std::optional(value) : std::nullopt);
  };
  for (int i = 0; i < target.pattern.part_count; ++i) {
    const auto& part = target.pattern.parts[static_cast<std::size_t>(i)];
    for (const double value :
         {static_cast<double>(part.shape), static_cast<double>(part.combine), part.from, part.to,
          part.begin_m, part.end_m, part.cycles_per_m, part.cycles_per_s, part.phase_cycles, part.place_m,
          part.width_m, static_cast<double>(part.trigger.event), part.trigger.threshold, part.trigger.delay_s,
          part.trigger.lasts_s})
      add(value);
  }
  for (int i = 0; i < target.pattern.table_used; ++i)
    add(static_cast<double>(target.pattern.table[static_cast<std::size_t>(i)]));
  return numbers;
}

}  // namespace turnpoint::protocol

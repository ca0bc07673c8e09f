#include "station/scene/following.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "physics/root.hpp"
#include "station/core/limits.hpp"
#include "station/core/number.hpp"
#include "station/scene/force_carrier.hpp"

namespace turnpoint::scene {

using core::phrase, core::plain, core::number;
using follow::Part, follow::Pattern, follow::Plan, follow::Shape;

namespace {

/// Errors of Q of 15 % still give the figures of station/follow/README.md.
constexpr double kMostRatioOfTimes = 1.15;
constexpr double kTolerance = 0.02;  // of the friction at rest, or of the largest displacement
/// The figures of following hold for cells that are usable up to here: a third of their resonance.
constexpr double kUsable_Hz = 100;
constexpr double kUsableShare = 1.0 / 3;
constexpr double kHighestSpeed_m_s = 1.0, kLowestSpeed_m_s = 1e-3;
constexpr int kTexturePlaces = 5;
constexpr double kMostResidual = 0.15;   // as in follow::Presented
constexpr double kPresentedShare = 0.9;  // of the amplitude, as in follow::Presented
constexpr double kTablePower = 0.95;     // of a table's power, up to its highest cycle that counts
constexpr double kStill_Hz = 1;          // what varies no faster is a matter of the place alone
/// presented() takes no cycle of more than 12 s. A slower one is judged as if it were this fast, which is
/// harder.
constexpr double kSlowest_Hz = 0.1;
/// Fingers change their speed with up to this frequency, so slower cells do not even show where they are.
constexpr double kFinger_Hz = 10;
constexpr double kUsableOverLoop = 3;  // cells that are usable up to so many cut-offs add little to its delay
constexpr double kCurveStep_m = 0.0937e-3;  // no multiple of it is a usual period
constexpr int kPhases = 16;                 // of textures that move, for cues

core::Phrase mm(double value_m, int digits = 4) { return plain(number(1e3 * value_m, digits)); }
core::Phrase Hz(double value, int digits = 4) { return plain(number(value, digits)); }

bool is_texture(const Part& part) {
  return part.shape == Shape::sine || part.shape == Shape::square || part.shape == Shape::triangle ||
         part.shape == Shape::table;
}

/// The resonance of the force cells, from the calibration if it knows it.
double cells_resonance_Hz(const rig::Rig& rig) {
  const auto& capture = *rig.capture;
  if (capture.forces && capture.forces->usable_Hz) return *capture.forces->usable_Hz / kUsableShare;
  if (capture.cells_resonance_Hz) return *capture.cells_resonance_Hz;
  throw Unreachable(phrase(
      "following the finger needs to know how fast the force cells are: give \"cells_resonance_Hz\" in "
      "[capture], or tap the plate while it is calibrated"));
}

void need_cells(const rig::Rig& rig) {
  if (rig.capture && rig.capture->converter)
    throw Unreachable(phrase(
        "following the finger needs force cells that the sound card captures (\"bridges\" in [capture]); "
        "samples of a converter with a clock of its own come too late"));
  if (!rig.capture || rig.capture->bridges.empty() || !rig.capture->excitation_channel)
    throw Unreachable(
        phrase("following the finger needs force cells: the rig has no \"bridges\" and \"reference\" in "
               "[capture]"));
}

follow::Timing timing_for(const rig::Rig& rig, double resonance_Hz) {
  auto timing = follow::timing_of(rig.output.rate_Hz);
  timing.period_frames = rig.output.period_frames;
  timing.buffer_periods = rig.output.periods;
  timing.cells_s = 2 * rig.capture->cells_damping / (2 * std::numbers::pi * resonance_Hz);
  timing.converter_s = rig.output.converter_delay_s;
  const auto delay = follow::total_delay(timing);
  if (delay.refused())
    throw Unreachable(
        phrase("the rig is too slow to follow the finger: %1 (\"period_frames\" and \"periods\" in [output])",
               {plain(follow::sentence(delay))}));
  return timing;
}

void check_carrier(const rig::Rig& rig, const DrivePlan& plan, const follow::Timing& timing) {
  const auto& forces = rig.capture->forces;
  const double carrier_Hz = forces && forces->carrier_Hz > 0 ? forces->carrier_Hz : core::kForceCarrier_Hz;
  const double distance_Hz = 4.0 * timing.rate_Hz / timing.window_frames;
  for (const auto& tone : plan.tones) {
    const double away_Hz = std::abs(captured_at(tone.frequency_Hz, timing.rate_Hz) - carrier_Hz);
    if (away_Hz < distance_Hz)
      throw Unreachable(
          phrase("the tone of %1 Hz is only %2 Hz from the carrier of the force cells (%3 Hz); following the "
                 "finger needs %4 Hz or more",
                 {Hz(tone.frequency_Hz, 7), Hz(away_Hz), Hz(carrier_Hz, 7), Hz(distance_Hz)}));
  }
}

/// The time constant of the plate's envelope for all tones.
double time_constant_s(const rig::Rig& rig, const DrivePlan& plan, const std::vector<Detuning>& detunings) {
  const double quality = rig.surface.quality_factor;
  if (plan.tones.empty())
    throw Unreachable(phrase("a scene that follows the finger needs a vibration, and this one has none"));
  if (!std::isfinite(quality))
    throw Unreachable(phrase("following the finger needs the surface's \"quality_factor\""));
  for (const auto& tone : detunings) {
    const double most_Hz = most_detuning_Hz(quality, tone.frequency_Hz);
    if (!tone.resonance_Hz)
      throw Unreachable(
          phrase("the tone of %1 Hz has no resonance near it, so its strength cannot follow the finger",
                 {Hz(tone.frequency_Hz, 7)}));
    const double away_Hz = std::abs(tone.frequency_Hz - *tone.resonance_Hz);
    if (away_Hz > most_Hz)
      throw Unreachable(
          phrase("the tone of %1 Hz is %2 Hz from the nearest resonance (%3 Hz), so its strength would beat "
                 "while it follows the finger: use a tone within %4 Hz of it, half of the resonance's width",
                 {Hz(tone.frequency_Hz, 7), Hz(away_Hz), Hz(*tone.resonance_Hz, 7), Hz(most_Hz, 3)}));
  }
  double shortest_s = std::numeric_limits<double>::infinity(), longest_s = 0;
  for (const auto& tone : plan.tones) {
    const double own_s = follow::envelope_time_constant_s(quality, tone.frequency_Hz);
    shortest_s = std::min(shortest_s, own_s), longest_s = std::max(longest_s, own_s);
  }
  if (longest_s > kMostRatioOfTimes * shortest_s)
    throw Unreachable(phrase(
        "the tones ring for %1 to %2 ms, too different to follow the finger together: their frequencies "
        "may differ by %3 % at most",
        {mm(shortest_s, 3), mm(longest_s, 3), plain(std::lround(100 * (kMostRatioOfTimes - 1)))}));
  return std::sqrt(shortest_s * longest_s);
}

double loop_cutoff_Hz(const Plan& plan) {
  follow::LoopUncertainty uncertainty;
  uncertainty.model_delay_s =
      follow::total_delay(plan.timing).horizon_s + 0.5 * plan.timing.period_frames / plan.timing.rate_Hz;
  uncertainty.added_delay_s = plan.loop.unknown_delay_s;
  uncertainty.gain_share = plan.loop.slope_share;
  uncertainty.most_amplified = plan.loop.most_amplified;
  return follow::design_loop(uncertainty).cutoff_Hz;
}

std::pair<double, double> stretch_of(const Part& part, const follow::GainMap& map) {
  return {std::max(part.begin_m, map.first_m()), std::min(part.end_m, map.last_m())};
}

/// The largest miss that counts as none, in the pattern's unit.
double tolerance_of(const Plan& plan) {
  if (plan.pattern.asked == follow::Asked::friction) return kTolerance * plan.resting_friction;
  double most_m = 0;
  for (int i = 0; i < follow::GainMap::kPlaces; ++i)
    most_m = std::max(most_m, plan.map.most_displacement_m(plan.map.first_m() +
                                                           i * (plan.map.last_m() - plan.map.first_m()) /
                                                               (follow::GainMap::kPlaces - 1)));
  return kTolerance * most_m;
}

/// What a pattern asks for without the parts from `part` on.
Pattern below(const Pattern& pattern, int part) {
  Pattern all = pattern;
  all.part_count = part;
  return all;
}

/// The gains with which a texture is felt as asked at its extremes; empty where one of them is out of reach.
struct Swing {
  double low = 0, high = 0;
};
std::optional<Swing> swing_at(const Plan& plan, int index, double place_m) {
  const auto& part = plan.pattern.parts[static_cast<std::size_t>(index)];
  const double base =
      part.combine == follow::Combine::add ? follow::asked_at(below(plan.pattern, index), {}, place_m, 0) : 0;
  const double tolerance = tolerance_of(plan);
  const bool friction = plan.pattern.asked == follow::Asked::friction;
  const double least = friction ? plan.resting_friction * plan.map.lowest_friction(place_m) : 0;
  const double most = friction ? plan.resting_friction : plan.map.most_displacement_m(place_m);
  Swing swing{plan.map.most_gain(), 0};
  for (const double value : {base + part.from, base + part.to}) {
    if (value < least - tolerance || value > most + tolerance) return std::nullopt;
    const double gain = friction ? plan.map.gain(place_m, value / plan.resting_friction)
                                 : plan.map.gain_for_displacement(place_m, value);
    swing.low = std::min(swing.low, gain), swing.high = std::max(swing.high, gain);
  }
  if (swing.high - swing.low < 1e-4) return std::nullopt;
  return swing;
}

/// A texture of a plan. `highest_cycle` is the frequency of the finest detail that counts, in multiples of
/// one cycle: 1 but for a table, for which it is the harmonic up to which 95 % of its power lie. (Of a square
/// only the fundamental is asked for: no plate has its jumps.)
struct Texture {
  int index = 0;
  Part part;
  double highest_cycle = 1;

  double frequency_Hz(double speed_m_s) const { return part.cycles_per_m * speed_m_s + part.cycles_per_s; }
};

double highest_cycle(const Pattern& pattern, const Part& part) {
  if (part.shape != Shape::table) return 1;
  const auto* samples = pattern.table.data() + part.table_first;
  const int count = part.table_count;
  std::vector<double> power(static_cast<std::size_t>(count / 2 + 1), 0);
  double total = 0;
  for (int k = 1; k <= count / 2; ++k) {
    const auto turn = std::polar(1.0, 2 * std::numbers::pi * k / count);
    std::complex<double> sum, angle = 1;
    for (int i = 0; i < count; ++i, angle *= turn) sum += static_cast<double>(samples[i]) * angle;
    total += power[static_cast<std::size_t>(k)] = std::norm(sum);
  }
  double below = 0;
  for (int k = 1; k <= count / 2; ++k)
    if ((below += power[static_cast<std::size_t>(k)]) >= kTablePower * total) return k;
  return 1;
}

std::vector<Texture> textures_of(const Plan& plan) {
  std::vector<Texture> textures;
  for (int i = 0; i < plan.pattern.part_count; ++i)
    if (const auto& part = plan.pattern.parts[static_cast<std::size_t>(i)]; is_texture(part))
      textures.push_back({i, part, highest_cycle(plan.pattern, part)});
  return textures;
}

/// Whether the plate can present a texture at a place, if it passes there with this frequency (in cycles per
/// second, below 0 backwards).
bool presentable(const Plan& plan, const Texture& texture, double place_m, double frequency_Hz) {
  if (texture.highest_cycle * std::abs(frequency_Hz) < kStill_Hz) return true;
  const double period_s = static_cast<double>(plan.timing.period_frames) / plan.timing.rate_Hz;
  auto passing = texture.part;
  passing.cycles_per_m = 0;
  passing.cycles_per_s = std::copysign(std::max(std::abs(frequency_Hz), kSlowest_Hz), frequency_Hz);
  const auto shown = follow::presented(below(plan.pattern, texture.index), passing, plan.map, plan.envelope,
                                       period_s, plan.resting_friction, place_m, 0);
  if (passing.shape != Shape::table) return shown.presentable;
  // Only what is left counts for a table: noise has no power in its first cycle, so the amplitude and the
  // phase of that say nothing. As for other shapes, the finest detail needs 8 gains in a cycle.
  return shown.residual < kMostResidual &&
         8 * texture.highest_cycle * std::abs(frequency_Hz) * period_s / follow::kGains <= 1;
}

/// The same for a finger of this speed, in both directions.
bool presentable_at(const Plan& plan, const Texture& texture, double place_m, double speed_m_s) {
  return presentable(plan, texture, place_m, texture.frequency_Hz(speed_m_s)) &&
         presentable(plan, texture, place_m, texture.frequency_Hz(-speed_m_s));
}

/// Places at which a texture can be met at all.
std::vector<double> places_of(const Plan& plan, int index) {
  const auto [begin_m, end_m] = stretch_of(plan.pattern.parts[static_cast<std::size_t>(index)], plan.map);
  std::vector<double> places;
  for (int i = 0; i < kTexturePlaces && begin_m < end_m; ++i) {
    const double place_m = begin_m + (i + 0.5) / kTexturePlaces * (end_m - begin_m);
    if (swing_at(plan, index, place_m)) places.push_back(place_m);
  }
  return places;
}

/// The highest speed at which a texture is presentable at a place, up to kHighestSpeed_m_s; 0 if at none.
double most_speed_m_s(const Plan& plan, const Texture& texture, double place_m) {
  if (presentable_at(plan, texture, place_m, kHighestSpeed_m_s)) return kHighestSpeed_m_s;
  double low = kLowestSpeed_m_s, high = kHighestSpeed_m_s;
  if (!presentable_at(plan, texture, place_m, low)) return 0;
  while (high > 1.02 * low) {
    const double middle = std::sqrt(low * high);
    (presentable_at(plan, texture, place_m, middle) ? low : high) = middle;
  }
  return low;
}

TextureFigures figures_of(const Plan& plan, const Texture& texture, const std::vector<double>& places) {
  TextureFigures least{texture.index, places.front(), 0, std::numeric_limits<double>::infinity(),
                       std::nullopt};
  const double per_m = std::abs(texture.part.cycles_per_m);
  if (per_m != 0) least.period_m = 1 / per_m;
  double speed_m_s = kHighestSpeed_m_s;
  for (const double place_m : places) {
    const auto swing = *swing_at(plan, texture.index, place_m);
    const double bandwidth_Hz = follow::bandwidth_Hz(plan.envelope, 0.5 * (swing.low + swing.high),
                                                     0.5 * kPresentedShare * (swing.high - swing.low));
    if (bandwidth_Hz < least.bandwidth_Hz) least.bandwidth_Hz = bandwidth_Hz, least.place_m = place_m;
    if (per_m != 0) speed_m_s = std::min(speed_m_s, most_speed_m_s(plan, texture, place_m));
  }
  if (per_m != 0 && speed_m_s > 0) least.most_speed_m_s = speed_m_s;
  return least;
}

/// Speeds are from the slowest to the fastest finger; a texture that varies only in time needs none.
void check_texture_speed(const Plan& plan, const Texture& texture, const std::vector<double>& places,
                         const std::pair<double, double>& speeds_m_s) {
  for (const double speed_m_s : {speeds_m_s.second, -speeds_m_s.second, speeds_m_s.first, -speeds_m_s.first})
    for (const double place_m : places) {
      const double frequency_Hz = texture.frequency_Hz(speed_m_s);
      if (presentable(plan, texture, place_m, frequency_Hz)) continue;
      const auto figures = figures_of(plan, texture, places);
      const auto varies = Hz(texture.highest_cycle * std::abs(frequency_Hz), 3);
      const auto bandwidth = std::isfinite(figures.bandwidth_Hz) ? Hz(figures.bandwidth_Hz, 3) : plain("inf");
      if (texture.part.cycles_per_m == 0)
        throw Unreachable(
            phrase("part %1 varies with %2 Hz, and the plate cannot follow that at %3 mm (its bandwidth for "
                   "this change of friction is %4 Hz)",
                   {plain(texture.index + 1), varies, mm(place_m, 3), bandwidth}));
      const auto most = figures.most_speed_m_s
                            ? phrase("up to %1 mm/s it can", {mm(*figures.most_speed_m_s, 3)})
                            : phrase("at no speed it can");
      throw Unreachable(phrase(
          "part %1 varies with %2 Hz under a finger of %3 mm/s, and the plate cannot follow that at %4 mm "
          "(its bandwidth for this change of friction is %5 Hz): %6",
          {plain(texture.index + 1), varies, mm(std::abs(speed_m_s), 3), mm(place_m, 3), bandwidth, most}));
    }
}

/// The shortest length over which a part varies (m); infinite if it is the same everywhere.
double shortest_m(const Pattern& pattern, const Part& part) {
  if (is_texture(part))
    return part.cycles_per_m == 0 ? std::numeric_limits<double>::infinity()
                                  : 1 / (highest_cycle(pattern, part) * std::abs(part.cycles_per_m));
  if (part.shape == Shape::edge || part.shape == Shape::bump) return part.width_m;
  if (part.shape == Shape::gradient) return part.end_m - part.begin_m;
  return std::numeric_limits<double>::infinity();
}

/// Cells that are usable up to 100 Hz and more show the place well enough for everything that the plate can
/// present. With slower ones, only what varies no faster under the finger than the cells can follow remains,
/// and a loop that is slower still.
void check_cells(const Plan& plan, double resonance_Hz,
                 const std::optional<std::pair<double, double>>& speeds_m_s) {
  const double usable_Hz = kUsableShare * resonance_Hz;
  if (usable_Hz >= kUsable_Hz) return;
  if (usable_Hz < kFinger_Hz)
    throw Unreachable(phrase(
        "the force cells resonate at %1 Hz and are usable up to %2 Hz, but fingers change their movement "
        "with up to %3 Hz: following needs cells that resonate at %4 Hz or more",
        {Hz(resonance_Hz, 3), Hz(usable_Hz, 3), Hz(kFinger_Hz), Hz(kFinger_Hz / kUsableShare)}));
  if (plan.control == follow::Control::closed && usable_Hz < kUsableOverLoop * plan.loop.cutoff_Hz)
    throw Unreachable(phrase(
        "the force cells are usable up to %1 Hz, but friction is held with up to %2 Hz: that needs cells "
        "that resonate at %3 Hz or more",
        {Hz(usable_Hz, 3), Hz(plan.loop.cutoff_Hz, 3),
         Hz(kUsableOverLoop * plan.loop.cutoff_Hz / kUsableShare, 3)}));
  for (int i = 0; i < plan.pattern.part_count; ++i) {
    const auto& part = plan.pattern.parts[static_cast<std::size_t>(i)];
    const double length_m = shortest_m(plan.pattern, part);
    if (std::isinf(length_m)) continue;
    if (!speeds_m_s)
      throw Unreachable(phrase(
          "the force cells are usable up to %1 Hz only, so how fast part %2 may vary depends on the finger's "
          "speed: give \"speed_mm_s\" in [sensing]",
          {Hz(usable_Hz, 3), plain(i + 1)}));
    const double speed_m_s = speeds_m_s->second;
    if (speed_m_s <= usable_Hz * length_m) continue;
    if (!is_texture(part))
      throw Unreachable(phrase(
          "the force cells resonate at %1 Hz and are usable up to %2 Hz, but part %3 changes within %4 mm "
          "under a finger of %5 mm/s; the cells lag by %6 ms (%7 mm at this speed), and changes over %8 mm "
          "and more remain",
          {Hz(resonance_Hz, 3), Hz(usable_Hz, 3), plain(i + 1), mm(length_m, 3), mm(speed_m_s, 3),
           mm(plan.timing.cells_s, 2), mm(plan.timing.cells_s * speed_m_s, 2),
           mm(speed_m_s / usable_Hz, 3)}));
    throw Unreachable(phrase(
        "the force cells resonate at %1 Hz and are usable up to %2 Hz, but part %3 varies with %4 Hz under a "
        "finger of %5 mm/s; the cells lag by %6 ms (%7 mm at this speed), and periods of %8 mm and more "
        "remain",
        {Hz(resonance_Hz, 3), Hz(usable_Hz, 3), plain(i + 1), Hz(speed_m_s / length_m, 3), mm(speed_m_s, 3),
         mm(plan.timing.cells_s, 2), mm(plan.timing.cells_s * speed_m_s, 2), mm(speed_m_s / usable_Hz, 3)}));
  }
}

/// Refuses parts that would never be felt, because they lie beyond the surface or where they do not act.
void check_places(const Plan& follow) {
  const double last_m = follow.map.last_m();
  for (int i = 0; i < follow.pattern.part_count; ++i) {
    const auto& part = follow.pattern.parts[static_cast<std::size_t>(i)];
    if (std::isfinite(part.begin_m) && part.begin_m >= last_m)
      throw Unreachable(phrase("part %1 begins at %2 mm, beyond the surface, which is %3 mm long",
                               {plain(i + 1), mm(part.begin_m), mm(last_m)}));
    if (part.trigger.event == follow::Event::place &&
        (part.trigger.threshold <= 0 || part.trigger.threshold >= last_m))
      throw Unreachable(
          phrase("the event of part %1 is at %2 mm, which no finger passes: the surface is %3 mm long",
                 {plain(i + 1), mm(part.trigger.threshold), mm(last_m)}));
    if (part.shape != Shape::edge && part.shape != Shape::bump) continue;
    const auto [begin_m, end_m] = stretch_of(part, follow.map);
    if (part.place_m + 0.5 * part.width_m >= begin_m && part.place_m - 0.5 * part.width_m <= end_m) continue;
    throw Unreachable(phrase("part %1 is to change at %2 mm, but it acts from %3 to %4 mm only",
                             {plain(i + 1), mm(part.place_m), mm(begin_m), mm(end_m)}));
  }
}

/// A part with begin and end promises its stretch.
void check_promises(const DrivePlan& plan, const Plan& follow) {
  for (int i = 0; i < follow.pattern.part_count; ++i) {
    const auto& part = follow.pattern.parts[static_cast<std::size_t>(i)];
    if (!std::isfinite(part.begin_m) || !std::isfinite(part.end_m)) continue;
    if (part.end_m > follow.map.last_m() + 1e-9)
      throw Unreachable(phrase("part %1 ends at %2 mm, beyond the surface, which is %3 mm long",
                               {plain(i + 1), mm(part.end_m), mm(follow.map.last_m())}));
    auto pattern = below(follow.pattern, i);
    follow::add(pattern, part);
    const auto missed = follow::unmet(pattern, follow.map, follow.resting_friction, part.begin_m,
                                      part.end_m - 1e-9, tolerance_of(follow));
    if (!missed.empty())
      throw Unreachable(phrase("part %1: %2; give it less, a stronger scene, or another stretch",
                               {plain(i + 1), in_words(plan, missed.front())}));
  }
}

double unit_of(const FollowTarget& target) {
  return target.unit == FollowUnit::relative      ? target.resting_friction.value_or(1)
         : target.unit == FollowUnit::coefficient ? 1
                                                  : 1e-6;
}

}  // namespace

double most_detuning_Hz(double quality_factor, double frequency_Hz) {
  return 0.5 * frequency_Hz / quality_factor;
}

std::shared_ptr<const Plan> follow_plan(const rig::Rig& rig, const physics::FrictionMap& friction,
                                        const DrivePlan& plan, const FingerField& field,
                                        const std::vector<Detuning>& detunings) {
  const auto& target = *plan.scene.follow;
  need_cells(rig);
  const double resonance_Hz = cells_resonance_Hz(rig);
  const auto made = std::make_shared<Plan>();
  made->timing = timing_for(rig, resonance_Hz);
  check_carrier(rig, plan, made->timing);
  made->envelope.time_constant_s = time_constant_s(rig, plan, detunings);
  made->envelope.step_s =
      static_cast<double>(made->timing.period_frames) / made->timing.rate_Hz / follow::kGains;
  made->pattern = target.pattern;
  made->control = target.control;
  made->resting_friction = target.resting_friction.value_or(1);
  made->resting_known = target.resting_friction.has_value() || target.unit == FollowUnit::coefficient;
  made->resting_gain = target.resting_gain;
  made->estimator.skin_m_per_N = rig.finger.skin_m_per_N;
  try {
    made->map = follow::GainMap(field.x_m, field.displacement_m, field.finger_share, friction,
                                rig.friction.fingertip_m, made->envelope.most_gain);
    if (target.control == follow::Control::closed) {
      made->loop.cutoff_Hz = loop_cutoff_Hz(*made);
      if (!(made->loop.cutoff_Hz > 0))
        throw Unreachable(phrase("friction cannot be held with a delay of %1 ms: no loop is stable enough",
                                 {mm(follow::total_delay(made->timing).horizon_s, 3)}));
    }
    std::make_unique<follow::Follower>(*made);  // refuses what is not possible
  } catch (const std::invalid_argument& error) {
    throw Unreachable(plain(error.what()));
  }
  check_places(*made);
  check_promises(plan, *made);
  check_cells(*made, resonance_Hz, target.speeds_m_s);
  for (const auto& texture : textures_of(*made)) {
    const auto places = places_of(*made, texture.index);
    if (places.empty())
      throw Unreachable(
          phrase("part %1 is beyond reach at all places that were tried: give it less, or a stronger scene",
                 {plain(texture.index + 1)}));
    if (texture.part.cycles_per_m == 0)
      check_texture_speed(*made, texture, places, {0, 0});
    else if (target.speeds_m_s)
      check_texture_speed(*made, texture, places, *target.speeds_m_s);
  }
  return made;
}

std::vector<follow::Unmet> unmet_of(const DrivePlan& plan) {
  const auto& follow = *plan.follow;
  return follow::unmet(follow.pattern, follow.map, follow.resting_friction, follow.map.first_m(),
                       follow.map.last_m(), tolerance_of(follow));
}

std::optional<core::Phrase> remark_on(const rig::Rig& rig, const DrivePlan& plan) {
  const auto& speeds_m_s = plan.scene.follow->speeds_m_s;
  const double usable_Hz = kUsableShare * cells_resonance_Hz(rig), lag_s = plan.follow->timing.cells_s;
  if (usable_Hz < kUsable_Hz)
    return speeds_m_s ? phrase(
                            "the force cells are usable up to %1 Hz only: they lag by %2 ms, %3 mm under a "
                            "finger of %4 mm/s, and periods of %5 mm and more remain",
                            {Hz(usable_Hz, 3), mm(lag_s, 2), mm(lag_s * speeds_m_s->second, 2),
                             mm(speeds_m_s->second, 3), mm(speeds_m_s->second / usable_Hz, 3)})
                      : phrase("the force cells are usable up to %1 Hz only: they lag by %2 ms",
                               {Hz(usable_Hz, 3), mm(lag_s, 2)});
  const auto textures = textures_of(*plan.follow);
  if (!speeds_m_s && std::any_of(textures.begin(), textures.end(),
                                 [](const auto& texture) { return texture.part.cycles_per_m != 0; }))
    return phrase(
        "whether the plate can present the texture depends on the finger's speed, which is not known: "
        "give \"speed_mm_s\" in [sensing]");
  const auto& target = *plan.scene.follow;
  if (target.unit == FollowUnit::coefficient && target.control == follow::Control::open &&
      !target.resting_friction)
    return phrase(
        "\"resting_friction\" is not given, so the surface at rest is taken to have a coefficient of "
        "friction of "
        "1: a finger that has another one feels that many times what is asked for");
  return std::nullopt;
}

core::Phrase in_words(const DrivePlan& plan, const follow::Unmet& unmet) {
  const auto& target = *plan.scene.follow;
  const auto value = [&](double in_pattern) { return plain(number(in_pattern / unit_of(target), 3)); };
  const char* text =
      target.unit == FollowUnit::relative
          ? "from %1 to %2 mm, relative friction %3 is asked for, and from %4 to %5 is reached "
            "(at %6 mm)"
      : target.unit == FollowUnit::coefficient
          ? "from %1 to %2 mm, a coefficient of friction of %3 is asked for, and from %4 to %5 "
            "is reached (at %6 mm)"
          : "from %1 to %2 mm, a displacement of %3 um is asked for, and from %4 to %5 um is "
            "reached (at %6 mm)";
  return phrase(text, {mm(unmet.from_m), mm(unmet.to_m), value(unmet.asked), value(unmet.least),
                       value(unmet.most), mm(unmet.at_m)});
}

FollowFigures follow_figures(const DrivePlan& plan) {
  const auto& follow = *plan.follow;
  FollowFigures figures;
  figures.delay = follow::total_delay(follow.timing);
  figures.time_constant_s = follow.envelope.time_constant_s;
  if (follow.control == follow::Control::closed) figures.loop_cutoff_Hz = follow.loop.cutoff_Hz;
  figures.unmet = unmet_of(plan);
  for (const auto& texture : textures_of(follow)) {
    const auto places = places_of(follow, texture.index);
    if (!places.empty()) figures.textures.push_back(figures_of(follow, texture, places));
  }
  return figures;
}

FollowCurve follow_curve(const DrivePlan& plan, int points, Events events) {
  const auto& follow = *plan.follow;
  const auto& target = *plan.scene.follow;
  const bool displacement = target.unit == FollowUnit::displacement;
  const double unit = displacement ? 1 : unit_of(target);
  follow::PatternState state;
  if (events == Events::all) state.active.fill(true);
  for (std::size_t i = 0; i < state.since_s.size(); ++i)
    state.since_s[i] = -follow.pattern.parts[i].trigger.delay_s;
  FollowCurve curve;
  for (int i = 0; i < points; ++i) {
    const double x_m = follow.map.first_m() + (follow.map.last_m() - follow.map.first_m()) * i / (points - 1);
    const double asked = follow::asked_at(follow.pattern, state, x_m, 0);
    const double reached = displacement
                               ? std::clamp(asked, 0.0, follow.map.most_displacement_m(x_m))
                               : std::clamp(asked, follow.resting_friction * follow.map.lowest_friction(x_m),
                                            follow.resting_friction);
    curve.x_m.push_back(x_m), curve.asked.push_back(asked / unit), curve.reached.push_back(reached / unit);
  }
  return curve;
}

FollowedGains followed_gains(const Plan& plan) {
  FollowedGains gains;
  gains.most = plan.resting_gain;
  const bool friction = plan.pattern.asked == follow::Asked::friction;
  const auto steps =
      std::max(1, static_cast<int>(std::lround((plan.map.last_m() - plan.map.first_m()) / kCurveStep_m)));
  follow::PatternState none, all;
  all.active.fill(true);
  bool moves = false, has_events = false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(plan.pattern.part_count); ++i) {
    const auto& part = plan.pattern.parts[i];
    all.since_s[i] = -part.trigger.delay_s;
    moves |= is_texture(part) && part.cycles_per_s != 0;
    has_events |= part.trigger.event != follow::Event::none;
  }
  const int phases = moves ? kPhases : 1;
  std::vector<const follow::PatternState*> states{&none};
  if (has_events) states.push_back(&all);
  auto pattern = plan.pattern;
  double squares = 0;
  for (int phase = 0; phase < phases; ++phase) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(pattern.part_count); ++i)
      if (pattern.parts[i].cycles_per_s != 0)  // different steps, so that two of them do not stay together
        pattern.parts[i].phase_cycles =
            plan.pattern.parts[i].phase_cycles +
            static_cast<double>((2 * i + 1) * static_cast<std::size_t>(phase)) / phases;
    for (const auto* state : states)
      for (int i = 0; i <= steps; ++i) {
        const double x_m = plan.map.first_m() + (plan.map.last_m() - plan.map.first_m()) * i / steps;
        const double asked = follow::asked_at(pattern, *state, x_m, 0);
        const double gain = friction ? plan.map.gain(x_m, asked / plan.resting_friction)
                                     : plan.map.gain_for_displacement(x_m, asked);
        squares += gain * gain / (steps + 1);
        gains.most = std::max(gains.most, gain);
        gains.lowest_friction = std::min(gains.lowest_friction, plan.map.relative_friction(x_m, gain));
      }
  }
  squares /= static_cast<double>(phases) * static_cast<double>(states.size());
  gains.rms = std::hypot(std::sqrt(squares), plan.resting_gain);
  return gains;
}

}  // namespace turnpoint::scene

#pragma once
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>

#include "station/core/draws.hpp"

namespace turnpoint::follow {

/// What the values of a pattern mean: the coefficient of friction, or the peak displacement (m) under the
/// finger.
enum class Asked { friction, displacement };

/// How the value of a part varies over place and time, between `from` and `to`. Here u counts cycles: u =
/// cycles_per_m (place - place_m) + cycles_per_s time + phase_cycles.
enum class Shape {
  constant,  ///< `to`
  sine,      ///< the middle plus half the range times sin(2 pi u)
  square,    ///< `to` in the first half of each cycle, `from` in the second
  triangle,  ///< rises from `from` to `to` in the first half of a cycle, and falls back in the second
  table,     ///< one cycle is the part's section of Pattern::table (0: `from`, 1: `to`), joined by lines
  gradient,  ///< from `from` at begin_m to `to` at end_m
  bump,      ///< `to` at place_m, and `from` at half of width_m from it and beyond; a raised cosine
  edge       ///< `from` before place_m and `to` behind it; a raised cosine of width_m between them
};

/// How a part acts on what the parts before it ask for: it takes their place, or its value is added.
enum class Combine { replace, add };

/// What makes a part begin.
enum class Event {
  none,     ///< the part is always active
  contact,  ///< the finger touches the surface
  force,    ///< the normal force (N) reaches the threshold
  place,    ///< the finger passes the threshold (m) towards larger places
  speed     ///< the finger's speed, in either direction, reaches the threshold (m/s)
};

/// What makes it end: the quantity falls below the threshold again (by a fifth of it, or by 0.3 mm of place),
/// or the finger leaves the surface.
enum class Until { released, lifted };

struct Trigger {
  Event event = Event::none;
  double threshold = 0;
  Until until = Until::released;
  double delay_s = 0;                                        ///< from the event to the part's begin
  double lasts_s = std::numeric_limits<double>::infinity();  ///< longest duration of the part
};

/// One part of a pattern. It acts from begin_m up to end_m, while its trigger is active.
struct Part {
  Shape shape = Shape::constant;
  Combine combine = Combine::replace;
  double from = 0, to = 0;
  double begin_m = -std::numeric_limits<double>::infinity(), end_m = std::numeric_limits<double>::infinity();
  double cycles_per_m = 0, cycles_per_s = 0, phase_cycles = 0;
  double place_m = 0, width_m = 0;
  int table_first = 0, table_count = 0;
  Trigger trigger;
};

inline constexpr int kMostParts = 8;
inline constexpr int kTableSamples = 2048;

/// Asked friction or displacement as a function of place and time. Fixed size; everything that is evaluated
/// per period allocates and throws nothing.
struct Pattern {
  Asked asked = Asked::friction;
  double base = 1;  ///< value where no part acts
  std::array<Part, kMostParts> parts{};
  int part_count = 0;
  std::array<float, kTableSamples> table{};  ///< samples of all tables, each from 0 to 1
  int table_used = 0;
};
static_assert(std::is_trivially_copyable_v<Pattern>);

/// Adds a part. Throws std::invalid_argument if there are too many, or for a value that is not finite, a
/// range, period or width that does not suit the shape, or a section beyond the table.
void add(Pattern& pattern, const Part& part);

/// A section of Pattern::table.
struct Section {
  int first = 0, count = 0;
};
/// Adds the samples of one table, each from 0 to 1. Throws std::invalid_argument for other values, for fewer
/// than two samples, and if the table is full.
Section add_table(Pattern& pattern, std::span<const double> samples);

/// A point of a spectrum of noise: power density (any unit) at a spatial frequency. Points are joined by
/// straight lines; outside of them there is no power.
struct SpectrumPoint {
  double cycles_per_m = 0, density = 0;
};
/// Adds a table of Gaussian-like noise with this spectrum, which repeats after `length_m`: a sum of sines of
/// fixed amplitude and random phase, so that the spectrum is met exactly in every draw. Mean 0.5, standard
/// deviation 1/6, so a part's `from` and `to` are three standard deviations from the middle; values beyond
/// them are clipped. Throws std::invalid_argument for a spectrum without power between 1/length_m and
/// count/(4 length_m).
Section add_noise(Pattern& pattern, std::span<const SpectrumPoint> spectrum, double length_m, int count,
                  const core::DrawKey& key);

/// The finger at one moment, as events see it.
struct Situation {
  double time_s = 0, place_m = 0, speed_m_s = 0, normal_N = 0;
  bool contact = false;
};

/// Which triggers are active.
struct PatternState {
  std::array<double, kMostParts> since_s{};  ///< time of each part's event; meaningless unless active
  std::array<bool, kMostParts> active{}, below{};
};

/// Updates the triggers; call it once in each period.
void note(const Pattern& pattern, PatternState& state, const Situation& now) noexcept;

/// The asked value at a place and time.
double asked_at(const Pattern& pattern, const PatternState& state, double place_m, double time_s) noexcept;

}  // namespace turnpoint::follow

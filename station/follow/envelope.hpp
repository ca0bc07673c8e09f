#pragma once
#include <limits>
#include <span>
#include <type_traits>

#include "station/follow/gain_map.hpp"
#include "station/follow/pattern.hpp"

namespace turnpoint::follow {

/// Gains in one period. The last one holds at the period's end; between them, and from the last gain of the
/// period before, the gain is a straight line.
inline constexpr int kGains = 8;

/// The plate's envelope follows the gain like a first-order low-pass with this time constant: Q / (pi f).
double envelope_time_constant_s(double quality, double frequency_Hz);

/// The plate and the limits of the gain.
struct Envelope {
  double time_constant_s = 0.64e-3;  ///< Q = 60 at 30 kHz
  double most_gain = 1;              ///< that of the GainMap
  double slew_per_s = 8000;          ///< largest change of the gain per second
  double step_s = 62.5e-6;           ///< distance of the gains: an eighth of a period
};

/// Turns wished amplitudes into gains whose envelope follows them: the gain is r + T r' + k (r - a), where r
/// is the wish, r' its slope from the neighbours (central difference, so that the shaper adds no delay), T
/// the time constant and a the modelled envelope. Without limits the first two terms are the exact inverse of
/// the plate, and the third is zero; after a limit it removes what is left with a time constant of 0.16 ms,
/// or of the time in which the gain can cross its range if that is longer. The gain stays between 0 and
/// most_gain, and changes no faster than the slew limit. Between two gains it is a straight line.
class EnvelopeShaper {
 public:
  EnvelopeShaper() : EnvelopeShaper(Envelope{}) {}
  /// Begins with the gain `start` and an envelope that has settled there. Throws std::invalid_argument for
  /// values that are not above 0, and for a start beyond the limits.
  explicit EnvelopeShaper(const Envelope& envelope, double start = 0);

  /// The gain at `now`, from the wish one step before, at, and one step after it. A wish that is not finite
  /// counts as the start.
  double next(double before, double now, double after) noexcept;
  /// Takes this gain as it is, within limit and slew, without the inverse. Returns the gain.
  double put(double gain) noexcept;
  double gain() const noexcept { return gain_; }
  double amplitude() const noexcept { return amplitude_; }  ///< the modelled envelope
  const Envelope& envelope() const noexcept { return envelope_; }

 private:
  Envelope envelope_;
  double keep_ = 0, from_last_ = 0, from_this_ = 0, catch_up_ = 0;
  double start_ = 0, gain_ = 0, amplitude_ = 0;
};
static_assert(std::is_trivially_copyable_v<EnvelopeShaper>);

/// The highest frequency at which the envelope can swing by `swing` to both sides of `mean` (as gains)
/// without a limit; infinite for a swing of 0, and 0 if the swing itself does not fit.
double bandwidth_Hz(const Envelope& envelope, double mean, double swing);

/// How a texture would be felt at a constant speed around a place.
struct Presented {
  double frequency_Hz = 0;
  double amplitude_ratio = 0;  ///< of the fundamental of friction: felt to asked
  double phase_cycles = 0;     ///< of the fundamental; positive if felt late
  double residual = 0;         ///< rms of felt minus asked, to the rms of the asked variation
  double limited = 0;          ///< fraction of the time at a limit of gain or slew
  /// At most 10 % of amplitude and 5 % of a period off, and at least 8 gains in a period. For a texture
  /// without jumps also a residual below 15 %.
  bool presentable = false;
};

/// Computes what the shaper makes of a texture (sine, square, triangle or table), for a finger with this
/// coefficient of friction on the surface at rest and updates of this period. `below` has the table, and the
/// base and parts to which a texture is added that does not replace them: their value at the place, at time 0
/// and without events. Delays count as predicted. Throws std::invalid_argument for another shape, for limits
/// of map and envelope that differ, and for a texture that does not vary under the finger or with less than
/// one cycle in 200000 gains. Some 0.5 ms.
Presented presented(const Pattern& below, const Part& texture, const GainMap& map, const Envelope& envelope,
                    double period_s, double resting_friction, double place_m, double speed_m_s);

}  // namespace turnpoint::follow

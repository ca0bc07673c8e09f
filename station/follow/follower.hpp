#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "station/follow/delay.hpp"
#include "station/follow/envelope.hpp"
#include "station/follow/finger.hpp"
#include "station/follow/friction_loop.hpp"
#include "station/follow/gain_map.hpp"
#include "station/follow/pattern.hpp"

namespace turnpoint::follow {

enum class Control {
  open,   ///< by the friction table and `resting_friction` alone
  closed  ///< corrected by the measured friction
};

/// Everything that a follower needs, prepared before the trial.
struct Plan {
  Pattern pattern;
  GainMap map;
  Envelope envelope;  ///< step_s is set by the constructor of Follower
  Timing timing;
  EstimatorSettings estimator;  ///< rate and strip are set by the constructor of Follower
  LoopSettings loop;
  Control control = Control::open;
  double resting_friction = 1;  ///< coefficient of friction of the surface at rest, as measured
  bool resting_known = true;    ///< false: it stands for a value that nobody has stated
  double resting_gain = 0;      ///< without a finger, and after a fault
  double ramp_s = 5e-3;         ///< from the gain at a fault to the resting gain, in a straight line
  double resume_s = 10e-3;      ///< from there to following, after `steady_s` without a fault
  double steady_s = 5e-3;
  int most_age_periods = 4;  ///< of the newest sample beyond its normal age; older: Fault::late
};
static_assert(std::is_trivially_copyable_v<Plan>);

/// A fault must lead to the resting gain within this time.
inline constexpr double kMostUntilRest_s = 0.010;
/// The longest time from a fault to the resting gain: until it is certain (a window, or the age at which a
/// sample is late), a period until it is seen, the buffer, the converters, and the ramp.
double until_rest_s(const Plan& plan);

/// What one update gives: the gains of a period, and what was asked, commanded and felt.
struct Update {
  std::array<float, kGains> gain{};
  double place_m = 0, speed_m_s = 0;  ///< predicted for the middle of the period; speed of the newest sample
  double asked = 0;                   ///< friction or displacement at that place
  double modelled = 0;                ///< friction there, by the table and the modelled envelope
  double felt = std::numeric_limits<double>::quiet_NaN();  ///< measured friction of the newest sample; NaN if
                                                           ///< the finger does not slide
  double resting_friction = 0;                             ///< as the loop estimates it
  bool reachable = true;  ///< false if `asked` is beyond the finger's reach at that place
  Fault fault = Fault::lifted;
  float following = 0;  ///< 0: resting gain; 1: the gain follows the finger
  /// Bit n: Fault n has interrupted following since the start. Faults that come while following has not yet
  /// resumed belong to the first; but if the finger was too light to tell its place, and then lifts, that
  /// counts as lifted.
  std::uint32_t interrupted = 0;
  /// Bit n: Fault n has been seen since the start, also at rest.
  std::uint32_t seen = 0;
};
static_assert(std::is_trivially_copyable_v<Update> && sizeof(Update) == 96);

/// Computes the gain of a drive plan from what the finger does, period by period. Fixed size; after the
/// constructor nothing allocates, locks, throws or waits. One thread at a time.
class Follower {
 public:
  /// Throws std::invalid_argument for impossible settings and for a delay that is refused (with the sentence
  /// of delay.hpp), and if until_rest_s() is above kMostUntilRest_s. Until the first update the gain must be
  /// the resting gain.
  explicit Follower(const Plan& plan);

  /// The gains of the period that begins at this playback frame. `newest` is the newest sample; if there is
  /// none since the last call, pass the same one again. Its frame is the one that was played when it was
  /// captured: the converters' loop delay is subtracted, so it counts in how far `output_frame` is ahead.
  const Update& update(std::int64_t output_frame, const FingerSample& newest) noexcept;
  const Update& last() const noexcept { return update_; }
  const Plan& plan() const noexcept { return plan_; }

 private:
  static constexpr int kHistory = 64;

  Fault judge(std::int64_t output_frame, double newest_age_frames) noexcept;
  void name_interruption(Fault fault) noexcept;
  double wish_at(double place_m, double time_s, double& asked, bool& reachable) const noexcept;
  void learn(const FingerSample& newest) noexcept;
  double modelled_at(double frame) const noexcept;

  Plan plan_;
  double lead_frames_ = 0, normal_age_frames_ = 0, period_s_ = 0;
  FingerEstimator estimator_;
  EnvelopeShaper shaper_;
  FrictionLoop loop_;
  PatternState state_;
  Update update_;
  std::int64_t start_frame_ = -1;  ///< of the first update
  std::int64_t first_frame_ =
      -1;  ///< of the first period of the history, moved on by frames that were left out
  std::int64_t next_frame_ = -1, newest_frame_ = -1;
  double following_ = 0, leave_share_ = 0, leave_gain_ = 0, steady_s_ = 0, saturated_ = 0, wish_ = 0;
  double asked_ = 0;  ///< friction asked for at the last gain, as far as it can be felt
  bool saturation_ = false, leaving_ = false, too_light_ = false;
  Fault interruption_ = Fault::none;  ///< what has interrupted following, until it resumes
  std::uint32_t earlier_ = 0;         ///< Update::interrupted before that
  /// relative friction by table and modelled envelope at the middle of the newest periods
  std::array<float, kHistory> history_{};
  std::int64_t periods_ = 0;
};
static_assert(std::is_trivially_copyable_v<Follower>);

}  // namespace turnpoint::follow

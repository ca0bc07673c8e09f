#pragma once
#include <type_traits>

namespace turnpoint::follow {

/// How a measured friction corrects the model of this finger.
struct LoopSettings {
  double cutoff_Hz = 8;         ///< of the filter; see design_loop()
  double least_normal_N = 0.2;  ///< friction under a smaller force is not used
  double least_speed_m_s = 0.01;
  /// The finger must have moved this far in one direction: before, its skin is still being stretched.
  double settle_m = 2e-3;
  /// What comes on top of the known delay, by which share the table's slope may be wrong, and how much the
  /// largest disturbance may then be amplified. Follower refuses a cut-off that is too high for that.
  double unknown_delay_s = 5e-3, slope_share = 0.3, most_amplified = 1.5;
  double lowest = 0.05, highest = 3;  ///< of the coefficient of friction of the surface at rest
};

/// What a loop does to a disturbance of friction: a part of it remains, which depends on its frequency.
struct LoopMargins {
  bool stable = false;
  double most_amplified = 0;  ///< largest ratio of the remaining to the whole disturbance, at any frequency
  double at_Hz = 0;           ///< where that is
  double reduced_1_Hz = 0;    ///< how many times smaller a disturbance at 1 Hz becomes
  double reduced_3_Hz = 0;
};

/// The loop is an internal-model controller (Garcia & Morari 1982) in the logarithm of friction. Measured
/// friction divided by what the friction table says for the amplitude of that moment is an estimate of the
/// friction of the surface at rest; low-passed (F, first order), it divides the asked friction. With the
/// table's slope times `gain_ratio`, a delay D of the loop and the delay D' of its model, the part 1 - F
/// e^(-sD') over 1 - F e^(-sD') + gain_ratio F e^(-sD) remains of a disturbance. An integrator is inside, so
/// a drift is removed; the model sees the limited amplitude, so nothing winds up; and what the pattern asks
/// for is never fed back, only what differs from the table.
LoopMargins loop_margins(double cutoff_Hz, double model_delay_s, double delay_s, double gain_ratio);

/// What is known of the plant: the modelled delay, what may come on top of it, and by which share the slope
/// of the friction table may be wrong.
struct LoopUncertainty {
  double model_delay_s = 3e-3, added_delay_s = 2e-3, gain_share = 0.3;
  double most_amplified = 1.5;
};
struct LoopDesign {
  double cutoff_Hz = 0;
  LoopMargins nominal, worst;  ///< worst: the worst of each number over the uncertainty
};
/// Finds the highest cut-off up to 20 Hz (in steps of 0.25 Hz) with which no disturbance is amplified more
/// than allowed, for all plants of the uncertainty.
LoopDesign design_loop(const LoopUncertainty& uncertainty);

/// One measurement for the loop.
struct LoopMeasurement {
  double normal_N = 0, lateral_N = 0, speed_m_s = 0, travelled_m = 0;
  double modelled = 1;  ///< relative friction by the table at that moment
};

/// The estimate of this finger's friction on the surface at rest. Allocates and throws nothing.
class FrictionLoop {
 public:
  FrictionLoop() = default;
  FrictionLoop(const LoopSettings& settings, double resting_friction, double period_s);

  /// True if the finger presses and moves enough to slide freely.
  bool slides(double normal_N, double speed_m_s, double travelled_m) const noexcept {
    return normal_N >= settings_.least_normal_N &&
           (speed_m_s < 0 ? -speed_m_s : speed_m_s) >= settings_.least_speed_m_s &&
           travelled_m >= settings_.settle_m;
  }
  /// Friction of a measurement, lateral over normal force in the direction of movement; NaN if the finger
  /// does not slide freely or presses too little.
  double friction(const LoopMeasurement& measured) const noexcept;
  /// Takes the measurement of one period. Does nothing if its friction is NaN.
  void learn(const LoopMeasurement& measured) noexcept;
  double resting_friction() const noexcept { return resting_; }

 private:
  LoopSettings settings_;
  double take_ = 0, log_resting_ = 0, resting_ = 1;
};
static_assert(std::is_trivially_copyable_v<FrictionLoop>);

}  // namespace turnpoint::follow

#pragma once
// Joins a plant and a follower as a sound device would: periods of 96 frames, two of them on their way.
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "station/follow/follower.hpp"
#include "tests/follow/plant.hpp"
#include "tests/follow/tables.hpp"

namespace lab {

using namespace turnpoint;

/// A plan for a finger of which the table is known.
inline follow::Plan plan_of(const plant::Setup& setup) {
  follow::Plan plan;
  plan.map = map_of(setup, table_of(setup));
  plan.envelope.time_constant_s = follow::envelope_time_constant_s(setup.quality, setup.resonance_Hz);
  plan.timing.cells_s = 2 * setup.damping / (2 * 3.14159265358979 * setup.cells_Hz);
  plan.timing.film_s = setup.film_s;
  plan.resting_friction = setup.friction;
  return plan;
}

/// What the tests look at, once in each eighth of a period.
struct Moment {
  double time_s, place_m, friction, felt, gain, normal_N;
};

/// Lets a test change the sample, the frame, or the update itself; period counts from 0.
struct Hooks {
  std::function<void(std::int64_t period, follow::FingerSample&)> sample;
  std::function<std::int64_t(std::int64_t period)> skip;  ///< frames that the device loses before this period
  std::function<void(std::int64_t period, const follow::Update&)> update;
  std::function<void(const Moment&)> moment;
};

class Lab {
 public:
  Lab(const plant::Setup& setup, const follow::Plan& plan) : plant_(setup), follower_(plan) {}

  void run(double seconds, const Hooks& hooks = {}) {
    const auto end = period_ + static_cast<std::int64_t>(seconds * plant::kRate_Hz / plant::kPeriod);
    for (; period_ < end; ++period_) {
      for (const float gain : queue_[static_cast<std::size_t>(period_ % 3)]) {
        plant_.step(static_cast<double>(gain));
        if (hooks.moment)
          hooks.moment({plant_.time_s(), plant_.place_m(), plant_.friction(), plant_.felt(), plant_.gain(),
                        plant_.normal_N()});
      }
      const auto read = plant_.reading();
      follow::FingerSample sample;
      // with a stated delay of the converters, the readings are older by it (Setup::added_delay_s)
      sample.frame = (period_ + 1) * plant::kPeriod - 144 + skipped_ -
                     std::lround(follower_.plan().timing.converter_s * plant::kRate_Hz);
      sample.normal_N = read.normal_N, sample.lateral_N = read.lateral_N, sample.moment_Nm = read.moment_Nm;
      if (hooks.skip) skipped_ += hooks.skip(period_);
      if (hooks.sample) hooks.sample(period_, sample);
      // period_ + 1 and + 2 are on their way, so this update is for period_ + 3
      const auto& update = follower_.update((period_ + 3) * plant::kPeriod + skipped_, sample);
      queue_[static_cast<std::size_t>(period_ % 3)] = update.gain;
      if (hooks.update) hooks.update(period_, update);
    }
  }

  plant::Plant& plant() { return plant_; }
  const follow::Follower& follower() const { return follower_; }

 private:
  plant::Plant plant_;
  follow::Follower follower_;
  std::array<std::array<float, follow::kGains>, 3> queue_{};
  std::int64_t period_ = 0, skipped_ = 0;
};

/// From x0 to x1 and back at a constant speed;
inline std::function<double(double)> strokes(double from_m, double to_m, double speed_m_s) {
  return [=](double t) {
    const double length = to_m - from_m, way = std::fmod(speed_m_s * t, 2 * length);
    return from_m + (way < length ? way : 2 * length - way);
  };
}

}  // namespace lab

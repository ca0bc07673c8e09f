#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "station/plant/setup.hpp"

namespace turnpoint::plant {

/// What the faults that are on at a frame amount to.
struct Condition {
  std::array<double, kMostTransducers> transducer_gain{};
  std::array<bool, 3> bridge_open{};  ///< a, b, lateral
  bool no_reference = false, lifted = false;
  double clip = 1e300;  ///< full scale
  std::int64_t late_frames = 0;
  double resonance = 1;  ///< factor on all resonances of the surface
  double frequency = 1;  ///< factor on what is driven
  double warmth_K = 0;   ///< above the surface's temperature
};

Condition condition_at(const Setup& setup, const std::vector<Fault>& faults, std::int64_t frame);

/// Captured frames that this fault loses; 0 if it is no gap.
std::int64_t frames_lost(const Fault& fault);

/// Throws std::invalid_argument, naming what is wrong, if there cannot be such a laboratory.
void validate(const Setup& setup, const std::vector<Fault>& faults);
Setup validated(const Setup& setup);

}  // namespace turnpoint::plant

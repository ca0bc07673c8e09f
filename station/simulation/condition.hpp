#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "station/simulation/setup.hpp"

namespace turnpoint::simulation {

/// The state of the laboratory at one frame, with all faults that are active then.
struct Condition {
  std::array<double, kMostTransducers> transducer_gain{};
  std::array<bool, 3> bridge_open{};  ///< true for each of the cells a, b and lateral that has an open wire
  std::array<bool, 3> bridge_dead{};  ///< true for each of the cells whose captured channel is exactly zero
  bool no_reference = false, lifted = false;
  double clip = 1e300;  ///< level at which the amplifier clips, as a fraction of full scale
  std::int64_t late_frames = 0;
  double resonance = 1;    ///< factor by which all resonance frequencies of the surface are multiplied
  double frequency = 1;    ///< factor by which the frequencies of the drive are multiplied
  double sounding_um = 0;  ///< amplitude of a tone at the drive edge that nobody plays
  double warmth_K = 0;     ///< present temperature minus Setup::surface_temperature_C
};

Condition condition_at(const Setup& setup, const std::vector<Fault>& faults, std::int64_t frame);

/// Number of captured frames that this fault loses; 0 if it is not a gap.
std::int64_t frames_lost(const Fault& fault);

/// Throws std::invalid_argument, with the reason, if such a laboratory is impossible.
void validate(const Setup& setup, const std::vector<Fault>& faults);
Setup validated(const Setup& setup);

}  // namespace turnpoint::simulation

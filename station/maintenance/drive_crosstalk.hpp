#pragma once
#include <functional>
#include <string>
#include <vector>

#include "station/io/probe.hpp"
#include "station/rig/rig.hpp"
#include "station/simulation/setup.hpp"

namespace turnpoint::maintenance {

/// By how much the drive of one transducer changes the measured force of a weight at rest. The drive couples
/// into the wires of the bridges, and amplifiers that distort turn that into a force that is not there.
struct DriveCrosstalk {
  std::string transducer;
  double frequency_Hz = 0;
  double normal_mN = 0, lateral_mN = 0;  ///< mean change while the drive is on
  double restless_mN = 0;                ///< standard deviation of the normal force while the drive is off
};

/// The mass that rests on the plate.
inline constexpr double kRestingMass_g = 50;
/// Largest allowed change of the force.
inline constexpr double kCrosstalkLimit_mN = 1;

/// Switches the drive of each transducer on and off, twice, while a weight rests on the plate. The tone has
/// half of the displacement that the rig allows. On a real rig this arms the amplifier, so only an operator
/// may request it; in the simulated laboratory, which `laboratory` may change, the weight stands in the
/// middle. Throws core::UsageError for a rig without calibrated force cells on its sound card,
/// std::runtime_error if a wire is off or frames were lost, and the errors of play_armed().
std::vector<DriveCrosstalk> measure_drive_crosstalk(
    const rig::Rig& rig, const std::function<void(simulation::Setup&)>& laboratory = {});

/// Judges one reading.
io::Finding judged(const DriveCrosstalk& reading);

}  // namespace turnpoint::maintenance

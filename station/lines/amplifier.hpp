#pragma once
#include <memory>
#include <string>

#include "station/drive/amplifier.hpp"

namespace turnpoint::lines {

/// The rig's amplifier: `sim:` or `gpio:enable=AMP_EN,fault=AMP_FAULT,stop=STOP,heartbeat=AMP_HB` (all but
/// enable may be absent). Fault and stop are active high unless `active=low` (both), `fault_active=low` or
/// `stop_active=low` is given. `read_back=off` is for a chip that cannot read the level of an output and says
/// nothing about it. Both have a guard thread (see guarded_amplifier.hpp); `sim:` keeps its lines in memory.
/// Throws terms::UsageError, LineError.
std::unique_ptr<drive::Amplifier> open_amplifier(const std::string& uri);

/// Drives the enable and heartbeat lines of such a rig low, whatever state a station that died has left them
/// in, and lets them go. Throws as above, LineError where a living program holds them, std::runtime_error
/// where the enable line reads high all the same.
void force_amplifier_off(const std::string& uri);

}  // namespace turnpoint::lines

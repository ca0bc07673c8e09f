#pragma once
#include <memory>
#include <string>

#include "station/audio/amplifier.hpp"

namespace turnpoint::io {

/// Opens the rig's amplifier: `sim:` or `gpio:enable=AMP_EN,fault=AMP_FAULT,stop=STOP,heartbeat=AMP_HB,
/// gate=AMP_GATE` (only enable is required; gate needs heartbeat). The fault and stop lines are active high,
/// unless `active=low` (for both), `fault_active=low` or `stop_active=low` is given. Use `read_back=off` for
/// a chip that reports wrong levels of its outputs without an error. Both kinds of amplifier have a guard
/// thread (see guarded_amplifier.hpp); `sim:` keeps its lines in memory. Throws core::UsageError, LineError.
std::unique_ptr<audio::Amplifier> open_amplifier(const std::string& uri);

/// Sets the enable and heartbeat lines of the amplifier at `uri` low, whatever state a dead station left them
/// in, and releases them. Throws the errors of open_amplifier, LineError if a running program holds the
/// lines, and std::runtime_error if the enable line still reads high.
void force_amplifier_off(const std::string& uri);

}  // namespace turnpoint::io

#pragma once
#include <memory>

#include "station/drive/output.hpp"

namespace turnpoint::drive {

/// Opens an ALSA device by its alsa-lib name (`hw:CARD=DAC,DEV=0`) in such a way that no sample is altered.
/// Throws OutputRefused with what was asked and what the device offers.
std::unique_ptr<Output> open_alsa(const OutputConfig& config, const std::string& name);

}  // namespace turnpoint::drive

#pragma once
#include <memory>

#include "station/drive/output.hpp"

namespace turnpoint::drive {

/// Opens a RIFF/WAVE file of 32-bit PCM for writing (WAVE_FORMAT_EXTENSIBLE, with the converter's depth as
/// valid bits). Writing fails with an error before the file reaches 4 GiB, the limit of the format. Throws
/// std::system_error if the file cannot be created.
std::unique_ptr<Output> open_wav(const OutputConfig& config, const std::string& path);

}  // namespace turnpoint::drive

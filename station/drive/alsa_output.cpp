#include "station/drive/alsa_output.hpp"

namespace turnpoint::drive {

std::unique_ptr<Output> open_alsa(const OutputConfig&, const std::string& name) {
  throw OutputRefused("alsa:" + name + ": not supported by this build");
}

}  // namespace turnpoint::drive

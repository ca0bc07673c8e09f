#include "station/drive/amplifier.hpp"

namespace turnpoint::drive {

const char* name(AmplifierState state) {
  switch (state) {
    case AmplifierState::disarmed:
      return "disarmed";
    case AmplifierState::armed:
      return "armed";
    case AmplifierState::enabled:
      return "enabled";
    case AmplifierState::faulted:
      return "faulted";
  }
  return "?";
}

}  // namespace turnpoint::drive

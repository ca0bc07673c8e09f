#include "station/audio/amplifier.hpp"

namespace turnpoint::audio {

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

}  // namespace turnpoint::audio

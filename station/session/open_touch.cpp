#include "station/session/open_touch.hpp"

#include <utility>

namespace turnpoint::session {

std::unique_ptr<io::TouchReader> open_touch(const rig::Rig& rig, io::TouchReader::OnState on_state) {
  const std::string scheme = "evdev:";
  if (!rig.touch_uri || rig.touch_uri->rfind(scheme, 0) != 0) return nullptr;
  return std::make_unique<io::TouchReader>(rig.touch_uri->substr(scheme.size()), std::move(on_state));
}

}  // namespace turnpoint::session

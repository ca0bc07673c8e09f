#include "station/app/touch.hpp"

#include <utility>

namespace turnpoint::app {

std::unique_ptr<panel::TouchReader> open_touch(const rig::Rig& rig, panel::TouchReader::OnState on_state) {
  const std::string scheme = "evdev:";
  if (!rig.touch_uri || rig.touch_uri->rfind(scheme, 0) != 0) return nullptr;
  return std::make_unique<panel::TouchReader>(rig.touch_uri->substr(scheme.size()), std::move(on_state));
}

}  // namespace turnpoint::app

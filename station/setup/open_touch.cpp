#include "station/setup/open_touch.hpp"

#include <utility>

namespace turnpoint::setup {

std::unique_ptr<touch::TouchReader> open_touch(const rig::Rig& rig, touch::TouchReader::OnState on_state) {
  const std::string scheme = "evdev:";
  if (!rig.touch_uri || rig.touch_uri->rfind(scheme, 0) != 0) return nullptr;
  return std::make_unique<touch::TouchReader>(rig.touch_uri->substr(scheme.size()), std::move(on_state));
}

}  // namespace turnpoint::setup

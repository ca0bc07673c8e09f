#pragma once
#include <memory>

#include "station/panel/touch_reader.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::app {

/// The reader that gives touches their kernel time, for a rig whose `[touch] uri` is `evdev:DEVICE`; null for
/// `qt:`, `sim:` and rigs without touch, whose touches have the toolkit's time. Throws as panel::TouchReader.
std::unique_ptr<panel::TouchReader> open_touch(const rig::Rig& rig, panel::TouchReader::OnState on_state);

}  // namespace turnpoint::app

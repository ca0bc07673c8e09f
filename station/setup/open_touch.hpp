#pragma once
#include <memory>

#include "station/rig/rig.hpp"
#include "station/touch/touch_reader.hpp"

namespace turnpoint::setup {

/// Makes the reader that provides the kernel time of touches, for a rig whose `[touch] uri` is
/// `evdev:DEVICE`. Returns null for `qt:`, `sim:` and rigs without touch, whose touches have the toolkit's
/// time. Throws the errors of touch::TouchReader.
std::unique_ptr<touch::TouchReader> open_touch(const rig::Rig& rig, touch::TouchReader::OnState on_state);

}  // namespace turnpoint::setup

#pragma once
#include <memory>

#include "station/rig/rig.hpp"
#include "station/touch/touch_reader.hpp"

namespace turnpoint::setup {

/// Opens a reader for the kernel's time of touches, if the rig's `[touch] uri` is `evdev:DEVICE`. Returns
/// null for `qt:`, `sim:` and rigs without touch; their touches have the toolkit's time. Throws the errors of
/// touch::TouchReader.
std::unique_ptr<touch::TouchReader> open_touch(const rig::Rig& rig, touch::TouchReader::OnState on_state);

}  // namespace turnpoint::setup

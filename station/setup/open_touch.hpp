#pragma once
#include <memory>

#include "station/rig/rig.hpp"
#include "station/touch/touch_reader.hpp"

namespace turnpoint::setup {

/// Opens a reader for the kernel's time stamps of touches, if the rig's `[touch] uri` is `evdev:DEVICE`.
/// Returns null if it is `qt:` or `sim:`, or if the rig has no `[touch]`; touches then have Qt's time stamps.
/// Throws the errors of touch::TouchReader.
std::unique_ptr<touch::TouchReader> open_touch(const rig::Rig& rig, touch::TouchReader::OnState on_state);

}  // namespace turnpoint::setup

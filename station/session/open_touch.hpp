#pragma once
#include <memory>

#include "station/io/touch_reader.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::session {

/// Opens a reader for the kernel's time stamps of touches, if the rig's `[touch] uri` is `evdev:DEVICE`.
/// Returns null if it is `qt:` or `sim:`, or if the rig has no `[touch]`; touches then have Qt's time stamps.
/// Throws the errors of io::TouchReader.
std::unique_ptr<io::TouchReader> open_touch(const rig::Rig& rig, io::TouchReader::OnState on_state);

}  // namespace turnpoint::session

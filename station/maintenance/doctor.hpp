#pragma once
#include <string>
#include <vector>

#include "station/lines/probe.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::maintenance {

using lines::try_input_devices;

/// Looks at everything a session on this rig depends on: converter (rate, type, depth, measured clock: two
/// seconds of silence), GPIO lines, touch, display, input devices, real-time rights, swap, watchdog, disk,
/// clock. Changes nothing; the amplifier stays off. `data_path` is where databases go.
std::vector<lines::Finding> examine(const rig::Rig& rig, const std::string& data_path);

/// Whether the machine swaps: a page that has to come back from a card takes longer than a buffer lasts.
/// `swaps` is the kernel's list.
lines::Finding check_swap(const std::string& swaps = "/proc/swaps");

/// Whether the hardware watchdog is fed, which resets a kernel that hangs. `folder` is where the kernel lists
/// them.
lines::Finding check_watchdog(const std::string& folder = "/sys/class/watchdog");

/// True where nothing failed; warnings do not count.
bool fit_for_use(const std::vector<lines::Finding>& checks);

}  // namespace turnpoint::maintenance

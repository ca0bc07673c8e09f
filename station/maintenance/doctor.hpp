#pragma once
#include <string>
#include <vector>

#include "station/lines/probe.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::maintenance {

using lines::try_input_devices;

/// Examines everything that a session on this rig depends on: converter (rate, type, depth, clock measured
/// during two seconds of silence), GPIO lines, touch, display, input devices, real-time rights, swap,
/// watchdog, disk, clock. Changes nothing; the amplifier stays off. `data_path` is the folder for databases.
std::vector<lines::Finding> examine(const rig::Rig& rig, const std::string& data_path);

/// Checks whether the machine swaps, because reading a page back from a card takes longer than a buffer
/// lasts. `swaps` is the kernel's list.
lines::Finding check_swap(const std::string& swaps = "/proc/swaps");

/// Checks whether the hardware watchdog, which resets a kernel that hangs, is in use. `folder` is where the
/// kernel lists watchdogs.
lines::Finding check_watchdog(const std::string& folder = "/sys/class/watchdog");

/// True if nothing failed; warnings do not count.
bool fit_for_use(const std::vector<lines::Finding>& checks);

}  // namespace turnpoint::maintenance

#pragma once
#include <string>
#include <vector>

#include "station/io/probe.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::maintenance {

using io::try_input_devices;

/// Examines everything on which a session on this rig depends: converter (rate, type, depth, and its clock
/// during some seconds of silence), capture device and the calibration of its pick-ups, GPIO lines, touch,
/// display, input devices, real-time rights, swap, watchdog, disk, clock. Changes nothing; the amplifier
/// stays off. `data_path` is the folder for databases.
std::vector<io::Finding> examine(const rig::Rig& rig, const std::string& data_path);

/// Checks that the machine does not swap. Reading a page of memory back from a memory card takes longer than
/// an audio buffer lasts. `swaps` is the kernel's list of swap areas.
io::Finding check_swap(const std::string& swaps = "/proc/swaps");

/// Checks that the hardware watchdog is in use. It resets the machine if the kernel hangs. `folder` is where
/// the kernel lists watchdogs.
io::Finding check_watchdog(const std::string& folder = "/sys/class/watchdog");

/// False for a device of alsa-lib that names no card, such as alsa:default, or names it by its number, as in
/// alsa:hw:0 or alsa:plughw:CARD=0: after the next boot, this may be another card.
bool names_a_card(const std::string& uri);

/// Checks the file system of the data folder, as system::Disk names it: fails for those that lose their files
/// when the machine is switched off, and warns of network and FUSE mounts.
io::Finding check_file_system(const std::string& file_system);

/// True if no check failed. Warnings do not count.
bool fit_for_use(const std::vector<io::Finding>& checks);

}  // namespace turnpoint::maintenance

#pragma once
#include <poll.h>

#include <cstdint>
#include <string>
#include <vector>

#include "station/io/lines.hpp"

namespace turnpoint::io {

/// Paths of the machine's GPIO chips in the order of their numbers.
std::vector<std::string> chip_paths();

/// Waits until one of the descriptors is readable. Returns its index, or nothing after `timeout_ns`. If a
/// descriptor hangs up or fails, its chip is gone, and the function throws ENODEV. The kernel reports the
/// loss of a chip in no other way.
std::optional<std::size_t> wait_readable(std::vector<pollfd>& descriptors, std::int64_t timeout_ns, int wake);

[[noreturn]] void throw_line_error(int error, const std::string& name, const std::string& what);

}  // namespace turnpoint::io

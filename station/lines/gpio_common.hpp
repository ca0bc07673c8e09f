#pragma once
#include <poll.h>

#include <string>
#include <vector>

#include "station/lines/lines.hpp"

namespace turnpoint::lines {

/// Paths of the machine's GPIO chips in the order of their numbers.
std::vector<std::string> chip_paths();

/// Waits for one of the descriptors; its index, or none after `timeout_ns`. A descriptor that hangs up or
/// fails means that its chip is gone, which the holder of a line is told in no other way: throws ENODEV.
std::optional<std::size_t> wait_readable(std::vector<pollfd>& descriptors, std::int64_t timeout_ns, int wake);

[[noreturn]] void throw_line_error(int error, const std::string& name, const std::string& what);

}  // namespace turnpoint::lines

#pragma once
#include <cstdint>
#include <string>

namespace turnpoint::store {

/// A random UUID (version 4, RFC 9562) from the kernel's random numbers.
std::string new_uuid();

/// Wall-clock time in ns since 1970: for records only, never for durations.
std::int64_t realtime_ns();

}  // namespace turnpoint::store

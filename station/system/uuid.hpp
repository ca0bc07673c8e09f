#pragma once
#include <string>

namespace turnpoint::system {

/// A random UUID (version 4, RFC 9562) from the kernel's random numbers.
std::string new_uuid();

}  // namespace turnpoint::system

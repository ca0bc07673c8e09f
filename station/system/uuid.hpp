#pragma once
#include <string>

namespace turnpoint::system {

/// Returns a random UUID (version 4, RFC 9562), made from the kernel's random numbers.
std::string new_uuid();

}  // namespace turnpoint::system

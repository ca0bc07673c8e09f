#pragma once
#include <string>

#include "station/core/toml.hpp"

namespace turnpoint::core {

/// The canonical form of a document: JSON without spaces, with sorted keys and with numbers in the shortest
/// text that reads back as the same double. Two files that differ only in order, spacing, notation or
/// comments have the same canonical form.
std::string canonical(const Value& value);

}  // namespace turnpoint::core

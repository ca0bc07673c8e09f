#pragma once
#include <string>

#include "station/text/toml.hpp"

namespace turnpoint::text {

/// A document in its one canonical form: JSON without spaces, keys sorted, numbers in the shortest text that
/// reads back as the same double. Two files that say the same in another order, spacing or notation have the
/// same form; comments are not part of it.
std::string canonical(const Value& value);

}  // namespace turnpoint::text

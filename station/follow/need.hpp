#pragma once
#include <stdexcept>

namespace turnpoint::follow {

/// Throws std::invalid_argument with this message unless `holds`.
inline void need(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(message);
}

}  // namespace turnpoint::follow

#pragma once
#include <cstdint>
#include <optional>

namespace turnpoint::touch {

/// A finger touches the surface of the rig, or leaves it.
struct Contact {
  std::int64_t time_ns = 0;
  bool on = false;
  std::optional<double>
      position;  ///< along the surface, from 0 at one end of the sensor to 1 at the other, if it can tell
};

}  // namespace turnpoint::touch

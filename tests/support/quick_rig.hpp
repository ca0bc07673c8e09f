#pragma once
#include <string>

#include "station/core/read_file.hpp"
#include "station/rig/rig.hpp"
#include "tests/support/replaced.hpp"

/// Returns the file of the rig with the thin plate, changed to simply supported sides and a thicker plate.
/// Its boundary map is nearly the same but has a closed form, so that surveys of protocols are fast.
inline std::string quick_rig_source() {
  const auto text =
      turnpoint::core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/tests/support/thin_plate.toml");
  return replaced(replaced(text, "edges = \"clamped\"", "edges = \"supported\""), "thickness_mm = 2.0",
                  "thickness_mm = 4.2");
}

inline turnpoint::rig::Rig quick_rig() { return turnpoint::rig::parse(quick_rig_source(), "r.toml"); }

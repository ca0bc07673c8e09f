#pragma once
#include <stdexcept>
#include <string>

#include "station/core/read_file.hpp"
#include "station/rig/rig.hpp"

/// Returns `text` with the first `from` replaced. Throws if `text` does not contain it.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("not in the text: " + from);
  return text.replace(at, from.size(), to);
}

/// Returns the file of the rig with the thin plate, changed to simply supported sides and a thicker plate.
/// Its boundary map is nearly the same but has a closed form, so that surveys of protocols are fast.
inline std::string quick_rig_source() {
  const auto text =
      turnpoint::core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/tests/support/thin_plate.toml");
  return replaced(replaced(text, "edges = \"clamped\"", "edges = \"supported\""), "thickness_mm = 2.0",
                  "thickness_mm = 4.2");
}

inline turnpoint::rig::Rig quick_rig() { return turnpoint::rig::parse(quick_rig_source(), "r.toml"); }

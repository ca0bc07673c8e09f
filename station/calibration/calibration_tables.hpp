#pragma once
#include <fmt/format.h>

#include <cstddef>
#include <string>

#include "station/calibration/calibration.hpp"
#include "station/text/number.hpp"
#include "station/text/reader.hpp"

// Helpers for reading and writing the tables of a calibration file.
namespace turnpoint::calibration {

std::string quoted(const std::string& plain);

/// One line `key = [...]`, with one number for each point.
template <typename Points, typename Get>
std::string numbers(const char* key, const Points& points, Get&& get) {
  std::string out = fmt::format("{} = [", key);
  for (std::size_t k = 0; k < points.size(); ++k) out += (k ? ", " : "") + text::exact(get(points[k]));
  return out + "]\n";
}

/// Returns true if the columns have equal length; otherwise reports a problem.
bool same_length(text::TableReader& reader, const char* key, std::size_t length, std::size_t wanted);

/// Write and read the table [[pickup]] of a calibration file.
std::string pick_up_toml(const PickUp& pick_up);
PickUp read_pick_up(const text::Value& table, text::Findings& findings);

/// Write and read the table [forces] of a calibration file.
std::string forces_toml(const rig::ForceCells& forces);
rig::ForceCells read_forces(const text::Value& table, text::Findings& findings);

}  // namespace turnpoint::calibration

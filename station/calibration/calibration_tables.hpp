#pragma once
#include <fmt/format.h>

#include <cstddef>
#include <string>

#include "station/calibration/calibration.hpp"
#include "station/text/number.hpp"
#include "station/text/reader.hpp"

// Helpers that both the readers and the writers of the tables in a calibration file use.
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

/// The table [[pickup]].
std::string pick_up_toml(const PickUp& pick_up);
PickUp read_pick_up(const text::Value& table, text::Findings& findings);

/// The table [forces].
std::string forces_toml(const rig::ForceCells& forces);
rig::ForceCells read_forces(const text::Value& table, text::Findings& findings);

}  // namespace turnpoint::calibration

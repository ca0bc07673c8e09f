#pragma once
#include <string>
#include <vector>

#include "station/text/reader.hpp"

namespace turnpoint::rig {

/// Rows of numbers from a comma-separated file whose first line must name exactly `columns`; lines that start
/// with # and empty lines are skipped. Problems (with the line in that file) go to `findings`; the rows that
/// could be read are returned. `needed_by` is where the rig file names it.
std::vector<std::vector<double>> read_table(const std::string& path, const std::vector<std::string>& columns,
                                            const text::Place& needed_by, text::Findings& findings);

}  // namespace turnpoint::rig

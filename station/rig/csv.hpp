#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "station/core/reader.hpp"

namespace turnpoint::rig {

/// Reads rows of numbers from a file whose first line must name exactly `columns`. Cells are separated by
/// commas, semicolons or tabs; with the latter two, numbers may have decimal commas. Skips a byte order mark,
/// empty lines and lines that start with #. Adds problems, with their line in that file, to `findings` and
/// returns the readable rows. `needed_by` is the place in the rig file that names the file. Fewer than
/// `least` rows are a problem.
std::vector<std::vector<double>> read_table(const std::string& path, const std::vector<std::string>& columns,
                                            const core::Place& needed_by, core::Findings& findings,
                                            std::size_t least = 2);

}  // namespace turnpoint::rig

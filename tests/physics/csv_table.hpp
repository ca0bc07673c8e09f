#pragma once
// Reads the tables of reference values ("oracles") in tests/physics/oracles.
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace turnpoint::physics_test {

// Returns all rows of the file tests/physics/oracles/NAME, split at commas.
inline std::vector<std::vector<std::string>> oracle(const std::string& name) {
  const std::string path = std::string(TURNPOINT_SOURCE_DIR) + "/tests/physics/oracles/" + name;
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream cells(line);
    auto& row = rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
  }
  return rows;
}

}  // namespace turnpoint::physics_test

#pragma once
#include <fstream>
#include <stdexcept>
#include <string>

#include "station/core/read_file.hpp"

// Files of the source tree that are made from declarations in the code.
namespace turnpoint::tests {

inline std::string in_source(const std::string& path) {
  return core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/" + path);
}

inline void write_source(const std::string& path, const std::string& text) {
  std::ofstream file(std::string(TURNPOINT_SOURCE_DIR) + "/" + path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path);
}

}  // namespace turnpoint::tests

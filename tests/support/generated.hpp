#pragma once
#include <fstream>
#include <stdexcept>
#include <string>

#include "station/core/read_file.hpp"

// Files of the source tree that are made from declarations in the code, wholly or between two markers.
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

inline const std::string begin_of_generated = "<!-- generated from the declared keys -->\n";
inline const std::string end_of_generated = "<!-- end of the generated part -->\n";

/// The part of a page between the two markers.
inline std::string generated_part(const std::string& path) {
  const auto page = in_source(path);
  const auto begin = page.find(begin_of_generated), end = page.find(end_of_generated);
  if (begin == std::string::npos || end == std::string::npos)
    throw std::runtime_error(path + " has no markers of a generated part");
  return page.substr(begin + begin_of_generated.size(), end - begin - begin_of_generated.size());
}

inline void write_generated_part(const std::string& path, const std::string& part) {
  auto page = in_source(path);
  const auto begin = page.find(begin_of_generated) + begin_of_generated.size();
  page.replace(begin, page.find(end_of_generated) - begin, part);
  write_source(path, page);
}

}  // namespace turnpoint::tests

#pragma once
#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>

namespace turnpoint::cli {

/// Writes a whole file, replacing what was there. Throws std::system_error naming it.
inline void write_file(const std::string& path, const std::string& content) {
  std::ofstream file(path, std::ios::binary);
  file << content;
  if (!file.flush()) throw std::system_error(errno, std::generic_category(), "writing " + path);
}

}  // namespace turnpoint::cli

#pragma once
#include <sys/stat.h>

#include <string>
#include <string_view>
#include <vector>

#include "station/core/file_descriptor.hpp"

namespace turnpoint::core {

/// Reads a file piece by piece. Throws std::system_error with the file's name if the file cannot be opened or
/// read, or is not a regular file (a folder, a pipe, a device). The process remembers which files it has
/// read, and FileWriter refuses to replace them.
class FileReader {
 public:
  explicit FileReader(const std::string& path);

  /// Returns the next bytes, valid until the next call. Returns nothing at the end of the file.
  std::string_view read();

 private:
  std::string path_;
  FileDescriptor file_;
  std::vector<char> buffer_ = std::vector<char>(1 << 16);
};

/// Returns the bytes of a file. Throws like FileReader; also throws if the file has more than `most_bytes`.
std::string read_file(const std::string& path, std::size_t most_bytes = std::size_t{256} << 20);

/// True if this process has read the file with this status by FileReader, and has not written it itself
/// before.
bool was_read(const struct stat& file);
/// Makes the file an output of this process: reading it later does not protect it.
void mark_written(const struct stat& file);

}  // namespace turnpoint::core

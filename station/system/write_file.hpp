#pragma once
#include <sys/types.h>

#include <string>
#include <string_view>

#include "station/system/file_descriptor.hpp"

namespace turnpoint::system {

/// Writes a file completely or leaves it unchanged. The bytes go to PATH.new; commit() syncs that file and
/// renames it to PATH. `mode` is reduced by the process's umask. A device or a pipe is written directly.
///
/// It is safe for root to write into another user's folder: a symbolic link that another user has made is
/// refused, and whatever exists as PATH.new is replaced and never followed. All functions throw
/// std::system_error with the file's name.
class FileWriter {
 public:
  explicit FileWriter(const std::string& path, mode_t mode = 0666);
  FileWriter(FileWriter&& other) noexcept;
  FileWriter& operator=(FileWriter&&) = delete;
  ~FileWriter();  ///< removes PATH.new unless it was committed

  void write(std::string_view bytes);
  void commit();

 private:
  std::string path_, draft_;  ///< draft_ is PATH.new; "" for a device, and after commit()
  FileDescriptor file_;
};

/// Writes a file as FileWriter does. Use this if all bytes are already in memory.
void write_file(const std::string& path, std::string_view bytes, mode_t mode = 0666);

/// Makes a folder and the folders above it, unless they exist. Throws std::system_error with the folder's
/// name.
void make_folder(const std::string& path);

}  // namespace turnpoint::system

#pragma once
#include <sys/types.h>

#include <string>
#include <string_view>

#include "station/system/file_descriptor.hpp"

namespace turnpoint::system {

/// Writes a whole file or changes nothing. The bytes go to PATH.new; commit() syncs it and renames it to
/// PATH. `mode` is reduced by the process's umask. A device or a pipe is written directly. A symbolic link
/// that another user has made is refused, and anything that already exists as PATH.new is replaced and never
/// followed, so that root can safely write into another user's folder. All functions throw std::system_error
/// naming the file.
class FileWriter {
 public:
  explicit FileWriter(const std::string& path, mode_t mode = 0666);
  FileWriter(FileWriter&& other) noexcept;
  FileWriter& operator=(FileWriter&&) = delete;
  ~FileWriter();  ///< removes PATH.new unless it was committed

  void write(std::string_view bytes);
  void commit();

 private:
  std::string path_, draft_;  ///< draft_: "" for a device, and after commit()
  FileDescriptor file_;
};

/// The same for bytes that are already complete.
void write_file(const std::string& path, std::string_view bytes, mode_t mode = 0666);

}  // namespace turnpoint::system

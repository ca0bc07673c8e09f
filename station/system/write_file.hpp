#pragma once
#include <sys/types.h>

#include <stdexcept>
#include <string>
#include <string_view>

#include "station/core/file_descriptor.hpp"

namespace turnpoint::system {

/// Thrown if a file must not be written because of what is there: a database, one of the inputs of this
/// program, a folder, a disk.
class RefusedDestination : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a FileWriter may replace. `input` is for a program that reads a file, changes it and writes it again.
enum class Replaces { output, input };

/// Writes a file completely or leaves it unchanged. The bytes go to a draft beside the file (PATH.new, or
/// PATH.new2 and so on while other processes write the same file). commit() syncs the draft, renames it to
/// PATH, and syncs the folder. `mode` is reduced by the process's umask. A device or a pipe is written
/// directly.
///
/// Every output of the program is written by this class, and it refuses to replace an SQLite database, the
/// files beside one, whatever has a lock file beside it, and a file that this process has read (see
/// core::FileReader) unless `replaces` allows it. Throws RefusedDestination then, and for a folder or a disk.
///
/// It is safe for root to write into another user's folder: a symbolic link that another user has made is
/// refused, and a draft that a killed process left is replaced and never followed. All functions throw
/// std::system_error with the file's name if a system call fails.
class FileWriter {
 public:
  explicit FileWriter(const std::string& path, mode_t mode = 0666, Replaces replaces = Replaces::output);
  FileWriter(FileWriter&& other) noexcept;
  FileWriter& operator=(FileWriter&&) = delete;
  ~FileWriter();  ///< removes the draft unless it was committed

  void write(std::string_view bytes);
  /// Writes over the first bytes, for a header that states the file's length. Fails for a pipe.
  void write_start(std::string_view bytes);
  void commit();

 private:
  void open_draft(mode_t mode);

  std::string path_, draft_;  ///< draft_ is "" for a device, and after commit()
  core::FileDescriptor file_;
};

/// Writes a file as FileWriter does. Use this if all bytes are already in memory.
void write_file(const std::string& path, std::string_view bytes, mode_t mode = 0666,
                Replaces replaces = Replaces::output);

/// Makes the entries of a folder durable. Folders that cannot be synced (some network and FUSE mounts, FAT)
/// count as synced, because nothing more can be done there. Throws std::system_error for any other failure.
void sync_folder(const std::string& path);

/// True if a system call failed because the file system does not offer it: some network and FUSE mounts, and
/// FAT, refuse chmod, or fsync of a folder.
bool not_offered(int error);

/// Makes a folder and the folders above it, unless they exist. Throws std::system_error with the folder's
/// name.
void make_folder(const std::string& path);

/// Makes failed writes return an error instead of killing the process: to a closed pipe (SIGPIPE), and beyond
/// the limit on file size (SIGXFSZ). If standard input, output or error is closed, opens something in its
/// place, so that no file gets its number; writing to it fails. Call this before any file is opened.
void let_writes_fail();

}  // namespace turnpoint::system

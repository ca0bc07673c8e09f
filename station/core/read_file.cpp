#include "station/core/read_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <map>
#include <mutex>
#include <system_error>
#include <utility>

namespace turnpoint::core {

namespace {

[[noreturn]] void refuse(const std::string& path, int error) {
  throw std::system_error(error, std::generic_category(), path);
}

/// The files that this process has read or written. Global, because what is read in one place of the program
/// must not be replaced in any other. The time of the last change tells a file from a later one that has
/// its inode.
struct KnownFiles {
  struct Use {
    bool written = false;
    timespec changed{};
  };
  std::mutex mutex;
  std::map<std::pair<dev_t, ino_t>, Use> files;

  /// The use of this very file; null if it is not known.
  Use* find(const struct stat& file) {
    const auto found = files.find({file.st_dev, file.st_ino});
    if (found == files.end()) return nullptr;
    const auto& changed = found->second.changed;
    const bool same = changed.tv_sec == file.st_ctim.tv_sec && changed.tv_nsec == file.st_ctim.tv_nsec;
    return same ? &found->second : nullptr;
  }
};

KnownFiles& known_files() {
  static KnownFiles known;
  return known;
}

}  // namespace

bool was_read(const struct stat& file) {
  auto& known = known_files();
  const std::lock_guard lock(known.mutex);
  const auto* use = known.find(file);
  return use != nullptr && !use->written;
}

void mark_written(const struct stat& file) {
  auto& known = known_files();
  const std::lock_guard lock(known.mutex);
  known.files[{file.st_dev, file.st_ino}] = {true, file.st_ctim};
}

// With O_NONBLOCK, opening a pipe does not wait for a writer.
FileReader::FileReader(const std::string& path)
    : path_(path), file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  if (!file_.is_open()) refuse(path_, errno);
  struct stat status {};
  if (::fstat(file_.get(), &status) != 0) refuse(path_, errno);
  if (S_ISDIR(status.st_mode)) refuse(path_, EISDIR);
  if (!S_ISREG(status.st_mode))
    throw std::system_error(std::make_error_code(std::errc::invalid_argument),
                            path_ + ": not a file but a pipe or a device");
  auto& known = known_files();
  const std::lock_guard lock(known.mutex);
  if (known.find(status) == nullptr) known.files[{status.st_dev, status.st_ino}] = {false, status.st_ctim};
}

std::string_view FileReader::read() {
  for (;;) {
    const auto count = ::read(file_.get(), buffer_.data(), buffer_.size());
    if (count >= 0) return {buffer_.data(), static_cast<std::size_t>(count)};
    if (errno != EINTR) refuse(path_, errno);
  }
}

std::string read_file(const std::string& path, std::size_t most_bytes) {
  FileReader file(path);
  std::string bytes;
  for (auto part = file.read(); !part.empty(); part = file.read()) {
    bytes += part;
    if (bytes.size() > most_bytes)
      throw std::system_error(std::make_error_code(std::errc::file_too_large), path);
  }
  return bytes;
}

}  // namespace turnpoint::core

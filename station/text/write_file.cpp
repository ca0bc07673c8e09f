#include "station/text/write_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

namespace turnpoint::text {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, int code) {
  throw std::system_error(code, std::generic_category(), "writing " + path);
}

/// Where the bytes belong: the file behind the user's own or the system's links. Throws for a link that
/// another user has made.
std::string destination(const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0 || !S_ISLNK(status.st_mode)) return path;
  if (status.st_uid != 0 && status.st_uid != ::geteuid())
    throw std::system_error(ELOOP, std::generic_category(),
                            "writing " + path + ", a symbolic link that another user has made");
  return fs::weakly_canonical(path).string();
}

void write_all(int descriptor, std::string_view bytes, const std::string& path) {
  while (!bytes.empty()) {
    const auto written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path, errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// An open file that goes again, unless it was kept.
class Draft {
 public:
  Draft(const std::string& path, mode_t mode) : path_(path) {
    ::unlink(path.c_str());  // of a writer that was killed, or somebody's link
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
    if (descriptor_ < 0) fail(path, errno);
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  ~Draft() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!path_.empty()) ::unlink(path_.c_str());
  }

  void write(std::string_view bytes) {
    write_all(descriptor_, bytes, path_);
    if (::fsync(descriptor_) != 0) fail(path_, errno);
    if (::close(std::exchange(descriptor_, -1)) != 0) fail(path_, errno);
  }
  void keep_as(const std::string& path) {
    if (::rename(path_.c_str(), path.c_str()) != 0) fail(path, errno);
    path_.clear();
  }

 private:
  std::string path_;
  int descriptor_ = -1;
};

void write_through(const std::string& path, std::string_view bytes) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) fail(path, errno);
  try {
    write_all(descriptor, bytes, path);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  ::close(descriptor);
}

}  // namespace

void write_file(const std::string& path, std::string_view bytes, mode_t mode) {
  const auto place = destination(path);
  std::error_code missing;
  const auto status = fs::status(path, missing);
  if (fs::is_character_file(status) || fs::is_fifo(status)) return write_through(path, bytes);
  Draft draft(place + ".new", mode);
  draft.write(bytes);
  draft.keep_as(place);
}

}  // namespace turnpoint::text

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

/// The file to write after following links that belong to this user or to the system. Throws for a link that
/// another user has made.
std::string destination(const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0 || !S_ISLNK(status.st_mode)) return path;
  if (status.st_uid != 0 && status.st_uid != ::geteuid())
    throw std::system_error(ELOOP, std::generic_category(),
                            "writing " + path + ", a symbolic link that another user has made");
  return fs::weakly_canonical(path).string();
}

bool is_device(const std::string& path) {
  std::error_code missing;
  const auto status = fs::status(path, missing);
  return fs::is_character_file(status) || fs::is_fifo(status);
}

}  // namespace

FileWriter::FileWriter(const std::string& path, mode_t mode) : path_(destination(path)) {
  if (is_device(path)) {
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail(path, errno);
    return;
  }
  draft_ = path_ + ".new";
  ::unlink(draft_.c_str());  // left by a killed process, or somebody's link
  descriptor_ = ::open(draft_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
  if (descriptor_ < 0) fail(std::exchange(draft_, ""), errno);
}

FileWriter::FileWriter(FileWriter&& other) noexcept
    : path_(std::move(other.path_)),
      draft_(std::exchange(other.draft_, "")),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

FileWriter::~FileWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!draft_.empty()) ::unlink(draft_.c_str());
}

void FileWriter::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const auto written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(draft_.empty() ? path_ : draft_, errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void FileWriter::commit() {
  if (!draft_.empty() && ::fsync(descriptor_) != 0) fail(draft_, errno);
  if (::close(std::exchange(descriptor_, -1)) != 0 && !draft_.empty()) fail(draft_, errno);
  if (!draft_.empty() && ::rename(draft_.c_str(), path_.c_str()) != 0) fail(path_, errno);
  draft_.clear();
}

void write_file(const std::string& path, std::string_view bytes, mode_t mode) {
  FileWriter file(path, mode);
  file.write(bytes);
  file.commit();
}

}  // namespace turnpoint::text

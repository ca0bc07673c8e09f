#include "station/system/write_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

namespace turnpoint::system {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, int code) {
  throw std::system_error(code, std::generic_category(), "writing " + path);
}

/// Follows symbolic links and returns the file to write. Throws for a link that belongs to neither this user
/// nor root.
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
    file_ = FileDescriptor(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    if (!file_.is_open()) fail(path, errno);
    return;
  }
  draft_ = path_ + ".new";
  // remove what may already exist under this name: a file from a process that was killed, or a link made by
  // another user
  ::unlink(draft_.c_str());
  file_ = FileDescriptor(::open(draft_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode));
  if (!file_.is_open()) fail(std::exchange(draft_, ""), errno);
}

FileWriter::FileWriter(FileWriter&& other) noexcept
    : path_(std::move(other.path_)), draft_(std::exchange(other.draft_, "")), file_(std::move(other.file_)) {}

FileWriter::~FileWriter() {
  if (!draft_.empty()) ::unlink(draft_.c_str());
}

void FileWriter::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const auto written = ::write(file_.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(draft_.empty() ? path_ : draft_, errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void FileWriter::commit() {
  if (!draft_.empty() && ::fsync(file_.get()) != 0) fail(draft_, errno);
  if (::close(file_.release()) != 0 && !draft_.empty()) fail(draft_, errno);
  if (!draft_.empty() && ::rename(draft_.c_str(), path_.c_str()) != 0) fail(path_, errno);
  draft_.clear();
}

void write_file(const std::string& path, std::string_view bytes, mode_t mode) {
  FileWriter file(path, mode);
  file.write(bytes);
  file.commit();
}

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error || !fs::is_directory(path, error))
    throw std::system_error(error ? error : std::make_error_code(std::errc::not_a_directory),
                            "making the folder " + path);
}

}  // namespace turnpoint::system

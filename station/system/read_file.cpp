#include "station/system/read_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <system_error>

namespace turnpoint::system {

namespace {

[[noreturn]] void refuse(const std::string& path, int error) {
  throw std::system_error(error, std::generic_category(), path);
}

}  // namespace

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

}  // namespace turnpoint::system

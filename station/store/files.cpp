#include "station/store/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <functional>
#include <string_view>
#include <system_error>

#include "station/core/read_file.hpp"
#include "station/core/sha256.hpp"
#include "station/system/write_file.hpp"

namespace turnpoint::store {

namespace fs = std::filesystem;
using core::FileDescriptor;

namespace {

struct stat status_of(int descriptor, const std::string& path) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) fail_system(kind_of_errno(errno), path, errno, "check the disk");
  return status;
}

/// If root created the file, gives it to the owner of its folder. A file of an ordinary user keeps its owner.
void give_open_file_to_owner_of_folder(int descriptor, const std::string& path) {
  const auto file = status_of(descriptor, path);
  if (::geteuid() != 0 || file.st_uid != 0) return;
  struct stat folder {};
  const auto name = folder_of(path);
  const bool known = ::stat(name.c_str(), &folder) == 0;
  if (known && file.st_uid == folder.st_uid && file.st_gid == folder.st_gid) return;
  if (!known || ::fchown(descriptor, folder.st_uid, folder.st_gid) != 0)
    fail_system(kind_of_errno(errno), "owner of " + path, errno,
                "run this command as the user who owns the folder " + name);
}

}  // namespace

void fail_system(ErrorKind kind, const std::string& what, int code, const std::string& advice) {
  throw StoreError(kind, fmt::format("{}: {}; {}", what, std::strerror(code), advice));
}

ErrorKind kind_of_errno(int code) {
  if (code == ENOSPC || code == EDQUOT) return ErrorKind::disk_full;
  if (code == EACCES || code == EROFS || code == EPERM) return ErrorKind::read_only;
  return code == ENOENT ? ErrorKind::missing : ErrorKind::io;
}

bool file_exists(const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) == 0) return true;
  if (errno == ENOENT) return false;
  fail_system(kind_of_errno(errno), path, errno, "check the path, its permissions and the disk");
}

std::uint64_t file_size(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) return static_cast<std::uint64_t>(status.st_size);
  if (errno == ENOENT) return 0;
  fail_system(kind_of_errno(errno), path, errno, "check the path, its permissions and the disk");
}

namespace {

/// Reads a file and passes its bytes to `take`, piece by piece.
void read_pieces(const std::string& path, const std::function<void(std::string_view)>& take) try {
  core::FileReader file(path);
  const auto expected = file_size(path);
  std::uint64_t taken = 0;
  for (auto piece = file.read(); !piece.empty(); piece = file.read()) {
    take(piece);
    taken += piece.size();
  }
  // fewer bytes were read than the system reported as the file's size
  if (taken < expected) throw std::system_error(EIO, std::generic_category(), path);
} catch (const std::system_error& error) {
  const int code = error.code().value();
  if (code == EISDIR || code == EINVAL)
    fail_system(ErrorKind::cannot_open, "read " + path, EINVAL,
                "this is a folder, a pipe or a device; name a file");
  fail_system(kind_of_errno(code), "read " + path, code, "check the disk and the permissions");
}

}  // namespace

std::string read_bytes(const std::string& path) {
  std::string bytes;
  read_pieces(path, [&](std::string_view piece) { bytes += piece; });
  return bytes;
}

std::string sha256_of_file(const std::string& path) {
  core::Sha256 hash;
  read_pieces(path, [&](std::string_view piece) { hash.add(piece); });
  return hash.hex();
}

std::string folder_of(const std::string& path) { return fs::absolute(path).parent_path().string(); }

std::vector<std::string> list_folder(const std::string& path) {
  std::error_code error;
  std::vector<std::string> names;
  fs::directory_iterator entry(path, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error))
    names.push_back(entry->path().filename().string());
  if (error)
    fail_system(kind_of_errno(error.value()), "list " + path, error.value(),
                "name a folder that can be read");
  std::sort(names.begin(), names.end());
  return names;
}

std::string canonical(const std::string& path) {
  std::error_code error;
  const auto resolved = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error)
    fail_system(kind_of_errno(error.value()), path, error.value(), "check the path and its permissions");
  return resolved.string();
}

FileDescriptor open_lock(const std::string& path) {
  FileDescriptor lock(::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0660));
  if (!lock.is_open() && errno == ELOOP)
    throw StoreError(ErrorKind::io,
                     "lock file " + path + ": the file is a symbolic link and was not used; remove the link");
  if (!lock.is_open())
    fail_system(kind_of_errno(errno), "lock file " + path, errno,
                "the folder of the database must exist and be writable");
  const auto status = status_of(lock.get(), path);
  if (!S_ISREG(status.st_mode) || status.st_nlink > 1)
    throw StoreError(ErrorKind::io, "lock file " + path +
                                        ": the file is not a regular file, or has a second name (a hard "
                                        "link), and was not used; remove the file");
  give_open_file_to_owner_of_folder(lock.get(), path);
  return lock;
}

void create_private(const std::string& path) {
  const FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
  if (!file.is_open())
    fail_system(kind_of_errno(errno), path, errno, "the folder must exist and be writable");
}

void give_to_owner_of_folder(const std::string& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC));
  if (!file.is_open()) fail_system(kind_of_errno(errno), path, errno, "check the disk");
  give_open_file_to_owner_of_folder(file.get(), path);
}

void permit_as(const std::string& original, const std::string& path) {
  struct stat status {};
  status.st_mode = 0640;  // the station's group may read a new database
  if (!original.empty() && ::stat(original.c_str(), &status) != 0) return;
  // A disk without Unix permissions gives all files the same permissions.
  if (::chmod(path.c_str(), (status.st_mode & 0666) | 0600) != 0 && !system::not_offered(errno))
    fail_system(kind_of_errno(errno), "permissions of " + path, errno, "check the disk");
}

void sync_path(const std::string& path) {
  const auto name = path.empty() ? std::string(".") : path;
  const FileDescriptor file(::open(name.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat status {};
  const bool folder = file.is_open() && ::fstat(file.get(), &status) == 0 && S_ISDIR(status.st_mode);
  if (file.is_open() && (::fsync(file.get()) == 0 || (folder && system::not_offered(errno)))) return;
  fail_system(kind_of_errno(errno), "sync " + name, errno, "check the disk");
}

void rename_file(const std::string& from, const std::string& to) {
  if (::rename(from.c_str(), to.c_str()) != 0)
    fail_system(kind_of_errno(errno), "rename " + from + " to " + to, errno, "check the folder and the disk");
}

void remove_file(const std::string& path) {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT)
    fail_system(kind_of_errno(errno), "remove " + path, errno, "remove it by hand");
}

void remove_database(const std::string& path) {
  for (const auto* suffix : kLogSuffixes) remove_file(path + suffix);
  remove_file(path);
}

}  // namespace turnpoint::store

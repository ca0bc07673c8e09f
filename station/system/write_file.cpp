#include "station/system/write_file.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "station/core/read_file.hpp"

namespace turnpoint::system {

namespace {

namespace fs = std::filesystem;

/// More processes than this never write the same file at the same time.
constexpr int kMostDrafts = 1000;

[[noreturn]] void fail(const std::string& path, int code) {
  throw std::system_error(code, std::generic_category(), "writing " + path);
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw RefusedDestination(path + " " + why + ", and was not changed; name another file");
}

/// Follows symbolic links and returns the file to write. Throws for a link that belongs to neither this user
/// nor root.
std::string destination(const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0 || !S_ISLNK(status.st_mode)) return path;
  if (status.st_uid != 0 && status.st_uid != ::geteuid())
    throw std::system_error(ELOOP, std::generic_category(),
                            "writing " + path + ", a symbolic link that another user has made");
  // The links in /proc/self/fd (/dev/stdout, and `>(command)` of a shell) lead to names that are not files.
  struct stat target {};
  if (::stat(path.c_str(), &target) == 0 && !S_ISREG(target.st_mode)) return path;
  return fs::weakly_canonical(path).string();
}

/// True if the file begins as an SQLite database does. A file that this user cannot read is not recognised.
bool is_database(const std::string& path) {
  constexpr std::string_view kStart("SQLite format 3\0", 16);
  const core::FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  std::array<char, kStart.size()> start{};
  return file.is_open() &&
         ::read(file.get(), start.data(), start.size()) == static_cast<ssize_t>(start.size()) &&
         std::string_view(start.data(), start.size()) == kStart;
}

/// Throws if the file at this name must be kept.
void require_replaceable(const std::string& path, Replaces replaces) {
  // The lock is kept as a file: another one of its name would let a second station in.
  for (const std::string_view ending : {"-wal", "-shm", "-journal", ".lock"})
    if (path.ends_with(ending) && is_database(path.substr(0, path.size() - ending.size())))
      refuse(path, "belongs to a database");
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return;
  if (S_ISDIR(status.st_mode)) refuse(path, "is a folder");
  if (!S_ISREG(status.st_mode)) refuse(path, "is neither a file nor a pipe");
  if (is_database(path)) refuse(path, "is a database");
  // Even if it is empty or damaged, somebody may want to look at it.
  struct stat lock {};
  if (::stat((path + ".lock").c_str(), &lock) == 0)
    refuse(path, "is a station's database, as its lock file says");
  if (replaces == Replaces::output && core::was_read(status))
    refuse(path, "is one of the files that were read");
}

/// Opens a device or a pipe; a closed descriptor for anything else. A pipe that nobody reads is refused,
/// because opening it would wait for ever.
core::FileDescriptor opened_device(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !(S_ISCHR(status.st_mode) || S_ISFIFO(status.st_mode)))
    return core::FileDescriptor();
  core::FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (!file.is_open() && errno == ENXIO && S_ISFIFO(status.st_mode))
    throw RefusedDestination(path + " is a pipe that nobody reads; start its reader first");
  if (!file.is_open()) fail(path, errno);
  const int flags = ::fcntl(file.get(), F_GETFL);
  if (flags < 0 || ::fcntl(file.get(), F_SETFL, flags & ~O_NONBLOCK) != 0) fail(path, errno);
  return file;
}

/// True if the open file still has this name. Throws if that cannot be found out.
bool is_named(const core::FileDescriptor& file, const std::string& path) {
  struct stat ours {
  }, named{};
  if (::fstat(file.get(), &ours) != 0) fail(path, errno);
  if (::lstat(path.c_str(), &named) == 0) return ours.st_ino == named.st_ino && ours.st_dev == named.st_dev;
  if (errno != ENOENT) fail(path, errno);
  return false;
}

/// Removes a draft that no process is writing. Whoever writes a draft holds a lock on it.
void remove_if_abandoned(const std::string& draft) {
  const core::FileDescriptor file(::open(draft.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK));
  const bool link_or_pipe = !file.is_open() && (errno == ELOOP || errno == ENXIO);
  const bool abandoned =
      file.is_open() && ::flock(file.get(), LOCK_EX | LOCK_NB) == 0 && is_named(file, draft);
  if (link_or_pipe || abandoned) ::unlink(draft.c_str());
}

}  // namespace

FileWriter::FileWriter(const std::string& path, mode_t mode, Replaces replaces) : path_(destination(path)) {
  file_ = opened_device(path);
  if (file_.is_open()) return;
  require_replaceable(path_, replaces);
  open_draft(mode);
}

void FileWriter::open_draft(mode_t mode) {
  for (int k = 1; k <= kMostDrafts; ++k) {
    const auto draft = path_ + ".new" + (k > 1 ? std::to_string(k) : "");
    remove_if_abandoned(draft);
    core::FileDescriptor file(
        ::open(draft.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode));
    if (!file.is_open() && errno == EEXIST) continue;
    if (!file.is_open()) fail(draft, errno);
    // Between the two calls, another process may have taken the draft for an abandoned one. Where there are
    // no locks, nothing is taken for abandoned.
    try {
      const bool taken = ::flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
      if (!taken && is_named(file, draft)) {
        draft_ = draft, file_ = std::move(file);
        return;
      }
    } catch (...) {
      ::unlink(draft.c_str());
      throw;
    }
  }
  fail(path_ + ".new", EEXIST);
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

void FileWriter::write_start(std::string_view bytes) {
  if (::lseek(file_.get(), 0, SEEK_SET) != 0) fail(path_, errno);
  write(bytes);
}

void FileWriter::commit() {
  if (draft_.empty()) {
    if (::close(file_.release()) != 0) fail(path_, errno);
    return;
  }
  if (::fsync(file_.get()) != 0) fail(draft_, errno);
  // something else may have appeared under this name while the draft was written
  require_replaceable(path_, Replaces::input);
  if (::rename(draft_.c_str(), path_.c_str()) != 0) fail(path_, errno);
  draft_.clear();
  struct stat status {};
  if (::fstat(file_.get(), &status) == 0) core::mark_written(status);
  if (::close(file_.release()) != 0) fail(path_, errno);
  sync_folder(fs::path(path_).parent_path().string());
}

void write_file(const std::string& path, std::string_view bytes, mode_t mode, Replaces replaces) {
  FileWriter file(path, mode, replaces);
  file.write(bytes);
  file.commit();
}

bool not_offered(int error) {
  return error == EPERM || error == EACCES || error == ENOTSUP || error == ENOSYS || error == EINVAL ||
         error == ENOTTY;
}

void sync_folder(const std::string& path) {
  const auto name = path.empty() ? std::string(".") : path;
  const core::FileDescriptor folder(::open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // a folder may be writable but not readable
  if (!folder.is_open() && errno == EACCES) return;
  if (!folder.is_open() || (::fsync(folder.get()) != 0 && !not_offered(errno))) fail(name, errno);
}

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error || !fs::is_directory(path, error))
    throw std::system_error(error ? error : std::make_error_code(std::errc::not_a_directory),
                            "making the folder " + path);
}

void let_writes_fail() {
  ::signal(SIGPIPE, SIG_IGN);
  ::signal(SIGXFSZ, SIG_IGN);
  // Opened for reading, so that writing fails. open() takes the lowest number that is free.
  for (int standard = STDIN_FILENO; standard <= STDERR_FILENO; ++standard)
    while (::fcntl(standard, F_GETFD) < 0 && errno == EBADF)
      if (::open("/dev/null", O_RDONLY) < 0) return;
}

}  // namespace turnpoint::system

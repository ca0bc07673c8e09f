// A library for LD_PRELOAD that intercepts a program's system calls on files and makes one of them fail.
// Linux and glibc only; the program must be linked dynamically.
//
//   FAULT_UNDER=FOLDER   only calls on files in this folder count (absolute, without links)
//   FAULT_AT=N           the N-th such call fails, counted from 1; 0 or empty: none fails
//   FAULT_KIND=KIND      kill: the process is killed before the call, or in the middle of a write
//                        EIO: this call fails
//                        ENOSPC: this call and all later ones that need space fail, as on a full disk
//   HANGS_WHEN=FILE      calls that need space do not return once this file exists, as on a disk that hangs
//   FAULT_LOG=FILE       gets a line "N CALL r|w|a PATH" for each call: r reads, w needs space, a changes
//                        something else
//   NOT_OFFERED=ERRNO    the folder's file system offers neither chmod nor chown nor fsync of a folder nor
//   flock: such
//                        calls fail with this number, as on some network and FUSE mounts and on FAT; none
//                        counts as one of the calls above
//   CLOCK_OFFSET_S=S     the wall clock is ahead by S seconds (negative: behind)
//   USE_LOCALE=1         the program has the locale of its environment, as a program of Qt has
//   CLOCK_SET_AFTER=N    this begins after the program has read the wall clock N times, as if it was set then
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <clocale>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

[[gnu::constructor]] void use_locale() {
  if (std::getenv("USE_LOCALE") != nullptr) std::setlocale(LC_ALL, "");
}

struct Settings {
  std::string under, hangs_when;
  long at = 0;
  bool kills = false, fills = false;
  int log = -1, not_offered = 0;
  long clock_offset_s = 0, clock_set_after = 0;
};

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

Settings read_settings() {
  Settings settings;
  settings.under = variable("FAULT_UNDER");
  settings.hangs_when = variable("HANGS_WHEN");
  settings.at = std::atol(variable("FAULT_AT").c_str());
  settings.kills = variable("FAULT_KIND") == "kill";
  settings.fills = variable("FAULT_KIND") == "ENOSPC";
  settings.not_offered = std::atoi(variable("NOT_OFFERED").c_str());
  settings.clock_offset_s = std::atol(variable("CLOCK_OFFSET_S").c_str());
  settings.clock_set_after = std::atol(variable("CLOCK_SET_AFTER").c_str());
  if (const auto log = variable("FAULT_LOG"); !log.empty())
    settings.log = static_cast<int>(
        ::syscall(SYS_openat, AT_FDCWD, log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600));
  return settings;
}

const Settings& settings() {
  static const Settings the_only = read_settings();
  return the_only;
}

std::atomic<long> calls = 0;
std::atomic<bool> full = false;

std::string path_of(int descriptor) {
  char link[64], target[PATH_MAX];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const auto length = ::syscall(SYS_readlinkat, AT_FDCWD, link, target, sizeof target);
  return length > 0 ? std::string(target, static_cast<std::size_t>(length)) : "";
}

std::string absolute(const char* path) {
  if (path == nullptr || path[0] == '/') return path == nullptr ? "" : path;
  char folder[PATH_MAX];
  return ::syscall(SYS_getcwd, folder, sizeof folder) > 0 ? std::string(folder) + "/" + path : "";
}

enum class Effect {
  reads,
  writes,    ///< calls that need space on the disk
  arranges,  ///< calls that change files or folders but need no space on the disk
};

bool is_inside(const std::string& path) {
  const auto& under = settings().under;
  return !under.empty() && (path == under || path.rfind(under + "/", 0) == 0);
}

/// Returns true, with errno set, if the file system of this path does not offer the call.
bool is_not_offered(const std::string& path) {
  if (settings().not_offered == 0 || !is_inside(path)) return false;
  return errno = settings().not_offered, true;
}

bool is_folder(int descriptor) {
  struct stat status {};
  return ::syscall(SYS_fstat, descriptor, &status) == 0 && S_ISDIR(status.st_mode);
}

/// Returns true, with errno set, if this call must fail. `torn` executes only the first half of the call.
template <class Torn>
bool fails(const char* call, Effect effect, const std::string& path, Torn torn) {
  const auto& set = settings();
  if (!is_inside(path)) return false;
  const long number = ++calls;
  const bool writes = effect == Effect::writes;
  if (set.log >= 0) {
    const char* const letter = writes ? " w " : effect == Effect::arranges ? " a " : " r ";
    const auto line = std::to_string(number) + " " + call + letter + path + "\n";
    ::syscall(SYS_write, set.log, line.data(), line.size());
  }
  if (writes && !set.hangs_when.empty() &&
      ::syscall(SYS_faccessat, AT_FDCWD, set.hangs_when.c_str(), F_OK) == 0)
    for (;;) ::pause();
  if (full && writes) return errno = ENOSPC, true;
  if (number != set.at) return false;
  if (set.kills) {
    torn();
    ::syscall(SYS_kill, ::getpid(), SIGKILL);
  }
  if (set.fills) full = true;
  return errno = set.fills ? ENOSPC : EIO, true;
}

bool fails(const char* call, Effect effect, const std::string& path) {
  return fails(call, effect, path, [] {});
}

template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

Effect of_flags(int flags) { return (flags & (O_CREAT | O_TRUNC)) != 0 ? Effect::writes : Effect::reads; }

mode_t mode_of(int flags, va_list arguments) {
  return (flags & O_CREAT) != 0 ? va_arg(arguments, mode_t) : mode_t{0};
}

}  // namespace

#define REAL(name) static auto* const the_real = real<decltype(::name)>(#name)

extern "C" {

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const auto mode = mode_of(flags, rest);
  va_end(rest);
  if (fails("open", of_flags(flags), absolute(path))) return -1;
  return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const auto mode = mode_of(flags, rest);
  va_end(rest);
  if (fails("open", of_flags(flags), absolute(path))) return -1;
  return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

FILE* fopen64(const char* path, const char* mode) {
  REAL(fopen64);
  if (fails("fopen", mode[0] == 'r' ? Effect::reads : Effect::writes, absolute(path))) return nullptr;
  return the_real(path, mode);
}

DIR* opendir(const char* path) {
  REAL(opendir);
  return fails("opendir", Effect::reads, absolute(path)) ? nullptr : the_real(path);
}

/// libstdc++ opens folders with this function.
DIR* fdopendir(int descriptor) {
  REAL(fdopendir);
  return fails("fdopendir", Effect::reads, path_of(descriptor)) ? nullptr : the_real(descriptor);
}

struct dirent* readdir(DIR* folder) {
  REAL(readdir);
  return fails("readdir", Effect::reads, path_of(::dirfd(folder))) ? nullptr : the_real(folder);
}

int stat(const char* path, struct stat* status) {
  REAL(stat);
  return fails("stat", Effect::reads, absolute(path)) ? -1 : the_real(path, status);
}

int stat64(const char* path, struct stat64* status) {
  REAL(stat64);
  return fails("stat", Effect::reads, absolute(path)) ? -1 : the_real(path, status);
}

int lstat(const char* path, struct stat* status) {
  REAL(lstat);
  return fails("lstat", Effect::reads, absolute(path)) ? -1 : the_real(path, status);
}

int lstat64(const char* path, struct stat64* status) {
  REAL(lstat64);
  return fails("lstat", Effect::reads, absolute(path)) ? -1 : the_real(path, status);
}

int fstat64(int descriptor, struct stat64* status) {
  REAL(fstat64);
  return fails("fstat", Effect::reads, path_of(descriptor)) ? -1 : the_real(descriptor, status);
}

ssize_t read(int descriptor, void* bytes, size_t size) {
  if (fails("read", Effect::reads, path_of(descriptor))) return -1;
  return ::syscall(SYS_read, descriptor, bytes, size);
}

ssize_t pread64(int descriptor, void* bytes, size_t size, off64_t at) {
  if (fails("pread", Effect::reads, path_of(descriptor))) return -1;
  return ::syscall(SYS_pread64, descriptor, bytes, size, at);
}

ssize_t write(int descriptor, const void* bytes, size_t size) {
  const auto half = [&] { ::syscall(SYS_write, descriptor, bytes, size / 2); };
  if (fails("write", Effect::writes, path_of(descriptor), half)) return -1;
  return ::syscall(SYS_write, descriptor, bytes, size);
}

ssize_t writev(int descriptor, const struct iovec* parts, int count) {
  const auto half = [&] { ::syscall(SYS_writev, descriptor, parts, count / 2); };
  if (fails("writev", Effect::writes, path_of(descriptor), half)) return -1;
  return ::syscall(SYS_writev, descriptor, parts, count);
}

ssize_t pwrite(int descriptor, const void* bytes, size_t size, off_t at) {
  const auto half = [&] { ::syscall(SYS_pwrite64, descriptor, bytes, size / 2, at); };
  if (fails("pwrite", Effect::writes, path_of(descriptor), half)) return -1;
  return ::syscall(SYS_pwrite64, descriptor, bytes, size, at);
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t size, off64_t at) {
  const auto half = [&] { ::syscall(SYS_pwrite64, descriptor, bytes, size / 2, at); };
  if (fails("pwrite", Effect::writes, path_of(descriptor), half)) return -1;
  return ::syscall(SYS_pwrite64, descriptor, bytes, size, at);
}

int fsync(int descriptor) {
  REAL(fsync);
  if (is_folder(descriptor) && is_not_offered(path_of(descriptor))) return -1;
  return fails("fsync", Effect::writes, path_of(descriptor)) ? -1 : the_real(descriptor);
}

int fdatasync(int descriptor) {
  REAL(fdatasync);
  return fails("fdatasync", Effect::writes, path_of(descriptor)) ? -1 : the_real(descriptor);
}

int ftruncate(int descriptor, off_t size) {
  REAL(ftruncate);
  return fails("ftruncate", Effect::arranges, path_of(descriptor)) ? -1 : the_real(descriptor, size);
}

int ftruncate64(int descriptor, off64_t size) {
  REAL(ftruncate64);
  return fails("ftruncate", Effect::arranges, path_of(descriptor)) ? -1 : the_real(descriptor, size);
}

int rename(const char* from, const char* to) {
  REAL(rename);
  return fails("rename", Effect::arranges, absolute(to)) ? -1 : the_real(from, to);
}

int link(const char* from, const char* to) {
  REAL(link);
  return fails("link", Effect::writes, absolute(to)) ? -1 : the_real(from, to);
}

int unlink(const char* path) {
  REAL(unlink);
  return fails("unlink", Effect::arranges, absolute(path)) ? -1 : the_real(path);
}

int remove(const char* path) {
  REAL(remove);
  return fails("remove", Effect::arranges, absolute(path)) ? -1 : the_real(path);
}

int mkdir(const char* path, mode_t mode) {
  REAL(mkdir);
  return fails("mkdir", Effect::writes, absolute(path)) ? -1 : the_real(path, mode);
}

int chmod(const char* path, mode_t mode) {
  REAL(chmod);
  if (is_not_offered(absolute(path))) return -1;
  return fails("chmod", Effect::arranges, absolute(path)) ? -1 : the_real(path, mode);
}

int fchmod(int descriptor, mode_t mode) {
  REAL(fchmod);
  if (is_not_offered(path_of(descriptor))) return -1;
  return fails("fchmod", Effect::arranges, path_of(descriptor)) ? -1 : the_real(descriptor, mode);
}

int fchown(int descriptor, uid_t user, gid_t group) noexcept {
  static auto* const the_real = real<int(int, uid_t, gid_t)>("fchown");
  return is_not_offered(path_of(descriptor)) ? -1 : the_real(descriptor, user, group);
}

int flock(int descriptor, int operation) noexcept {
  static auto* const the_real = real<int(int, int)>("flock");
  return is_not_offered(path_of(descriptor)) ? -1 : the_real(descriptor, operation);
}

int gethostname(char* name, size_t size) noexcept {
  static const auto given = variable("HOST_NAME");
  static auto* const the_real = real<int(char*, size_t)>("gethostname");
  if (given.empty()) return the_real(name, size);
  std::snprintf(name, size, "%s", given.c_str());
  return 0;
}

int clock_gettime(clockid_t clock, struct timespec* time) {
  const int result = static_cast<int>(::syscall(SYS_clock_gettime, clock, time));
  static std::atomic<long> readings = 0;
  if (result == 0 && clock == CLOCK_REALTIME && readings++ >= settings().clock_set_after)
    time->tv_sec += settings().clock_offset_s;
  return result;
}

time_t time(time_t* result) {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (result != nullptr) *result = now.tv_sec;
  return now.tv_sec;
}

}  // extern "C"

#include "station/system/rights.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace turnpoint::system {
namespace {

constexpr std::size_t used_stack = 256 * 1024;  ///< in bytes; enough for any real-time thread of the station

// Touches 64 KiB of the stack, so that these pages are loaded before the thread needs them.
void prefault_stack() noexcept {
  volatile unsigned char stack[64 * 1024];
  for (std::size_t k = 0; k < sizeof stack; k += 1024) stack[k] = 0;
}

/// Reads a line of /proc/self/maps. Returns its memory range if it should be locked: the heap, or a mapped
/// file that can be read, such as the program and its libraries.
std::optional<MemoryRange> lockable(const std::string& line) {
  std::istringstream words(line);
  std::string range, rights, offset, device, path;
  std::uint64_t inode = 0;
  words >> range >> rights >> offset >> device >> inode >> path;
  const auto dash = range.find('-');
  if (dash == std::string::npos || rights.empty() || rights[0] != 'r') return std::nullopt;
  const bool file = inode != 0 && path.rfind("/dev/", 0) != 0 && path.rfind("/memfd:", 0) != 0;
  if (!file && path != "[heap]") return std::nullopt;
  const auto start = std::stoull(range.substr(0, dash), nullptr, 16);
  const auto end = std::stoull(range.substr(dash + 1), nullptr, 16);
  return MemoryRange{reinterpret_cast<const void*>(start), end - start};
}

}  // namespace

Rights lock_memory(const std::vector<MemoryRange>& ranges, const std::string& left_out) {
  std::vector<MemoryRange> wanted = ranges;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (const auto range = lockable(line)) wanted.push_back(*range);
  Rights rights;
  rights.asked = true;
  rights.memory_locked = true;
  for (const MemoryRange& range : wanted) {
    if (range.length == 0 || ::mlock(range.start, range.length) == 0) continue;
    rights.memory_locked = false;
    rights.note = fmt::format("mlock: {} (raise LimitMEMLOCK)", std::strerror(errno));
    return rights;
  }
  if (!left_out.empty()) rights.note = "not locked: " + left_out;
  return rights;
}

int lock_stack() noexcept {
  pthread_attr_t attributes;
  if (const int error = ::pthread_getattr_np(::pthread_self(), &attributes); error != 0) return error;
  void* lowest = nullptr;
  std::size_t size = 0;
  const int error = ::pthread_attr_getstack(&attributes, &lowest, &size);
  ::pthread_attr_destroy(&attributes);
  if (error != 0) return error;
  // Stacks grow downwards, so the used part is at the upper end.
  const std::size_t used = std::min(size, used_stack);
  return ::mlock(static_cast<std::byte*>(lowest) + (size - used), used) == 0 ? 0 : errno;
}

int become_realtime(int priority) noexcept {
  prefault_stack();
  static_cast<void>(lock_stack());
  // longest run time without a blocking call, in microseconds: soft and hard limit
  const rlimit limit{200'000, 400'000};
  static_cast<void>(::setrlimit(RLIMIT_RTTIME, &limit));
  sched_param parameters{};
  parameters.sched_priority = priority;
  return ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
}

}  // namespace turnpoint::system

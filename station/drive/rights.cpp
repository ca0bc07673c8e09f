#include "station/drive/rights.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

namespace turnpoint::drive {
namespace {

// Touches the stack that the thread will use, so that no page of it is missing later.
void prefault_stack() noexcept {
  volatile unsigned char stack[64 * 1024];
  for (std::size_t k = 0; k < sizeof stack; k += 1024) stack[k] = 0;
}

struct Range {
  const void* start = nullptr;
  std::size_t length = 0;
};

/// The range of a line of /proc/self/maps that is to be locked: readable files (the program and its
/// libraries) and the heap.
std::optional<Range> lockable(const std::string& line) {
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
  return Range{reinterpret_cast<const void*>(start), end - start};
}

}  // namespace

Rights lock_memory() {
  Rights rights;
  rights.asked = true;
  rights.memory_locked = true;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    const auto range = lockable(line);
    if (!range || ::mlock(range->start, range->length) == 0) continue;
    rights.memory_locked = false;
    rights.note = fmt::format("mlock: {} (raise LimitMEMLOCK)", std::strerror(errno));
    return rights;
  }
  return rights;
}

int become_realtime(int priority) noexcept {
  prefault_stack();
  const rlimit limit{200'000, 400'000};  // microseconds without a blocking call
  static_cast<void>(::setrlimit(RLIMIT_RTTIME, &limit));
  sched_param parameters{};
  parameters.sched_priority = priority;
  return ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
}

}  // namespace turnpoint::drive

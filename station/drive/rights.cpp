#include "station/drive/rights.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstring>

namespace turnpoint::drive {
namespace {

// Touches the stack that the thread will use, so that no page of it is missing later.
void prefault_stack() noexcept {
  volatile unsigned char stack[64 * 1024];
  for (std::size_t k = 0; k < sizeof stack; k += 1024) stack[k] = 0;
}

}  // namespace

Rights lock_memory() {
  Rights rights;
  rights.asked = true;
  rights.memory_locked = ::mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  if (!rights.memory_locked)
    rights.note = fmt::format("mlockall: {} (raise LimitMEMLOCK)", std::strerror(errno));
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

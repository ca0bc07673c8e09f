#include "station/ui/platform/newest_job.hpp"

#include <QCoreApplication>
#include <QEvent>
#include <chrono>
#include <thread>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/ui/event_loop.hpp"

using namespace turnpoint;

namespace {

/// The longest time that a test waits. It is long enough for a busy machine, and only ends a test that hangs.
constexpr std::chrono::seconds kPatience{20};

/// The owner of jobs. Counts the calls that reach its thread.
struct Owner : QObject {
  int calls = 0;
  bool event(QEvent* event) override {
    calls += event->type() == QEvent::MetaCall ? 1 : 0;
    return QObject::event(event);
  }
};

/// A page that receives the results of its jobs.
struct Page {
  EventLoop<> loop;
  Owner owner;
  std::vector<int> received;
  ui::NewestJob job{owner};

  /// Handles events until this many more calls have reached the owner.
  void handle(int calls) {
    const auto wanted = owner.calls + calls;
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (owner.calls < wanted && std::chrono::steady_clock::now() < until)
      QCoreApplication::processEvents();
    REQUIRE(owner.calls == wanted);
  }
  /// Runs a job to its end.
  void run(int number) {
    job.start(
        [this, number](const std::stop_token&) { return [this, number] { received.push_back(number); }; });
    handle(1);
  }
};

}  // namespace

TEST_CASE("a job's result waits while results are held back, and only the newest one counts", "[jobs]") {
  Page page;
  page.run(1);
  CHECK(page.received == std::vector{1});
  page.job.hold(true);
  page.run(2);
  page.run(3);
  CHECK(page.received == std::vector{1});
  page.job.hold(false);
  CHECK(page.received == std::vector{1});  // the release of the finger is still on its way
  page.handle(1);
  CHECK(page.received == std::vector{1, 3});
  page.job.hold(false);
  page.handle(1);
  CHECK(page.received == std::vector{1, 3});
}

TEST_CASE("a result that waits is dropped with its job, and waits on if a finger returns", "[jobs]") {
  Page page;
  page.job.hold(true);
  page.run(1);
  page.job.abandon();
  page.job.hold(false);
  page.handle(1);
  CHECK(page.received.empty());
  page.job.hold(true);
  page.run(2);
  page.job.hold(false);
  page.job.hold(true);  // a second press before the event of the release was handled
  page.handle(1);
  CHECK(page.received.empty());
  page.job.hold(false);
  page.handle(1);
  CHECK(page.received == std::vector{2});
}

#if defined(__x86_64__)
namespace {

/// Whether the upper halves of the vector registers count as used in this thread (XINUSE).
bool upper_halves_used() {
  unsigned low = 0, high = 0;
  __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(1));
  return (low & 4) != 0;
}

}  // namespace

TEST_CASE("A job does not inherit upper halves of vector registers that the thread of the screen has used",
          "[jobs]") {
  unsigned a = 13, b = 0, c = 1, d = 0;  // does the processor tell?
  __asm__ volatile("cpuid" : "+a"(a), "=b"(b), "+c"(c), "=d"(d));
  if (!__builtin_cpu_supports("avx2") || (a & 4) == 0) return;
  const auto use = [] { __asm__ volatile("vpcmpeqd %%ymm0, %%ymm0, %%ymm0" ::: "xmm0"); };
  bool inherited = false;
  use();
  std::jthread([&inherited] { inherited = upper_halves_used(); }).join();
  if (!inherited) return;  // the C library has cleared them before it began the thread
  use();
  Page page;
  bool used = true;
  page.job.start([&used](const std::stop_token&) -> std::function<void()> {
    used = upper_halves_used();
    return [] {};
  });
  page.handle(1);
  __asm__ volatile("vzeroupper");
  CHECK_FALSE(used);
}
#endif

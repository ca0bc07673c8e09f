#include "station/ui/platform/newest_job.hpp"

#include <QCoreApplication>
#include <QEvent>
#include <chrono>
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

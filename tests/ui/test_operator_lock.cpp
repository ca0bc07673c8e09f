#include <QCoreApplication>
#include <chrono>

#include "station/ui/operator/operator_lock.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/ui/event_loop.hpp"

using namespace turnpoint;

namespace {

/// The longest time that a test waits. It is long enough for a busy machine, and only ends a test that hangs.
constexpr std::chrono::seconds kPatience{20};

/// The operator's lock without its page. The test sets its clock.
struct Keypad {
  EventLoop<> loop;
  double now_s = 1000;
  int opened = 0, refused = 0;
  ui::OperatorLock lock{view::OperatorCode::of_digits("7391"), [this] { return now_s; }};

  Keypad() {
    QObject::connect(&lock, &ui::OperatorLock::opened, [this] { ++opened; });
    QObject::connect(&lock, &ui::OperatorLock::refused, [this] { ++refused; });
  }
  void enter(const char* code) {
    lock.enter(code);
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (lock.checking() && std::chrono::steady_clock::now() < until)
      QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents);
    REQUIRE_FALSE(lock.checking());
  }
};

}  // namespace

TEST_CASE("the operator's code opens the lock, and it is compared on another thread than that of the pages",
          "[lock]") {
  Keypad keypad;
  keypad.lock.enter("7391");
  CHECK(keypad.lock.checking());  // enter() returned before the code was compared
  CHECK(keypad.opened == 0);
  keypad.enter("1234");  // this code is ignored, because the first is still being compared
  CHECK(keypad.opened == 1);
  CHECK(keypad.refused == 0);
}

TEST_CASE("after wrong codes the lock refuses even the right one until the waiting time is over", "[lock]") {
  Keypad keypad;
  keypad.enter("1111");
  keypad.enter("2222");
  CHECK(keypad.lock.wait_s() == 0);
  keypad.enter("3333");
  CHECK(keypad.refused == 3);
  CHECK(keypad.lock.wait_s() == 5);
  keypad.enter("7391");
  keypad.now_s += 4.5;
  keypad.enter("7391");
  CHECK(keypad.opened == 0);
  CHECK(keypad.lock.wait_s() == 1);
  keypad.now_s += 0.5;
  keypad.enter("7391");
  CHECK(keypad.opened == 1);
  keypad.enter("1111");
  keypad.enter("2222");
  CHECK(keypad.lock.wait_s() == 0);  // the right code reset the count of wrong ones
}

TEST_CASE(
    "as long as the code is the built-in one, the lock shows it; a chosen code replaces it and is stored",
    "[lock]") {
  const TemporaryFolder folder;
  EventLoop<> loop;
  ui::OperatorLock lock{view::OperatorCode()};
  lock.store_in(folder / "operator-code");
  int chosen = 0, refused = 0;
  QObject::connect(&lock, &ui::OperatorLock::chosen, [&] { ++chosen; });
  QObject::connect(&lock, &ui::OperatorLock::refused, [&] { ++refused; });
  const auto choose = [&](const char* digits) {
    lock.choose(digits);
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (lock.checking() && std::chrono::steady_clock::now() < until)
      QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents);
    REQUIRE_FALSE(lock.checking());
  };
  CHECK(lock.built_in());
  CHECK(lock.shown_code() == view::OperatorCode::built_in);
  for (const char* impossible : {"123", view::OperatorCode::built_in}) choose(impossible);
  CHECK(refused == 2);
  CHECK(lock.built_in());
  choose("7391");
  CHECK(chosen == 1);
  CHECK_FALSE(lock.built_in());
  CHECK(lock.shown_code().isEmpty());
  CHECK(view::operator_code({folder / "operator-code"}).opens("7391"));
}

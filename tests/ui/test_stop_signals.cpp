#include <signal.h>

#include <QCoreApplication>
#include <QTimer>

#include "station/store/read.hpp"
#include "station/ui/platform/stop_signals.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child.hpp"
#include "tests/support/small_disk.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/ui/event_loop.hpp"

using turnpoint::ui::StopSignals;

namespace {

/// The longest time that a test waits. It is long enough for a busy machine, and ends a test in which the
/// program ignores the signal.
constexpr int kPatience_ms = 20000;
/// The process must end within this time after the signal. A service manager would kill it after 5 s.
constexpr int kPrompt_ms = 1000;

const std::string kSource = TURNPOINT_SOURCE_DIR;

std::vector<std::string> without_screen(const TemporaryFolder& folder) {
  return {"QT_QPA_PLATFORM=offscreen", "QT_QUICK_BACKEND=software", "XDG_RUNTIME_DIR=" + folder.path,
          "QT_LOGGING_RULES=turnpoint.startup=true"};
}

std::vector<std::string> station(const TemporaryFolder& folder) {
  return {TURNPOINT_UI, "station",    "--rig", kSource + "/tests/support/thin_plate.toml",
          "--db",       folder / "db"};
}

using Loop = turnpoint::EventLoop<>;

/// While this object exists, signals have their default action instead of the test framework's own handlers.
struct KernelsWay {
  KernelsWay() { set(SIG_DFL, SIG_DFL); }
  ~KernelsWay() { set(terminate, interrupt); }
  void set(sighandler_t on_terminate, sighandler_t on_interrupt) {
    terminate = ::signal(SIGTERM, on_terminate);
    interrupt = ::signal(SIGINT, on_interrupt);
  }
  sighandler_t terminate = SIG_DFL, interrupt = SIG_DFL;
};

bool is(int signal, sighandler_t expected) {
  struct sigaction action {};
  ::sigaction(signal, nullptr, &action);
  return action.sa_handler == expected;
}

}  // namespace

TEST_CASE("a start that hangs before its event loop ends at once on a stop signal", "[stop]") {
  const TemporaryFolder folder;
  Child child({HELD_START}, {"XDG_RUNTIME_DIR=" + folder.path});
  REQUIRE(child.says("held", kPatience_ms));
  const int signal = GENERATE(SIGTERM, SIGINT, SIGHUP);
  CAPTURE(signal, child.said());
  CHECK_FALSE(child.handles(signal));
  child.signal(signal);
  REQUIRE(child.ends_within(kPrompt_ms));
  CHECK(child.outcome() == -signal);
}

TEST_CASE("the station ends promptly whenever it gets a signal during its start", "[stop]") {
  const TemporaryFolder folder;
  Child child(station(folder), without_screen(folder));
  const int delay_ms = GENERATE(0, 20, 50, 100, 200, 500);
  CAPTURE(delay_ms, child.said());
  REQUIRE_FALSE(child.ends_within(delay_ms));
  child.signal(SIGTERM);
  REQUIRE(child.ends_within(kPrompt_ms));
  // Before the first page the signal kills the process; afterwards the program ends cleanly. A service
  // manager accepts both results.
  CHECK((child.outcome() == -SIGTERM || child.outcome() == 0));
}

TEST_CASE("with its first page on the screen, the station ends cleanly on a stop signal", "[stop]") {
  const TemporaryFolder folder;
  Child child(station(folder), without_screen(folder));
  REQUIRE(child.says("first page after", kPatience_ms));
  for (int waited_ms = 0; !child.handles(SIGTERM) && waited_ms < kPatience_ms; ++waited_ms)
    REQUIRE_FALSE(child.ends_within(1));
  child.signal(SIGTERM);
  REQUIRE(child.ends_within(kPrompt_ms));
  CAPTURE(child.said());
  CHECK(child.outcome() == 0);
}

TEST_CASE("a session stopped during a stimulus is closed in its log, and can be resumed", "[stop]") {
  const TemporaryFolder folder;
  Child child({STOPPED_SESSION, kSource + "/tests/ui/short.toml", kSource + "/tests/support/thin_plate.toml",
               folder / "db"},
              without_screen(folder));
  REQUIRE(child.ends_within(kPatience_ms));
  CAPTURE(child.said());
  CHECK(child.outcome() == 0);
  CHECK(child.said().find("interrupted, ") != std::string::npos);
  CHECK(child.said().find(" trials: the program was stopped by a signal") != std::string::npos);
  const auto sessions = turnpoint::store::list_sessions(folder / "db");
  REQUIRE(sessions.size() == 1);
  CHECK(sessions[0].status == turnpoint::core::SessionStatus::interrupted);
}

TEST_CASE("on a full disk, a session ends within three seconds of the signal and says what was kept",
          "[stop]") {
  SmallDisk disk(24);
  if (!disk.mounted) {
    WARN("not tested: needs the right to mount a file system");
    return;
  }
  const TemporaryFolder folder;
  Child child({STOPPED_SESSION, kSource + "/tests/ui/short.toml", kSource + "/tests/support/thin_plate.toml",
               disk / "db", disk / "filling"},
              without_screen(folder));
  for (int waited_ms = 0; !std::filesystem::exists(disk / "filling") && waited_ms < kPatience_ms;
       waited_ms += 10)
    REQUIRE_FALSE(child.ends_within(10));
  // On a busy machine the end takes longer than what the program waits for.
  static_assert(turnpoint::ui::StopSignals::kPatience < std::chrono::seconds(3));
  REQUIRE(child.ends_within(kPatience_ms));
  CAPTURE(child.said());
  CHECK(child.outcome() == 1);
  CHECK(child.said().find("trials that are stored: 1;") != std::string::npos);
  CHECK(child.said().find("turnpoint resume") != std::string::npos);
  std::filesystem::remove(disk / "filling");
  const auto sessions = turnpoint::store::list_sessions(disk / "db");
  REQUIRE(sessions.size() == 1);
  CHECK(sessions[0].trials == 1);
}

#ifdef FAULTY_SYSTEM
TEST_CASE("on a disk that hangs, a session ends within three seconds of the signal and says what was kept",
          "[stop]") {
  const TemporaryFolder folder, data;
  auto environment = without_screen(folder);
  for (const auto& setting : {std::string("LD_PRELOAD=" FAULTY_SYSTEM), "FAULT_UNDER=" + data.path,
                              "HANGS_WHEN=" + (folder / "hangs")})
    environment.push_back(setting);
  Child child({STOPPED_SESSION, kSource + "/tests/ui/short.toml", kSource + "/tests/support/thin_plate.toml",
               data / "db", folder / "hangs"},
              environment);
  for (int waited_ms = 0; !std::filesystem::exists(folder / "hangs") && waited_ms < kPatience_ms;
       waited_ms += 10)
    REQUIRE_FALSE(child.ends_within(10));
  // On a busy machine the end takes longer than what the program waits for.
  static_assert(turnpoint::ui::StopSignals::kPatience < std::chrono::seconds(3));
  REQUIRE(child.ends_within(kPatience_ms));
  CAPTURE(child.said());
  CHECK(child.outcome() == 1);
  CHECK(child.said().find("a disk that does not answer") != std::string::npos);
  CHECK(child.said().find("trials stored since the session began or was resumed: 1;") != std::string::npos);
  CHECK(child.said().find("turnpoint resume") != std::string::npos);
  const auto sessions = turnpoint::store::list_sessions(data / "db");
  REQUIRE(sessions.size() == 1);
  CHECK(sessions[0].trials == 1);
}
#endif

TEST_CASE(
    "once stop signals are handled, the first one ends the event loop and the second one ends the process",
    "[stop]") {
  const Loop loop;
  const KernelsWay kernels_way;
  {
    StopSignals stop;
    CHECK(is(SIGTERM, SIG_DFL));
    stop.take_over();
    stop.take_over();
    CHECK_FALSE(is(SIGTERM, SIG_DFL));
    QTimer::singleShot(kPatience_ms, [] { QCoreApplication::exit(1); });
    ::raise(SIGTERM);
    CHECK(QCoreApplication::exec() == 0);
    CHECK(is(SIGTERM, SIG_DFL));
    CHECK_FALSE(is(SIGINT, SIG_DFL));
  }
  CHECK(is(SIGINT, SIG_DFL));
}

TEST_CASE("a stop signal that the starting program has set to be ignored stays ignored", "[stop]") {
  const Loop loop;
  const KernelsWay kernels_way;
  ::signal(SIGHUP, SIG_IGN);
  {
    StopSignals stop;
    stop.take_over();
    CHECK(is(SIGHUP, SIG_IGN));
  }
  CHECK(is(SIGHUP, SIG_IGN));
  ::signal(SIGHUP, SIG_DFL);
}

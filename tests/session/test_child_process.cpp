#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <limits>
#include <string>
#include <system_error>

#include "station/system/child_process.hpp"
#include "station/system/clocks.hpp"
#include "tests/session/written_program.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using system::ChildProcess;

namespace {

constexpr auto kForever = std::numeric_limits<std::int64_t>::max() / 2;

std::string next_line(ChildProcess& child) {
  for (;;) {
    if (auto line = child.line()) return *line;
    if (child.silent()) return "(silent)";
    child.wait(kForever);
  }
}

/// Waits until a process has gone that this process does not own.
bool gone(pid_t id) {
  const auto until_ns = system::monotonic_ns() + 10'000'000'000;
  while (::kill(id, 0) == 0)
    if (system::monotonic_ns() > until_ns)
      return false;
    else
      while (::waitpid(-1, nullptr, WNOHANG) > 0) {
      }
  return true;
}

}  // namespace

TEST_CASE("lines of any length travel to a program and back", "[programs]") {
  const TemporaryFolder folder;
  ChildProcess child(written_program(folder / "cat", "#!/bin/sh\nexec cat\n"));
  child.send("one");
  child.send("two");
  CHECK(next_line(child) == "one");
  CHECK(next_line(child) == "two");
  const std::string longest(300'000, 'x');  // more than the pipes hold
  child.send(longest);
  CHECK(next_line(child) == longest);
  CHECK_FALSE(child.line());
  CHECK(child.unfinished() == 0);
}

TEST_CASE("a program starts without rights, in its own folder, with an environment of its own",
          "[programs]") {
  const TemporaryFolder folder;
  ::setenv("TURNPOINT_SECRET", "1", 1);
  const auto path = written_program(folder / "who", R"(#!/bin/sh
echo "$PWD"
echo "secret ${TURNPOINT_SECRET-unset}"
grep NoNewPrivs /proc/self/status | tr '\t' ' '
ulimit -l
ls /proc/self/fd | wc -w
cat /proc/self/oom_score_adj
)");
  const auto leak = ::dup(STDOUT_FILENO);  // a descriptor that is not closed on exec
  ChildProcess child(path);
  CHECK(next_line(child) == std::filesystem::canonical(folder.path).string());
  CHECK(next_line(child) == "secret unset");
  CHECK(next_line(child) == "NoNewPrivs: 1");
  CHECK(next_line(child) == "0");
  CHECK(next_line(child) == "4");  // the three streams, and the folder that ls reads
  CHECK(next_line(child) == "1000");
  CHECK(next_line(child) == "(silent)");
  CHECK(child.how_it_ended() == "ended with status 0");
  ::close(leak);
  ::unsetenv("TURNPOINT_SECRET");
}

TEST_CASE("how a program ended and its last complaint are known", "[programs]") {
  const TemporaryFolder folder;
  ChildProcess failed(
      written_program(folder / "a", "#!/bin/sh\necho first >&2\necho 'no luck ' >&2\nexit 3\n"));
  CHECK(next_line(failed) == "(silent)");
  CHECK(failed.how_it_ended() == "ended with status 3");
  CHECK(failed.complaint() == "no luck");
  ChildProcess killed(written_program(folder / "b", "#!/bin/sh\nkill -9 $$\n"));
  CHECK(next_line(killed) == "(silent)");
  CHECK(killed.how_it_ended() == "was killed by signal 9");
  CHECK(killed.complaint().empty());
  killed.send("a line that nobody reads any more");  // must not end this program with SIGPIPE
  CHECK_FALSE(killed.line());
}

TEST_CASE("a path may be relative to the working folder", "[programs]") {
  const TemporaryFolder folder;
  written_program(folder / "a", "#!/bin/sh\necho here\n");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path);
  ChildProcess child("a");
  std::filesystem::current_path(before);
  CHECK(next_line(child) == "here");
}

TEST_CASE("a file that cannot be run is refused with its name", "[programs]") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(ChildProcess(folder / "absent"), std::system_error);
  const auto no_interpreter = written_program(folder / "odd", "#!/no/such/interpreter\n");
  CHECK_THROWS_WITH(ChildProcess(no_interpreter),
                    Catch::Matchers::ContainsSubstring("odd: cannot start this program"));
}

TEST_CASE("a program ends with the object that started it, and so do its own children", "[programs]") {
  const TemporaryFolder folder;
  const auto ends = GENERATE(as<std::string>(), "read -r line; read -r line",  // ends with its standard input
                             "exec 0</dev/null; sleep 1000",                   // ends with SIGTERM
                             "trap '' TERM HUP; while :; do sleep 1000; done");  // ends with SIGKILL
  INFO(ends);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);  // to learn when the program's own child has gone
  pid_t id = 0, grandchild = 0;
  {
    ChildProcess child(
        written_program(folder / "a", "#!/bin/sh\nsleep 1000 >/dev/null 2>&1 &\necho $$ $!\n" + ends + "\n"));
    const auto line = next_line(child);
    id = std::stoi(line), grandchild = std::stoi(line.substr(line.find(' ')));
    CHECK(::kill(grandchild, 0) == 0);
  }
  CHECK(gone(id));
  CHECK(gone(grandchild));
  ::prctl(PR_SET_CHILD_SUBREAPER, 0);
}

TEST_CASE("a program is killed if the process that started it is", "[programs]") {
  const TemporaryFolder folder;
  const auto path = written_program(folder / "a", "#!/bin/sh\necho $$\nexec sleep 1000\n");
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  const pid_t session = ::fork();
  if (session == 0) {
    ChildProcess child(path);
    const auto line = next_line(child) + "\n";
    static_cast<void>(!::write(ends[1], line.data(), line.size()));
    for (;;) ::pause();
  }
  char text[32] = {};
  REQUIRE(::read(ends[0], text, sizeof text - 1) > 0);
  const pid_t program = std::atoi(text);
  CHECK(::kill(program, 0) == 0);
  ::kill(session, SIGKILL);
  CHECK(gone(program));
  ::prctl(PR_SET_CHILD_SUBREAPER, 0);
  ::close(ends[0]), ::close(ends[1]);
}

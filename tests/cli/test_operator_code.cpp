#include <poll.h>
#include <pty.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/support/catch.hpp"
#include "tests/support/child.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

constexpr int kPatience_ms = 20000;

/// Runs `turnpoint operator-code` on a terminal made for the test.
class Terminal {
 public:
  explicit Terminal(const std::string& config) {
    process_ = ::forkpty(&master_, nullptr, nullptr, nullptr);
    REQUIRE(process_ >= 0);
    if (process_ > 0) return;
    ::setenv("XDG_CONFIG_HOME", config.c_str(), 1);
    ::execl(TURNPOINT, TURNPOINT, "operator-code", nullptr);
    ::_exit(127);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  ~Terminal() { ::close(master_); }

  void type_after(const std::string& prompt, const std::string& line) {
    while (seen_.find(prompt, from_) == std::string::npos) REQUIRE(read());
    from_ = seen_.size();
    const auto text = line + "\n";
    REQUIRE(::write(master_, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  }
  int ends() {
    while (read()) {
    }
    int status = 0;
    REQUIRE(::waitpid(process_, &status, 0) == process_);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  const std::string& seen() const { return seen_; }

 private:
  /// Returns false if the program has closed the terminal, or has not printed anything for a long time.
  bool read() {
    pollfd wait{master_, POLLIN, 0};
    char bytes[512];
    if (::poll(&wait, 1, kPatience_ms) <= 0) return false;
    const auto got = ::read(master_, bytes, sizeof bytes);
    if (got > 0) seen_.append(bytes, static_cast<std::size_t>(got));
    return got > 0;
  }

  int master_ = -1;
  pid_t process_ = -1;
  std::string seen_;
  std::size_t from_ = 0;
};

std::string content(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("the operator's code is asked for twice on a terminal and never shown there", "[code]") {
  const TemporaryFolder folder;
  const auto file = folder / "turnpoint/operator-code";
  Terminal same(folder.path);
  same.type_after("New operator's code", "7391");
  same.type_after("Again", "7391");
  CHECK(same.ends() == 0);
  CAPTURE(same.seen());
  CHECK(same.seen().find("7391") == std::string::npos);
  CHECK(same.seen().find("stored in " + file) != std::string::npos);
  CHECK(content(file).substr(0, 3) == "$y$");
  struct stat status {};
  REQUIRE(::stat(file.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0600);

  const auto before = content(file);
  Terminal other(folder.path);
  other.type_after("New operator's code", "8520");
  other.type_after("Again", "8521");
  CHECK(other.ends() == 2);
  CHECK(other.seen().find("the two codes differ") != std::string::npos);
  CHECK(content(file) == before);
}

TEST_CASE("without a terminal the operator's code is a line of standard input", "[code]") {
  const TemporaryFolder folder;
  const auto file = folder / "turnpoint/operator-code";
  const auto enter = [&](const std::string& line) {
    Child child({TURNPOINT, "operator-code"}, {"XDG_CONFIG_HOME=" + folder.path});
    child.type(line);
    REQUIRE(child.ends_within(kPatience_ms));
    return std::pair(child.outcome(), child.said());
  };
  CHECK(enter("2468").first == 2);
  CHECK(enter("24b8").second.find("4 to 12 digits") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(file));
  CHECK(enter("7391").first == 0);
  CHECK(content(file).substr(0, 3) == "$y$");
}

TEST_CASE("a locked station starts only if a code is stored, and no option of the command line takes a code",
          "[code]") {
  const TemporaryFolder folder;
  const auto station = [&](const std::vector<std::string>& options) {
    std::vector<std::string> command = {TURNPOINT, "station"};
    command.insert(command.end(), options.begin(), options.end());
    Child child(command, {"XDG_CONFIG_HOME=" + folder.path});
    REQUIRE(child.ends_within(kPatience_ms));
    CHECK(child.outcome() == 2);
    return child.said();
  };
  CHECK(station({"--locked"}).find("store one with: sudo turnpoint operator-code") != std::string::npos);
  CHECK(station({"--operator-code", "7391"}).find("--operator-code") != std::string::npos);
}

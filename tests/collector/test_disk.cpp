#include <fmt/format.h>
#include <sys/mount.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "station/collector/push.hpp"
#include "tests/collector/postgres_server.hpp"
#include "tests/collector/whole_sessions.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

namespace fs = std::filesystem;

/// A small file system in memory, with a folder `space` for the server's user.
class SmallDisk {
 public:
  explicit SmallDisk(int size_MiB) {
    if (::mount("small", folder_.path.c_str(), "tmpfs", 0, fmt::format("size={}m", size_MiB).c_str()) != 0)
      throw std::runtime_error("no file system could be mounted");
    fs::create_directory(space());
    fs::permissions(space(), fs::perms::owner_all);
    PostgresServer::own(space());
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() { ::umount2(folder_.path.c_str(), MNT_DETACH); }

  std::string space() const { return folder_ / "space"; }

  /// Writes a file that leaves only this much room.
  void fill(std::uintmax_t left_bytes) const {
    const auto free_bytes = fs::space(folder_.path).available;
    REQUIRE(free_bytes > left_bytes);
    std::ofstream file(ballast(), std::ios::binary);
    const std::string piece(1U << 16U, 'x');
    for (auto rest = free_bytes - left_bytes; rest > 0;) {
      const auto size = std::min<std::uintmax_t>(rest, piece.size());
      file.write(piece.data(), static_cast<std::streamsize>(size));
      rest -= size;
    }
    REQUIRE(file.flush().good());
  }
  void free() const { fs::remove(ballast()); }

 private:
  std::string ballast() const { return folder_ / "ballast"; }
  TemporaryFolder folder_;
};

bool can_mount() {
  if (::geteuid() == 0) return true;
  WARN("skipped: only root can mount a small disk; sudo tests/run");
  return false;
}

std::string failure_of(const collector::PushOptions& options) {
  try {
    collector::push(options);
  } catch (const collector::ServerError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a full disk on the server stops a push with a clear message, and the next one brings the rest",
          "[collector]") {
  if (!can_mount()) return;
  const SmallDisk disk(64);
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 2);
  const PostgresServer postgres;
  postgres.admin().query("CREATE TABLESPACE small LOCATION '" + disk.space() + "'");
  collector::Connection(postgres.as("postgres") + " dbname=postgres")
      .query("ALTER DATABASE turnpoint SET TABLESPACE small");
  const collector::PushOptions options{db, postgres.as("station_a"), "", "", {}, {}};
  REQUIRE(collector::push(options).complete());

  sample::session(db, 400, sample::start("P02"));
  sample::session(db, 2, sample::start("P03"));
  // Either size is enough for a push to begin, but too small for the session of 400 trials.
  for (const auto left_KiB : {256U, 2048U}) {
    INFO(left_KiB);
    disk.free();
    disk.fill(std::uintmax_t{left_KiB} << 10U);
    const auto message = failure_of(options);
    CHECK(sample::contains(message, "No space left on device"));
    CHECK(sample::contains(message, "free some on the server, and push again"));
    CHECK(whole_sessions(postgres, db) == 1);
    // Nothing of the session that did not fit is left, not even the enrolment of its participant.
    CHECK(postgres.admin().query("SELECT count(*) FROM turnpoint.trial").integer(0, 0) == 2);
    CHECK(postgres.admin().query("SELECT count(*) FROM turnpoint.enrolment").integer(0, 0) == 1);
  }
  disk.free();
  CHECK(collector::push(options).complete());
  CHECK(whole_sessions(postgres, db) == 3);
}

TEST_CASE("a server that dies because the disk of its log is full has whole sessions when it is back",
          "[collector]") {
  if (!can_mount()) return;
  const SmallDisk disk(64);
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 2);
  PostgresServer postgres({false, "--wal-segsize=1 --waldir=" + disk.space() + "/wal"});
  const collector::PushOptions options{db, postgres.as("station_a"), "", "", {}, {}};
  REQUIRE(collector::push(options).complete());
  for (int i = 0; i < 8; ++i) sample::session(db, 150, sample::start(fmt::format("P1{}", i)));
  disk.fill(3U << 20U);
  CHECK(sample::contains(failure_of(options), "collector:"));
  CHECK(sample::contains(sample::bytes_of(postgres.folder() + "/log"), "No space left on device"));
  disk.free();
  try {
    postgres.stop();
  } catch (const std::exception&) {
    // The server has crashed, and could not recover while the disk was full.
  }
  postgres.start();
  const auto whole = whole_sessions(postgres, db);
  CHECK(whole >= 1);
  CHECK(whole < 9);
  CHECK(collector::push(options).complete());
  CHECK(whole_sessions(postgres, db) == 9);
}

#include <sys/stat.h>

#include <fstream>
#include <iterator>

#include "station/cli/sign.hpp"
#include "station/store/error.hpp"
#include "station/store/read.hpp"
#include "station/store/sqlite.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

constexpr int kPatience_ms = 60000;
const std::string kSource = TURNPOINT_SOURCE_DIR;

/// Runs a program until it ends and returns its output.
std::string said_by(const std::vector<std::string>& command, int outcome = 0) {
  Child child(command);
  REQUIRE(child.ends_within(kPatience_ms));
  INFO(child.said());
  CHECK(child.outcome() == outcome);
  return child.said();
}

std::string run_demo(const std::string& db) {
  return said_by({TURNPOINT, "run", kSource + "/protocols/demo.toml", "--rig",
                  kSource + "/tests/support/thin_plate.toml", "--participant", "P01", "--db", db,
                  "--observer", "sim", "--seed", "7"});
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("the checksum printed at the end of a session is also exported, reported and verified", "[cli]") {
  const TemporaryFolder folder;
  const auto db = folder / "lab.sqlite";
  const auto summary = run_demo(db);
  const auto checksum = turnpoint::store::list_sessions(db).front().checksum;
  REQUIRE(checksum.size() == 64);
  CHECK(contains(summary, "checksum " + checksum));
  said_by({TURNPOINT, "export", "--db", db, "--out", folder / "out"});
  said_by({TURNPOINT, "report", "--db", db, "--out", folder / "P01.html"});
  for (const auto& file : {folder / "out/demo/sessions.csv", folder / "P01.html"}) {
    std::ifstream stream(file);
    CHECK(contains({std::istreambuf_iterator<char>(stream), {}}, checksum));
  }
  const std::vector<std::string> verify = {TURNPOINT, "verify",    "--db",
                                           db,        "--against", folder / "out/demo/sessions.csv"};
  CHECK(contains(said_by(verify), "as recorded, checksum " + checksum));
  {
    turnpoint::store::Database raw(db, turnpoint::store::Database::Access::read_write);
    raw.execute("DROP TRIGGER trial_is_never_changed; UPDATE trial SET level = 0.5 WHERE trial_index = 3");
  }
  CHECK(contains(said_by(verify, 1), "trial 3"));
}

TEST_CASE("ssh-keygen accepts a signed export, and rejects a changed one", "[cli]") {
  const TemporaryFolder folder;
  const auto db = folder / "lab.sqlite", key = folder / "key", out = folder / "out";
  run_demo(db);
  said_by({"/usr/bin/ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-C", "lab", "-f", key});
  said_by({TURNPOINT, "export", "--db", db, "--out", out, "--sign", key});
  said_by({"/bin/sh", "-c", "cd " + out + " && sha256sum -c --quiet SHA256SUMS"});
  const auto check = "cd " + out +
                     " && (printf 'lab '; cat ../key.pub) > ../signers && ssh-keygen -Y verify -f "
                     "../signers -I lab -n turnpoint -s SHA256SUMS.sig < SHA256SUMS";
  CHECK(contains(said_by({"/bin/sh", "-c", check}), "Good"));
  std::ofstream(out + "/SHA256SUMS", std::ios::app) << " ";
  said_by({"/bin/sh", "-c", check}, 255);
  CHECK(contains(said_by({TURNPOINT, "export", "--db", db, "--out", out, "--sign", folder / "absent"}, 1),
                 "unsigned"));
}

TEST_CASE("nothing is signed if an exported file cannot be read completely", "[cli]") {
  const TemporaryFolder folder;
  const auto fifo = folder / "fifo.csv";
  REQUIRE(::mkfifo(fifo.c_str(), 0600) == 0);
  for (const std::string& file : {folder.path, fifo, folder / "absent.csv", std::string("/proc/self/mem")}) {
    INFO(file);
    CHECK_THROWS_AS(turnpoint::cli::sign_files(folder.path, {file}, "key"), turnpoint::store::StoreError);
    CHECK_FALSE(std::filesystem::exists(folder / "SHA256SUMS"));
  }
}

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "station/core/read_file.hpp"
#include "station/system/write_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
namespace fs = std::filesystem;

namespace {

std::string content(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("writing a file replaces the old file as a whole", "[write]") {
  const TemporaryFolder folder;
  const auto path = folder / "a.csv";
  system::write_file(path, "one\n");
  system::write_file(path, "two\n", 0600);
  CHECK(content(path) == "two\n");
  CHECK((fs::status(path).permissions() & fs::perms::all) == fs::perms(0600));
  CHECK_FALSE(fs::exists(path + ".new"));
  CHECK_THROWS_AS(system::write_file(folder / "no/a.csv", "x"), std::system_error);
}

TEST_CASE("a file written in pieces appears whole, or not at all", "[write]") {
  const TemporaryFolder folder;
  const auto path = folder / "a.csv";
  system::write_file(path, "old\n");
  for (const bool committed : {false, true}) {
    system::FileWriter file(path);
    file.write("one\n");
    file.write("two\n");
    CHECK(content(path) == "old\n");
    if (committed) file.commit();
  }
  CHECK(content(path) == "one\ntwo\n");
  CHECK_FALSE(fs::exists(path + ".new"));
}

TEST_CASE("a link with the name of the temporary file is not followed", "[write]") {
  const TemporaryFolder folder;
  const auto path = folder / "a.csv", victim = folder / "victim";
  std::ofstream(victim) << "precious";
  fs::create_symlink(victim, path + ".new");
  system::write_file(path, "table\n");
  CHECK(content(victim) == "precious");
  CHECK(content(path) == "table\n");
  CHECK(fs::is_regular_file(fs::symlink_status(path)));
}

TEST_CASE("the user's own link is followed, and one that another user has made is refused", "[write]") {
  const TemporaryFolder folder;
  const auto path = folder / "a.csv", target = folder / "target";
  std::ofstream(target) << "old";
  fs::create_symlink(target, path);
  system::write_file(path, "new");
  CHECK(content(target) == "new");
  CHECK(fs::is_symlink(path));
  if (::geteuid() != 0) return;  // only root can act as another user
  REQUIRE(::lchown(path.c_str(), 12345, 12345) == 0);
  CHECK_THROWS_AS(system::write_file(path, "worse"), std::system_error);
  CHECK(content(target) == "new");
}

TEST_CASE("bytes are written directly to a pipe or a device", "[write]") {
  CHECK_NOTHROW(system::write_file("/dev/null", "bytes"));
  CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("a database, its logs, an input, a folder and a pipe without a reader are refused and unchanged",
          "[write]") {
  const TemporaryFolder folder;
  const auto database = folder / "lab.sqlite", input = folder / "table.csv", pipe = folder / "pipe";
  const auto start = std::string("SQLite format 3\0", 16) + "pages";
  std::ofstream(database, std::ios::binary) << start;
  std::ofstream(input) << "rows";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  fs::create_symlink(database, folder / "link");
  CHECK(core::read_file(input) == "rows");
  for (const auto& path : {database, database + "-wal", folder / "link", input, folder.path + "", pipe})
    CHECK_THROWS_AS(system::write_file(path, "report"), system::RefusedDestination);
  CHECK(content(database) == start);
  CHECK(content(input) == "rows");
  CHECK_FALSE(fs::exists(database + "-wal"));
  system::write_file(input, "changed", 0666, system::Replaces::input);
  CHECK(content(input) == "changed");
  CHECK(core::read_file(input) == "changed");  // an output is not protected by being read
  system::write_file(input, "again");
  CHECK(content(input) == "again");
}

TEST_CASE("writers of one file do not share a draft, and a draft that was left behind is removed",
          "[write]") {
  const TemporaryFolder folder;
  const auto path = folder / "a.csv";
  std::ofstream(path + ".new") << "left by a process that was killed";
  {
    system::FileWriter first(path), second(path);
    first.write("first");
    second.write("second");
    second.commit();
    CHECK(content(path) == "second");
    first.commit();
  }
  CHECK(content(path) == "first");
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);
}

#include "station/core/read_file.hpp"

#include <fstream>
#include <system_error>

#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using turnpoint::core::read_file;

TEST_CASE("a file that cannot be read completely is an error, and never counts as empty", "[system]") {
  CHECK_THROWS_AS(read_file("/proc/self/mem"), std::system_error);  // reading its first byte fails with EIO
  CHECK_THROWS_AS(read_file("/proc/self"), std::system_error);
  CHECK_THROWS_AS(read_file("/dev/zero"), std::system_error);
  CHECK_THROWS_AS(read_file("/nowhere/at/all"), std::system_error);
}

TEST_CASE("a file longer than its reader allows is an error", "[system]") {
  const TemporaryFolder folder;
  std::ofstream(folder / "a") << "0123456789";
  CHECK(read_file(folder / "a", 10) == "0123456789");
  CHECK_THROWS_AS(read_file(folder / "a", 9), std::system_error);
}

#include "station/io/probe.hpp"

#include <filesystem>
#include <fstream>

#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint::io;

TEST_CASE("an input device that can be read but not written is reported with the kernel's reason",
          "[lines][probe]") {
  const TemporaryFolder folder;
  std::ofstream(folder / "event0");
  std::ofstream(folder / "mouse0");
  // A directory can be opened only for reading, even by root. This simulates a device that the station's
  // service may only read.
  std::filesystem::create_directory(folder / "event1");
  const auto devices = try_input_devices(folder.path);
  CHECK(devices.opened == 1);
  CHECK(devices.refused == std::vector<std::string>{folder / "event1" + ": Is a directory"});
}

TEST_CASE("on a machine without input devices the probe reports nothing", "[lines][probe]") {
  const auto devices = try_input_devices("/no/such/folder");
  CHECK(devices.opened == 0);
  CHECK(devices.refused.empty());
}

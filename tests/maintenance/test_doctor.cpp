#include <fstream>

#include "station/maintenance/doctor.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
using Status = lines::Finding::Status;

TEST_CASE("the doctor fails if the machine swaps, and says how to switch swapping off",
          "[maintenance][doctor]") {
  const TemporaryFolder folder;
  const auto file = folder / "swaps";
  const std::string heading = "Filename\t\t\t\tType\t\tSize\t\tUsed\t\tPriority\n";
  std::ofstream(file) << heading;
  CHECK(maintenance::check_swap(file).status == Status::ok);
  std::ofstream(file) << heading << "/var/swap                               file\t\t524284\t\t0\t\t-2\n"
                      << "/dev/zram0                              partition\t2097136\t\t0\t\t100\n";
  const auto found = maintenance::check_swap(file);
  CHECK(found.status == Status::failed);
  CHECK(found.what == "on: /var/swap, /dev/zram0");
  CHECK(found.mend.find("sudo swapoff -a") != std::string::npos);
  CHECK_FALSE(maintenance::fit_for_use({found}));
  // an unreadable file must not count as "off"
  CHECK(maintenance::check_swap(folder / "nothing").status == Status::warning);
}

TEST_CASE("the doctor says whether the hardware watchdog is in use", "[maintenance][doctor]") {
  const TemporaryFolder folder;
  CHECK(maintenance::check_watchdog(folder.path).status == Status::warning);
  std::filesystem::create_directory(folder / "watchdog0");
  std::ofstream(folder / "watchdog0/state") << "inactive\n";
  const auto idle = maintenance::check_watchdog(folder.path);
  CHECK(idle.status == Status::warning);
  CHECK(idle.mend.find("watchdog.conf") != std::string::npos);
  std::ofstream(folder / "watchdog0/state") << "active\n";
  CHECK(maintenance::check_watchdog(folder.path).status == Status::ok);
}

// Tests removable disks. Folders of the test replace those of the kernel, and a script replaces udisksctl.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "station/core/read_file.hpp"
#include "station/maintenance/disks.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
namespace fs = std::filesystem;

namespace {

/// A machine with an internal disk, a USB stick with one partition, an empty card reader, and a memory card
/// without partitions from which the machine runs.
struct Machine {
  fs::path folder = fs::temp_directory_path() / ("turnpoint-disks-" + std::to_string(::getpid()));
  maintenance::DiskSources sources{(folder / "block").string(), (folder / "mountinfo").string(),
                                   (folder / "udisksctl").string()};

  Machine() {
    fs::remove_all(folder);
    disk("nvme0n1", "0", "2000000000", "259:0", "Samsung");
    disk("sda", "1", "61440000", "8:0", "Ultra Fit       ");
    partition("sda", "sda1", "8:1");
    disk("sdb", "1", "0", "8:16", "Card Reader");
    disk("mmcblk0", "1", "30000000", "179:0", "");
    mounts("");
  }
  ~Machine() { fs::remove_all(folder); }

  void write(const fs::path& path, const std::string& text) const {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  void disk(const std::string& name, const std::string& removable, const std::string& sectors,
            const std::string& number, const std::string& model) const {
    const auto block = fs::path(sources.blocks) / name;
    write(block / "removable", removable + "\n");
    write(block / "size", sectors + "\n");
    write(block / "dev", number + "\n");
    if (!model.empty()) write(block / "device/model", model + "\n");
  }
  void partition(const std::string& disk, const std::string& name, const std::string& number) const {
    write(fs::path(sources.blocks) / disk / name / "partition", "1\n");
    write(fs::path(sources.blocks) / disk / name / "dev", number + "\n");
  }
  void mounts(const std::string& more) const {
    write(sources.mounts, "25 1 179:0 / / rw,noatime shared:1 - ext4 /dev/mmcblk0 rw\n" + more);
  }
  /// Replaces udisksctl by a script that notes its arguments and then runs the commands `does`.
  void udisks(const std::string& does) const {
    write(sources.tool, "#!/bin/sh\necho \"$@\" >> " + (folder / "asked").string() + "\n" + does + "\n");
    fs::permissions(sources.tool, fs::perms::owner_all);
  }
  std::string asked() const { return core::read_file((folder / "asked").string()); }
};

/// Returns the message of the error that a call throws; "" if it throws none.
template <typename Call>
std::string error_of(Call call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

const std::string kStick = "31 25 8:1 / /media/lab/MY\\040STICK rw,nosuid shared:9 - vfat /dev/sda1 rw\n";

}  // namespace

TEST_CASE("a USB stick is listed with its model, size and folder, and nothing that the system runs from",
          "[disks]") {
  const Machine machine;
  const auto before = maintenance::removable_disks(machine.sources);
  REQUIRE(before.size() == 1);
  CHECK(before[0] == maintenance::Disk{"/dev/sda1", "Ultra Fit, 31 GB", "", "/dev/sda"});
  machine.mounts(kStick);
  const auto after = maintenance::removable_disks(machine.sources);
  REQUIRE(after.size() == 1);
  CHECK(after[0].folder == "/media/lab/MY STICK");
}

TEST_CASE("the disk with the station's data is never offered, nor another partition of it", "[disks]") {
  Machine machine;
  machine.disk("sdc", "0", "2000000", "8:32", "Portable");
  fs::create_directories(machine.folder / "usb");
  const auto block = fs::path(machine.sources.blocks) / "sdc";
  machine.write(block / "removable", "1\n");
  machine.partition("sdc", "sdc1", "8:33");
  machine.partition("sdc", "sdc2", "8:34");
  const auto offered = [&](const std::string& folder) {
    machine.mounts("40 25 8:33 / " + folder + " rw shared:9 - ext4 /dev/sdc1 rw\n");
    std::string devices;
    for (const auto& disk : maintenance::removable_disks(machine.sources)) devices += disk.device + " ";
    return devices;
  };
  CHECK(offered("/media/lab/portable") == "/dev/sda1 /dev/sdc1 /dev/sdc2 ");
  CHECK(offered("/var/lib/turnpoint") == "/dev/sda1 ");
  machine.sources.data = "/srv/lab/lab.sqlite";
  CHECK(offered("/srv/lab") == "/dev/sda1 ");
  CHECK(offered("/srv") == "/dev/sda1 ");
  CHECK(offered("/srv/la") == "/dev/sda1 /dev/sdc1 /dev/sdc2 ");
  // the data's folder is a link to the disk
  fs::create_directories(machine.folder / "mounted/data");
  fs::create_directory_symlink(machine.folder / "mounted/data", machine.folder / "data");
  machine.sources.data = (machine.folder / "data/lab.sqlite").string();
  CHECK(offered(fs::canonical(machine.folder / "mounted").string()) == "/dev/sda1 ");
}

TEST_CASE("a disk is mounted through udisks, and its folder is the one that the kernel reports", "[disks]") {
  const Machine machine;
  const auto disk = maintenance::removable_disks(machine.sources).at(0);
  machine.udisks("printf '%s\\n' '" + kStick.substr(0, kStick.size() - 1) + "' >> " + machine.sources.mounts);
  CHECK(maintenance::mount(disk, machine.sources) == "/media/lab/MY STICK");
  CHECK(machine.asked() == "mount --no-user-interaction --block-device /dev/sda1\n");
  CHECK(maintenance::mount(disk, machine.sources) == "/media/lab/MY STICK");
  CHECK(machine.asked() == "mount --no-user-interaction --block-device /dev/sda1\n");  // and not once more
  machine.mounts("");                                                                  // it was pulled out
  machine.udisks("echo 'Error looking up object for device /dev/sda1' >&2; exit 1");
  CHECK(error_of([&] { maintenance::mount(disk, machine.sources); }).find("Error looking up") !=
        std::string::npos);
}

TEST_CASE("a disk that cannot be mounted is named with what udisks said", "[disks]") {
  const Machine machine;
  const auto disk = maintenance::removable_disks(machine.sources).at(0);
  machine.udisks("echo 'unknown filesystem type exfat' >&2; exit 1");
  CHECK(error_of([&] { maintenance::mount(disk, machine.sources); }) ==
        "Ultra Fit, 31 GB (/dev/sda1) could not be mounted: unknown filesystem type exfat\n");
}

TEST_CASE("ejecting unmounts and then switches off, and stops if the disk is in use", "[disks]") {
  const Machine machine;
  machine.mounts(kStick);
  const auto disk = maintenance::removable_disks(machine.sources).at(0);
  // a disk that cannot be switched off, such as a memory card
  machine.udisks("case $1 in power-off) exit 1;; esac");
  maintenance::eject(disk, machine.sources);
  CHECK(machine.asked() ==
        "unmount --no-user-interaction --block-device /dev/sda1\n"
        "power-off --no-user-interaction --block-device /dev/sda1\n");
  fs::remove(machine.folder / "asked");
  machine.udisks("echo 'target is busy'; exit 1");
  CHECK(error_of([&] {
          maintenance::eject(disk, machine.sources);
        }).find("do not unplug it: target is busy") != std::string::npos);
  CHECK(machine.asked() == "unmount --no-user-interaction --block-device /dev/sda1\n");
}

TEST_CASE("all partitions of a disk are unmounted before it is switched off", "[disks]") {
  const Machine machine;
  machine.partition("sda", "sda2", "8:2");
  machine.mounts(kStick + "32 25 8:2 / /media/lab/MORE rw shared:9 - vfat /dev/sda2 rw\n");
  machine.udisks("case $1$4 in unmount/dev/sda2) echo busy; exit 1;; esac");
  const auto disk = maintenance::removable_disks(machine.sources).at(0);
  CHECK(error_of([&] { maintenance::eject(disk, machine.sources); }).find("/dev/sda2") != std::string::npos);
  CHECK(machine.asked().find("power-off") == std::string::npos);
  machine.udisks("");
  maintenance::eject(disk, machine.sources);
  CHECK(machine.asked().ends_with(
      "--block-device /dev/sda1\nunmount --no-user-interaction --block-device /dev/sda2\n"
      "power-off --no-user-interaction --block-device /dev/sda1\n"));
}

TEST_CASE("without udisks the error names the Debian package", "[disks]") {
  const Machine machine;
  const auto disk = maintenance::removable_disks(machine.sources).at(0);
  CHECK(error_of([&] { maintenance::eject(disk, machine.sources); }).find("udisks2") != std::string::npos);
}

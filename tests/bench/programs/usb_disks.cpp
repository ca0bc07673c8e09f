// usb_disks DATABASE [mount DEVICE | eject DEVICE]: does what the page of sessions does with USB disks, as
// the user who starts it. Without a verb it prints a line for each disk that the page offers: its device,
// folder and name.
#include <cstdio>
#include <exception>
#include <string>

#include "station/maintenance/disks.hpp"

using namespace turnpoint;

int main(int argc, char** argv) try {
  if (argc != 2 && argc != 4)
    return std::fputs("usb_disks: DATABASE [mount DEVICE | eject DEVICE]\n", stderr), 2;
  maintenance::DiskSources sources;
  sources.data = argv[1];
  for (const auto& disk : maintenance::removable_disks(sources)) {
    if (argc == 2)
      std::printf("%s %s %s\n", disk.device.c_str(), disk.folder.empty() ? "-" : disk.folder.c_str(),
                  disk.name.c_str());
    if (argc == 2 || disk.device != argv[3]) continue;
    if (std::string(argv[2]) == "eject") return maintenance::eject(disk, sources), 0;
    return std::printf("%s\n", maintenance::mount(disk, sources).c_str()), 0;
  }
  if (argc == 2) return 0;
  return std::fprintf(stderr, "usb_disks: %s is not offered\n", argv[3]), 1;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "usb_disks: %s\n", error.what()), 1;
}

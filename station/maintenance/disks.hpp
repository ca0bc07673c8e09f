#pragma once
#include <string>
#include <vector>

namespace turnpoint::maintenance {

/// A disk that somebody can take out: a USB stick, a USB disk or a memory card.
struct Disk {
  std::string device;  ///< such as "/dev/sda1"
  std::string name;    ///< its model and size, such as "Ultra Fit, 31 GB"
  std::string folder;  ///< folder at which it is mounted; "" if it is not mounted
  std::string whole;   ///< device of the whole disk, such as "/dev/sda"
  bool operator==(const Disk&) const = default;
};

/// Where disks are listed, and the program that mounts and ejects them.
struct DiskSources {
  std::string blocks = "/sys/block";
  std::string mounts = "/proc/self/mountinfo";
  std::string tool = "udisksctl";           ///< Debian package udisks2
  std::string data = "/var/lib/turnpoint";  ///< the station's data; their disk is part of the system
};

/// Returns the disks that can be taken out, sorted by device: each partition of one, or the whole disk if it
/// has no partitions. Leaves out disks that hold a part of the running system (/, /boot, /usr, /var) or the
/// station's data, with all of their partitions, because ejecting one switches off the whole disk.
std::vector<Disk> removable_disks(const DiskSources& sources = {});

/// Returns the folder at which a disk is mounted now; mounts it through udisks if it is not. Throws
/// std::runtime_error with what udisks said, as for a disk that was pulled out since it was listed.
std::string mount(const Disk& disk, const DiskSources& sources = {});

/// Writes everything to a disk and unmounts it with all of its partitions, and then switches it off, so that
/// it can be unplugged. Throws std::runtime_error if one could not be unmounted. A disk that cannot be
/// switched off, such as a memory card, can be taken out as soon as it is unmounted.
void eject(const Disk& disk, const DiskSources& sources = {});

}  // namespace turnpoint::maintenance

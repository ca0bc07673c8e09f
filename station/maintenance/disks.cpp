#include "station/maintenance/disks.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "station/core/file_descriptor.hpp"
#include "station/core/texts.hpp"

namespace turnpoint::maintenance {

namespace fs = std::filesystem;

namespace {

std::string first_line(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  const auto end = line.find_last_not_of(' ');
  return end == std::string::npos ? "" : line.substr(0, end + 1);
}

/// Returns a path without escapes. (The kernel writes spaces and some other characters of a path as \ and
/// three octal digits.)
std::string unescaped(const std::string& text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\\' && i + 3 < text.size())
      plain += static_cast<char>(std::stoi(text.substr(i + 1, 3), nullptr, 8)), i += 3;
    else
      plain += text[i];
  return plain;
}

/// The folders at which each device is mounted, by "major:minor" and by device ("/dev/sda1").
std::multimap<std::string, std::string> mount_points(const std::string& mountinfo) {
  std::multimap<std::string, std::string> points;
  std::ifstream file(mountinfo);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    const std::vector<std::string> fields{std::istream_iterator<std::string>(words), {}};
    const auto dash = std::find(fields.begin(), fields.end(), "-");
    if (fields.size() < 6 || fields.end() - dash < 3) continue;
    points.emplace(fields[2], unescaped(fields[4]));
    if (dash[2].starts_with("/dev/")) points.emplace(dash[2], unescaped(fields[4]));
  }
  return points;
}

bool can_be_taken_out(const fs::path& block) {
  return first_line(block / "removable") == "1" ||
         fs::canonical(block).string().find("/usb") != std::string::npos;
}

double size_GB(const fs::path& block) {
  const auto sectors = first_line(block / "size");
  return sectors.empty()
             ? 0
             : 512e-9 * static_cast<double>(std::stoll(sectors));  // the kernel counts sectors of 512 bytes
}

bool is_of_the_system(const std::string& folder, const std::string& data) {
  static const std::array parts{"/", "/boot", "/boot/firmware", "/boot/efi", "/usr", "/var", "/home"};
  return std::find(parts.begin(), parts.end(), folder) != parts.end() || folder.starts_with("/var/") ||
         data == folder || data.starts_with(folder + "/");
}

struct Ended {
  int status = 0;
  std::string said;
};

/// Runs a program without a shell and returns its exit status and everything that it printed.
Ended run(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
  const core::FileDescriptor reading(ends[0]);
  core::FileDescriptor writing(ends[1]);
  posix_spawn_file_actions_t actions{};
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  pid_t process = -1;
  const int error = ::posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    throw std::system_error(error, std::generic_category(),
                            "cannot start " + words[0] + " (Debian package udisks2)");
  writing = core::FileDescriptor();
  Ended ended;
  std::array<char, 512> buffer{};
  for (ssize_t count = 0; (count = ::read(reading.get(), buffer.data(), buffer.size())) != 0;) {
    if (count > 0) ended.said.append(buffer.data(), static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR) break;
  }
  int status = 0;
  while (::waitpid(process, &status, 0) < 0)
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "waiting for " + words[0]);
  ended.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return ended;
}

Ended ask_udisks(const DiskSources& sources, const std::string& verb, const std::string& device) {
  return run({sources.tool, verb, "--no-user-interaction", "--block-device", device});
}

/// The folders at which a partition, or a disk without partitions, is mounted.
std::vector<std::string> folders_of(const fs::path& block,
                                    const std::multimap<std::string, std::string>& points) {
  std::vector<std::string> folders;
  for (const auto& key : {first_line(block / "dev"), "/dev/" + block.filename().string()}) {
    const auto [begin, end] = points.equal_range(key);
    for (auto point = begin; point != end; ++point) folders.push_back(point->second);
  }
  return folders;
}

/// True if the partition is in use by something other than a mount, such as an encrypted or a logical volume.
bool has_holders(const fs::path& block) {
  std::error_code none;
  return fs::directory_iterator(block / "holders", none) != fs::directory_iterator();
}

}  // namespace

std::vector<Disk> removable_disks(const DiskSources& sources) {
  std::vector<Disk> disks;
  if (!fs::is_directory(sources.blocks)) return disks;
  const auto points = mount_points(sources.mounts);
  std::error_code unresolved;  // the data's folder may be a link to the disk that holds them
  const auto resolved = fs::weakly_canonical(sources.data, unresolved).string();
  const auto data = unresolved ? sources.data : resolved;
  for (const auto& entry : fs::directory_iterator(sources.blocks)) {
    const auto& block = entry.path();
    const double gigabytes = size_GB(block);
    // skip card readers without a card, whose size is 0
    if (gigabytes == 0 || !can_be_taken_out(block)) continue;
    const auto model = first_line(block / "device/model");
    const auto name = fmt::format(
        "{}, {} GB", model.empty() ? block.filename().string() : model,
        gigabytes < 10 ? fmt::format("{:.1f}", gigabytes) : fmt::format("{}", std::lround(gigabytes)));
    std::vector<fs::path> parts;
    for (const auto& part : fs::directory_iterator(block))
      if (fs::exists(part.path() / "partition")) parts.push_back(part.path());
    if (parts.empty()) parts.push_back(block);
    std::vector<Disk> found;
    bool of_the_system = false;
    for (const auto& part : parts) {
      const auto folders = folders_of(part, points);
      of_the_system = of_the_system || has_holders(part) ||
                      std::any_of(folders.begin(), folders.end(),
                                  [&](const auto& folder) { return is_of_the_system(folder, data); });
      found.push_back({"/dev/" + part.filename().string(), name, folders.empty() ? "" : folders.front(),
                       "/dev/" + block.filename().string()});
    }
    if (!of_the_system) disks.insert(disks.end(), found.begin(), found.end());
  }
  std::sort(disks.begin(), disks.end(), [](const Disk& a, const Disk& b) { return a.device < b.device; });
  return disks;
}

std::string mount(const Disk& disk, const DiskSources& sources) {
  const auto folder = [&]() -> std::string {
    for (const auto& now : removable_disks(sources))
      if (now.device == disk.device) return now.folder;
    return "";
  };
  if (const auto mounted = folder(); !mounted.empty()) return mounted;
  const auto ended = ask_udisks(sources, "mount", disk.device);
  if (const auto mounted = folder(); !mounted.empty()) return mounted;
  throw core::Failure(
      core::phrase("operator.cannot_mount",
                   {core::plain(disk.name), core::plain(disk.device),
                    ended.said.empty() ? core::phrase("operator.no_reason") : core::plain(ended.said)}));
}

void eject(const Disk& disk, const DiskSources& sources) {
  ::sync();
  for (const auto& now : removable_disks(sources)) {
    if (now.whole != disk.whole || now.folder.empty()) continue;
    if (const auto ended = ask_udisks(sources, "unmount", now.device); ended.status != 0)
      throw core::Failure(
          core::phrase("operator.still_in_use",
                       {core::plain(now.name), core::plain(now.device), core::plain(ended.said)}));
  }
  ask_udisks(sources, "power-off", disk.device);
}

}  // namespace turnpoint::maintenance

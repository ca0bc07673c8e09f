#include <sys/mount.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "station/maintenance/doctor.hpp"
#include "station/system/condition.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
using Status = io::Finding::Status;

namespace {

std::string english(const core::Phrase& phrase) { return core::say(phrase, "en"); }

/// Parts of a phrase that are the same in every language although they are several words in a row.
std::vector<std::string> untranslated(const core::Phrase& phrase) {
  static const std::regex words("[A-Za-z]{2,} [a-z]{2,} [a-z]{2,}");
  std::vector<std::string> found;
  if (phrase.key.empty() && std::regex_search(phrase.words, words)) found.push_back(phrase.words);
  // What the system reported stays as it is.
  if (phrase.key != "doctor.reported" && phrase.key != "doctor.touch_missing")
    for (const auto& value : phrase.values)
      for (auto& part : untranslated(value)) found.push_back(std::move(part));
  return found;
}

}  // namespace

TEST_CASE("each finding of the doctor is said in the language of the screen, and as before in English",
          "[maintenance][doctor]") {
  const TemporaryFolder folder;
  auto rig = rig::load(TURNPOINT_SOURCE_DIR "/deploy/rigs/simulated-forces.toml");
  rig.amplifier_uri = "gpio:enable=no-such-line,heartbeat=neither";
  rig.buttons_uri = "gpio:left=nor-this";
  rig.contact_uri = "evdev:no such sensor";
  rig.output.uri = "alsa:hw:CARD=nosuchcard";
  const auto findings = maintenance::examine(rig, folder.path);
  CHECK(findings.size() > 12);
  for (const auto& finding : findings)
    for (const auto* part : {&finding.name, &finding.what, &finding.mend}) {
      INFO(english(*part));
      CHECK(untranslated(*part) == std::vector<std::string>());
    }
  const auto said = [&](const std::string& name, const char* language) {
    for (const auto& finding : findings)
      if (english(finding.name) == name) return core::say(finding.what, language);
    return "no finding " + name;
  };
  CHECK(said("amplifier enable", "en") == "no GPIO chip has a line named no-such-line");
  CHECK(said("amplifier enable", "de") == "kein GPIO-Baustein hat eine Leitung namens no-such-line");
  CHECK(said("contact", "en") == "input device 'no such sensor': No such file or directory");
  CHECK(said("converter", "de") == "Meldung: " + said("converter", "en"));
}

TEST_CASE("the doctor names the file system of the data folder, and what is wrong with it",
          "[maintenance][doctor]") {
  const TemporaryFolder folder;  // in memory, on machines that have such a folder
  bool named = false;
  for (const auto& finding :
       maintenance::examine(rig::load(TURNPOINT_SOURCE_DIR "/deploy/rigs/simulated.toml"), folder.path))
    if (english(finding.name) == "file system of the data folder") {
      named = true;
      if (folder.path.starts_with("/dev/shm")) {
        CHECK(finding.status == Status::failed);
        CHECK(english(finding.what) == "tmpfs");
      }
    }
  CHECK(named);
  const auto mend = [](const char* file_system) {
    const auto finding = maintenance::check_file_system(file_system);
    CHECK(finding.status != Status::failed);
    return finding.status == Status::ok ? "" : english(finding.mend);
  };
  for (const auto* good : {"ext4", "btrfs", "xfs", "f2fs"}) CHECK(mend(good).empty());
  for (const auto* remote : {"nfs", "cifs", "fuse", "9p", "ceph"})
    CHECK_THAT(mend(remote), Catch::Matchers::ContainsSubstring("on a disk of this machine"));
  for (const auto* plain : {"vfat", "exfat", "ntfs"})
    CHECK_THAT(mend(plain), Catch::Matchers::ContainsSubstring("ext4"));
  for (const auto* in_memory : {"tmpfs", "ramfs", "overlay"}) {
    const auto finding = maintenance::check_file_system(in_memory);
    CHECK(finding.status == Status::failed);
    CHECK_THAT(english(finding.mend), Catch::Matchers::ContainsSubstring("switched off"));
  }
}

TEST_CASE("the doctor reads the name of a file system from the folder itself", "[maintenance][doctor]") {
  const TemporaryFolder folder;
  const auto mounted = [&](const char* type, const std::string& options) {
    const auto place = folder / type;
    std::filesystem::create_directory(place);
    if (::mount(type, place.c_str(), type, 0, options.empty() ? nullptr : options.c_str()) != 0)
      return std::string();
    const auto found = system::read_disk(place + "/folder/that/is/not/there").file_system;
    ::umount2(place.c_str(), MNT_DETACH);
    return found;
  };
  const auto memory = mounted("tmpfs", "");
  if (memory.empty()) {
    WARN("skipped: only root can mount; sudo tests/run");
    return;
  }
  CHECK(memory == "tmpfs");
  CHECK(mounted("ramfs", "") == "ramfs");
  const auto lower = folder / "lower", upper = folder / "upper", work = folder / "work";
  for (const auto& part : {lower, upper, work}) std::filesystem::create_directory(part);
  const auto overlay = mounted("overlay", "lowerdir=" + lower + ",upperdir=" + upper + ",workdir=" + work);
  if (!overlay.empty()) CHECK(overlay == "overlay");
}

TEST_CASE("the doctor warns of a sound card that has a number instead of a name, or neither",
          "[maintenance][doctor]") {
  for (const auto* uri : {"alsa:hw:0",
                          "alsa:hw:0,0",
                          "alsa:hw:1,0,2",
                          "alsa:hw",
                          "alsa:hw:",
                          "alsa:hw:CARD=0",
                          "alsa:hw:CARD=12,DEV=0",
                          "alsa:hw:DEV=0,CARD=1",
                          "alsa:hw:DEV=0",
                          "alsa:plughw:0",
                          "alsa:plughw:CARD=0,DEV=0",
                          "alsa:default",
                          "alsa:default:0",
                          "alsa:default:CARD=1",
                          "alsa:sysdefault",
                          "alsa:sysdefault:1",
                          "alsa:front:0",
                          "alsa:surround51:CARD=2",
                          "alsa:dmix:0",
                          "alsa:plug:hw:0",
                          "alsa:plug:'hw:0'",
                          "alsa:hdmi:CARD=0,DEV=1"}) {
    INFO(uri);
    CHECK_FALSE(maintenance::names_a_card(uri));
  }
  for (const auto* uri :
       {"alsa:hw:CARD=sndrpihifiberry", "alsa:hw:CARD=sndrpihifiberry,DEV=0", "alsa:hw:DEV=0,CARD=Loopback",
        "alsa:hw:Loopback,0", "alsa:hw:Loopback", "alsa:plughw:CARD=U192k,DEV=0", "alsa:plughw:U192k",
        "alsa:hw:CARD=0ab", "alsa:hw:2i2", "alsa:sysdefault:CARD=PCH", "alsa:default:CARD=PCH", "alsa:looped",
        "alsa:mixed", "alsa:plug:hw:CARD=PCH", "alsa:plug:'hw:PCH,0'", "sim:", "null:", "wav:hw:0"}) {
    INFO(uri);
    CHECK(maintenance::names_a_card(uri));
  }
  const TemporaryFolder folder;
  auto rig = rig::load(TURNPOINT_SOURCE_DIR "/deploy/rigs/simulated.toml");
  for (const auto* uri : {"alsa:hw:31", "alsa:hw:CARD=nosuchcard"}) {
    rig.output.uri = uri;
    int warnings = 0;
    for (const auto& finding : maintenance::examine(rig, folder.path))
      if (finding.mend.key == "doctor.card_number_mend") {
        ++warnings;
        CHECK(finding.status == Status::warning);
        CHECK(english(finding.what) == uri);
      }
    CHECK(warnings == (std::string(uri) == "alsa:hw:31" ? 1 : 0));
  }
}

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
  CHECK(english(found.what) == "on: /var/swap, /dev/zram0");
  CHECK(core::say(found.what, "de") == "an: /var/swap, /dev/zram0");
  CHECK(english(found.mend).find("sudo swapoff -a") != std::string::npos);
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
  CHECK(english(idle.mend).find("watchdog.conf") != std::string::npos);
  std::ofstream(folder / "watchdog0/state") << "active\n";
  CHECK(maintenance::check_watchdog(folder.path).status == Status::ok);
}

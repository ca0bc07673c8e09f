#include "station/maintenance/doctor.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <regex>
#include <string_view>
#include <system_error>
#include <utility>

#include "station/audio/alsa_capture.hpp"
#include "station/audio/alsa_device.hpp"
#include "station/audio/engine.hpp"
#include "station/io/converter.hpp"
#include "station/sensing/own_clock.hpp"
#include "station/session/cell_feed.hpp"
#include "station/session/places.hpp"
#include "station/session/self_test.hpp"
#include "station/session/stage.hpp"
#include "station/system/clocks.hpp"
#include "station/system/condition.hpp"

namespace turnpoint::maintenance {

bool names_a_card(const std::string& uri) {
  // The devices that alsa-lib makes for every card; a name from the machine's own configuration may be any
  // other.
  static const std::regex of_card(
      "alsa:(plug:)?['\"]?(hw|plughw|default|sysdefault|front|rear|side|center_lfe|surround[0-9]+|iec958|"
      "spdif|hdmi|dmix|dshare|dsnoop)(:(.*))?");
  static const std::regex named(
      "(.*,)?CARD=(?![0-9]+([,'\"].*)?$).+|(?!.*CARD=)(?![A-Z]+=)(?![0-9]*([,'\"].*)?$).+");
  std::smatch parts;
  return !std::regex_match(uri, parts, of_card) || std::regex_match(parts[4].str(), named);
}

namespace {

using Status = io::Finding::Status;
using core::Phrase, core::phrase, core::plain;

Phrase number(auto value) { return plain(fmt::format("{}", value)); }

// Measures the rate of the device's own clock. Plays silence for two and a half seconds, or longer if the
// device's time stamps are coarse.
io::Finding measured_clock(audio::Stream& stream) {
  for (int k = 0; k < 220; ++k) {
    system::sleep_until_ns(system::monotonic_ns() + 100'000'000);
    while (stream.poll()) {
    }
    if (const auto rate = stream.measured_rate()) {
      const bool good = std::abs(rate->deviation_ppm) <= audio::RateCheck::tolerance_ppm;
      return {phrase("doctor.converter_clock"), good ? Status::ok : Status::failed,
              phrase("doctor.clock_rate", {plain(fmt::format("{:.2f}", rate->rate_Hz)),
                                           plain(fmt::format("{:+.1f}", rate->deviation_ppm)),
                                           plain(fmt::format("{:.1f}", rate->standard_error_ppm))}),
              good ? Phrase() : phrase("doctor.clock_rate_mend")};
    }
  }
  return {phrase("doctor.converter_clock"), Status::failed, phrase("doctor.no_stamps"),
          phrase("doctor.no_stamps_mend")};
}

// Returns the card for amixer: NAME in alsa:hw:CARD=NAME,DEV=0 or alsa:plughw:NAME,0; the first one if none
// is named.
std::string card_for_amixer(const std::string& uri) {
  const auto card = audio::card_of(uri);
  const auto from = card.find_first_of(":=");
  if (from == std::string::npos) return "0";
  const auto last = card.find('=', from);
  return card.substr((last == std::string::npos ? from : last) + 1);
}

// A PCM512x mutes its analogue outputs after 1024 frames of zeros (5 ms at 192 kHz), and unmutes them at the
// next onset (TI, PCM512x data sheet, zero data detection). Between stimuli, a session plays nothing but
// zeros.
void converter_mute(const rig::Rig& rig, std::vector<io::Finding>& checks) {
  const auto on = audio::card_switch(rig.output.uri, "Auto Mute Switch");
  if (!on) return;
  checks.push_back({phrase("doctor.converter_mute"), *on ? Status::failed : Status::ok,
                    phrase(*on ? "doctor.mute_on" : "doctor.mute_off"),
                    *on ? phrase("doctor.mute_mend", {plain(card_for_amixer(rig.output.uri))}) : Phrase()});
}

// Compares the card's levels with those of the calibration.
void mixer(const rig::Rig& rig, std::vector<io::Finding>& checks) {
  const auto check = session::judged(session::read_mixer(rig));
  if (check.verdict == core::Verdict::not_possible) return;
  const bool good = check.verdict == core::Verdict::passed;
  checks.push_back({check.name, good ? Status::ok : Status::failed, check.what,
                    good ? Phrase() : phrase("refusal.mixer")});
}

/// What to do if a sound device does not open.
Phrase sound_mend(const std::exception& error, const char* otherwise) {
  const auto* refused = dynamic_cast<const std::system_error*>(&error);
  const bool rights = refused != nullptr && refused->code() == std::errc::permission_denied;
  return phrase(rights ? "doctor.sound_rights_mend" : otherwise);
}

// Warns of a sound device that may be another card after the next boot.
void card_name(const Phrase& name, const std::string& uri, std::vector<io::Finding>& checks) {
  if (!names_a_card(uri))
    checks.push_back({name, Status::warning, plain(uri), phrase("doctor.card_number_mend")});
}

void converter(const rig::Rig& rig, std::vector<io::Finding>& checks) {
  const auto uri = plain(rig.output.uri), name = phrase("doctor.converter");
  if (!rig.output.uri.starts_with("alsa:")) {
    checks.push_back({name, Status::ok, phrase("doctor.no_converter", {uri}), {}});
    return;
  }
  card_name(name, rig.output.uri, checks);
  try {
    const auto stream = audio::open_realtime(session::stream_of(rig));
    checks.push_back(
        {name,
         Status::ok,
         phrase("doctor.converter_good", {uri, number(rig.output.rate_Hz), number(rig.output.bits)}),
         {}});
    checks.push_back(measured_clock(*stream));
    const auto underruns = stream->counters().underruns;
    checks.push_back({phrase("doctor.converter_stream"), underruns == 0 ? Status::ok : Status::failed,
                      phrase("doctor.underruns", {number(underruns)}),
                      underruns == 0 ? Phrase() : phrase("doctor.underruns_mend")});
  } catch (const std::exception& error) {
    checks.push_back({name, Status::failed, io::reported(error), sound_mend(error, "doctor.converter_mend")});
  }
}

// Opens the capture device and captures for half a second.
io::Finding capture(const session::CardCapture& plan) {
  const auto name = phrase("doctor.capture"), mend = phrase("doctor.capture_mend");
  try {
    const auto opened = audio::open_capture(plan.device);
    for (int k = 0; k < 50; ++k) {
      system::sleep_until_ns(system::monotonic_ns() + 10'000'000);
      while (opened->take() != nullptr) {
      }
    }
    const auto counters = opened->counters();
    const auto lost = counters.overruns + counters.unknown_gaps;
    const bool good = counters.frames > 0 && lost == 0;
    return {name, good ? Status::ok : Status::failed,
            phrase("doctor.captured", {plain(plan.device.uri), number(plan.device.channels),
                                       number(plan.device.rate_Hz), number(counters.frames), number(lost)}),
            good ? Phrase() : mend};
  } catch (const std::exception& error) {
    return {name, Status::failed, io::reported(error), sound_mend(error, "doctor.capture_mend")};
  }
}

io::Finding pick_ups(const rig::Rig& rig) {
  const auto unproven = rig::unproven_transducers(rig);
  const auto name = phrase("operator.measured_pick_ups");
  if (unproven.empty()) return {name, Status::ok, phrase("doctor.pick_ups_good"), {}};
  return {name, Status::warning,
          phrase("doctor.pick_ups_missing", {plain(fmt::format("{}", fmt::join(unproven, ", ")))}),
          phrase("doctor.pick_ups_mend")};
}

// Reads the converter of the force cells for half a second.
io::Finding force_converter(const rig::CellConverter& converter) {
  const auto name = phrase("doctor.force_converter"), mend = phrase("doctor.force_converter_mend");
  try {
    const auto config = session::converter_of(converter);
    const auto opened = io::open(config);
    sensing::OwnClock clock({.rate_Hz = converter.rate_Hz});
    std::int64_t first_ns = 0, last_ns = 0;
    for (bool begun = false; !begun || last_ns - first_ns < 500'000'000;)
      for (const auto& sample : opened->read()) {
        if (!std::exchange(begun, true)) first_ns = sample.time_ns;
        last_ns = sample.time_ns;
        clock.push({sample.time_ns, sample.value, sample.at_limit}, {}, [](const auto&) {});
      }
    const auto& [samples, lost, gaps, disorder] = clock.counters();
    const double rate_Hz =
        1e9 * static_cast<double>(samples + lost - 1) / static_cast<double>(last_ns - first_ns);
    if (const auto wrong = session::wrong_rate(config.device, rate_Hz, converter.rate_Hz))
      return {name, Status::failed, *wrong, mend};
    return {name, lost + disorder == 0 ? Status::ok : Status::failed,
            phrase("doctor.samples", {plain(converter.uri), plain(fmt::format("{:.1f}", rate_Hz)),
                                      plain(fmt::format("{}", fmt::join(converter.channels, ", "))),
                                      number(lost), number(disorder)}),
            lost + disorder == 0 ? Phrase() : mend};
  } catch (const std::exception& error) {
    return {name, Status::failed, io::reported(error), mend};
  }
}

io::Finding force_cells(const rig::Rig& rig) {
  const auto name = phrase("operator.measured_forces");
  if (rig.capture->forces) return {name, Status::ok, phrase("doctor.forces_good"), {}};
  return {name, Status::warning, phrase("doctor.forces_missing"), phrase("doctor.forces_mend")};
}

// Warns if the touch panel is simulated although the converter is real. A new rig file has a simulated panel,
// and people forget to replace it.
io::Finding touch(const rig::Rig& rig) {
  auto check = io::check_touch(phrase("doctor.touch"), *rig.touch_uri);
  if (check.status == Status::ok && *rig.touch_uri == "sim:" && rig.output.uri.starts_with("alsa:"))
    return {check.name, Status::warning, phrase("doctor.touch_simulated"),
            phrase("doctor.touch_simulated_mend")};
  return check;
}

void rights(std::vector<io::Finding>& checks) {
  rlimit priority{}, memory{};
  ::getrlimit(RLIMIT_RTPRIO, &priority);
  ::getrlimit(RLIMIT_MEMLOCK, &memory);
  const bool root = ::geteuid() == 0;
  const bool fifo = root || priority.rlim_cur >= 75;
  checks.push_back(
      {phrase("doctor.priority"), fifo ? Status::ok : Status::failed,
       root ? phrase("doctor.root") : phrase("doctor.priority_limit", {number(priority.rlim_cur)}),
       fifo ? Phrase() : phrase("doctor.priority_mend")});
  const bool locked = root || memory.rlim_cur == RLIM_INFINITY || memory.rlim_cur >= (256u << 20);
  checks.push_back({phrase("doctor.memory"), locked ? Status::ok : Status::failed,
                    memory.rlim_cur == RLIM_INFINITY || root
                        ? phrase("doctor.unlimited")
                        : plain(fmt::format("{} KiB", memory.rlim_cur >> 10)),
                    locked ? Phrase() : phrase("doctor.memory_mend")});
}

void display(std::vector<io::Finding>& checks) {
  std::error_code ignored;
  const bool session = std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY");
  const bool direct = !session::screen_card().empty() || std::filesystem::exists("/dev/fb0", ignored);
  checks.push_back({phrase("doctor.display"), session || direct ? Status::ok : Status::warning,
                    phrase(session  ? "doctor.desktop"
                           : direct ? "doctor.screen"
                                    : "doctor.no_display"),
                    session || direct ? Phrase() : phrase("doctor.no_display_mend")});
}

// On a desktop, the display server reads the input devices. Without a desktop, the program must be able to
// read them itself.
void input(std::vector<io::Finding>& checks) {
  if (std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY")) return;
  const auto devices = io::try_input_devices();
  const auto name = phrase("doctor.input");
  if (!devices.refused.empty())
    checks.push_back(
        {name, Status::failed,
         phrase("doctor.input_refused", {plain(fmt::format("{}", fmt::join(devices.refused, ", ")))}),
         phrase("doctor.input_refused_mend")});
  else if (devices.opened == 0)
    checks.push_back({name, Status::warning, phrase("doctor.input_none"), phrase("doctor.input_none_mend")});
  else
    checks.push_back({name, Status::ok, phrase("doctor.input_good", {number(devices.opened)}), {}});
}

// Converts a check of the self-test to a finding of the doctor. `mend` says what to do if the check failed.
io::Finding finding(const session::Check& check, const Phrase& mend) {
  if (check.verdict == core::Verdict::failed) return {check.name, Status::failed, check.what, mend};
  return {check.name, Status::ok, check.what, {}};
}

io::Finding disk(const std::string& path) {
  const auto state = system::read_disk(path);
  return finding(session::judged(state),
                 !state.error.empty() ? phrase("doctor.disk_mount_mend")
                 : state.writable     ? phrase("doctor.disk_space_mend", {number(session::kLeastDisk_MiB)})
                                      : phrase("doctor.disk_rights_mend"));
}

}  // namespace

io::Finding check_file_system(const std::string& file_system) {
  const auto is = [&](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* name) { return file_system == name; });
  };
  const auto name = phrase("doctor.file_system"), what = plain(file_system);
  if (is({"tmpfs", "ramfs", "overlay"})) return {name, Status::failed, what, phrase("doctor.volatile_mend")};
  if (is({"nfs", "cifs", "fuse", "9p", "ceph", "afs", "coda", "lustre", "gfs2", "ocfs2", "gpfs", "beegfs",
          "vboxsf"}))
    return {name, Status::warning, what, phrase("doctor.network_mend")};
  if (is({"vfat", "exfat", "ntfs", "hfsplus"}))
    return {name, Status::warning, what, phrase("doctor.fat_mend")};
  return {name, Status::ok, what, {}};
}

namespace {

io::Finding clock() {
  const session::ClockReading reading{system::read_wall_clock(), std::nullopt};
  auto found = finding(session::judged(reading), phrase("doctor.date_mend"));
  if (found.status == Status::ok && !reading.clock.steered) {
    found.status = Status::warning;
    found.mend = phrase("doctor.clock_free_mend");
  }
  return found;
}

io::Finding temperature() {
  return finding(session::judged_temperature(system::hottest_C()), phrase("doctor.temperature_mend"));
}

}  // namespace

io::Finding check_swap(const std::string& swaps) {
  const auto name = phrase("doctor.swap");
  std::ifstream file(swaps);
  if (!file)
    return {name, Status::warning, phrase("doctor.unreadable", {plain(swaps)}),
            phrase("doctor.swap_unread_mend")};
  std::string line, active;
  std::getline(file, line);  // skip the heading of the table
  while (std::getline(file, line))
    if (const auto area = line.substr(0, line.find_first_of(" \t")); !area.empty())
      active += (active.empty() ? "" : ", ") + area;
  if (active.empty()) return {name, Status::ok, phrase("doctor.swap_off"), {}};
  return {name, Status::failed, phrase("doctor.swap_on", {plain(active)}), phrase("doctor.swap_mend")};
}

io::Finding check_watchdog(const std::string& folder) {
  const auto name = phrase("doctor.watchdog");
  std::ifstream file(folder + "/watchdog0/state");
  std::string state;
  if (!(file >> state))
    return {name, Status::warning, phrase("doctor.watchdog_missing"), phrase("doctor.watchdog_missing_mend")};
  if (state == "active") return {name, Status::ok, phrase("doctor.watchdog_active"), {}};
  return {name, Status::warning, state == "inactive" ? phrase("doctor.watchdog_inactive") : plain(state),
          phrase("doctor.watchdog_mend")};
}

std::vector<io::Finding> examine(const rig::Rig& rig, const std::string& data_path) {
  std::vector<io::Finding> checks;
  converter(rig, checks);
  converter_mute(rig, checks);
  mixer(rig, checks);
  if (const auto plan = session::card_capture_of(rig)) {
    card_name(phrase("doctor.capture"), plan->device.uri, checks);
    checks.push_back(capture(*plan));
    checks.push_back(pick_ups(rig));
    if (rig.capture->converter) checks.push_back(force_converter(*rig.capture->converter));
    if (rig::has_force_cells(rig)) checks.push_back(force_cells(rig));
  }
  const auto lines = [&checks](const char* device, const std::string& uri) {
    for (auto& check : io::check_lines(phrase(device), uri)) checks.push_back(std::move(check));
  };
  lines("doctor.amplifier", rig.amplifier_uri);
  if (rig.buttons_uri) lines("doctor.buttons", *rig.buttons_uri);
  if (rig.contact_uri && rig.contact_uri->starts_with("evdev:"))
    checks.push_back(io::check_touch(phrase("doctor.contact"), *rig.contact_uri));
  else if (rig.contact_uri)
    lines("doctor.contact", *rig.contact_uri);
  if (rig.trigger_lines_uri) lines("doctor.trigger", *rig.trigger_lines_uri);
  if (rig.sync && !rig.sync->channel) lines("doctor.sync", rig.sync->uri);
  if (rig.touch_uri) checks.push_back(touch(rig));
  display(checks);
  input(checks);
  rights(checks);
  checks.push_back(check_swap());
  checks.push_back(check_watchdog());
  checks.push_back(temperature());
  checks.push_back(disk(data_path));
  if (const auto state = system::read_disk(data_path); state.error.empty())
    checks.push_back(check_file_system(state.file_system));
  checks.push_back(clock());
  return checks;
}

bool fit_for_use(const std::vector<io::Finding>& checks) {
  return std::none_of(checks.begin(), checks.end(),
                      [](const io::Finding& check) { return check.status == Status::failed; });
}

}  // namespace turnpoint::maintenance

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
#include <string_view>
#include <utility>

#include "station/drive/alsa_capture.hpp"
#include "station/drive/alsa_mixer.hpp"
#include "station/drive/engine.hpp"
#include "station/iio/converter.hpp"
#include "station/sensing/own_clock.hpp"
#include "station/session/cell_feed.hpp"
#include "station/session/self_test.hpp"
#include "station/session/stage.hpp"
#include "station/setup/places.hpp"
#include "station/system/clocks.hpp"
#include "station/system/condition.hpp"

namespace turnpoint::maintenance {
namespace {

using Status = lines::Finding::Status;

// Measures the rate of the device's own clock. Plays silence for two and a half seconds, or longer if the
// device's time stamps are coarse.
lines::Finding measured_clock(drive::Stream& stream) {
  for (int k = 0; k < 220; ++k) {
    system::sleep_until_ns(system::monotonic_ns() + 100'000'000);
    while (stream.poll()) {
    }
    if (const auto rate = stream.measured_rate()) {
      const bool good = std::abs(rate->deviation_ppm) <= drive::RateCheck::tolerance_ppm;
      return {"converter clock", good ? Status::ok : Status::failed,
              fmt::format("{:.2f} Hz, {:+.1f} ppm (standard error {:.1f} ppm)", rate->rate_Hz,
                          rate->deviation_ppm, rate->standard_error_ppm),
              good ? "" : "the device resamples, or its clock is wrong: try another cable, port or device"};
    }
  }
  return {"converter clock", Status::failed, "the device delivered no time stamps",
          "use another device or kernel driver"};
}

// Returns the card name for amixer: NAME in alsa:hw:CARD=NAME,DEV=0 or alsa:hw:NAME,0.
std::string card_of(std::string_view uri) {
  uri.remove_prefix(std::string_view("alsa:hw:").size());
  if (uri.starts_with("CARD=")) uri.remove_prefix(5);
  return std::string(uri.substr(0, uri.find(',')));
}

// A PCM512x mutes its analogue outputs after 1024 frames of zeros (5 ms at 192 kHz), and unmutes them at the
// next onset (TI, PCM512x data sheet, zero data detection). Between stimuli, a session plays nothing but
// zeros.
void converter_mute(const rig::Rig& rig, std::vector<lines::Finding>& checks) {
  const auto on = drive::card_switch(rig.output.uri, "Auto Mute Switch");
  if (!on) return;
  checks.push_back(
      {"converter mute", *on ? Status::failed : Status::ok,
       *on ? "Auto Mute is on: the converter mutes itself between stimuli, and each onset unmutes it"
           : "Auto Mute is off",
       *on ? fmt::format("run amixer -c {} sset 'Auto Mute' off, then sudo alsactl store",
                         card_of(rig.output.uri))
           : ""});
}

void converter(const rig::Rig& rig, std::vector<lines::Finding>& checks) {
  if (!rig.output.uri.starts_with("alsa:")) {
    checks.push_back({"converter", Status::ok, rig.output.uri + " (no converter)", ""});
    return;
  }
  try {
    const auto stream = drive::open_realtime(session::stream_of(rig));
    checks.push_back({"converter", Status::ok,
                      fmt::format("{} at {} Hz, {} bits, directly on the hardware, without conversion",
                                  rig.output.uri, rig.output.rate_Hz, rig.output.bits),
                      ""});
    checks.push_back(measured_clock(*stream));
    const auto underruns = stream->counters().underruns;
    checks.push_back(
        {"converter stream", underruns == 0 ? Status::ok : Status::failed,
         fmt::format("{} underruns", underruns),
         underruns == 0
             ? ""
             : "set a larger period_frames, grant real-time rights, or use a kernel with less latency"});
  } catch (const std::exception& error) {
    checks.push_back({"converter", Status::failed, error.what(),
                      "correct [output] in the rig file (aplay -l lists devices), plug the device in, or end "
                      "the program that uses it"});
  }
}

// Opens the capture device and captures for half a second.
lines::Finding capture(const session::CardCapture& plan) {
  const std::string mend =
      "correct [capture] in the rig file (arecord -l lists devices), plug the device in, or end the program "
      "that uses it";
  try {
    const auto opened = drive::open_capture(plan.device);
    for (int k = 0; k < 50; ++k) {
      system::sleep_until_ns(system::monotonic_ns() + 10'000'000);
      while (opened->take() != nullptr) {
      }
    }
    const auto counters = opened->counters();
    const auto lost = counters.overruns + counters.unknown_gaps;
    const bool good = counters.frames > 0 && lost == 0;
    return {"capture", good ? Status::ok : Status::failed,
            fmt::format("{}: {} channels at {} Hz without conversion, {} frames captured, {} gaps",
                        plan.device.uri, plan.device.channels, plan.device.rate_Hz, counters.frames, lost),
            good ? "" : mend};
  } catch (const std::exception& error) {
    return {"capture", Status::failed, error.what(), mend};
  }
}

lines::Finding pick_ups(const rig::Rig& rig) {
  const auto unproven = rig::unproven_transducers(rig);
  if (unproven.empty()) return {"pick-ups", Status::ok, "calibrated for all transducers", ""};
  return {"pick-ups", Status::warning,
          fmt::format("not calibrated for {}: these stimuli will be unproven", fmt::join(unproven, ", ")),
          "measure them with `turnpoint calibrate --pickup` (deploy/rigs/README.md, Pick-ups)"};
}

// Reads the converter of the force cells for half a second.
lines::Finding force_converter(const rig::CellConverter& converter) {
  const char* const name = "force converter";
  const std::string mend =
      "correct [force_cells] in the rig file, load the driver of the board, or give the station's user "
      "access "
      "(deploy/rigs/README.md, Force cells on a converter with a clock of its own)";
  try {
    const auto config = session::converter_of(converter);
    const auto opened = iio::open(config);
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
    const auto found =
        fmt::format("{}: {:.1f} samples a second on {}, {} lost, {} time stamps out of order", converter.uri,
                    rate_Hz, fmt::join(converter.channels, ", "), lost, disorder);
    if (const auto wrong = session::wrong_rate(config.device, rate_Hz, converter.rate_Hz); !wrong.empty())
      return {name, Status::failed, wrong, mend};
    return {name, lost + disorder == 0 ? Status::ok : Status::failed, found,
            lost + disorder == 0 ? "" : mend};
  } catch (const std::exception& error) {
    return {name, Status::failed, error.what(), mend};
  }
}

lines::Finding force_cells(const rig::Rig& rig) {
  if (rig.capture->forces) return {"force cells", Status::ok, "calibrated", ""};
  return {"force cells", Status::warning, "not calibrated: sessions measure no forces",
          "calibrate them with `turnpoint calibrate --forces` (deploy/rigs/README.md, Force cells)"};
}

// Warns if the touch panel is simulated although the converter is real. A new rig file has a simulated panel,
// and people forget to replace it.
lines::Finding touch(const rig::Rig& rig) {
  auto check = lines::check_touch("touch", *rig.touch_uri);
  if (check.status == Status::ok && *rig.touch_uri == "sim:" && rig.output.uri.starts_with("alsa:"))
    return {"touch", Status::warning, "the touch panel is simulated, so touches have no kernel time stamps",
            "write uri = \"evdev:NAME\" in [touch], with the panel's name in /proc/bus/input/devices"};
  return check;
}

void rights(std::vector<lines::Finding>& checks) {
  rlimit priority{}, memory{};
  ::getrlimit(RLIMIT_RTPRIO, &priority);
  ::getrlimit(RLIMIT_MEMLOCK, &memory);
  const bool root = ::geteuid() == 0;
  const bool fifo = root || priority.rlim_cur >= 75;
  checks.push_back(
      {"real-time priority", fifo ? Status::ok : Status::failed,
       root ? "granted to root" : fmt::format("only up to {} (75 is needed)", priority.rlim_cur),
       fifo ? "" : "set LimitRTPRIO=80 in the service, or \"@audio - rtprio 80\" in /etc/security/limits.d"});
  const bool locked = root || memory.rlim_cur == RLIM_INFINITY || memory.rlim_cur >= (256u << 20);
  checks.push_back(
      {"locked memory", locked ? Status::ok : Status::failed,
       memory.rlim_cur == RLIM_INFINITY || root ? "unlimited" : fmt::format("{} KiB", memory.rlim_cur >> 10),
       locked ? ""
              : "set LimitMEMLOCK=infinity in the service, or \"@audio - memlock unlimited\" in limits.d"});
}

void display(std::vector<lines::Finding>& checks) {
  std::error_code ignored;
  const bool session = std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY");
  const bool direct = !setup::screen_card().empty() || std::filesystem::exists("/dev/fb0", ignored);
  checks.push_back({"display", session || direct ? Status::ok : Status::warning,
                    session  ? "a desktop session"
                    : direct ? "a screen, without a desktop session"
                             : "no display",
                    session || direct
                        ? ""
                        : "connect a screen, or run sessions with --buttons-only or a simulated observer"});
}

// On a desktop, the display server reads the input devices. Without a desktop, the program must be able to
// read them itself.
void input(std::vector<lines::Finding>& checks) {
  if (std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY")) return;
  const auto devices = lines::try_input_devices();
  if (!devices.refused.empty())
    checks.push_back(
        {"input devices", Status::failed,
         fmt::format("cannot be opened for reading and writing: {}", fmt::join(devices.refused, ", ")),
         "the screen receives no touches from these devices: put the user into the group input; in a service "
         "that limits devices, add DeviceAllow=char-input rw"});
  else if (devices.opened == 0)
    checks.push_back(
        {"input devices", Status::warning, "none", "connect a touch panel if participants answer by touch"});
  else
    checks.push_back({"input devices", Status::ok,
                      fmt::format("{} devices can be opened for reading and writing, as the screen requires",
                                  devices.opened),
                      ""});
}

// Converts a check of the self-test to a finding of the doctor. `mend` says what to do if the check failed.
lines::Finding finding(const records::CheckRow& check, const std::string& mend) {
  if (check.verdict == records::Verdict::failed) return {check.name, Status::failed, check.what, mend};
  return {check.name, Status::ok, check.what, ""};
}

lines::Finding disk(const std::string& path) {
  const auto state = system::read_disk(path);
  return finding(session::judged(state),
                 !state.error.empty() ? "mount the data disk"
                 : state.writable
                     ? fmt::format("free some space: a session needs {} MiB", session::kLeastDisk_MiB)
                     : "give the user permission to write to this folder");
}

lines::Finding clock() {
  const session::ClockReading reading{system::read_wall_clock(), std::nullopt};
  auto found = finding(session::judged(reading),
                       "set the date; a board without a battery-backed clock needs a time service");
  if (found.status == Status::ok && !reading.clock.steered) {
    found.status = Status::warning;
    found.mend =
        "dates of records may be wrong (durations are not affected): run systemd-timesyncd or chrony";
  }
  return found;
}

lines::Finding temperature() {
  return finding(session::judged_temperature(system::hottest_C()),
                 "cool the machine: free its vents, add a fan");
}

}  // namespace

lines::Finding check_swap(const std::string& swaps) {
  std::ifstream file(swaps);
  if (!file) return {"swap", Status::warning, swaps + " cannot be read", "check with: swapon --show"};
  std::string line, active;
  std::getline(file, line);  // skip the heading of the table
  while (std::getline(file, line))
    if (const auto name = line.substr(0, line.find_first_of(" \t")); !name.empty())
      active += (active.empty() ? "" : ", ") + name;
  if (active.empty()) return {"swap", Status::ok, "off", ""};
  return {
      "swap", Status::failed, "on: " + active,
      "Raspberry Pi OS 12: sudo systemctl disable --now dphys-swapfile; 13: Mechanism=none below [Main] in "
      "/etc/rpi/swap.conf; elsewhere: sudo swapoff -a, and take swap out of /etc/fstab; then restart"};
}

lines::Finding check_watchdog(const std::string& folder) {
  const char* const mend =
      "sudo install -D -m 644 /usr/share/turnpoint/system/watchdog.conf "
      "/etc/systemd/system.conf.d/turnpoint-watchdog.conf, then restart";
  std::ifstream file(folder + "/watchdog0/state");
  std::string state;
  if (!(file >> state))
    return {"hardware watchdog", Status::warning, "the kernel has no hardware watchdog",
            "on a Raspberry Pi, set dtparam=watchdog=on in config.txt; a PC may have no watchdog"};
  if (state != "active") return {"hardware watchdog", Status::warning, state, mend};
  return {"hardware watchdog", Status::ok, state, ""};
}

std::vector<lines::Finding> examine(const rig::Rig& rig, const std::string& data_path) {
  std::vector<lines::Finding> checks;
  converter(rig, checks);
  converter_mute(rig, checks);
  if (const auto plan = session::card_capture_of(rig)) {
    checks.push_back(capture(*plan));
    checks.push_back(pick_ups(rig));
    if (rig.capture->converter) checks.push_back(force_converter(*rig.capture->converter));
    if (rig::has_force_cells(rig)) checks.push_back(force_cells(rig));
  }
  const auto lines = [&checks](const char* device, const std::string& uri) {
    for (auto& check : lines::check_lines(device, uri)) checks.push_back(std::move(check));
  };
  lines("amplifier", rig.amplifier_uri);
  if (rig.buttons_uri) lines("buttons", *rig.buttons_uri);
  if (rig.contact_uri && rig.contact_uri->starts_with("evdev:"))
    checks.push_back(lines::check_touch("contact", *rig.contact_uri));
  else if (rig.contact_uri)
    lines("contact", *rig.contact_uri);
  if (rig.trigger_lines_uri) lines("trigger", *rig.trigger_lines_uri);
  if (rig.sync && !rig.sync->channel) lines("sync", rig.sync->uri);
  if (rig.touch_uri) checks.push_back(touch(rig));
  display(checks);
  input(checks);
  rights(checks);
  checks.push_back(check_swap());
  checks.push_back(check_watchdog());
  checks.push_back(temperature());
  checks.push_back(disk(data_path));
  checks.push_back(clock());
  return checks;
}

bool fit_for_use(const std::vector<lines::Finding>& checks) {
  return std::none_of(checks.begin(), checks.end(),
                      [](const lines::Finding& check) { return check.status == Status::failed; });
}

}  // namespace turnpoint::maintenance

#include "station/session/self_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <utility>

namespace turnpoint::session {
namespace {

CheckRow not_possible(std::string name, std::string why) {
  return {std::move(name), Verdict::not_possible, {}, {}, "", std::move(why)};
}

Verdict verdict(bool good) { return good ? Verdict::passed : Verdict::failed; }

/// Runs one part of the self-test. If the part throws, adds a failed check with its message.
void run(const std::string& name, std::vector<CheckRow>& checks, const std::function<void()>& part) {
  try {
    part();
  } catch (const std::exception& error) {
    checks.push_back({name, Verdict::failed, {}, {}, "", error.what()});
  }
}

}  // namespace

CheckRow judged(const GateReading& reading) {
  if (!reading.missing.empty()) return not_possible("gate", reading.missing);
  CheckRow check{"gate", Verdict::failed, {}, 1e3 * kGateLimit_s, "ms", ""};
  if (!reading.opened) {
    check.what = "the gate stays shut although the amplifier was enabled and the heartbeat runs";
  } else if (!reading.dropped_s) {
    check.what =
        "the gate stays open although the heartbeat has stopped: nothing would switch the amplifier off "
        "if the station hung; look at the monostable and its wiring";
  } else {
    check.value = 1e3 * *reading.dropped_s;
    check.verdict = verdict(*reading.dropped_s <= kGateLimit_s);
    check.what = fmt::format("the gate shut {:.0f} ms after the heartbeat stopped", *check.value);
  }
  return check;
}

CheckRow judged(const PressReading& reading) {
  const bool stop = reading.button.empty();
  const std::string name = stop ? "stop" : "button " + reading.button;
  if (!reading.missing.empty()) return not_possible(name, reading.missing);
  if (!reading.pressed)
    return {
        name, Verdict::failed, {}, {}, "", "no press arrived: look at the button, its wire and the rig file"};
  if (!reading.released)
    return {name, Verdict::failed, {}, {}, "", "the press arrived, but not the release: the button is stuck"};
  return {
      name, Verdict::passed,
      {},   {},
      "",   stop ? "the press switched the amplifier off, and the release was seen" : "the press arrived"};
}

CheckRow judged(const ToneReading& reading) {
  const auto name = reading.transducer.empty() ? "tone" : "tone " + reading.transducer;
  if (!reading.missing.empty()) return not_possible(name, reading.missing);
  if (reading.proof == terms::Proof::unproven)
    return not_possible(name, "the pick-ups are not calibrated for this transducer");
  const bool good = reading.proof == terms::Proof::ok || reading.proof == terms::Proof::flagged;
  CheckRow check{name, verdict(good), reading.ratio_dB, kToneLimit_dB, "dB", ""};
  check.what =
      fmt::format("a quiet tone of {:.1f} kHz was measured at {:+.2f} dB relative to its calibration",
                  1e-3 * reading.frequency_Hz, reading.ratio_dB);
  if (reading.cause != terms::ProofCause::none) check.what += fmt::format(": {}", describe(reading.cause));
  return check;
}

std::vector<CheckRow> judged(const CellReading& reading) {
  if (!reading.missing.empty()) return {not_possible("cells", reading.missing)};
  const auto zero = "zero of cell " + reading.cell, noise = "noise of cell " + reading.cell;
  if (!reading.fault.empty()) return {{zero, Verdict::failed, {}, kZeroLimit_N, "N", reading.fault}};
  const bool near = std::abs(reading.zero_N) <= kZeroLimit_N, quiet = reading.noise_mN <= kNoiseLimit_mN;
  return {{zero, verdict(near), reading.zero_N, kZeroLimit_N, "N",
           near ? fmt::format("the cell reads {:+.3f} N without a load", reading.zero_N)
                : fmt::format("the cell reads {:+.3f} N: something lies on the surface, or the cell is "
                              "overloaded or bent",
                              reading.zero_N)},
          {noise, verdict(quiet), reading.noise_mN, kNoiseLimit_mN, "mN",
           quiet ? fmt::format("standard deviation {:.2f} mN", reading.noise_mN)
                 : fmt::format("standard deviation {:.2f} mN: somebody touched the surface, or a wire or a "
                               "shield is loose",
                               reading.noise_mN)}};
}

CheckRow judged_temperature(std::optional<double> hottest_C) {
  if (!hottest_C) return not_possible("temperature", "the machine has no temperature sensor");
  const bool good = *hottest_C < kHottest_C;
  return {"temperature",
          verdict(good),
          *hottest_C,
          kHottest_C,
          "degC",
          fmt::format("the hottest sensor of the machine reads {:.0f} degrees Celsius{}", *hottest_C,
                      good ? "" : ": cool the machine, or it will slow down during the session")};
}

CheckRow judged(const ClockReading& reading) {
  const auto& clock = reading.clock;
  CheckRow check{"clock", Verdict::passed, {}, {}, "", ""};
  check.what =
      fmt::format("source {}, {}", clock.source, clock.steered ? "synchronised" : "not synchronised");
  if (!clock.plausible) {
    check.verdict = Verdict::failed;
    check.what += ", the date cannot be right";
  }
  if (reading.jump_s) {
    check.verdict = Verdict::failed;
    check.value = *reading.jump_s;
    check.unit = "s";
    check.what += fmt::format(", and the clock was set by {:+.3f} s during the self-test", *reading.jump_s);
  }
  return check;
}

CheckRow judged(const system::Disk& disk) {
  CheckRow check{"disk", Verdict::failed, {}, kLeastDisk_MiB, "MiB", ""};
  if (!disk.error.empty()) {
    check.what = disk.folder + ": " + disk.error;
    return check;
  }
  check.value = disk.free_MiB;
  check.verdict = verdict(disk.free_MiB >= kLeastDisk_MiB && disk.writable);
  check.what = fmt::format("{:.0f} MiB free in {}{}", disk.free_MiB, disk.folder,
                           disk.writable ? "" : ", not writable");
  return check;
}

std::vector<CheckRow> self_test(SelfTestRig& rig) {
  std::vector<CheckRow> checks;
  const auto add = [&checks](const auto& reading) { checks.push_back(judged(reading)); };
  run("gate", checks, [&] { add(rig.drop_heartbeat()); });
  run("stop", checks, [&] { add(rig.press_stop()); });
  run("buttons", checks, [&] {
    for (const auto& reading : rig.press_buttons()) add(reading);
  });
  run("tone", checks, [&] {
    for (const auto& reading : rig.play_tones()) add(reading);
  });
  run("cells", checks, [&] {
    for (const auto& reading : rig.read_cells())
      for (auto& check : judged(reading)) checks.push_back(std::move(check));
  });
  run("temperature", checks, [&] { checks.push_back(judged_temperature(rig.hottest_C())); });
  run("clock", checks, [&] { add(rig.clock()); });
  run("disk", checks, [&] { add(rig.disk()); });
  return checks;
}

bool passed(const std::vector<CheckRow>& checks) {
  return std::none_of(checks.begin(), checks.end(),
                      [](const CheckRow& check) { return check.verdict == Verdict::failed; });
}

}  // namespace turnpoint::session

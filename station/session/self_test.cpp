#include "station/session/self_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <utility>

#include "station/audio/alsa_device.hpp"
#include "station/io/probe.hpp"

namespace turnpoint::session {
namespace {

using core::Phrase, core::phrase, core::plain;

/// Rounds to this number of decimals; a value that becomes 0 has no minus sign.
double rounded(double value, int decimals) {
  const double scale = std::pow(10, decimals);
  return std::round(scale * value) / scale + 0.0;
}

Check not_possible(Phrase name, Phrase why) {
  return {std::move(name), Verdict::not_possible, {}, {}, "", std::move(why)};
}

Verdict verdict(bool good) { return good ? Verdict::passed : Verdict::failed; }

bool is_good(core::Proof proof) { return proof == core::Proof::ok || proof == core::Proof::flagged; }

Phrase decibels(double value_dB) { return plain(fmt::format("{:.2f}", value_dB)); }

/// Runs one part of the self-test. If the part throws, adds a failed check with its message.
void run(const Phrase& name, std::vector<Check>& checks, const std::function<void()>& part) {
  try {
    part();
  } catch (const PartFailed& failed) {
    checks.push_back({name, Verdict::failed, {}, {}, "", failed.why()});
  } catch (const std::exception& error) {
    checks.push_back({name, Verdict::failed, {}, {}, "", io::reported(error)});
  }
}

}  // namespace

CheckRow row_of(const Check& check) {
  return {core::say(check.name, "en"), check.verdict, check.value, check.limit, check.unit,
          core::say(check.what, "en")};
}

PartFailed::PartFailed(Phrase why) : std::runtime_error(core::say(why, "en")), why_(std::move(why)) {}

Check judged(const GateReading& reading) {
  Check check{phrase("self_test.gate"), Verdict::failed, {}, 1e3 * kGateLimit_s, "ms", {}};
  if (reading.missing) return not_possible(check.name, *reading.missing);
  if (!reading.opened) {
    check.what = phrase("self_test.gate_shut");
  } else if (!reading.dropped_s) {
    check.what = phrase("self_test.gate_open");
  } else {
    check.value = 1e3 * *reading.dropped_s;
    check.verdict = verdict(*reading.dropped_s <= kGateLimit_s);
    check.what = phrase("self_test.gate_dropped", {plain(fmt::format("{:.0f}", *check.value))});
  }
  return check;
}

Check judged(const PressReading& reading) {
  const bool stop = reading.button.empty();
  const auto name = stop ? phrase("self_test.stop") : phrase("self_test.button", {plain(reading.button)});
  if (reading.missing) return not_possible(name, *reading.missing);
  const auto check = [&name](bool good, const char* what) {
    return Check{name, verdict(good), {}, {}, "", phrase(what)};
  };
  if (!reading.pressed) return check(false, "self_test.not_pressed");
  if (!reading.released) return check(false, "self_test.not_released");
  return check(true, stop ? "self_test.stop_good" : "self_test.button_good");
}

Check judged(const ToneReading& reading) {
  const auto name = reading.transducer.empty() ? phrase("self_test.tone")
                                               : phrase("self_test.tone_of", {plain(reading.transducer)});
  if (reading.missing) return not_possible(name, *reading.missing);
  if (reading.proof == core::Proof::unproven) return not_possible(name, phrase("self_test.tone_unproven"));
  const bool good = is_good(reading.proof);
  auto what =
      phrase("self_test.tone_measured", {plain(fmt::format("{:.1f}", 1e-3 * reading.frequency_Hz)),
                                         plain(fmt::format("{:+.2f}", rounded(reading.ratio_dB, 2)))});
  if (reading.cause != core::ProofCause::none)
    what = {"", "", {what, plain(": "), core::phrase_of(reading.cause)}};
  return {name, verdict(good), reading.ratio_dB, kToneLimit_dB, "dB", what};
}

std::optional<Check> judged_linearity(const ToneReading& reading) {
  // without a vibration there are no levels to compare
  const bool vibrates = is_good(reading.proof) || reading.proof == core::Proof::refused;
  if (!reading.nonlinearity_dB || !vibrates) return std::nullopt;
  const double off_dB = *reading.nonlinearity_dB;
  const auto what = off_dB >= kLinearityLimit_dB  ? phrase("self_test.linearity_bad", {decibels(off_dB)})
                    : off_dB >= kLinearityFlag_dB ? phrase("self_test.linearity_flagged", {decibels(off_dB)})
                                                  : phrase("self_test.linearity_good", {decibels(off_dB)});
  return Check{phrase("self_test.linearity_of", {plain(reading.transducer)}),
               verdict(off_dB < kLinearityLimit_dB),
               off_dB,
               kLinearityLimit_dB,
               "dB",
               what};
}

std::vector<Check> judged(const CellReading& reading) {
  if (reading.missing) return {not_possible(phrase("self_test.cells"), *reading.missing)};
  const auto zero = phrase("self_test.zero_of", {reading.cell}),
             noise = phrase("self_test.noise_of", {reading.cell});
  if (reading.fault) return {{zero, Verdict::failed, {}, kZeroLimit_N, "N", *reading.fault}};
  const bool near = std::abs(reading.zero_N) <= kZeroLimit_N, quiet = reading.noise_mN <= kNoiseLimit_mN;
  return {{zero, verdict(near), reading.zero_N, kZeroLimit_N, "N",
           phrase(near ? "self_test.zero_good" : "self_test.zero_bad",
                  {plain(fmt::format("{:+.3f}", rounded(reading.zero_N, 3)))})},
          {noise, verdict(quiet), reading.noise_mN, kNoiseLimit_mN, "mN",
           phrase(quiet ? "self_test.noise_good" : "self_test.noise_bad",
                  {plain(fmt::format("{:.2f}", reading.noise_mN))})}};
}

std::map<std::string, std::string> mixer_levels(const rig::Rig& rig) {
  auto levels = audio::mixer_levels(rig.output.uri).value_or(std::map<std::string, std::string>{});
  if (!rig.capture || audio::card_of(rig.capture->uri) == audio::card_of(rig.output.uri)) return levels;
  if (const auto captured = audio::mixer_levels(rig.capture->uri))
    for (const auto& [control, values] : *captured) levels["capture: " + control] = values;
  return levels;
}

MixerReading read_mixer(const rig::Rig& rig) {
  MixerReading reading{rig.mixer.size(), {}};
  if (rig.mixer.empty()) return reading;
  const auto now = mixer_levels(rig);
  for (const auto& [control, values] : rig.mixer) {
    const auto found = now.find(control);
    if (found == now.end())
      reading.changes.push_back(phrase("self_test.mixer_gone", {plain(control), plain(values)}));
    else if (found->second != values)
      reading.changes.push_back(
          phrase("self_test.mixer_changed", {plain(control), plain(found->second), plain(values)}));
  }
  return reading;
}

Check judged(const MixerReading& reading) {
  const auto name = phrase("self_test.mixer");
  if (reading.controls == 0) return not_possible(name, phrase("self_test.mixer_missing"));
  Check check{name, verdict(reading.changes.empty()), {}, {}, "", {}};
  if (reading.changes.empty())
    check.what = phrase("self_test.mixer_good", {plain(reading.controls)});
  else
    check.what.values = reading.changes;
  return check;
}

Check judged_temperature(std::optional<double> hottest_C) {
  const auto name = phrase("self_test.temperature");
  if (!hottest_C) return not_possible(name, phrase("self_test.temperature_missing"));
  const bool good = *hottest_C < kHottest_C;
  return {name,
          verdict(good),
          *hottest_C,
          kHottest_C,
          "degC",
          phrase(good ? "self_test.temperature_good" : "self_test.temperature_bad",
                 {plain(fmt::format("{:.0f}", *hottest_C))})};
}

Check judged(const ClockReading& reading) {
  const auto& clock = reading.clock;
  Check check{phrase("self_test.clock"), Verdict::passed, {}, {}, "", {}};
  check.what.values.push_back(
      phrase(clock.steered ? "self_test.clock_steered" : "self_test.clock_free", {plain(clock.source)}));
  if (!clock.plausible) {
    check.verdict = Verdict::failed;
    check.what.values.push_back(phrase("self_test.clock_date"));
  }
  if (reading.jump_s) {
    check.verdict = Verdict::failed;
    check.value = *reading.jump_s;
    check.unit = "s";
    check.what.values.push_back(
        phrase("self_test.clock_set", {plain(fmt::format("{:+.3f}", *reading.jump_s))}));
  }
  return check;
}

Check judged(const system::Disk& disk) {
  Check check{phrase("self_test.disk"), Verdict::failed, {}, kLeastDisk_MiB, "MiB", {}};
  if (!disk.error.empty()) {
    check.what = phrase("self_test.disk_error", {plain(disk.folder), plain(disk.error)});
    return check;
  }
  check.value = disk.free_MiB;
  check.verdict = verdict(disk.free_MiB >= kLeastDisk_MiB && disk.writable);
  check.what = phrase(disk.writable ? "self_test.disk_free" : "self_test.disk_protected",
                      {plain(fmt::format("{:.0f}", disk.free_MiB)), plain(disk.folder)});
  return check;
}

std::vector<Check> self_test(SelfTestRig& rig) {
  std::vector<Check> checks;
  const auto add = [&checks](const auto& reading) { checks.push_back(judged(reading)); };
  run(phrase("self_test.gate"), checks, [&] { add(rig.drop_heartbeat()); });
  run(phrase("self_test.stop"), checks, [&] { add(rig.press_stop()); });
  run(phrase("doctor.buttons"), checks, [&] {
    for (const auto& reading : rig.press_buttons()) add(reading);
  });
  run(phrase("self_test.tone"), checks, [&] {
    for (const auto& reading : rig.play_tones()) {
      add(reading);
      if (auto linearity = judged_linearity(reading)) checks.push_back(std::move(*linearity));
    }
  });
  run(phrase("self_test.cells"), checks, [&] {
    for (const auto& reading : rig.read_cells())
      for (auto& check : judged(reading)) checks.push_back(std::move(check));
  });
  run(phrase("self_test.mixer"), checks, [&] { add(rig.mixer()); });
  run(phrase("self_test.temperature"), checks,
      [&] { checks.push_back(judged_temperature(rig.hottest_C())); });
  run(phrase("self_test.clock"), checks, [&] { add(rig.clock()); });
  run(phrase("self_test.disk"), checks, [&] { add(rig.disk()); });
  return checks;
}

bool passed(const std::vector<Check>& checks) {
  return std::none_of(checks.begin(), checks.end(),
                      [](const Check& check) { return check.verdict == Verdict::failed; });
}

}  // namespace turnpoint::session

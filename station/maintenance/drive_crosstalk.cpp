#include "station/maintenance/drive_crosstalk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "station/core/limits.hpp"
#include "station/core/usage_error.hpp"
#include "station/maintenance/captured_sweep.hpp"
#include "station/maintenance/force_weights.hpp"
#include "station/session/self_test.hpp"
#include "station/session/stage.hpp"
#include "station/session/vibration_watch.hpp"

namespace turnpoint::maintenance {

namespace {

using core::phrase, core::plain;

// The drive is off, on, off, on and off again, for kDriveState_s each. The plate settles for kDriveSettle_s
// after each change. The pilot before needs the first two seconds.
constexpr double kDriveState_s = 1.5, kDriveSettle_s = 0.4, kDriveRamp_s = 0.05, kDriveFirst_s = 2;
constexpr std::size_t kDriveStates = 5;
constexpr double kDriveShare = 0.5, kMostDrive = 0.9;

void require_cells(const rig::Rig& rig) {
  if (!rig::has_force_cells(rig) || rig.capture->converter)
    throw core::UsageError(
        "doctor: --weight needs force cells that the rig's sound card captures (bridges in "
        "its [capture])");
  if (!rig.capture->forces)
    throw core::UsageError(
        "doctor: --weight needs calibrated force cells; calibrate them with `turnpoint calibrate --forces`");
}

audio::Tone drive_tone(const rig::Rig& rig, const rig::Transducer& transducer) {
  const double low_Hz = std::clamp(core::kAudible_Hz, transducer.low_Hz, transducer.high_Hz);
  double m_per_full_scale = transducer.m_per_full_scale.value_or(0);
  for (const auto& point : transducer.response)
    m_per_full_scale = std::max(m_per_full_scale, point.m_per_full_scale);
  const double amplitude =
      m_per_full_scale > 0 ? kDriveShare * rig.limits.displacement_m / m_per_full_scale : kMostDrive;
  return {0.5 * (low_Hz + transducer.high_Hz), std::min(amplitude, kMostDrive), 0, transducer.channel};
}

/// The carrier of the bridges, and a tone that is switched on and off.
audio::Burst toggled_drive(const rig::Rig& rig, const audio::Tone& tone) {
  const auto frames = [&](double s) { return std::llround(s * rig.output.rate_Hz); };
  audio::Burst burst;
  burst.start_frame = frames(kDriveFirst_s);
  burst.length_frames = frames(kDriveStates * kDriveState_s);
  burst.ramp.frames = frames(kDriveRamp_s);
  burst.tones.count = 1;
  burst.tones.tones[0] = {core::kForceCarrier_Hz, session::kCarrier, 0, *rig.capture->excitation_channel};
  auto both = burst.tones;
  both.count = 2;
  both.tones[1] = tone;
  for (std::size_t k = 1; k < kDriveStates; ++k)
    burst.changes[k - 1] = {frames(static_cast<double>(k) * kDriveState_s), burst.ramp.frames,
                            k % 2 == 1 ? both : burst.tones};
  burst.change_count = kDriveStates - 1;
  return burst;
}

/// All captured channels, interleaved as the sound card captures them.
std::vector<std::int32_t> interleaved(const Captured& captured) {
  std::vector<std::int32_t> samples;
  for (std::size_t k = 0; k < captured.channels.front().size(); ++k)
    for (const auto& channel : captured.channels)
      samples.push_back(
          static_cast<std::int32_t>(std::lrint(std::clamp(channel[k], -1.0, 1.0) * 0x1.fffffep30)));
  return samples;
}

/// Mean force in one state of the drive, and the standard deviation of the normal force.
struct DriveState {
  sensing::Force sum;
  double squares = 0, points = 0;

  void add(const sensing::Force& force) {
    sum.normal_N += force.normal_N, sum.lateral_N += force.lateral_N;
    squares += force.normal_N * force.normal_N;
    ++points;
  }
  double normal_N() const { return sum.normal_N / points; }
  double lateral_N() const { return sum.lateral_N / points; }
  double sd_N() const { return std::sqrt(std::max(0.0, squares / points - normal_N() * normal_N())); }
};

std::array<DriveState, kDriveStates> drive_states(const rig::Rig& rig, const Captured& captured,
                                                  const audio::Burst& burst) {
  const auto finger = session::calibrated_finger(rig).value();
  sensing::BridgeDemodulator demodulator(finger.bridges);
  std::array<DriveState, kDriveStates> states;
  const auto samples = interleaved(captured);
  const double rate_Hz = rig.output.rate_Hz;
  demodulator.push(
      {samples, finger.bridges.channels, captured.first_frame, finger.bridges.rate_Hz},
      [&](const auto& point) {
        const double at_s =
            static_cast<double>(point.index * demodulator.frames_per_point() - burst.start_frame) / rate_Hz;
        if (at_s < 0 || at_s >= kDriveStates * kDriveState_s) return;
        const double since_s = std::fmod(at_s, kDriveState_s);
        if (since_s < kDriveSettle_s || since_s > kDriveState_s - kDriveRamp_s) return;
        if (point.fault != sensing::WireFault::none)
          throw std::runtime_error("force cells: a wire of the bridges or of the reference is off");
        states[static_cast<std::size_t>(at_s / kDriveState_s)].add(finger.calibration.force(point.ratio));
      });
  for (const auto& state : states)
    if (!(state.points > 0)) throw std::runtime_error("force cells: nothing was captured");
  return states;
}

}  // namespace

std::vector<DriveCrosstalk> measure_drive_crosstalk(
    const rig::Rig& rig, const std::function<void(simulation::Setup&)>& laboratory) {
  require_cells(rig);
  std::vector<DriveCrosstalk> readings;
  for (const auto& transducer : rig.transducers) {
    const auto tone = drive_tone(rig, transducer);
    const auto burst = toggled_drive(rig, tone);
    const simulation::Load weight{1e-3 * kRestingMass_g * kGravity_m_s2, 0, 0.5 * rig.surface.length_m};
    const auto captured = session::simulates_capture(rig)
                              ? capture_simulated(rig, {burst}, laboratory, weight)
                              : capture_armed(rig, {burst});
    const auto states = drive_states(rig, captured, burst);
    // Each time with the drive is compared with the times before and after it, so that a slow drift cancels.
    const auto change_mN = [&](auto value) {
      double sum = 0;
      for (std::size_t on = 1; on < kDriveStates; on += 2)
        sum += value(states[on]) - (value(states[on - 1]) + value(states[on + 1])) / 2;
      return 1e3 * sum / 2;
    };
    readings.push_back({transducer.name, tone.frequency_Hz,
                        change_mN([](const DriveState& state) { return state.normal_N(); }),
                        change_mN([](const DriveState& state) { return state.lateral_N(); }),
                        1e3 * std::max({states[0].sd_N(), states[2].sd_N(), states[4].sd_N()})});
  }
  return readings;
}

io::Finding judged(const DriveCrosstalk& reading) {
  using Status = io::Finding::Status;
  const auto name = phrase("doctor.drive_force", {plain(reading.transducer)});
  if (reading.restless_mN > session::kNoiseLimit_mN)
    return {name, Status::failed,
            phrase("doctor.drive_restless", {plain(fmt::format("{:.1f}", reading.restless_mN))}),
            phrase("doctor.drive_restless_mend")};
  const double worst_mN = std::max(std::abs(reading.normal_mN), std::abs(reading.lateral_mN));
  const bool good = worst_mN <= kCrosstalkLimit_mN;
  return {name, good ? Status::ok : Status::failed,
          phrase("doctor.drive_changes", {plain(fmt::format("{:.1f}", 1e-3 * reading.frequency_Hz)),
                                          plain(fmt::format("{:+.2f}", reading.normal_mN + 0.0)),
                                          plain(fmt::format("{:+.2f}", reading.lateral_mN + 0.0)),
                                          plain(fmt::format("{:.0f}", kCrosstalkLimit_mN))}),
          good ? core::Phrase() : phrase("doctor.drive_changes_mend")};
}

}  // namespace turnpoint::maintenance

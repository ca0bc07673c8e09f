#include "station/session/simulated_room.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <utility>

#include "station/core/limits.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::session {

namespace {

// Positions of the simulated pick-ups: the first is 3 mm from the drive edge, and the others follow at
// intervals of 6 mm.
constexpr double kFirst_m = 3e-3, kNext_m = 6e-3;
// The simulated participant strokes the surface between these fractions of its length, at this mean speed,
// with this pause between strokes.
constexpr double kStrokeFrom = 0.25, kStrokeTo = 0.75, kStroke_m_s = 0.09, kPause_s = 0.05;
constexpr double kStep_Hz = 20;  // distance between two points of a pick-up's response
// The buffer turns the station's carrier into this peak voltage on the bridges. The reference input takes
// more, because the pilot is added to the carrier.
constexpr double kExcitation_V = 2.5, kReference_V = 4.0;
// windows in which the amplitudes of tones are found that the finger feels
constexpr double kShortWindow_s = 1e-3, kLongWindow_s = 10e-3;
constexpr double kHeight_m = 8e-3;  // height of the surface above the pivots of the force cells

/// Returns the ratio of bridge signal to reference signal for a force of 1 N on a cell.
double ratio_per_N(const simulation::Setup& room) {
  const auto& wires = room.wires;
  return room.cells.volt_per_volt_N * wires.gain * wires.reference_V_at_full_scale / wires.full_scale_V;
}

/// Returns the calibration that would be measured with exact weights.
sensing::ForceCalibration calibrated(const simulation::Setup& room) {
  std::vector<sensing::DeadWeight> weights;
  for (const double share : {0.2, 0.5, 0.8})
    for (const double pull_N : {-0.5, 0.0, 0.5}) {
      const double x_m = share * room.cells.span_m;
      const auto forces = simulation::forces_on(room.cells, {1, pull_N, x_m});
      auto& weight = weights.emplace_back(sensing::DeadWeight{1, pull_N, 1e3 * x_m, {}});
      for (std::size_t c = 0; c < forces.size(); ++c)
        for (std::size_t k = 0; k < forces.size(); ++k)
          weight.readings[c] += ratio_per_N(room) * room.cells.crosstalk[c][k] * forces[k];
    }
  return sensing::fit_weights(weights).calibration;
}

sensing::FingerSetup finger_of(const simulation::Setup& room) {
  sensing::FingerSetup finger;
  auto& bridges = finger.bridges;
  bridges.rate_Hz = room.rate_Hz;
  bridges.carrier_Hz = core::kForceCarrier_Hz;
  bridges.channels = room.capture.count;
  bridges.reference = *room.capture.reference;
  bridges.bridges = {*room.capture.bridge_a, *room.capture.bridge_b, *room.capture.lateral};
  bridges.reference_amplitude =
      kCarrier * room.wires.excitation_V_per_full_scale / room.wires.reference_V_at_full_scale;
  bridges.full_scale.fill(kRated_N * ratio_per_N(room));
  finger.calibration = calibrated(room);
  finger.length_mm = 1e3 * room.cells.span_m;
  return finger;
}

}  // namespace

simulation::Setup laboratory_of(const rig::Rig& rig) {
  if (!rig.capture) throw std::logic_error("simulated laboratory: the rig captures nothing");
  simulation::Setup room;
  room.rate_Hz = rig.output.rate_Hz;
  room.playback_channels = rig::channels(rig);
  // What the rig states of its converters and cells is true of the simulated ones.
  if (rig.output.converter_delay_s > 0)
    room.loop_delay_frames = rig.output.converter_delay_s * rig.output.rate_Hz;
  room.transducers.clear();
  room.band_low_Hz = 1e9, room.band_high_Hz = 0;
  for (const auto& t : rig.transducers) {
    room.transducers.push_back({t.channel, 1e6 * t.m_per_full_scale.value_or(4e-6)});
    room.band_low_Hz = std::min(room.band_low_Hz, t.low_Hz);
    room.band_high_Hz = std::max(room.band_high_Hz, t.high_Hz);
  }
  room.capture.count = rig.capture->channels;
  room.capture.marker = std::nullopt;
  room.wires.carrier_channel = rig.capture->excitation_channel;
  room.wires.excitation_V_per_full_scale = kExcitation_V / kCarrier;
  room.wires.reference_V_at_full_scale = kReference_V;
  if (const auto& bridges = rig.capture->bridges; !bridges.empty()) {
    room.capture.reference = rig.capture->reference;
    room.capture.bridge_a = bridges[0], room.capture.bridge_b = bridges[1], room.capture.lateral = bridges[2];
    room.cells.span_m = rig.surface.length_m;
    room.cells.height_m = kHeight_m;
    if (const auto resonance_Hz = rig.capture->cells_resonance_Hz) {
      room.cells.normal_Hz = room.cells.lateral_Hz = *resonance_Hz;
      room.cells.damping = rig.capture->cells_damping;
    }
    room.finger.from_m = kStrokeFrom * rig.surface.length_m;
    room.finger.to_m = kStrokeTo * rig.surface.length_m;
    room.finger.stroke_s = (room.finger.to_m - room.finger.from_m) / kStroke_m_s;
    room.finger.pause_s = kPause_s;
    room.finger.fingertip_m = rig.friction.fingertip_m;
    room.finger.impedance_Ns_per_m = std::polar(rig.finger.impedance_Ns_per_m, rig.finger.phase_rad);
    room.finger.contact_m = rig.finger.contact_m;
  } else {
    room.capture.reference = room.capture.bridge_a = room.capture.bridge_b = room.capture.lateral =
        std::nullopt;
  }
  if (rig.capture->marker_channel) {
    room.capture.marker = rig.capture->marker_channel;
    room.marker_channel = rig.marker.value().channel;
  }
  room.pickups.clear();
  for (const int pick_up : rig.capture->pick_ups)
    room.pickups.push_back({pick_up, kFirst_m + kNext_m * static_cast<double>(room.pickups.size())});
  room.surface = rig::surface_of(rig);
  room.friction = rig::friction_of(rig);
  return room;
}

SimulatedRoom::SimulatedRoom(const rig::Rig& rig, const std::function<void(simulation::Setup&)>& change)
    : rig_(rig.capture.value_or(rig::Capture{})), plant_([&] {
        auto room = laboratory_of(rig);
        if (change) change(room);
        impedance_Ns_per_m_ = std::exchange(room.finger.impedance_Ns_per_m, 0);
        return room;
      }()) {}

void SimulatedRoom::expect(std::span<const audio::PreparedBurst> bursts) {
  std::vector<double> frequencies;
  const auto add = [&](std::uint64_t increment) {
    frequencies.push_back(static_cast<double>(increment) * 0x1p-64 * plant_.setup().rate_Hz);
  };
  for (const auto& burst : bursts) {
    for (std::size_t t = 0; t < static_cast<std::size_t>(burst.tone_count); ++t)
      add(burst.tones[t].increment);
    for (std::size_t c = 0; c < static_cast<std::size_t>(burst.change_count); ++c)
      for (std::size_t t = 0; t < static_cast<std::size_t>(burst.changes[c].count); ++t)
        add(burst.changes[c].to[t].increment);
  }
  std::sort(frequencies.begin(), frequencies.end());
  frequencies.erase(std::unique(frequencies.begin(), frequencies.end()), frequencies.end());
  // The finger feels a gain that follows it as soon as the distance of the tones allows to tell them apart.
  const bool follows =
      std::any_of(bursts.begin(), bursts.end(), [](const auto& burst) { return burst.following.follows(); });
  double window_s = follows ? kShortWindow_s : kLongWindow_s;
  for (const auto& burst : bursts)
    for (int a = 0; a < burst.tone_count; ++a)
      for (int b = 0; b < a; ++b) {
        const auto apart = static_cast<double>(static_cast<std::int64_t>(
                               burst.tones[static_cast<std::size_t>(a)].increment -
                               burst.tones[static_cast<std::size_t>(b)].increment)) *
                           0x1p-64 * plant_.setup().rate_Hz;
        if (apart != 0) window_s = std::max(window_s, std::min(kLongWindow_s, 10 / std::abs(apart)));
      }
  plant_.set_impedance(follows ? impedance_Ns_per_m_ : 0);
  plant_.set_tones(frequencies, window_s);
}

void SimulatedRoom::touch(std::int64_t frames) {
  if (plant_.setup().capture.bridge_a) plant_.touch(frames);
}

sensing::CaptureBlock SimulatedRoom::advance(std::int64_t first_frame, std::span<const std::int32_t> played) {
  const auto& setup = plant_.setup();
  const auto frames = played.size() / static_cast<std::size_t>(setup.playback_channels);
  played_.resize(played.size());
  std::transform(played.begin(), played.end(), played_.begin(),
                 [](std::int32_t sample) { return 0x1p-31 * sample; });
  captured_.resize(frames * static_cast<std::size_t>(setup.capture.count));
  plant_.advance(played_, captured_);
  samples_.resize(captured_.size());
  std::transform(captured_.begin(), captured_.end(), samples_.begin(), [](double value) {
    return static_cast<std::int32_t>(std::clamp(std::round(value * 0x1p31), -0x1p31, 0x1p31 - 1));
  });
  if (marker_broken_ && setup.capture.marker)
    for (auto k = static_cast<std::size_t>(*setup.capture.marker); k < samples_.size();
         k += static_cast<std::size_t>(setup.capture.count))
      samples_[k] = 0;
  return {samples_, setup.capture.count, first_frame, setup.rate_Hz};
}

CaptureSetup SimulatedRoom::capture() const {
  const auto& setup = plant_.setup();
  CaptureSetup made;
  made.rate_Hz = setup.rate_Hz;
  made.channels = setup.capture.count;
  made.delay_frames = setup.loop_delay_frames;
  made.in_contact = false;
  if (setup.capture.bridge_a) {
    made.finger = finger_of(setup);
    if (rig_.forces) use(*rig_.forces, *made.finger);
    made.finger->window = window_;
  }
  if (!rig_.responses.empty()) {
    made.pick_ups = calibrated_pick_ups(rig_);
    return made;
  }
  for (std::size_t p = 0; p < setup.pickups.size(); ++p) {
    auto& pick_up = made.pick_ups.emplace_back();
    pick_up.channel = setup.pickups[p].channel;
    for (const auto& transducer : setup.transducers) {
      sensing::Transfer transfer{transducer.channel, {}, {}};
      for (double f = setup.band_low_Hz; f <= setup.band_high_Hz; f += kStep_Hz) {
        transfer.frequency_Hz.push_back(f);
        transfer.response.push_back(plant_.pickup_response(p, f) * transducer.um_per_full_scale *
                                    setup.pickups[p].full_scale_per_um);
      }
      pick_up.transfers.push_back(std::move(transfer));
    }
  }
  return made;
}

}  // namespace turnpoint::session

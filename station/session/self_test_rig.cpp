#include "station/session/self_test_rig.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "station/core/limits.hpp"
#include "station/io/uri.hpp"
#include "station/sensing/pick_up.hpp"
#include "station/simulation/observer.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::session {
namespace {

constexpr std::int64_t kGate_ns = 500'000'000;
constexpr std::int64_t kQuiet_ns = 700'000'000;  // The cells are read for the last 0.4 s of this silence.
constexpr std::int64_t kResult_ns = 5'000'000'000;
// A tone is played at full level for kTone_s, and then kLower_s at each of its lower levels.
constexpr double kTone_s = 0.6, kLower_s = 0.3, kRamp_s = 0.05;
constexpr std::array kLower{0.71, 0.5};
constexpr double kAmplitude = 0.1, kShareOfLimit = 0.25;

using core::phrase;

/// Throws if the amplifier has refused. `what` is the key of the text that says what it was to do.
void require(const std::optional<Fault>& refusal, const char* what) {
  if (refusal) throw PartFailed(phrase(what, {core::phrase_of(*refusal)}));
}

/// Enables the amplifier. The destructor starts the heartbeat again and switches the amplifier off, even
/// after an exception.
class GateOpened {
 public:
  explicit GateOpened(audio::Amplifier& amplifier) : amplifier_(amplifier) {
    require(amplifier.enable(), "self_test.cannot_enable");
  }
  ~GateOpened() {
    amplifier_.disable();
    amplifier_.resume_heartbeat();
  }
  GateOpened(const GateOpened&) = delete;
  GateOpened& operator=(const GateOpened&) = delete;

 private:
  audio::Amplifier& amplifier_;
};

/// A tone for the self-test, at a frequency to which the pick-ups respond well.
struct Choice {
  double frequency_Hz = 0, response = 0;
};

/// Returns the frequency in the transducer's band at which the pick-ups respond best. Near this peak, a small
/// shift of the resonances hardly changes the level. Returns frequency 0 if no pick-up is calibrated for the
/// transducer.
Choice best_tone(const rig::Transducer& transducer, const std::vector<sensing::PickUp>& pick_ups) {
  Choice best;
  const auto low_Hz = std::min(std::max(transducer.low_Hz, core::kAudible_Hz), transducer.high_Hz);
  for (const auto& pick_up : pick_ups)
    for (const auto& transfer : pick_up.transfers) {
      if (transfer.drive_channel != transducer.channel) continue;
      for (double f = low_Hz; f <= transducer.high_Hz; f += 10)
        if (const auto response = sensing::response(pick_up, transducer.channel, f);
            response && std::abs(*response) > best.response)
          best = {f, std::abs(*response)};
    }
  return best;
}

/// Returns an amplitude relative to full scale that is small, and far below the rig's limit.
double quiet_amplitude(const rig::Rig& rig, const rig::Transducer& transducer) {
  double m_per_full_scale = transducer.m_per_full_scale.value_or(0);
  for (const auto& point : transducer.response)
    m_per_full_scale = std::max(m_per_full_scale, point.m_per_full_scale);
  if (m_per_full_scale <= 0 || rig.limits.displacement_m <= 0) return kAmplitude;
  return std::min(kAmplitude, kShareOfLimit * rig.limits.displacement_m / m_per_full_scale);
}

/// A quiet tone that goes down in two steps, each of 3 dB. At lower levels, the noise of the pick-up would
/// stand out.
audio::PreparedBurst quiet_tone(const rig::Rig& rig, const rig::Transducer& transducer, double frequency_Hz) {
  const auto frames = [&](double s) {
    return static_cast<std::int64_t>(std::llround(s * rig.output.rate_Hz));
  };
  const double amplitude = quiet_amplitude(rig, transducer);
  audio::Burst burst;
  burst.ramp.frames = frames(kRamp_s);
  burst.tones.count = 1;
  burst.tones.tones[0] = {frequency_Hz, amplitude, 0, transducer.channel};
  burst.length_frames = frames(kTone_s);
  for (const double level : kLower) {
    auto& change = burst.changes[static_cast<std::size_t>(burst.change_count++)];
    change = {burst.length_frames, burst.ramp.frames, burst.tones};
    change.to.tones[0].amplitude = level * amplitude;
    burst.length_frames += frames(kLower_s);
  }
  return audio::prepare(burst, {rig.output.rate_Hz, rig::channels(rig), rig.output.bits});
}

/// The largest difference between the measured levels of a tone, each relative to the plan. Empty unless all
/// levels were measured.
std::optional<double> nonlinearity_dB(const sensing::IntervalResult& measured) {
  std::vector<double> ratios_dB;
  for (const auto& tone : measured.tones)
    if (tone.seen) ratios_dB.push_back(tone.ratio_dB);
  if (ratios_dB.size() != kLower.size() + 1) return std::nullopt;
  const auto [least, most] = std::minmax_element(ratios_dB.begin(), ratios_dB.end());
  return *most - *least;
}

bool has_stop_line(const std::string& amplifier_uri) {
  if (amplifier_uri == "sim:") return true;
  const auto uri = io::parse_uri(amplifier_uri);
  return std::any_of(uri.values.begin(), uri.values.end(),
                     [](const auto& key) { return key.first == "stop"; });
}

class StageRig : public SelfTestRig {
 public:
  explicit StageRig(SelfTestParts parts) : parts_(std::move(parts)), watch_(parts_.clocks()) {}

  GateReading drop_heartbeat() override {
    GateReading reading;
    if (parts_.amplifier == nullptr) {
      reading.missing = phrase("self_test.session_simulated");
      return reading;
    }
    auto& amplifier = *parts_.amplifier;
    if (!amplifier.gate()) {
      reading.missing = phrase("self_test.gate_missing");
      return reading;
    }
    require(parts_.stage->arm(), "self_test.cannot_arm");
    // Measure up to three times and keep the shortest time, because a busy machine can only lengthen it.
    for (int attempt = 0; attempt < 3 && reading.dropped_s.value_or(1) > kGateLimit_s; ++attempt) {
      const GateOpened opened(amplifier);
      reading.opened = until([&] { return amplifier.gate() == true; }, kGate_ns);
      if (!reading.opened) return reading;
      amplifier.hold_heartbeat();
      const auto held_ns = system::monotonic_ns();
      if (!until([&] { return amplifier.gate() == false; }, kGate_ns)) return reading;
      // Make sure that the external monitor has shut the gate. If the guard shut it after a fault, the
      // reading would say nothing about the monitor.
      if (amplifier.state() == audio::AmplifierState::faulted)
        throw PartFailed(phrase("self_test.gate_other", {core::phrase_of(amplifier.fault())}));
      const auto dropped_s = 1e-9 * static_cast<double>(system::monotonic_ns() - held_ns);
      reading.dropped_s = std::min(dropped_s, reading.dropped_s.value_or(dropped_s));
    }
    return reading;
  }

  PressReading press_stop() override {
    PressReading reading;
    if (!has_stop_line(parts_.rig->amplifier_uri))
      reading.missing = phrase("self_test.stop_missing");
    else if (!parts_.ask)
      reading.missing = phrase("self_test.nobody_asked");
    if (reading.missing) return reading;
    auto& amplifier = *parts_.amplifier;
    require(parts_.stage->arm(), "self_test.cannot_arm");
    parts_.ask({Request::Kind::press_stop, 0, ""});
    reading.pressed = until(
        [&] {
          return amplifier.state() == audio::AmplifierState::faulted &&
                 amplifier.fault().kind == FaultKind::stop_pressed;
        },
        press_ns_);
    if (!reading.pressed) return reading;
    parts_.ask({Request::Kind::release_stop, 0, ""});
    reading.released = until([&] { return !parts_.stage->clear(); }, press_ns_);
    if (reading.released) require(parts_.stage->arm(), "self_test.cannot_arm");
    return reading;
  }

  std::vector<PressReading> press_buttons() override {
    std::vector<PressReading> readings;
    const auto& names = parts_.stage->buttons();
    for (std::size_t k = 0; k < names.size(); ++k) {
      auto& reading = readings.emplace_back();
      reading.button = names[k];
      if (parts_.ask)
        reading.pressed = reading.released = pressed(static_cast<int>(k), names[k]);
      else
        reading.missing = phrase("self_test.nobody_asked");
    }
    return readings;
  }

  std::vector<ToneReading> play_tones() override {
    if (parts_.room == nullptr || !parts_.capture || parts_.capture->pick_ups.empty()) {
      ToneReading none;
      none.missing = phrase("self_test.pick_up_missing");
      return {none};
    }
    std::vector<ToneReading> readings;
    for (const auto& transducer : parts_.rig->transducers) {
      auto& reading = readings.emplace_back();
      reading.transducer = transducer.name;
      reading.frequency_Hz = best_tone(transducer, parts_.capture->pick_ups).frequency_Hz;
      if (reading.frequency_Hz > 0) play(transducer, reading);
    }
    return readings;
  }

  std::vector<CellReading> read_cells() override {
    if (!parts_.capture || !parts_.capture->finger) {
      CellReading reading;
      reading.missing = phrase(rig::has_force_cells(*parts_.rig) ? "self_test.cells_not_calibrated"
                                                                 : "self_test.cells_missing");
      return {reading};
    }
    std::vector<CellReading> readings;
    for (std::size_t k = 0; k < sensing::bridge_count; ++k) {
      CellReading& reading = readings.emplace_back();
      reading.cell = k == 2 ? phrase("self_test.lateral") : core::plain(k == 0 ? "a" : "b");
      const bool wire = forces_ && forces_->state == sensing::ForcesState::wire;
      if (wire && forces_->faulty_bridge.value_or(k) == k) {
        reading.fault = phrase("self_test.wire_off");
      } else if (forces_ && forces_->zero && forces_->noise) {
        reading.zero_N = kRated_N * (*forces_->zero)[k];
        reading.noise_mN = 1e3 * kRated_N * (*forces_->noise)[k];
      } else {
        reading.fault = phrase("self_test.samples_missing");
      }
    }
    return readings;
  }

  MixerReading mixer() override { return read_mixer(*parts_.rig); }

  std::optional<double> hottest_C() override { return system::hottest_C(parts_.sensors); }

  ClockReading clock() override { return {system::read_wall_clock(), watch_.look(parts_.clocks()).jump_s}; }

  system::Disk disk() override { return system::read_disk(parts_.data_folder); }

 private:
  /// Waits until the condition is true, for at most this time. Returns whether it is.
  bool until(const std::function<bool()>& condition, std::int64_t longest_ns) {
    const auto end_ns = system::monotonic_ns() + longest_ns;
    bool met = false;
    parts_.stage->wait_for([&] { return (met = condition()) || system::monotonic_ns() > end_ns; });
    return met;
  }

  void pass_on(Input input) {
    if (parts_.other) parts_.other(std::move(input));
  }

  bool pressed(int button, const std::string& name) {
    auto& stage = *parts_.stage;
    static_cast<void>(stage.drain());
    parts_.ask({Request::Kind::press_button, button, name});
    const auto end_ns = stage.now_ns() + press_ns_;
    while (const auto input = stage.wait_until(end_ns))
      if (const auto* press = input->as<input::Button>(); press && press->index == button) return true;
    return false;
  }

  void play(const rig::Transducer& transducer, ToneReading& reading) {
    auto& stage = *parts_.room;
    for (auto& input : stage.drain()) pass_on(std::move(input));
    require(stage.arm(), "self_test.cannot_arm");
    require(stage.open_amplifier(), "self_test.cannot_enable");
    const auto settled_ns = stage.now_ns() + kQuiet_ns;
    while (auto input = stage.wait_until(settled_ns)) pass_on(std::move(*input));
    const auto burst = quiet_tone(*parts_.rig, transducer, reading.frequency_Hz);
    const auto onsets = stage.present({&burst, 1}, stage.now_ns());
    const auto end_ns = stage.now_ns() + kResult_ns;
    reading.proof = core::Proof::lost;
    while (auto input = stage.wait_until(end_ns)) {
      if (const auto* found = input->as<Fault>()) {
        stage.close_amplifier();
        const Fault fault = *found;
        pass_on(std::move(*input));
        throw PartFailed(core::phrase_of(fault));
      }
      if (input->is<input::Heard>()) break;
      const auto* measured = input->as<input::Measured>();
      if (!measured) {
        pass_on(std::move(*input));
        continue;
      }
      if (measured->forces) forces_ = measured->forces;
      reading.proof = measured->result->verdict;
      reading.cause = measured->result->cause;
      reading.ratio_dB = measured->result->ratio_dB;
      reading.nonlinearity_dB = nonlinearity_dB(*measured->result);
    }
    stage.close_amplifier();
  }

  SelfTestParts parts_;
  const std::int64_t press_ns_ = static_cast<std::int64_t>(1e9 * parts_.longest_press_s);
  system::ClockWatch watch_;
  std::shared_ptr<const sensing::TrialForces> forces_;  ///< forces measured during the newest tone
};

}  // namespace

std::unique_ptr<SelfTestRig> self_test_rig(SelfTestParts parts) {
  return std::make_unique<StageRig>(std::move(parts));
}

std::vector<Check> self_test(const rig::Rig& rig, const AskOperator& ask, const std::string& data_folder) {
  if (rig.amplifier_uri == "sim:") return simulated_self_test(rig, data_folder);
  Inputs inputs;
  auto devices = open_devices(rig, inputs);
  auto* amplifier = devices.amplifier.get();
  const auto capture = card_capture_of(rig);
  const auto stage = real_stage(session_stream(rig), std::move(devices), inputs, capture);
  SelfTestParts parts{&rig, stage.get(), amplifier, capture ? stage.get() : nullptr, {}, ask, data_folder};
  if (capture) parts.capture = capture->setup;
  auto checks = self_test(*self_test_rig(std::move(parts)));
  stage->finish();
  return checks;
}

std::vector<Check> simulated_self_test(const rig::Rig& rig, const std::string& data_folder,
                                       const SimulatedFaults& faults) {
  Inputs inputs, room_inputs;
  const auto lines = std::make_shared<io::SimulatedAmplifierLines>();
  if (faults.lines) faults.lines(*lines);
  Devices devices;
  devices.amplifier = io::simulated_amplifier(lines);
  if (rig.buttons_uri)
    devices.buttons = io::open_buttons(io::ButtonsConfig{}, std::nullopt, handlers_for(inputs));
  auto* amplifier = devices.amplifier.get();
  auto* buttons = devices.buttons.get();
  auto stream = stream_of(rig);
  stream.output.uri = "null:";
  const auto stage = real_stage(stream, std::move(devices), inputs);
  SelfTestParts parts{&rig, stage.get(), amplifier,     nullptr,        {},
                      {},   data_folder, faults.clocks, faults.sensors, faults.longest_press_s};
  SimulatedParticipant nobody(simulation::Observer(simulation::parse("sim")));
  std::unique_ptr<Stage> room_stage;
  if (simulates_capture(rig)) {
    auto room = std::make_unique<SimulatedRoom>(rig, faults.laboratory);
    if (faults.room) faults.room(*room);
    parts.capture = room->capture();
    room_stage = virtual_stage(simulated_stream(rig), nobody, room_inputs, std::move(room));
    parts.room = room_stage.get();
  }
  parts.ask = [&](const Request& request) {
    const auto now_ns = system::monotonic_ns();
    if (request.kind == Request::Kind::press_button && !faults.button_disconnected)
      buttons->simulate(io::Press{now_ns, request.button});
    if (request.kind != Request::Kind::press_button && !faults.stop_disconnected)
      lines->set(io::kSimulatedAmplifier.stop, request.kind == Request::Kind::press_stop, now_ns);
  };
  auto checks = self_test(*self_test_rig(std::move(parts)));
  stage->finish();
  return checks;
}

}  // namespace turnpoint::session

#include "station/simulation/plant.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "physics/field.hpp"
#include "physics/finger.hpp"

namespace turnpoint::simulation {

namespace {

std::vector<double> places_of(const std::vector<Pickup>& pickups) {
  std::vector<double> x_m;
  for (const auto& pickup : pickups) x_m.push_back(pickup.x_m);
  return x_m;
}

// The friction under the fingertip is the mean of this many equal parts.
constexpr int kFingertipParts = 10;

// frequency of the fault `sounding`
constexpr double kSounding_Hz = 27000;

/// Interpolates linearly between values at positions that are `step_m` apart.
double between(const std::vector<double>& values, double step_m, double x_m) {
  const double place = std::clamp(x_m / step_m, 0.0, static_cast<double>(values.size() - 1));
  const auto k = std::min(static_cast<std::size_t>(place), values.size() - 2);
  const double part = place - static_cast<double>(k);
  return (1 - part) * values[k] + part * values[k + 1];
}

// There are 8000 steps a second (one every eighth of a ms).
int frames_per_step(int rate_Hz) { return static_cast<int>(std::lround(rate_Hz / 8000.0)); }

}  // namespace

Plant::Plant(const Setup& setup)
    : setup_(validated(setup)),
      step_frames_(frames_per_step(setup.rate_Hz)),
      whole_delay_(static_cast<std::int64_t>(std::floor(setup.loop_delay_frames))),
      response_(
          surface_response(setup.surface, places_of(setup.pickups), setup.band_low_Hz, setup.band_high_Hz)),
      wires_(setup.wires, setup.cells.volt_per_volt_N, setup.rate_Hz, setup.seed),
      cells_(setup.cells, setup.rate_Hz),
      finger_(setup.finger, static_cast<double>(step_frames_) / setup.rate_Hz, step_frames_, setup.seed) {
  const double fraction = setup.loop_delay_frames - static_cast<double>(whole_delay_);
  // leave room for the fault drive_late, which can delay the drive by up to a second
  const Delay delay(whole_delay_ + setup.rate_Hz, fraction);
  transducer_delays_.assign(setup.transducers.size(), delay);
  if (setup.wires.carrier_channel) carrier_delay_.push_back(delay);
  if (setup.marker_channel) marker_delay_.emplace_back(whole_delay_ + 1, 0);
  for (std::size_t k = 0; k < setup.pickups.size(); ++k) pickup_noise_.emplace_back(setup.seed, 10 + k);
  prepare();
  change(0);
}

void Plant::add(const Fault& fault) {
  if (fault.from_frame < captured_)
    throw std::invalid_argument("plant: a fault must begin at a frame that was not captured yet");
  auto faults = faults_;
  faults.push_back(fault);
  validate(setup_, faults);
  faults_ = std::move(faults);
  prepare();
  next_change_ = captured_;
}

void Plant::touch(std::int64_t frames) { finger_.touch({world_, world_ + frames}); }

void Plant::lift(std::int64_t frames) { finger_.lift(world_ + frames); }

void Plant::repair() {
  for (auto& fault : faults_) fault.to_frame = std::min(fault.to_frame, captured_);
  std::erase_if(faults_, [](const Fault& fault) { return fault.to_frame <= fault.from_frame; });
  next_change_ = captured_;
}

const Plant::Gains& Plant::gains_for(double frequency_Hz) {
  const auto found = gains_.find(frequency_Hz);
  if (found != gains_.end()) return found->second;
  std::vector<double> x_m, squares;
  for (double x = 0; x <= setup_.surface.length_m; x += kGain_m) x_m.push_back(x);
  const physics::Tone tone{frequency_Hz, 1, 0};
  const auto field = physics::evaluate_tones(setup_.surface, {&tone, 1}, x_m, physics::Model::mode,
                                             physics::Normalise::none);
  for (const auto& v : field[0].v) squares.push_back(std::norm(v));
  auto under = physics::fingertip_average(x_m, squares, setup_.finger.fingertip_m);
  std::vector<double> share(x_m.size(), 1.0);
  if (setup_.finger.impedance_Ns_per_m != 0.0) {
    const physics::Finger finger{setup_.finger.impedance_Ns_per_m, 0.5 * setup_.finger.contact_m};
    const auto loads = physics::finger_load(setup_.surface, frequency_Hz, x_m, finger);
    std::transform(loads.begin(), loads.end(), share.begin(),
                   [&](const auto& load) { return std::pow(load.share(finger), 2); });
  }
  return gains_.emplace(frequency_Hz, Gains{std::move(squares), std::move(under), std::move(share)})
      .first->second;
}

std::size_t Plant::filter_for(double resonance) {
  for (std::size_t k = 0; k < filters_.size(); ++k)
    if (filters_[k].first == resonance) return k;
  filters_.emplace_back(resonance, PickupFilter(response_, setup_.rate_Hz, resonance));
  return filters_.size() - 1;
}

/// Computes in advance all that advance() will need with the listed faults, because advance() must not
/// allocate.
void Plant::prepare() {
  std::vector<std::int64_t> frames{0, captured_};
  for (const auto& fault : faults_) {
    frames.push_back(fault.from_frame);
    frames.push_back(fault.to_frame);
  }
  for (const auto frame : frames) {
    const Condition c = condition_at(setup_, faults_, frame);
    filter_for(c.resonance);
    for (const auto& tone : tones_) gains_for(tone.lock_in.frequency_Hz() * c.frequency / c.resonance);
  }
}

void Plant::set_tones(std::vector<double> frequency_Hz, double window_s) {
  const int window =
      std::clamp(static_cast<int>(std::lround(window_s * setup_.rate_Hz / step_frames_)), 1, LockIn::kWindow);
  std::vector<Tone> tones;
  for (const double f : frequency_Hz) {
    const auto old = std::find_if(tones_.begin(), tones_.end(), [&](const Tone& t) {
      return t.lock_in.frequency_Hz() == f && t.lock_in.window_steps() == window;
    });
    tones.push_back(old != tones_.end() ? *old
                                        : Tone{LockIn(f, setup_.rate_Hz, step_frames_, window), nullptr});
  }
  tones_ = std::move(tones);
  prepare();
  for (auto& tone : tones_)
    tone.gains = &gains_for(tone.lock_in.frequency_Hz() * now_.frequency / now_.resonance);
}

void Plant::set_impedance(std::complex<double> impedance_Ns_per_m) {
  if (impedance_Ns_per_m == setup_.finger.impedance_Ns_per_m) return;
  setup_.finger.impedance_Ns_per_m = impedance_Ns_per_m;
  gains_.clear();
  prepare();
  for (auto& tone : tones_)
    tone.gains = &gains_for(tone.lock_in.frequency_Hz() * now_.frequency / now_.resonance);
}

/// Applies the faults that are active at this captured frame.
void Plant::change(std::int64_t frame) {
  for (const auto& fault : faults_)
    if (fault.kind == FaultKind::gap && fault.from_frame == frame)
      for (std::int64_t k = frames_lost(fault); k > 0; --k) next_frame({});
  now_ = condition_at(setup_, faults_, frame);
  const std::size_t filter = filter_for(now_.resonance);
  if (filter != filter_) filters_[filter].second.continue_from(filters_[filter_].second);
  filter_ = filter;
  for (auto& tone : tones_)
    tone.gains = &gains_for(tone.lock_in.frequency_Hz() * now_.frequency / now_.resonance);
  next_change_ = kNever;
  for (const auto& fault : faults_)
    for (const auto edge : {fault.from_frame, fault.to_frame})
      if (edge > frame) next_change_ = std::min(next_change_, edge);
}

void Plant::advance(std::span<const double> played, std::span<double> captured) {
  const auto inputs = static_cast<std::size_t>(setup_.playback_channels);
  const auto outputs = static_cast<std::size_t>(setup_.capture.count);
  const std::size_t frames = played.size() / inputs;
  if (played.size() % inputs != 0 || captured.size() != frames * outputs)
    throw std::invalid_argument(
        "plant: played and captured blocks must have the same number of whole frames");
  for (std::size_t k = 0; k < frames; ++k) {
    if (captured_ >= next_change_) change(captured_);
    const auto in = played.subspan(k * inputs, inputs);
    for (std::size_t t = 0; t < transducer_delays_.size(); ++t)
      transducer_delays_[t].push(in[static_cast<std::size_t>(setup_.transducers[t].channel)]);
    for (auto& delay : carrier_delay_)
      delay.push(in[static_cast<std::size_t>(*setup_.wires.carrier_channel)]);
    for (auto& delay : marker_delay_) delay.push(in[static_cast<std::size_t>(*setup_.marker_channel)]);
    ++played_;
    next_frame(captured.subspan(k * outputs, outputs));
    ++captured_;
  }
}

/// Returns the displacement of the drive edge (um). `full_scale` becomes the sum of the transducers'
/// voltages, in units of full scale.
double Plant::edge_um(double& full_scale) const {
  const std::int64_t delay = whole_delay_ + now_.late_frames - (world_ - (played_ - 1));
  double sum = 0;
  full_scale = 0;
  for (std::size_t t = 0; t < transducer_delays_.size(); ++t) {
    const double voltage = std::clamp(transducer_delays_[t].read(delay), -now_.clip, now_.clip);
    full_scale += voltage;
    sum += setup_.transducers[t].um_per_full_scale * now_.transducer_gain[t] * voltage;
  }
  return sum;
}

/// Displacement of the drive edge (um) with the fault frequency_off: the frequencies of all named tones are
/// multiplied by the fault's factor.
double Plant::shifted_edge_um() const {
  double sum = 0;
  for (const auto& tone : tones_) {
    const double cycles = tone.lock_in.frequency_Hz() * now_.frequency / setup_.rate_Hz;
    sum += (tone.lock_in.amplitude() * phasor(cycles, world_)).real();
  }
  return sum;
}

double Plant::gain_at(std::size_t tone, double x_m) const {
  const auto& gains = *tones_.at(tone).gains;
  return std::sqrt(between(gains.under_fingertip, kGain_m, x_m) * between(gains.share, kGain_m, x_m));
}

double Plant::amplitude_um(double x_m) const {
  double sum = 0;
  for (std::size_t t = 0; t < tones_.size(); ++t) {
    const double gain = gain_at(t, x_m);
    sum += gain * gain * std::norm(tones_[t].lock_in.amplitude());
  }
  return std::sqrt(sum);
}

/// Displacement at x under a fingertip whose middle is at `finger_m`.
double Plant::amplitude_um_at_point(double x_m, double finger_m) const {
  double sum = 0;
  for (const auto& tone : tones_)
    sum += between(tone.gains->squares, kGain_m, x_m) * between(tone.gains->share, kGain_m, finger_m) *
           std::norm(tone.lock_in.amplitude());
  return std::sqrt(sum);
}

/// The factor by which a steady vibration would reduce the friction of a fingertip at x. Parts of the
/// fingertip beyond an end of the surface do not count.
double Plant::relative_friction(double x_m) const {
  double sum = 0;
  int parts = 0;
  for (int k = 0; k < kFingertipParts; ++k) {
    const double at_m = x_m + setup_.finger.fingertip_m * ((k + 0.5) / kFingertipParts - 0.5);
    if (at_m < 0 || at_m > setup_.surface.length_m) continue;
    sum += setup_.friction.relative_friction(1e-6 * amplitude_um_at_point(at_m, x_m));
    ++parts;
  }
  return parts > 0 ? sum / parts : 1;
}

/// Computes the finger's forces at the end of the next step. Within a step, forces change linearly.
void Plant::begin_step() {
  for (auto& tone : tones_) tone.lock_in.begin_step(world_);
  from_ = to_;
  amplitude_um_ = amplitude_um(finger_.contact_m());
  truth_.finger = finger_.step(world_, relative_friction(finger_.contact_m()), now_.lifted);
  to_ = forces_on(setup_.cells, {truth_.finger.normal_N, truth_.finger.lateral_N, truth_.finger.contact_m});
}

/// Simulates one frame of the laboratory. `out` is empty if a gap loses this frame.
void Plant::next_frame(std::span<double> out) {
  const auto within = world_ % step_frames_;
  if (within == 0) begin_step();

  double full_scale = 0;
  double edge = edge_um(full_scale);
  for (auto& tone : tones_) tone.lock_in.add(edge);
  if (now_.frequency != 1) edge = shifted_edge_um();
  if (now_.sounding_um > 0) edge += now_.sounding_um * phasor(kSounding_Hz / setup_.rate_Hz, world_).real();
  filters_[filter_].second.step(edge);

  CellForces forces = forces_on(setup_.cells, load_);
  const double part = static_cast<double>(within) / step_frames_;
  for (std::size_t c = 0; c < forces.size(); ++c) forces[c] += from_[c] + part * (to_[c] - from_[c]);
  truth_.reading_N = cells_.step(forces, now_.warmth_K);
  truth_.normal_N = forces[0] + forces[1];
  truth_.lateral_N = forces[2];
  truth_.frame = captured_;
  truth_.drive_um = edge;
  truth_.amplitude_um = amplitude_um_;
  truth_.temperature_C = setup_.surface_temperature_C + now_.warmth_K;

  const std::int64_t delay = whole_delay_ - (world_ - (played_ - 1));
  wires_.step(carrier_delay_.empty() ? 0 : carrier_delay_.front().read(delay), full_scale);
  if (!out.empty()) write(out);
  ++world_;
}

void Plant::write(std::span<double> out) {
  std::fill(out.begin(), out.end(), 0.0);
  const auto& capture = setup_.capture;
  const auto put = [&](int channel) -> double& { return out[static_cast<std::size_t>(channel)]; };
  if (capture.reference) put(*capture.reference) = wires_.reference(world_, !now_.no_reference);
  const std::array bridges{capture.bridge_a, capture.bridge_b, capture.lateral};
  for (std::size_t c = 0; c < bridges.size(); ++c)
    if (bridges[c])
      put(*bridges[c]) = now_.bridge_dead[c] ? 0
                                             : wires_.bridge(static_cast<int>(c), truth_.reading_N[c], world_,
                                                             !now_.bridge_open[c]);
  for (std::size_t k = 0; k < setup_.pickups.size(); ++k) {
    const Pickup& pickup = setup_.pickups[k];
    const double signal = pickup.full_scale_per_um * filters_[filter_].second.output(k);
    put(pickup.channel) = converted(signal + pickup.cubic * signal * signal * signal +
                                        pickup.noise_full_scale * pickup_noise_[k].at(world_),
                                    setup_.wires.bits);
  }
  if (capture.marker && !marker_delay_.empty())
    put(*capture.marker) = marker_delay_.front().whole(whole_delay_ - (world_ - (played_ - 1)));
}

std::complex<double> Plant::tone_um(std::size_t tone) const { return tones_.at(tone).lock_in.amplitude(); }

std::complex<double> Plant::pickup_response(std::size_t pickup, double frequency_Hz) const {
  return filters_[filter_].second.response(pickup, frequency_Hz);
}

}  // namespace turnpoint::simulation

#include "station/plant/plant.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "physics/field.hpp"

namespace turnpoint::plant {

namespace {

double default_amount(FaultKind kind) {
  switch (kind) {
    case FaultKind::resonance_off:
    case FaultKind::frequency_off:
      return 0.03;
    case FaultKind::drive_late:
      return 0.005;
    case FaultKind::clip:
      return 0.5;
    case FaultKind::gap:
      return 480;
    case FaultKind::warmer:
      return 10;
    default:
      return 0;
  }
}

double amount_of(const Fault& fault) { return fault.amount.value_or(default_amount(fault.kind)); }

std::int64_t frames_lost(const std::vector<Fault>& faults) {
  std::int64_t sum = 0;
  for (const auto& fault : faults)
    if (fault.kind == FaultKind::gap) sum += std::llround(amount_of(fault));
  return sum;
}

void refuse(const std::string& why) { throw std::invalid_argument("plant: " + why); }

void check_channel(int channel, int count, const char* what) {
  if (channel < 0 || channel >= count)
    refuse(std::string(what) + ": channel " + std::to_string(channel) + " of " + std::to_string(count));
}

Setup checked(const Setup& setup) {
  if (setup.rate_Hz < 8000) refuse("rate_Hz must be at least 8000");
  if (!(setup.surface.quality_factor < 1e6)) refuse("the surface needs a finite quality factor");
  if (setup.loop_delay_frames < 0) refuse("loop_delay_frames must not be negative");
  const double whole = std::floor(setup.loop_delay_frames);
  if (whole != setup.loop_delay_frames && whole < Delay::kLeast)
    refuse("a delay of less than " + std::to_string(Delay::kLeast) + " frames must be whole");
  if (setup.transducers.size() > Plant::kMostTransducers) refuse("at most 8 transducers");
  for (const auto& t : setup.transducers) check_channel(t.channel, setup.playback_channels, "transducer");
  if (const auto c = setup.wires.carrier_channel) check_channel(*c, setup.playback_channels, "carrier");
  if (const auto c = setup.marker_channel) check_channel(*c, setup.playback_channels, "marker");
  std::vector<int> used;
  const auto use = [&](int channel, const char* what) {
    check_channel(channel, setup.capture.count, what);
    if (std::find(used.begin(), used.end(), channel) != used.end())
      refuse(std::string(what) + ": capture channel " + std::to_string(channel) + " is used twice");
    used.push_back(channel);
  };
  if (setup.capture.reference) use(*setup.capture.reference, "reference");
  if (setup.capture.bridge_a) use(*setup.capture.bridge_a, "bridge a");
  if (setup.capture.bridge_b) use(*setup.capture.bridge_b, "bridge b");
  if (setup.capture.lateral) use(*setup.capture.lateral, "lateral bridge");
  if (setup.capture.marker) use(*setup.capture.marker, "marker");
  for (const auto& pickup : setup.pickups) use(pickup.channel, "pick-up");
  return setup;
}

std::vector<double> places_of(const std::vector<Pickup>& pickups) {
  std::vector<double> x_m;
  for (const auto& pickup : pickups) x_m.push_back(pickup.x_m);
  return x_m;
}

// 8000 steps a second: an eighth of a ms.
int frames_per_step(int rate_Hz) { return static_cast<int>(std::lround(rate_Hz / 8000.0)); }

}  // namespace

Plant::Plant(const Setup& setup)
    : setup_(checked(setup)),
      step_frames_(frames_per_step(setup.rate_Hz)),
      whole_delay_(static_cast<std::int64_t>(std::floor(setup.loop_delay_frames))),
      response_(
          surface_response(setup.surface, places_of(setup.pickups), setup.band_low_Hz, setup.band_high_Hz)),
      wires_(setup.wires, setup.cells.volt_per_volt_N, setup.rate_Hz, setup.seed),
      cells_(setup.cells, setup.rate_Hz),
      finger_(setup.finger, setup.friction, static_cast<double>(step_frames_) / setup.rate_Hz, step_frames_,
              setup.seed) {
  const double fraction = setup.loop_delay_frames - static_cast<double>(whole_delay_);
  // room for a drive that is late by up to a second
  const Delay delay(whole_delay_ + setup.rate_Hz, fraction);
  transducer_delays_.assign(setup.transducers.size(), delay);
  if (setup.wires.carrier_channel) carrier_delay_.push_back(delay);
  if (setup.marker_channel) marker_delay_.emplace_back(whole_delay_ + 1, 0);
  for (std::size_t k = 0; k < setup.pickups.size(); ++k) pickup_noise_.emplace_back(setup.seed, 10 + k);
  prepare();
  change(0);
}

void Plant::add(const Fault& fault) {
  if (fault.from_frame < captured_) refuse("a fault must begin at a frame that was not captured yet");
  const double amount = amount_of(fault);
  if (fault.kind == FaultKind::gap) {
    const auto least = setup_.loop_delay_frames != static_cast<double>(whole_delay_) ? Delay::kLeast : 0;
    if (amount < 0 || whole_delay_ - frames_lost(faults_) - std::llround(amount) < least)
      refuse("gaps must not lose more frames than the loop delay has");
  }
  if (fault.kind == FaultKind::drive_late && !(amount >= 0 && amount < 1)) refuse("drive_late: 0 to 1 s");
  const int count = fault.kind == FaultKind::broken_bridge ? 3 : static_cast<int>(setup_.transducers.size());
  if (fault.index < 0 || fault.index >= count)
    refuse("the fault's index must be below " + std::to_string(count));
  faults_.push_back(fault);
  prepare();
  next_change_ = captured_;
}

Plant::Condition Plant::condition_at(std::int64_t frame) const {
  Condition c;
  c.transducer_gain.fill(1);
  c.warmth_K = setup_.temperature_C - setup_.surface_temperature_C;
  for (const auto& fault : faults_) {
    if (frame < fault.from_frame || frame >= fault.to_frame) continue;
    const double amount = amount_of(fault);
    const auto index = static_cast<std::size_t>(fault.index);
    switch (fault.kind) {
      case FaultKind::transducer_dead:
        c.transducer_gain[index] = 0;
        break;
      case FaultKind::transducer_half:
        c.transducer_gain[index] *= 0.5;
        break;
      case FaultKind::resonance_off:
        c.resonance *= 1 + amount;
        break;
      case FaultKind::frequency_off:
        c.frequency *= 1 + amount;
        break;
      case FaultKind::drive_late:
        c.late_frames += std::llround(amount * setup_.rate_Hz);
        break;
      case FaultKind::clip:
        c.clip = std::min(c.clip, amount);
        break;
      case FaultKind::broken_bridge:
        c.bridge_open[index] = true;
        break;
      case FaultKind::no_reference:
        c.no_reference = true;
        break;
      case FaultKind::finger_lifts:
        c.lifted = true;
        break;
      case FaultKind::gap:
        break;
      case FaultKind::warmer:
        c.warmth_K += amount;
        break;
    }
  }
  // f ~ sqrt(E / rho) h / W^2 for a plate; its lengths grow, and its density falls with their cube.
  c.resonance *= 1 + 0.5 * (setup_.expansion_per_K + setup_.modulus_per_K) * c.warmth_K;
  return c;
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
  return gains_.emplace(frequency_Hz, physics::fingertip_average(x_m, squares, setup_.finger.fingertip_m))
      .first->second;
}

std::size_t Plant::filter_for(double resonance) {
  for (std::size_t k = 0; k < filters_.size(); ++k)
    if (filters_[k].first == resonance) return k;
  filters_.emplace_back(resonance, PickupFilter(response_, setup_.rate_Hz, resonance));
  return filters_.size() - 1;
}

/// Computes all that advance() will need under the faults as they are listed, since it may not allocate.
void Plant::prepare() {
  std::vector<std::int64_t> frames{0, captured_};
  for (const auto& fault : faults_) {
    frames.push_back(fault.from_frame);
    frames.push_back(fault.to_frame);
  }
  for (const auto frame : frames) {
    const Condition c = condition_at(frame);
    filter_for(c.resonance);
    for (const auto& tone : tones_) gains_for(tone.lock_in.frequency_Hz() * c.frequency / c.resonance);
  }
}

void Plant::set_tones(std::vector<double> frequency_Hz) {
  std::vector<Tone> tones;
  for (const double f : frequency_Hz) {
    const auto old = std::find_if(tones_.begin(), tones_.end(),
                                  [&](const Tone& t) { return t.lock_in.frequency_Hz() == f; });
    tones.push_back(old != tones_.end() ? *old : Tone{LockIn(f, setup_.rate_Hz, step_frames_), nullptr});
  }
  tones_ = std::move(tones);
  prepare();
  for (auto& tone : tones_)
    tone.gains = &gains_for(tone.lock_in.frequency_Hz() * now_.frequency / now_.resonance);
}

/// Applies the faults that are on at this captured frame.
void Plant::change(std::int64_t frame) {
  for (const auto& fault : faults_)
    if (fault.kind == FaultKind::gap && fault.from_frame == frame)
      for (std::int64_t k = std::llround(amount_of(fault)); k > 0; --k) next_frame({});
  now_ = condition_at(frame);
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
    refuse("played and captured blocks must have the same number of whole frames");
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

/// Displacement of the drive edge as it was played, and the voltage at the transducers in full scale.
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

/// The same with each named tone at a frequency that is wrong by the fault's factor.
double Plant::shifted_edge_um() const {
  double sum = 0;
  for (const auto& tone : tones_) {
    const double cycles = tone.lock_in.frequency_Hz() * now_.frequency / setup_.rate_Hz;
    sum += (tone.lock_in.amplitude() * phasor(cycles, world_)).real();
  }
  return sum;
}

double Plant::gain_at(std::size_t tone, double x_m) const {
  const Gains& gains = *tones_.at(tone).gains;
  const double place = std::clamp(x_m / kGain_m, 0.0, static_cast<double>(gains.size() - 1));
  const auto k = std::min(static_cast<std::size_t>(place), gains.size() - 2);
  const double part = place - static_cast<double>(k);
  return std::sqrt((1 - part) * gains[k] + part * gains[k + 1]);
}

double Plant::amplitude_um(double x_m) const {
  double sum = 0;
  for (std::size_t t = 0; t < tones_.size(); ++t) {
    const double gain = gain_at(t, x_m);
    sum += gain * gain * std::norm(tones_[t].lock_in.amplitude());
  }
  return std::sqrt(sum);
}

/// The finger's forces are straight lines between steps.
void Plant::begin_step() {
  for (auto& tone : tones_) tone.lock_in.begin_step(world_);
  from_ = to_;
  amplitude_um_ = amplitude_um(finger_.contact_m());
  truth_.finger = finger_.step(world_, amplitude_um_ * 1e-6, now_.lifted);
  to_ = forces_on(setup_.cells, {truth_.finger.normal_N, truth_.finger.lateral_N, truth_.finger.contact_m});
}

/// One frame of the laboratory. `out` is empty if the station loses it.
void Plant::next_frame(std::span<double> out) {
  const auto within = world_ % step_frames_;
  if (within == 0) begin_step();

  double full_scale = 0;
  double edge = edge_um(full_scale);
  for (auto& tone : tones_) tone.lock_in.add(edge);
  if (now_.frequency != 1) edge = shifted_edge_um();
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
      put(*bridges[c]) =
          wires_.bridge(static_cast<int>(c), truth_.reading_N[c], world_, !now_.bridge_open[c]);
  for (std::size_t k = 0; k < setup_.pickups.size(); ++k) {
    const Pickup& pickup = setup_.pickups[k];
    put(pickup.channel) = converted(pickup.full_scale_per_um * filters_[filter_].second.output(k) +
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

}  // namespace turnpoint::plant

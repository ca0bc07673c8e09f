#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "station/audio/alsa_capture.hpp"
#include "station/audio/engine.hpp"
#include "station/core/limits.hpp"
#include "station/core/texts.hpp"
#include "station/maintenance/force_weights.hpp"
#include "station/sensing/own_clock.hpp"
#include "station/session/capture_feed.hpp"
#include "station/session/cell_feed.hpp"
#include "station/session/simulated_room.hpp"
#include "station/session/stage.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::maintenance {
namespace {

using core::phrase, core::plain;

constexpr double kSettle_s = 1, kRead_s = 1, kGlance_s = 0.12, kPatience_s = 5;
constexpr double kTap_s = 3.5;                  // time in which the operator taps, and the plate rings
constexpr double kBlow_N = 1, kBlow_s = 0.005;  // a tap in the simulated laboratory
constexpr double kLeastReference = 0.02;  // smallest accepted amplitude of the reference; 1 is full scale

core::Phrase digits_of(double value) { return plain(fmt::format("{:.3g}", value)); }

sensing::BridgeOptions bridge_options(const rig::Rig& rig, double reference_amplitude) {
  const auto& capture = *rig.capture;
  sensing::BridgeOptions options;
  options.rate_Hz = rig.output.rate_Hz;
  options.carrier_Hz = core::kForceCarrier_Hz;
  options.channels = capture.channels;
  options.reference = capture.reference;
  options.bridges = {capture.bridges[0], capture.bridges[1], capture.bridges[2]};
  options.reference_amplitude = reference_amplitude;
  return options;
}

/// Computes the mean of the points captured in one reading of the bridges. The first reading fixes the
/// amplitude of the captured excitation (the reference); later readings are compared with it.
class BridgeMean {
 public:
  explicit BridgeMean(const rig::Rig& rig) : rig_(rig) {}

  BridgeReading of(const std::vector<std::int32_t>& samples) {
    BridgeReading reading;
    const auto points = points_of(samples);
    for (const auto& point : points) add(point, reading, 1.0 / static_cast<double>(points.size()));
    for (const auto& point : points)
      for (std::size_t cell = 0; cell < 3; ++cell)
        reading.sd[cell] +=
            std::pow(point.ratio[cell] - reading.ratio[cell], 2) / static_cast<double>(points.size());
    for (double& sd : reading.sd) sd = std::sqrt(sd);
    reference_ = reading.reference;
    return reading;
  }

  /// Returns the frequency with which the plate rings after a tap; empty if it does not.
  std::optional<double> ringing_Hz(const std::vector<std::int32_t>& samples) {
    const auto points = points_of(samples);
    std::array<std::vector<double>, 3> cells;
    for (const auto& point : points)
      for (std::size_t cell = 0; cell < 3; ++cell) cells[cell].push_back(point.ratio[cell]);
    return ringing_of(cells, sensing::points_per_second(sensing::Band::force));
  }

 private:
  std::vector<sensing::BridgePoint> points_of(const std::vector<std::int32_t>& samples) const {
    const auto options = bridge_options(rig_, reference_ > 0 ? reference_ : found_reference(samples));
    sensing::BridgeDemodulator demodulator(options);
    std::vector<sensing::BridgePoint> points;
    demodulator.push({samples, options.channels, 0, options.rate_Hz}, [&](const sensing::BridgePoint& point) {
      // skip the first 17 ms, in which the filter is still settling
      if (point.index >= 20) points.push_back(point);
    });
    if (points.empty()) throw core::Failure(phrase("weights.nothing_captured"));
    for (const auto& point : points) check(point);
    return points;
  }

  double found_reference(const std::vector<std::int32_t>& samples) const {
    const auto options = bridge_options(rig_, 1);
    sensing::BridgeDemodulator demodulator(options);
    double amplitude = 0;
    demodulator.push({samples, options.channels, 0, options.rate_Hz}, [&](const sensing::BridgePoint& point) {
      if (point.index >= 20) amplitude = point.reference;
    });
    if (!(amplitude > kLeastReference))
      throw core::Failure(
          phrase("weights.no_excitation",
                 {plain(options.reference), plain(rig_.capture->excitation_channel.value_or(0))}));
    return amplitude;
  }

  void check(const sensing::BridgePoint& point) const {
    constexpr std::array<const char*, 3> cells{"a", "b", "lateral"};
    const auto channel = rig_.capture->bridges[point.bridge];
    switch (point.fault) {
      case sensing::WireFault::none:
        return;
      case sensing::WireFault::reference:
        throw core::Failure(
            phrase("weights.reference_off",
                   {plain(rig_.capture->reference), digits_of(point.reference), digits_of(reference_)}));
      case sensing::WireFault::quadrature:
        throw core::Failure(phrase("weights.wire_off", {plain(cells[point.bridge]), plain(channel),
                                                        digits_of(point.quadrature[point.bridge])}));
      case sensing::WireFault::overload:
        throw core::Failure(phrase("weights.overloaded", {plain(cells[point.bridge]), plain(channel)}));
      case sensing::WireFault::silent:
        throw core::Failure(phrase("weights.silent", {plain(cells[point.bridge]), plain(channel)}));
    }
  }

  static void add(const sensing::BridgePoint& point, BridgeReading& sum, double share) {
    for (std::size_t cell = 0; cell < 3; ++cell) {
      sum.ratio[cell] += share * point.ratio[cell];
      sum.quadrature[cell] += share * point.quadrature[cell];
    }
    sum.reference += share * point.reference;
  }

  const rig::Rig& rig_;
  double reference_ = 0;
};

/// Reads the bridges of a simulated surface, on which it puts the weights.
class SimulatedBridges : public BridgeReader {
 public:
  SimulatedBridges(const rig::Rig& rig, const std::function<void(simulation::Setup&)>& laboratory)
      : rig_(rig), room_(rig_, laboratory), mean_(rig_) {
    auto config = session::session_stream(rig_);
    config.output.uri = "null:";
    stream_ = audio::open_synchronous(config);
    stream_->listen([this](std::int64_t first_frame, std::span<const std::int32_t> played) {
      const auto block = room_.advance(first_frame, played);
      if (keep_) samples_.insert(samples_.end(), block.samples.begin(), block.samples.end());
    });
  }

  BridgeReading read(const WeightStep& step) override {
    room_.plant().set_load(
        {1e-3 * step.mass_g * kGravity_m_s2, 1e-3 * step.pull_g * kGravity_m_s2, 1e-3 * step.position_mm});
    pass(kSettle_s);
    return kept(kRead_s);
  }
  BridgeReading glance() override { return kept(kGlance_s); }
  bool notices_taps() const override { return true; }
  std::optional<double> tapped_Hz(Tap where) override {
    const double middle_m = 0.5 * rig_.surface.length_m;
    auto& plant = room_.plant();
    plant.set_load({});
    pass(kSettle_s);
    samples_.clear();
    keep_ = true;
    pass(0.5 * kTap_s);
    plant.set_load(where == Tap::along ? simulation::Load{0, kBlow_N, middle_m}
                                       : simulation::Load{kBlow_N, 0, middle_m});
    pass(kBlow_s);
    plant.set_load({});
    pass(0.5 * kTap_s);
    keep_ = false;
    return mean_.ringing_Hz(samples_);
  }

 private:
  BridgeReading kept(double seconds) {
    samples_.clear();
    keep_ = true;
    pass(seconds);
    keep_ = false;
    return mean_.of(samples_);
  }
  void pass(double seconds) {
    stream_->advance(std::llround(seconds * rig_.output.rate_Hz));
    while (stream_->poll()) {
    }
  }

  const rig::Rig rig_;
  session::SimulatedRoom room_;
  BridgeMean mean_;
  std::unique_ptr<audio::SynchronousStream> stream_;
  std::vector<std::int32_t> samples_;
  bool keep_ = false;
};

/// Captures the bridges with the sound card that plays the carrier. Reference and bridges are captured
/// together, so the delay from playback to capture does not matter.
class CardBridges : public BridgeReader {
 public:
  CardBridges(const rig::Rig& rig, BridgeDevices devices)
      : rig_(rig), devices_(std::move(devices)), mean_(rig_) {}

  BridgeReading read(const WeightStep&) override {
    collect(kSettle_s);
    return mean_.of(collect(kRead_s));
  }
  BridgeReading glance() override { return mean_.of(collect(kGlance_s)); }
  bool notices_taps() const override { return true; }
  std::optional<double> tapped_Hz(Tap) override { return mean_.ringing_Hz(collect(kTap_s)); }

 private:
  std::vector<std::int32_t> collect(double seconds) {
    auto& capture = *devices_.capture;
    auto& stream = *devices_.stream;
    const auto& uri = rig_.capture->uri;
    std::vector<std::int32_t> samples;
    while (capture.take() != nullptr) {
    }
    const auto before = capture.counters();
    const auto underruns = stream.counters().underruns;
    const auto wanted = static_cast<std::size_t>(seconds * rig_.output.rate_Hz) *
                        static_cast<std::size_t>(rig_.capture->channels);
    const auto until_ns = system::monotonic_ns() + static_cast<std::int64_t>(1e9 * (seconds + kPatience_s));
    while (samples.size() < wanted) {
      if (system::monotonic_ns() > until_ns)
        throw core::Failure(phrase("weights.device_silent", {plain(uri)}));
      while (stream.poll()) {
      }
      bool taken = false;
      while (const auto* block = capture.take()) {
        const auto used = block->used();
        samples.insert(samples.end(), used.begin(), used.end());
        taken = true;
      }
      if (!taken) devices_.pause();
    }
    const auto after = capture.counters();
    if (!after.present) throw core::Failure(phrase("weights.device_gone", {plain(uri)}));
    if (after.lost_frames != before.lost_frames || after.numbering != before.numbering ||
        stream.counters().underruns != underruns)
      throw core::Failure(phrase("weights.frames_lost", {plain(uri)}));
    return samples;
  }

  const rig::Rig rig_;
  BridgeDevices devices_;
  BridgeMean mean_;
};

}  // namespace

std::unique_ptr<BridgeReader> card_bridges(const rig::Rig& rig, BridgeDevices devices) {
  return std::make_unique<CardBridges>(rig, std::move(devices));
}

std::unique_ptr<BridgeReader> open_bridges(const rig::Rig& rig,
                                           const std::function<void(simulation::Setup&)>& laboratory) {
  if (!rig::has_force_cells(rig)) throw core::Refusal(phrase("weights.no_cells", {plain(rig.name)}));
  if (rig.capture->converter) return converter_bridges(*rig.capture->converter);
  if (session::simulates_capture(rig)) return std::make_unique<SimulatedBridges>(rig, laboratory);
  const auto card = session::card_capture_of(rig).value().device;
  return card_bridges(rig, {audio::open_realtime(session::session_stream(rig)), audio::open_capture(card),
                            [] { std::this_thread::sleep_for(std::chrono::milliseconds(2)); }});
}

namespace {

constexpr double kConverterSettle_s = 1, kConverterRead_s = 1, kConverterGlance_s = 0.12,
                 kConverterTap_s = 3.5;

/// Means of the samples of a converter with a clock of its own. The samples count the time.
class ConverterBridges : public BridgeReader {
 public:
  ConverterBridges(const rig::CellConverter& converter, std::unique_ptr<io::Converter> opened)
      : rig_(converter), converter_(std::move(opened)) {}

  BridgeReading read(const WeightStep&) override {
    return mean_of(collect(kConverterSettle_s, kConverterRead_s));
  }
  BridgeReading glance() override { return mean_of(collect(0, kConverterGlance_s)); }
  bool notices_taps() const override { return true; }
  std::optional<double> tapped_Hz(Tap) override {
    std::array<std::vector<double>, 3> cells;
    for (const auto& sample : collect(0, kConverterTap_s))
      for (std::size_t cell = 0; cell < cells.size(); ++cell) cells[cell].push_back(sample.value[cell]);
    return ringing_of(cells, rig_.rate_Hz);
  }

 private:
  /// Returns the samples of this length of time, which begins `settle_s` from now. Older samples may still
  /// wait in the buffer of the kernel.
  std::vector<io::Sample> collect(double settle_s, double seconds) {
    const auto from_ns = system::monotonic_ns() + static_cast<std::int64_t>(1e9 * settle_s);
    const auto wanted = static_cast<std::size_t>(std::ceil(seconds * rig_.rate_Hz));
    std::vector<io::Sample> samples;
    while (samples.size() < wanted)
      for (const auto& sample : converter_->read())
        if (sample.time_ns >= from_ns) samples.push_back(sample);
    return samples;
  }

  BridgeReading mean_of(const std::vector<io::Sample>& samples) const {
    constexpr std::array<const char*, 3> cells{"a", "b", "lateral"};
    sensing::OwnClock clock({.rate_Hz = rig_.rate_Hz});
    BridgeReading reading;
    const auto count = static_cast<double>(samples.size());
    for (const auto& sample : samples) {
      clock.push({sample.time_ns, sample.value, sample.at_limit}, {}, [](const sensing::BridgePoint&) {});
      for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        if (sample.at_limit[cell])
          throw core::Failure(phrase("weights.overloaded", {plain(cells[cell]), plain(rig_.channels[cell])}));
        reading.ratio[cell] += sample.value[cell] / count;
      }
    }
    if (const auto silent = clock.silent_cell())
      throw core::Failure(phrase("weights.silent", {plain(cells[*silent]), plain(rig_.channels[*silent])}));
    if (clock.counters().lost + clock.counters().disorder > 0)
      throw std::runtime_error(fmt::format("{}: {} samples were lost", rig_.uri, clock.counters().lost));
    if (const auto rate_Hz = clock.rate_Hz())
      if (const auto wrong = session::wrong_rate(rig_.uri.substr(4), *rate_Hz, rig_.rate_Hz))
        throw core::Failure(*wrong);
    for (const auto& sample : samples)
      for (std::size_t cell = 0; cell < cells.size(); ++cell)
        reading.sd[cell] += std::pow(sample.value[cell] - reading.ratio[cell], 2) / count;
    for (double& sd : reading.sd) sd = std::sqrt(sd);
    return reading;
  }

  const rig::CellConverter rig_;
  std::unique_ptr<io::Converter> converter_;
};

}  // namespace

std::unique_ptr<BridgeReader> converter_bridges(
    const rig::CellConverter& converter,
    const std::function<std::unique_ptr<io::Converter>(const io::Config&)>& open) {
  return std::make_unique<ConverterBridges>(converter, open(session::converter_of(converter)));
}

}  // namespace turnpoint::maintenance

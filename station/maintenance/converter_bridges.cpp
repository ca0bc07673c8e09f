#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "station/maintenance/force_weights.hpp"
#include "station/sensing/own_clock.hpp"
#include "station/session/cell_feed.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::maintenance {

namespace {

constexpr double kConverterSettle_s = 1, kConverterRead_s = 1, kConverterGlance_s = 0.12,
                 kConverterTap_s = 3.5;

/// Means of the samples of a converter with a clock of its own. The samples count the time.
class ConverterBridges : public BridgeReader {
 public:
  ConverterBridges(const rig::CellConverter& converter, std::unique_ptr<iio::Converter> opened)
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
  std::vector<iio::Sample> collect(double settle_s, double seconds) {
    const auto from_ns = system::monotonic_ns() + static_cast<std::int64_t>(1e9 * settle_s);
    const auto wanted = static_cast<std::size_t>(std::ceil(seconds * rig_.rate_Hz));
    std::vector<iio::Sample> samples;
    while (samples.size() < wanted)
      for (const auto& sample : converter_->read())
        if (sample.time_ns >= from_ns) samples.push_back(sample);
    return samples;
  }

  BridgeReading mean_of(const std::vector<iio::Sample>& samples) const {
    constexpr std::array<const char*, 3> cells{"a", "b", "lateral"};
    sensing::OwnClock clock({.rate_Hz = rig_.rate_Hz});
    BridgeReading reading;
    const auto count = static_cast<double>(samples.size());
    for (const auto& sample : samples) {
      clock.push({sample.time_ns, sample.value, sample.at_limit}, {}, [](const sensing::BridgePoint&) {});
      for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        if (sample.at_limit[cell])
          throw std::runtime_error(
              fmt::format("cell {} on channel {}: a wire is off, or the cell is overloaded", cells[cell],
                          rig_.channels[cell]));
        reading.ratio[cell] += sample.value[cell] / count;
      }
    }
    if (const auto silent = clock.silent_cell())
      throw std::runtime_error(
          fmt::format("cell {} on channel {}: the samples do not change at all; its amplifier or the converter is dead",
                      cells[*silent], rig_.channels[*silent]));
    if (clock.counters().lost + clock.counters().disorder > 0)
      throw std::runtime_error(fmt::format("{}: {} samples were lost", rig_.uri, clock.counters().lost));
    if (const auto rate_Hz = clock.rate_Hz())
      if (const auto wrong = session::wrong_rate(rig_.uri.substr(4), *rate_Hz, rig_.rate_Hz))
        throw std::runtime_error(texts::say(*wrong, "en"));
    for (const auto& sample : samples)
      for (std::size_t cell = 0; cell < cells.size(); ++cell)
        reading.sd[cell] += std::pow(sample.value[cell] - reading.ratio[cell], 2) / count;
    for (double& sd : reading.sd) sd = std::sqrt(sd);
    return reading;
  }

  const rig::CellConverter rig_;
  std::unique_ptr<iio::Converter> converter_;
};

}  // namespace

std::unique_ptr<BridgeReader> converter_bridges(
    const rig::CellConverter& converter,
    const std::function<std::unique_ptr<iio::Converter>(const iio::Config&)>& open) {
  return std::make_unique<ConverterBridges>(converter, open(session::converter_of(converter)));
}

}  // namespace turnpoint::maintenance

#include "station/store/signal_code.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "station/store/error.hpp"

namespace turnpoint::store {

namespace {

constexpr std::int32_t kMissing = std::numeric_limits<std::int32_t>::min();

std::int32_t whole(double value, const SignalChannel& channel) {
  if (std::isnan(value)) return kMissing;
  const double rounded = std::round(value / channel.resolution);
  if (!(std::abs(rounded) <= std::numeric_limits<std::int32_t>::max()))
    throw std::logic_error(fmt::format("signal {}: {} {} does not fit into 32 bits at a resolution of {}",
                                       channel.name, value, channel.unit, channel.resolution));
  return static_cast<std::int32_t>(rounded);
}

/// Returns the double nearest to `whole` times the resolution. For a resolution such as 1e-4, divides by
/// 10000 instead of multiplying, so that the result is rounded only once.
double multiple(std::int32_t whole, double resolution) {
  const double parts = std::round(1 / resolution);
  return 1 / parts == resolution ? whole / parts : whole * resolution;
}

/// Fills points, encoding and data of a signal from `number_at(channel, point)`.
template <class NumberAt>
void pack(SignalRow& signal, std::size_t points, const NumberAt& number_at) {
  const std::size_t channels = signal.channels.size(), numbers = points * channels;
  std::string shuffled(4 * numbers, '\0');
  for (std::size_t c = 0, at = 0; c < channels; ++c) {
    std::uint32_t before = 0;
    for (std::size_t k = 0; k < points; ++k, ++at) {
      const auto number = static_cast<std::uint32_t>(number_at(c, k));
      const std::uint32_t difference = number - std::exchange(before, number);
      for (std::size_t byte = 0; byte < 4; ++byte)
        shuffled[byte * numbers + at] = static_cast<char>(difference >> (8 * byte) & 0xFFU);
    }
  }
  auto size = compressBound(shuffled.size());
  std::string packed(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(shuffled.data()), shuffled.size(), 6) != Z_OK)
    throw std::logic_error("signal " + signal.stream + ": zlib could not compress it");
  packed.resize(size);
  signal.points = static_cast<std::int64_t>(points);
  signal.encoding = kSignalEncoding;
  signal.data.bytes = std::move(packed);
}

[[noreturn]] void damaged(const SignalRow& signal, const std::string& why) {
  throw StoreError(ErrorKind::corrupt, fmt::format("signal \"{}\": {}", signal.stream, why));
}

}  // namespace

void encode(SignalRow& signal, std::span<const std::vector<double>> values) {
  if (values.size() != signal.channels.size())
    throw std::logic_error("signal " + signal.stream + ": the number of channels does not match");
  const std::size_t points = values.empty() ? 0 : values.front().size();
  for (const auto& channel : values)
    if (channel.size() != points)
      throw std::logic_error("signal " + signal.stream + ": channels of different lengths");
  pack(signal, points, [&](std::size_t c, std::size_t k) { return whole(values[c][k], signal.channels[c]); });
}

void encode(SignalRow& signal, std::span<const std::int32_t> numbers) {
  const std::size_t channels = signal.channels.size();
  if (channels == 0 || numbers.size() % channels != 0)
    throw std::logic_error("signal " + signal.stream + ": the number of channels does not match");
  pack(signal, numbers.size() / channels,
       [&](std::size_t c, std::size_t k) { return numbers[k * channels + c]; });
}

std::vector<std::vector<double>> decode(const SignalRow& signal) {
  if (signal.encoding != kSignalEncoding)
    damaged(signal, fmt::format("encoding \"{}\" is not known to this release", signal.encoding));
  constexpr std::int64_t most_points = 1'000'000'000;
  if (signal.points < 0 || signal.points > most_points) damaged(signal, "impossible number of points");
  const auto points = static_cast<std::size_t>(signal.points);
  const std::size_t numbers = points * signal.channels.size();
  std::string shuffled(4 * numbers, '\0');
  auto size = static_cast<uLongf>(shuffled.size());
  if (uncompress(reinterpret_cast<Bytef*>(shuffled.data()), &size,
                 reinterpret_cast<const Bytef*>(signal.data.bytes.data()),
                 signal.data.bytes.size()) != Z_OK ||
      size != shuffled.size())
    damaged(signal, "its bytes do not hold as many points as the row says");
  std::vector<std::vector<double>> values;
  for (std::size_t c = 0, at = 0; c < signal.channels.size(); ++c) {
    auto& channel = values.emplace_back(points);
    std::uint32_t number = 0;
    for (double& value : channel) {
      for (std::size_t byte = 0; byte < 4; ++byte)
        number += static_cast<std::uint32_t>(static_cast<unsigned char>(shuffled[byte * numbers + at]))
                  << (8 * byte);
      const auto whole = static_cast<std::int32_t>(number);
      value = whole == kMissing ? std::numeric_limits<double>::quiet_NaN()
                                : multiple(whole, signal.channels[c].resolution);
      ++at;
    }
  }
  return values;
}

}  // namespace turnpoint::store

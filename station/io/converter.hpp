#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace turnpoint::io {

inline constexpr std::size_t channel_count = 3;

/// A converter that the kernel offers as a device of its subsystem IIO, and how to read it.
struct Config {
  std::string device;  ///< name or label of the device, or iio:deviceN
  std::array<std::string, channel_count> channels;
  double rate_Hz = 1000;           ///< samples of each channel per second, as they are expected to arrive
  std::string sampling_frequency;  ///< value for the attribute of this name; "" leaves it as it is
  std::string trigger;             ///< name of the trigger; "" leaves it as it is
};

/// The channels at one moment.
struct Sample {
  std::int64_t time_ns = 0;                    ///< CLOCK_MONOTONIC
  std::array<double, channel_count> value{};   ///< (raw + offset) x scale, in the unit of the driver
  std::array<bool, channel_count> at_limit{};  ///< the raw value is the lowest or highest that there is
};

/// An open converter that sends samples. Use it from one thread.
class Converter {
 public:
  virtual ~Converter() = default;
  /// Waits for up to a tenth of a second, and returns the samples that have arrived. Samples that the kernel
  /// dropped are missing without notice; only the time stamps show it. Throws std::system_error if the device
  /// is gone or sends nothing any more.
  virtual std::vector<Sample> read() = 0;
};

/// Opens the device and starts its buffer. Throws std::runtime_error that names the device, what is wrong,
/// and what there is instead; std::system_error if the kernel refuses something.
std::unique_ptr<Converter> open(const Config& config);

}  // namespace turnpoint::io

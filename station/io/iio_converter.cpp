#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iio.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "station/io/converter.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::io {

namespace {

constexpr double kBlock_s = 0.02;                    // samples come in blocks of this length
constexpr unsigned int kBlocks = 64;                 // the kernel keeps as many
constexpr int kWait_ms = 100;                        // longest wait of read()
constexpr std::int64_t kSilent_ns = 1'000'000'000;   // a device that sends nothing for so long is not usable
constexpr std::int64_t kFarOff_ns = 10'000'000'000;  // between the clock and a stamp of the same clock

struct Free {
  void operator()(iio_context* context) const noexcept { iio_context_destroy(context); }
  void operator()(iio_buffer* buffer) const noexcept { iio_buffer_destroy(buffer); }
};

std::string text_of(const char* text) { return text == nullptr ? "" : text; }

[[noreturn]] void fail(const std::string& device, int error, const std::string& what) {
  const bool refused = error == EACCES || error == EPERM || error == EROFS;
  throw std::system_error(
      error, std::generic_category(),
      fmt::format("iio:{}: {}{}", device, what,
                  refused ? " (deploy/rigs/README.md, Force cells on a converter with a clock "
                            "of its own, says which rights are needed)"
                          : ""));
}

bool is_called(const iio_device* device, const std::string& name) {
  return name == text_of(iio_device_get_id(device)) || name == text_of(iio_device_get_name(device)) ||
         name == text_of(iio_device_get_label(device));
}

std::string listed(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

iio_device* find_device(const iio_context* context, const std::string& name, bool trigger) {
  std::vector<std::string> there;
  iio_device* found = nullptr;
  const char* const what = trigger ? "trigger" : "device";
  for (unsigned int k = 0; k < iio_context_get_devices_count(context); ++k) {
    auto* const device = iio_context_get_device(context, k);
    if (iio_device_is_trigger(device) != trigger) continue;
    const auto called = text_of(iio_device_get_name(device));
    there.push_back(called.empty() ? text_of(iio_device_get_id(device)) : called);
    if (!is_called(device, name)) continue;
    if (found != nullptr)
      throw std::runtime_error(
          fmt::format("iio:{0}: two {1}s have this name; use the label or the number of one "
                      "of them, such as {2}",
                      name, what, iio_device_get_id(device)));
    found = device;
  }
  if (found == nullptr)
    throw std::runtime_error(
        fmt::format("iio:{}: there is no such {}; there are: {}", name, what, listed(there)));
  return found;
}

iio_channel* find_channel(const iio_device* device, const std::string& device_name, const std::string& name) {
  std::vector<std::string> there;
  for (unsigned int k = 0; k < iio_device_get_channels_count(device); ++k) {
    auto* const channel = iio_device_get_channel(device, k);
    if (iio_channel_is_output(channel) || !iio_channel_is_scan_element(channel)) continue;
    const auto id = text_of(iio_channel_get_id(channel));
    if (id == name || text_of(iio_channel_get_name(channel)) == name) return channel;
    if (id != "timestamp") there.push_back(id);
  }
  if (there.empty())
    throw std::runtime_error(
        fmt::format("iio:{}: the driver of this device has no buffer, so it cannot be read at a steady rate",
                    device_name));
  throw std::runtime_error(
      name == "timestamp" ? fmt::format("iio:{}: the buffer of this device has no time stamps", device_name)
                          : fmt::format("iio:{}: there is no channel \"{}\"; there are: {}", device_name,
                                        name, listed(there)));
}

double attribute(const iio_channel* channel, const char* name, double otherwise) {
  double value = otherwise;
  return iio_channel_find_attr(channel, name) != nullptr &&
                 iio_channel_attr_read_double(channel, name, &value) == 0
             ? value
             : otherwise;
}

/// A channel, and how its bytes become a value.
struct Input {
  iio_channel* channel = nullptr;
  double offset = 0, scale = 1;
  double lowest = 0, highest = 0;

  explicit Input(iio_channel* opened) : channel(opened) {
    offset = attribute(channel, "offset", 0);
    scale = attribute(channel, "scale", 1);
    const auto* format = iio_channel_get_data_format(channel);
    const double codes = std::ldexp(1, static_cast<int>(format->bits));
    lowest = format->is_signed ? -codes / 2 : 0;
    highest = lowest + codes - 1;
  }

  double raw(const void* bytes) const {
    const auto* format = iio_channel_get_data_format(channel);
    unsigned char host[8] = {};
    iio_channel_convert(channel, host, bytes);
    const auto as = [&host](auto number) {
      std::memcpy(&number, host, sizeof number);
      return static_cast<double>(number);
    };
    switch (format->length) {
      case 8:
        return format->is_signed ? as(std::int8_t{}) : as(std::uint8_t{});
      case 16:
        return format->is_signed ? as(std::int16_t{}) : as(std::uint16_t{});
      case 32:
        return format->is_signed ? as(std::int32_t{}) : as(std::uint32_t{});
      default:
        return format->is_signed ? as(std::int64_t{}) : as(std::uint64_t{});
    }
  }
};

class KernelConverter : public Converter {
 public:
  explicit KernelConverter(Config config) : config_(std::move(config)) {
    context_.reset(iio_create_local_context());
    if (!context_) {
      if (errno == ENOENT || errno == ENODEV)
        throw std::runtime_error(
            fmt::format("iio:{}: there is no such device; the kernel has no IIO devices", config_.device));
      fail(config_.device, errno, "the IIO devices cannot be read");
    }
    device_ = find_device(context_.get(), config_.device, false);
    id_ = iio_device_get_id(device_);
    for (unsigned int k = 0; k < iio_device_get_channels_count(device_); ++k)
      iio_channel_disable(iio_device_get_channel(device_, k));
    for (const auto& name : config_.channels)
      inputs_.emplace_back(find_channel(device_, config_.device, name));
    stamp_ = find_channel(device_, config_.device, "timestamp");
    set_clock();
    set_trigger();
    set_rate();
    for (const auto& input : inputs_) iio_channel_enable(input.channel);
    iio_channel_enable(stamp_);
    start();
  }

  std::vector<Sample> read() override {
    pollfd wait{descriptor_, POLLIN, 0};
    if (::poll(&wait, 1, kWait_ms) < 0 && errno != EINTR) fail(config_.device, errno, "reading");
    std::vector<Sample> samples;
    if (wait.revents != 0) {
      const auto bytes = iio_buffer_refill(buffer_.get());
      if (bytes < 0 && bytes != -EAGAIN) fail(config_.device, static_cast<int>(-bytes), "reading");
      if (bytes > 0) samples = taken();
    }
    const auto now_ns = system::monotonic_ns();
    if (samples.empty()) {
      look_for_life(now_ns);
      return samples;
    }
    if (std::abs(samples.back().time_ns - now_ns) > kFarOff_ns)
      throw std::runtime_error(fmt::format(
          "iio:{}: the time stamps are {:.1f} s off CLOCK_MONOTONIC; the driver uses a clock of its own",
          config_.device, 1e-9 * static_cast<double>(samples.back().time_ns - now_ns)));
    heard_ns_ = now_ns;
    return samples;
  }

 private:
  void set_clock() {
    if (const auto error = iio_device_attr_write(device_, "current_timestamp_clock", "monotonic"); error < 0)
      fail(config_.device, static_cast<int>(-error), "the clock of its time stamps cannot be set");
  }

  void set_trigger() {
    if (config_.trigger.empty()) return;
    trigger_ = find_device(context_.get(), config_.trigger, true);
    if (const auto error = iio_device_set_trigger(device_, trigger_); error < 0)
      fail(config_.device, -error, fmt::format("trigger \"{}\" cannot be used", config_.trigger));
  }

  void set_rate() {
    if (config_.sampling_frequency.empty()) return;
    constexpr const char* name = "sampling_frequency";
    const auto written = [&](ssize_t error) {
      if (error < 0)
        fail(config_.device, static_cast<int>(-error),
             fmt::format("{} cannot be set to {}", name, config_.sampling_frequency));
    };
    const char* const value = config_.sampling_frequency.c_str();
    bool any = true;
    if (trigger_ != nullptr && iio_device_find_attr(trigger_, name) != nullptr)
      written(iio_device_attr_write(trigger_, name, value));
    else if (iio_device_find_attr(device_, name) != nullptr)
      written(iio_device_attr_write(device_, name, value));
    else
      any = false;
    if (any) return;
    for (const auto& input : inputs_) {
      if (iio_channel_find_attr(input.channel, name) == nullptr) continue;
      written(iio_channel_attr_write(input.channel, name, value));
      any = true;
    }
    if (!any) throw std::runtime_error(fmt::format("iio:{}: the device has no {}", config_.device, name));
  }

  void start() {
    const auto block = static_cast<std::size_t>(std::max(1.0, std::round(kBlock_s * config_.rate_Hz)));
    iio_device_set_kernel_buffers_count(device_, kBlocks);
    buffer_.reset(iio_device_create_buffer(device_, block, false));
    if (!buffer_) {
      const int error = errno;
      fail(config_.device, error,
           error == EBUSY    ? "another program reads this device"
           : error == EINVAL ? "the buffer cannot be started; most devices need a trigger for it"
                             : "the buffer cannot be started");
    }
    iio_buffer_set_blocking_mode(buffer_.get(), false);
    descriptor_ = iio_buffer_get_poll_fd(buffer_.get());
    if (descriptor_ < 0) fail(config_.device, -descriptor_, "the buffer cannot be waited for");
    heard_ns_ = system::monotonic_ns();
  }

  std::vector<Sample> taken() const {
    std::vector<Sample> samples;
    const auto step = iio_buffer_step(buffer_.get());
    const auto* const end = static_cast<const char*>(iio_buffer_end(buffer_.get()));
    std::array<const char*, channel_count> at{};
    for (std::size_t k = 0; k < inputs_.size(); ++k)
      at[k] = static_cast<const char*>(iio_buffer_first(buffer_.get(), inputs_[k].channel));
    const auto* stamp = static_cast<const char*>(iio_buffer_first(buffer_.get(), stamp_));
    for (; stamp < end; stamp += step) {
      auto& sample = samples.emplace_back();
      iio_channel_convert(stamp_, &sample.time_ns, stamp);
      for (std::size_t k = 0; k < inputs_.size(); ++k) {
        const auto& input = inputs_[k];
        const double raw = input.raw(at[k]);
        sample.value[k] = (raw + input.offset) * input.scale;
        sample.at_limit[k] = raw <= input.lowest || raw >= input.highest;
        at[k] += step;
      }
    }
    return samples;
  }

  /// A device that was removed does not wake up its readers in every kernel.
  void look_for_life(std::int64_t now_ns) const {
    if (::access(("/sys/bus/iio/devices/" + id_).c_str(), F_OK) != 0)
      fail(config_.device, ENODEV, "the device was disconnected");
    if (now_ns - heard_ns_ > kSilent_ns + static_cast<std::int64_t>(2e9 * kBlock_s))
      throw std::runtime_error(
          fmt::format("iio:{}: the device sends no samples; check its trigger", config_.device));
  }

  const Config config_;
  std::unique_ptr<iio_context, Free> context_;
  iio_device* device_ = nullptr;
  const iio_device* trigger_ = nullptr;
  std::string id_;
  std::vector<Input> inputs_;
  iio_channel* stamp_ = nullptr;
  std::unique_ptr<iio_buffer, Free> buffer_;
  int descriptor_ = -1;
  std::int64_t heard_ns_ = 0;
};

}  // namespace

std::unique_ptr<Converter> open(const Config& config) { return std::make_unique<KernelConverter>(config); }

}  // namespace turnpoint::io

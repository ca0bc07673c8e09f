#include "station/drive/output.hpp"

#include <fmt/format.h>

#include "station/drive/alsa_output.hpp"
#include "station/drive/wav_output.hpp"
#include "station/terms/usage_error.hpp"

namespace turnpoint::drive {
namespace {

class NullOutput final : public Output {
 public:
  explicit NullOutput(OutputConfig config) : config_(std::move(config)) {}
  const OutputConfig& config() const noexcept override { return config_; }
  WriteResult write(std::span<const std::int32_t>) noexcept override { return {}; }
  std::optional<Position> position() noexcept override { return std::nullopt; }
  void finish() override {}
  bool paced() const noexcept override { return false; }

 private:
  OutputConfig config_;
};

}  // namespace

Format format_of(const OutputConfig& config) noexcept {
  return {config.rate_Hz, config.channels, config.bits};
}

std::unique_ptr<Output> open_output(const OutputConfig& config) {
  if (config.period_frames < 16 || config.period_frames > 65536 || config.periods < 2 || config.periods > 64)
    throw terms::UsageError(
        fmt::format("output with {} periods of {} frames; allowed are 2 to 64 periods of 16 to 65536 frames",
                    config.periods, config.period_frames));
  const auto colon = config.uri.find(':');
  const std::string scheme = config.uri.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : config.uri.substr(colon + 1);
  if (scheme == "null" && colon != std::string::npos && rest.empty())
    return std::make_unique<NullOutput>(config);
  if (scheme == "wav" && !rest.empty()) return open_wav(config, rest);
  if (scheme == "alsa" && !rest.empty()) return open_alsa(config, rest);
  throw terms::UsageError(fmt::format("output '{}'; allowed are null:, wav:FILE and alsa:NAME", config.uri));
}

}  // namespace turnpoint::drive

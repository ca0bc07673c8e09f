#include "station/drive/wav_output.hpp"

#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <exception>
#include <optional>
#include <system_error>

#include "station/system/write_file.hpp"

namespace turnpoint::drive {
namespace {

static_assert(std::endian::native == std::endian::little, "RIFF files are little-endian");

constexpr std::size_t header_bytes = 68;
constexpr std::uint64_t most_bytes = 0xffffffffu - header_bytes;

template <typename T>
void put(std::array<char, header_bytes>& header, std::size_t at, T value) {
  std::memcpy(header.data() + at, &value, sizeof value);
}

std::array<char, header_bytes> header_of(const OutputConfig& config, std::uint32_t data_bytes) {
  std::array<char, header_bytes> h{};
  // The GUID KSDATAFORMAT_SUBTYPE_PCM without its first two bytes, which are the format tag.
  constexpr unsigned char pcm_tail[14] = {0, 0, 0, 0, 0x10, 0, 0x80, 0, 0, 0xaa, 0, 0x38, 0x9b, 0x71};
  const auto channels = static_cast<std::uint16_t>(config.channels);
  const auto rate = static_cast<std::uint32_t>(config.rate_Hz);
  std::memcpy(h.data(), "RIFF", 4);
  put(h, 4, static_cast<std::uint32_t>(header_bytes - 8 + data_bytes));
  std::memcpy(h.data() + 8, "WAVEfmt ", 8);
  put(h, 16, std::uint32_t{40});
  put(h, 20, std::uint16_t{0xfffe});
  put(h, 22, channels);
  put(h, 24, rate);
  put(h, 28, rate * channels * 4u);
  put(h, 32, static_cast<std::uint16_t>(channels * 4));
  put(h, 34, std::uint16_t{32});
  put(h, 36, std::uint16_t{22});
  put(h, 38, static_cast<std::uint16_t>(config.bits));
  put(h, 44, std::uint16_t{1});
  std::memcpy(h.data() + 46, pcm_tail, sizeof pcm_tail);
  std::memcpy(h.data() + 60, "data", 4);
  put(h, 64, data_bytes);
  return h;
}

class WavOutput final : public Output {
 public:
  WavOutput(OutputConfig config, const std::string& path)
      : config_(std::move(config)), path_(path), file_(path) {
    const auto header = header_of(config_, 0);
    file_->write({header.data(), header.size()});
  }

  // A session that was interrupted keeps what it has played so far.
  ~WavOutput() override {
    try {
      finish();
    } catch (const std::exception&) {
      // whoever wants to know calls finish()
    }
  }

  const OutputConfig& config() const noexcept override { return config_; }
  bool paced() const noexcept override { return false; }
  std::optional<Position> position() noexcept override { return std::nullopt; }

  WriteResult write(std::span<const std::int32_t> interleaved) noexcept override {
    if (error_ == 0 && data_bytes_ + interleaved.size_bytes() > most_bytes) error_ = EFBIG;
    if (error_ == 0) error_ = written(interleaved);
    if (error_ != 0)
      return {WriteStatus::lost, -error_, 0,
              static_cast<std::int64_t>(interleaved.size()) / config_.channels};
    data_bytes_ += interleaved.size_bytes();
    return {};
  }

  void finish() override {
    if (!file_) return;
    auto file = std::move(*file_);
    file_.reset();
    if (error_ != 0) throw std::system_error(error_, std::generic_category(), "wav:" + path_);
    const auto header = header_of(config_, static_cast<std::uint32_t>(data_bytes_));
    file.write_start({header.data(), header.size()});
    file.commit();
  }

 private:
  /// Returns 0 or the errno.
  int written(std::span<const std::int32_t> interleaved) noexcept try {
    file_->write({reinterpret_cast<const char*>(interleaved.data()), interleaved.size_bytes()});
    return 0;
  } catch (const std::system_error& error) {
    return error.code().value();
  }

  OutputConfig config_;
  std::string path_;
  std::optional<system::FileWriter> file_;  ///< empty after finish()
  int error_ = 0;
  std::uint64_t data_bytes_ = 0;
};

}  // namespace

std::unique_ptr<Output> open_wav(const OutputConfig& config, const std::string& path) {
  return std::make_unique<WavOutput>(config, path);
}

}  // namespace turnpoint::drive

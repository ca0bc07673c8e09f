#include "station/cli/tones.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include "station/cli/command.hpp"

namespace turnpoint::cli {

namespace {

std::optional<double> parse_number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

}  // namespace

physics::Tone parse_tone(const std::string& text) {
  const auto parts = split(text, ':');
  std::vector<double> numbers;
  for (const auto& part : parts)
    if (const auto number = parse_number(part)) numbers.push_back(*number);
  if (parts.size() > 3 || numbers.size() != parts.size() || numbers[0] <= 0 ||
      (numbers.size() > 1 && numbers[1] < 0))
    throw UsageError(
        fmt::format("--tone {}: this is not a tone; write HZ[:UM[:DEG]] with HZ above 0 and UM 0 or more, as "
                    "in 30000:0.5:90",
                    text));
  physics::Tone tone;
  tone.frequency_Hz = numbers[0];
  tone.amplitude_m = 1e-6 * (numbers.size() > 1 ? numbers[1] : 1.0);
  tone.phase_rad = numbers.size() > 2 ? numbers[2] * std::numbers::pi / 180 : 0;
  return tone;
}

std::vector<physics::Tone> parse_tones(const std::vector<std::string>& texts) {
  std::vector<physics::Tone> tones;
  for (const auto& text : texts) tones.push_back(parse_tone(text));
  return tones;
}

std::vector<double> parse_list(const std::string& text, const std::string& option) {
  std::vector<double> numbers;
  for (const auto& part : split(text, ',')) {
    const auto number = parse_number(part);
    if (!number)
      throw UsageError(
          fmt::format("{} {}: \"{}\" is not a number; write numbers separated by commas, as in 10,20.5",
                      option, text, part));
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace turnpoint::cli

#include "station/system/thermometer.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace turnpoint::system {

namespace {

constexpr std::string_view kHwmonScheme = "hwmon:";

std::string first_line(const std::filesystem::path& path) {
  std::string line;
  std::ifstream file(path);
  std::getline(file, line);
  return line;
}

/// Returns the name of the device behind a sensor's folder, such as 1-0048; "" if it has none.
std::string device_of(const std::filesystem::path& folder) {
  std::error_code none;
  const auto target = std::filesystem::canonical(folder / "device", none);
  return none ? "" : target.filename().string();
}

}  // namespace

std::string find_thermometer(const std::string& uri, const std::string& root) {
  const auto slash = uri.find('/');
  if (!uri.starts_with(kHwmonScheme) || slash == std::string::npos)
    throw std::runtime_error(uri + ": a temperature sensor is written hwmon:NAME/tempN");
  auto name = uri.substr(kHwmonScheme.size(), slash - kHwmonScheme.size());
  const auto input = uri.substr(slash + 1) + "_input";
  std::string device;
  if (const auto at = name.find('@'); at != std::string::npos)
    device = name.substr(at + 1), name = name.substr(0, at);
  std::vector<std::string> fitting;
  std::string all;
  std::error_code none;
  for (const auto& chip : std::filesystem::directory_iterator(root, none)) {
    const auto its_name = first_line(chip.path() / "name"), its_device = device_of(chip.path());
    if (its_name.empty()) continue;
    all += (all.empty() ? "" : ", ") + its_name + (its_device.empty() ? "" : "@" + its_device);
    if (its_name == name && (device.empty() || its_device == device) &&
        std::filesystem::exists(chip.path() / input, none))
      fitting.push_back((chip.path() / input).string());
  }
  if (fitting.size() == 1) return fitting.front();
  throw std::runtime_error(uri + ": " + std::to_string(fitting.size()) + " temperature sensors fit; " + root +
                           " has " + (all.empty() ? "none" : all));
}

std::optional<double> read_thermometer_C(const std::string& file) {
  std::ifstream in(file);
  double thousandths = 0;
  if (!(in >> thousandths) || thousandths < -50'000 || thousandths > 150'000) return std::nullopt;
  return 1e-3 * thousandths;
}

}  // namespace turnpoint::system

#include "station/system/thermometer.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

namespace turnpoint::system {

namespace {

std::string first_line(const std::filesystem::path& path) {
  std::string line;
  std::ifstream file(path);
  std::getline(file, line);
  return line;
}

constexpr std::string_view kRaw = "_raw";

/// A subsystem of the kernel that has thermometers, with the folders in which it lists its devices.
struct Subsystem {
  std::string_view scheme;
  std::string root;

  bool iio() const { return scheme == "iio:"; }

  /// Returns the name of the device behind a sensor's folder, such as 1-0048; "" if it has none.
  std::string device_of(const std::filesystem::path& folder) const {
    std::error_code none;
    const auto target = std::filesystem::canonical(iio() ? folder : folder / "device", none);
    if (none) return "";
    return (iio() ? target.parent_path() : target).filename().string();
  }

  /// Returns the file of a sensor's input; "" if the sensor has no such input. With IIO, some drivers only
  /// give the converter's number.
  std::string file_of(const std::filesystem::path& folder, const std::string& input) const {
    std::error_code none;
    for (const std::string_view ending : {std::string_view("_input"), kRaw}) {
      if (ending == kRaw && !iio()) break;
      const auto file = folder / ((iio() ? "in_" : "") + input + std::string(ending));
      if (std::filesystem::exists(file, none)) return file.string();
    }
    return "";
  }
};

}  // namespace

std::string find_thermometer(const std::string& uri, const std::string& hwmon, const std::string& iio) {
  const auto slash = uri.find('/');
  const Subsystem of = uri.starts_with("iio:") ? Subsystem{"iio:", iio} : Subsystem{"hwmon:", hwmon};
  if (!uri.starts_with(of.scheme) || slash == std::string::npos)
    throw std::runtime_error(uri + ": a temperature sensor is written hwmon:NAME/tempN or iio:NAME/temp");
  auto name = uri.substr(of.scheme.size(), slash - of.scheme.size());
  std::string device;
  if (const auto at = name.find('@'); at != std::string::npos)
    device = name.substr(at + 1), name = name.substr(0, at);
  std::vector<std::string> fitting;
  std::string all;
  std::error_code none;
  for (const auto& chip : std::filesystem::directory_iterator(of.root, none)) {
    const auto its_name = first_line(chip.path() / "name"), its_device = of.device_of(chip.path());
    if (its_name.empty()) continue;
    all += (all.empty() ? "" : ", ") + its_name + (its_device.empty() ? "" : "@" + its_device);
    if (its_name != name || (!device.empty() && its_device != device)) continue;
    if (auto file = of.file_of(chip.path(), uri.substr(slash + 1)); !file.empty())
      fitting.push_back(std::move(file));
  }
  if (fitting.size() == 1) return fitting.front();
  throw std::runtime_error(uri + ": " + std::to_string(fitting.size()) + " temperature sensors fit; " +
                           of.root + " has " + (all.empty() ? "none" : all));
}

std::optional<double> read_thermometer_C(const std::string& file) {
  const auto number_in = [](const std::string& path) -> std::optional<double> {
    std::ifstream in(path);
    double number = 0;
    return in >> number ? std::optional(number) : std::nullopt;
  };
  auto thousandths = number_in(file);
  if (thousandths && file.ends_with(kRaw)) {
    const auto stem = file.substr(0, file.size() - kRaw.size());
    const auto scale = number_in(stem + "_scale");
    if (!scale) return std::nullopt;
    *thousandths = (*thousandths + number_in(stem + "_offset").value_or(0)) * *scale;
  }
  if (!thousandths || *thousandths < -50'000 || *thousandths > 150'000) return std::nullopt;
  return 1e-3 * *thousandths;
}

}  // namespace turnpoint::system

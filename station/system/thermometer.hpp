#pragma once
#include <optional>
#include <string>

namespace turnpoint::system {

/// Returns the file of a temperature sensor of the kernel. `uri` is hwmon:NAME/tempN, where NAME is what the
/// file `name` of the sensor's folder contains (such as lm75). If several have that name, write
/// hwmon:NAME@DEVICE/tempN with the name of the device, such as 1-0048. `root` is where the kernel lists the
/// sensors. Throws std::runtime_error, with the devices to choose from, if not exactly one sensor fits.
std::string find_thermometer(const std::string& uri, const std::string& root = "/sys/class/hwmon");

/// Reads the temperature (degrees Celsius) from a file that find_thermometer() returned; empty if the sensor
/// does not answer, or reports a temperature outside of -50 to 150.
std::optional<double> read_thermometer_C(const std::string& file);

}  // namespace turnpoint::system

#pragma once
#include <optional>
#include <string>

namespace turnpoint::system {

/// Returns the file of a temperature sensor of the kernel. `uri` is hwmon:NAME/tempN, where NAME is what the
/// file `name` of the sensor's folder contains (such as lm75), or iio:NAME/temp for a sensor of the subsystem
/// IIO; such a sensor may have several channels, such as temp_object. If several have that name, write
/// NAME@DEVICE with the name of the device, such as 1-0048. `hwmon` and `iio` are where the kernel lists the
/// sensors. Throws std::runtime_error, with the devices to choose from, if not exactly one sensor fits.
std::string find_thermometer(const std::string& uri, const std::string& hwmon = "/sys/class/hwmon",
                             const std::string& iio = "/sys/bus/iio/devices");

/// Reads the temperature (degrees Celsius) from a file that find_thermometer() returned; empty if the sensor
/// does not answer, or reports a temperature outside of -50 to 150.
std::optional<double> read_thermometer_C(const std::string& file);

}  // namespace turnpoint::system

#include "station/rig/pick_up_fit.hpp"

#include <algorithm>
#include <cmath>

#include "station/core/least_squares.hpp"
#include "station/core/number.hpp"
#include "station/core/pole_fit.hpp"
#include "station/core/texts.hpp"

namespace turnpoint::rig {

namespace {

using core::phrase, core::plain, core::Refusal;

// A scatter of more than 15 % cannot be noise of the instrument. It means a wrong unit, place or sensor.
constexpr double kMostScatter = 0.15;
constexpr std::size_t kLeastForPatch = 5;
// Limits of the exponent of a patch. A patch responds to bending, which is proportional to the square of the
// wave number: exponent 1 in a plate, 2 in a membrane, and less if the patch is not short compared with the
// wavelength. An exponent outside these limits means that something else was measured.
constexpr double kLeastExponent = -1, kMostExponent = 4;

double amplitude_at(const PickUpResponse& response, double frequency_Hz) {
  const auto& points = response.points;
  const auto above = std::find_if(points.begin(), points.end(),
                                  [=](const auto& p) { return p.frequency_Hz >= frequency_Hz; });
  if (points.empty() || above == points.end() || frequency_Hz < points.front().frequency_Hz)
    throw Refusal(phrase("fitted.outside_sweep",
                         {plain(core::number(frequency_Hz)),
                          plain(core::number(points.empty() ? 0 : points.front().frequency_Hz)),
                          plain(core::number(points.empty() ? 0 : points.back().frequency_Hz))}));
  if (above == points.begin()) return above->amplitude;
  const auto below = above - 1;
  const double u = (frequency_Hz - below->frequency_Hz) / (above->frequency_Hz - below->frequency_Hz);
  return below->amplitude + u * (above->amplitude - below->amplitude);
}

struct ScaleRows {
  std::vector<std::vector<double>> rows;
  std::vector<double> logs, weights;
};

/// Returns the rows of a linear fit: ln(um per full scale of the capture) at each measured frequency as a
/// function of ln(frequency / at_Hz).
ScaleRows scale_rows(const PickUp& pick_up, const std::vector<DisplacementPoint>& table, double at_Hz) {
  ScaleRows made;
  for (const auto& point : table) {
    const double captured = amplitude_at(pick_up.response, point.frequency_Hz);
    if (!(point.um_per_full_scale > 0))
      throw Refusal(phrase("fitted.not_positive", {plain(core::number(point.frequency_Hz))}));
    made.rows.push_back({1, -std::log(point.frequency_Hz / at_Hz)});
    made.logs.push_back(std::log(point.um_per_full_scale / captured));
    made.weights.push_back(1);
  }
  return made;
}

void check_scatter(const std::vector<double>& residuals, std::size_t parameters) {
  double sum = 0;
  for (const double r : residuals) sum += r * r;
  const auto free = static_cast<double>(residuals.size() - parameters);
  const double scatter = free > 0 ? std::sqrt(sum / free) : 0;
  if (scatter > kMostScatter)
    throw Refusal(phrase("fitted.scatter", {plain(core::number(100 * scatter, 2))}));
}

}  // namespace

std::string_view name(PickUpSensor sensor) {
  return sensor == PickUpSensor::patch ? "patch" : "accelerometer";
}

std::optional<PickUpSensor> find_sensor(std::string_view word) {
  for (const auto sensor : {PickUpSensor::patch, PickUpSensor::accelerometer})
    if (word == name(sensor)) return sensor;
  return std::nullopt;
}

double PickUpScale::at(double frequency_Hz) const {
  return um_per_full_scale * std::pow(frequency_Hz / at_Hz, -exponent);
}

PickUp fit_pick_up(int channel, int drive_channel, const std::vector<SweptPoint>& sweep, double noise) {
  std::vector<double> frequencies;
  std::vector<std::complex<double>> responses;
  for (const auto& point : sweep) {
    frequencies.push_back(point.frequency_Hz);
    responses.push_back(point.response);
  }
  const auto fit = core::fit_poles(frequencies, responses, noise);
  PickUp made;
  made.response.channel = channel, made.response.drive_channel = drive_channel;
  const bool good = fit.residual <= 2 * noise;
  double largest = 0, sd = noise;
  if (good) sd = *std::max_element(fit.fitted_sd.begin(), fit.fitted_sd.end());
  for (std::size_t k = 0; k < sweep.size(); ++k) {
    const auto value = good ? fit.fitted[k] : responses[k];
    made.response.points.push_back({frequencies[k], std::abs(value), std::arg(value)});
    largest = std::max(largest, std::abs(value));
  }
  if (!(largest > 0)) throw Refusal(phrase("fitted.nothing", {plain(channel)}));
  made.response_sd = sd / largest;
  for (const auto& pole : fit.resonances())
    made.resonances.push_back(
        {pole.frequency_Hz, pole.quality_factor, pole.frequency_sd_Hz, pole.quality_sd});
  return made;
}

PickUpScale fit_scale(const PickUp& pick_up, PickUpSensor sensor, const std::vector<DisplacementPoint>& table,
                      double instrument_sd) {
  const auto least = sensor == PickUpSensor::patch ? kLeastForPatch : 1;
  if (table.size() < least)
    throw Refusal(
        phrase(sensor == PickUpSensor::patch ? "fitted.few_for_patch" : "fitted.few_for_accelerometer",
               {plain(table.size()), plain(least)}));
  double sum = 0;
  for (const auto& point : table) sum += std::log(point.frequency_Hz);
  PickUpScale scale;
  scale.sensor = sensor;
  scale.at_Hz = std::exp(sum / static_cast<double>(table.size()));
  const auto [rows, logs, weights] = scale_rows(pick_up, table, scale.at_Hz);
  std::vector<double> residuals;
  double fit_sd = 0;
  if (sensor == PickUpSensor::patch) {
    const auto fit = core::least_squares(rows, logs, weights);
    scale.um_per_full_scale = std::exp(fit.value[0]), scale.exponent = fit.value[1];
    for (std::size_t k = 0; k < rows.size(); ++k) {
      residuals.push_back(logs[k] - fit.value[0] - fit.value[1] * rows[k][1]);
      fit_sd = std::max(fit_sd, std::hypot(fit.sd[0], fit.sd[1] * rows[k][1]));
    }
    check_scatter(residuals, 2);
    if (scale.exponent < kLeastExponent || scale.exponent > kMostExponent)
      throw Refusal(phrase("fitted.exponent", {plain(core::number(scale.exponent, 2))}));
  } else {
    scale.exponent = 2;
    double mean = 0;
    for (std::size_t k = 0; k < rows.size(); ++k)
      mean += (logs[k] - 2 * rows[k][1]) / static_cast<double>(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
      residuals.push_back(logs[k] - 2 * rows[k][1] - mean);
      fit_sd += residuals.back() * residuals.back();
    }
    check_scatter(residuals, 1);
    scale.um_per_full_scale = std::exp(mean);
    const auto n = static_cast<double>(rows.size());
    fit_sd = n > 1 ? std::sqrt(fit_sd / (n - 1) / n) : 0;
  }
  scale.sd = std::hypot(fit_sd, instrument_sd, pick_up.response_sd);
  return scale;
}

}  // namespace turnpoint::rig

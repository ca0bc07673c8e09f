#include "station/sensing/pick_up.hpp"

#include <algorithm>
#include <cmath>

namespace turnpoint::sensing {

namespace {

const Transfer* transfer_of(const PickUp& pick_up, int drive_channel) {
  for (const Transfer& transfer : pick_up.transfers)
    if (transfer.drive_channel == drive_channel) return &transfer;
  return nullptr;
}

// Index of the last calibration point that is not above the frequency; empty outside of the calibrated range.
std::optional<std::size_t> place(const Transfer& transfer, double frequency_Hz) {
  const auto& f = transfer.frequency_Hz;
  if (f.size() < 2 || !(frequency_Hz >= f.front() && frequency_Hz <= f.back())) return std::nullopt;
  const auto above = std::upper_bound(f.begin(), f.end(), frequency_Hz);
  return std::min(static_cast<std::size_t>(above - f.begin()), f.size() - 1) - 1;
}

}  // namespace

std::optional<std::complex<double>> response(const PickUp& pick_up, int drive_channel, double frequency_Hz) {
  const Transfer* transfer = transfer_of(pick_up, drive_channel);
  if (transfer == nullptr) return std::nullopt;
  const auto below = place(*transfer, frequency_Hz);
  if (!below) return std::nullopt;
  const auto& f = transfer->frequency_Hz;
  const std::size_t points = std::min<std::size_t>(4, f.size());
  const std::size_t first = std::min(*below > 0 ? *below - 1 : 0, f.size() - points);
  std::complex<double> sum = 0;  // Lagrange interpolation between the points
  for (std::size_t i = first; i < first + points; ++i) {
    double weight = 1;
    for (std::size_t j = first; j < first + points; ++j)
      if (j != i) weight *= (frequency_Hz - f[j]) / (f[i] - f[j]);
    sum += weight * transfer->response[i];
  }
  return sum;
}

double best_response(const PickUp& pick_up) {
  double best = 0;
  for (const Transfer& transfer : pick_up.transfers)
    for (const auto& value : transfer.response) best = std::max(best, std::abs(value));
  return best;
}

double group_delay_s(const PickUp& pick_up, int drive_channel, double frequency_Hz) {
  const Transfer* transfer = transfer_of(pick_up, drive_channel);
  if (transfer == nullptr) return 0;
  const auto below = place(*transfer, frequency_Hz);
  if (!below) return 0;
  const auto& f = transfer->frequency_Hz;
  const double half = (f[*below + 1] - f[*below]) / 2;
  const double low = std::max(f.front(), frequency_Hz - half), high = std::min(f.back(), frequency_Hz + half);
  const auto turn =
      *response(pick_up, drive_channel, high) * std::conj(*response(pick_up, drive_channel, low));
  return -std::arg(turn) / (2 * M_PI * (high - low));
}

}  // namespace turnpoint::sensing

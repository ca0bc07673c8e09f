#include "station/sensing/joint_fit.hpp"

#include <algorithm>
#include <cmath>

#include "station/audio/sine.hpp"

namespace turnpoint::sensing {

namespace {

// Returns the sum of e^(i (phase + n increment)) over n = 0 ... frames - 1.
std::complex<double> geometric_sum(std::uint64_t phase, std::uint64_t increment, std::int64_t frames) {
  const double half_turn = M_PI * 0x1p-64 * static_cast<double>(static_cast<std::int64_t>(increment));
  const double s = std::sin(half_turn), count = static_cast<double>(frames);
  const double length = std::fabs(s) < 1e-15 ? count : std::sin(count * half_turn) / s;
  const double start = 2 * M_PI * 0x1p-64 * static_cast<double>(phase);
  return std::polar(1.0, start + (count - 1) * half_turn) * length;
}

}  // namespace

JointFit::JointFit(std::size_t most_tones)
    : stride_(2 * most_tones), matrix_(stride_ * stride_), right_(stride_), solution_(stride_) {}

// Unknowns 2t and 2t + 1 are the coefficients of sin and cos of tone t.
bool JointFit::prepare(std::span<const std::uint64_t> phase, std::span<const std::uint64_t> increment,
                       std::int64_t frames) noexcept {
  unknowns_ = 2 * phase.size();
  for (std::size_t i = 0; i < phase.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const auto difference = geometric_sum(phase[i] - phase[j], increment[i] - increment[j], frames);
      const auto sum = geometric_sum(phase[i] + phase[j], increment[i] + increment[j], frames);
      entry(2 * i, 2 * j) = (difference.real() - sum.real()) / 2;
      entry(2 * i, 2 * j + 1) = (sum.imag() + difference.imag()) / 2;
      entry(2 * i + 1, 2 * j) = (sum.imag() - difference.imag()) / 2;
      entry(2 * i + 1, 2 * j + 1) = (difference.real() + sum.real()) / 2;
    }
  return factorise();
}

bool JointFit::prepare(std::span<const double> normal_matrix, std::size_t tones) noexcept {
  unknowns_ = 2 * tones;
  for (std::size_t i = 0; i < unknowns_; ++i)
    for (std::size_t j = 0; j <= i; ++j) entry(i, j) = normal_matrix[i * unknowns_ + j];
  return factorise();
}

bool JointFit::factorise() noexcept {
  for (std::size_t i = 0; i < unknowns_; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const double before = entry(i, j);
      double value = before;
      for (std::size_t k = 0; k < j; ++k) value -= entry(i, k) * entry(j, k);
      if (j < i)
        entry(i, j) = value / entry(j, j);
      else if (value > 1e-3 * before)  // with a smaller pivot, noise would grow thirtyfold
        entry(i, i) = std::sqrt(value);
      else
        return false;
    }
  return true;
}

double JointFit::solve(std::span<const std::complex<double>> sums, double energy,
                       std::span<std::complex<double>> amplitude) noexcept {
  for (std::size_t t = 0; t < sums.size(); ++t) {
    right_[2 * t] = sums[t].real();
    right_[2 * t + 1] = sums[t].imag();
  }
  double explained = 0;
  for (std::size_t i = 0; i < unknowns_; ++i) {
    double value = right_[i];
    for (std::size_t k = 0; k < i; ++k) value -= entry(i, k) * solution_[k];
    solution_[i] = value / entry(i, i);
    explained += solution_[i] * solution_[i];
  }
  for (std::size_t i = unknowns_; i-- > 0;) {
    double value = solution_[i];
    for (std::size_t k = i + 1; k < unknowns_; ++k) value -= entry(k, i) * solution_[k];
    solution_[i] = value / entry(i, i);
  }
  for (std::size_t t = 0; t < sums.size(); ++t) amplitude[t] = {solution_[2 * t], solution_[2 * t + 1]};
  return std::max(0.0, energy - explained);
}

}  // namespace turnpoint::sensing

#pragma once
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace turnpoint::sensing {

/// Least squares of several sinusoids of known frequencies over a window of frames, all together, so that
/// they do not leak into each other. It needs only the sums of products with each sinusoid (ToneSums::plain)
/// and of squares: the normal matrix is a closed formula. Allocates only in its constructor.
class JointFit {
 public:
  explicit JointFit(std::size_t most_tones);

  /// Prepares for a window of `frames` at whose first frame the tones have these phases (2^-64 cycles).
  /// Returns false if the window is too short to tell the tones apart.
  [[nodiscard]] bool prepare(std::span<const std::uint64_t> phase, std::span<const std::uint64_t> increment,
                             std::int64_t frames) noexcept;

  /// Complex amplitudes A e^(i theta) of signals A sin(phase + theta). `sums[t]` is the sum of sample times
  /// i e^(-i phase) of tone t. Returns what remains of `energy`, the sum of squares, without the tones.
  double solve(std::span<const std::complex<double>> sums, double energy,
               std::span<std::complex<double>> amplitude) noexcept;

 private:
  double& entry(std::size_t row, std::size_t column) noexcept { return matrix_[row * stride_ + column]; }
  bool factorise() noexcept;

  std::size_t stride_, unknowns_ = 0;
  std::vector<double> matrix_;  ///< normal matrix, then its Cholesky factor in the lower triangle
  std::vector<double> right_, solution_;
};

}  // namespace turnpoint::sensing

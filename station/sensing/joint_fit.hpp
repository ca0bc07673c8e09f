#pragma once
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace turnpoint::sensing {

/// Fits several sinusoids of known frequencies to a window of frames by least squares. All are fitted
/// together, so that no sinusoid affects the result of another. The fit needs only the sums of the samples'
/// products with each sinusoid (ToneSums::plain) and the sum of their squares, because the normal matrix has
/// a closed form. Allocates only in its constructor.
class JointFit {
 public:
  explicit JointFit(std::size_t most_tones);

  /// Prepares fits to windows of `frames` frames. `phase` and `increment` of each tone are in 2^-64 cycles;
  /// `phase` is that at the first frame. Returns false if the window is too short to separate the tones.
  [[nodiscard]] bool prepare(std::span<const std::uint64_t> phase, std::span<const std::uint64_t> increment,
                             std::int64_t frames) noexcept;

  /// Prepares fits of other signals than sinusoids of constant frequency. Column 2t of the normal matrix
  /// belongs to tone t, and column 2t + 1 to the same tone a quarter of a cycle ahead.
  [[nodiscard]] bool prepare(std::span<const double> normal_matrix, std::size_t tones) noexcept;

  /// Computes the complex amplitudes A e^(i theta) of signals A sin(phase + theta). `sums[t]` is the sum of
  /// sample times i e^(-i phase) for tone t, and `energy` the sum of squared samples. Returns the part of
  /// `energy` that the tones do not explain.
  double solve(std::span<const std::complex<double>> sums, double energy,
               std::span<std::complex<double>> amplitude) noexcept;

 private:
  double& entry(std::size_t row, std::size_t column) noexcept { return matrix_[row * stride_ + column]; }
  bool factorise() noexcept;

  std::size_t stride_, unknowns_ = 0;
  /// normal matrix; after factorise(), its Cholesky factor in the lower triangle
  std::vector<double> matrix_;
  std::vector<double> right_, solution_;
};

}  // namespace turnpoint::sensing

#include "station/simulation/pickup_response.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "physics/field.hpp"

namespace turnpoint::simulation {

using std::numbers::pi;
using Complex = std::complex<double>;

namespace {

double quadrature_power(const std::vector<Complex>& v) {
  double sum = 0;
  for (const Complex& z : v) sum += z.imag() * z.imag();
  return sum;
}

/// The resonance frequencies of a response: minima of the imaginary part, at the pick-up where the imaginary
/// part is strongest.
std::vector<double> resonances_of(const SurfaceResponse& response) {
  std::vector<double> found;
  const auto& v = *std::max_element(response.at.begin(), response.at.end(), [](const auto& a, const auto& b) {
    return quadrature_power(a) < quadrature_power(b);
  });
  for (std::size_t k = 1; k + 1 < v.size(); ++k) {
    const double a = v[k - 1].imag(), b = v[k].imag(), c = v[k + 1].imag();
    if (b < a && b <= c)
      found.push_back(response.frequency_Hz[k] + 0.5 * (a - c) / (a - 2 * b + c) *
                                                     (response.frequency_Hz[1] - response.frequency_Hz[0]));
  }
  // A resonance just outside of the band also acts inside the band. Add one at each end, at the same spacing.
  if (found.size() > 1) {
    found.insert(found.begin(), 2 * found[0] - found[1]);
    found.push_back(2 * found.back() - found[found.size() - 2]);
  }
  return found;
}

/// Returns the poles of the filter for these resonance frequencies. `loss` is half the width of a resonance
/// divided by its frequency.
std::vector<Complex> poles_of(const std::vector<double>& resonances, double loss, double scale,
                              double rate_Hz) {
  std::vector<Complex> poles;
  for (const double f : resonances)
    poles.push_back(std::exp(Complex(-loss, 1) * (2 * pi * f * scale / rate_Hz)));
  return poles;
}

/// Returns the columns of the least-squares fit: for each pole, the responses to the real and imaginary part
/// of its weight; then the responses to the taps.
Eigen::MatrixXcd basis_of(const std::vector<Complex>& poles, std::size_t taps,
                          std::span<const double> frequency_Hz, double rate_Hz) {
  const auto rows = static_cast<Eigen::Index>(frequency_Hz.size());
  Eigen::MatrixXcd basis(rows, static_cast<Eigen::Index>(2 * poles.size() + taps));
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Complex delay = std::polar(1.0, -2 * pi * frequency_Hz[static_cast<std::size_t>(row)] / rate_Hz);
    Eigen::Index column = 0;
    for (const Complex& pole : poles) {
      const Complex up = 1.0 / (1.0 - pole * delay), down = 1.0 / (1.0 - std::conj(pole) * delay);
      basis(row, column++) = 0.5 * (up + down);
      basis(row, column++) = Complex(0, 0.5) * (up - down);
    }
    Complex tap = 1;
    for (std::size_t k = 0; k < taps; ++k, tap *= delay) basis(row, column++) = tap;
  }
  return basis;
}

/// Fits real weights of the columns by least squares. Each column of the result belongs to one pick-up.
Eigen::MatrixXd fitted(const Eigen::MatrixXcd& basis, const Eigen::MatrixXcd& wanted) {
  Eigen::MatrixXd a(2 * basis.rows(), basis.cols()), b(2 * basis.rows(), wanted.cols());
  a << basis.real(), basis.imag();
  b << wanted.real(), wanted.imag();
  return a.colPivHouseholderQr().solve(b);
}

/// Returns 0 for a motion (um) that is far too small to matter. Without this, a surface that nothing drives
/// any more would reach the smallest numbers after half a second and stay there. With those, processors
/// compute up to a hundred times slower.
double rest_if_tiny(double x) { return std::abs(x) < 1e-100 ? 0 : x; }

}  // namespace

SurfaceResponse surface_response(const physics::Surface& surface, std::span<const double> x_m, double low_Hz,
                                 double high_Hz) {
  SurfaceResponse response;
  response.at.resize(x_m.size());
  // 200 Hz if Q is 30: a resonance at 30 kHz is then 1 kHz wide
  const double spacing_Hz = std::clamp(6000 / surface.quality_factor, 20.0, 400.0);
  for (double f = low_Hz; f <= high_Hz; f += spacing_Hz) {
    const physics::Tone tone{f, 1, 0};
    const auto field =
        physics::evaluate_tones(surface, {&tone, 1}, x_m, physics::Model::mode, physics::Normalise::none);
    response.frequency_Hz.push_back(f);
    for (std::size_t place = 0; place < x_m.size(); ++place) response.at[place].push_back(field[0].v[place]);
  }
  return response;
}

PickupFilter::PickupFilter(const SurfaceResponse& response, double rate_Hz, double scale)
    : rate_Hz_(rate_Hz) {
  if (response.at.empty()) return;
  auto frequency_Hz = response.frequency_Hz;
  for (double& f : frequency_Hz) f *= scale;
  Eigen::MatrixXcd wanted(static_cast<Eigen::Index>(frequency_Hz.size()),
                          static_cast<Eigen::Index>(response.at.size()));
  for (Eigen::Index place = 0; place < wanted.cols(); ++place)
    for (Eigen::Index k = 0; k < wanted.rows(); ++k)
      wanted(k, place) = response.at[static_cast<std::size_t>(place)][static_cast<std::size_t>(k)];

  const auto resonances = resonances_of(response);
  std::vector<Complex> poles;
  Eigen::MatrixXd weights;
  fit_error_ = 1e300;
  // How the loss follows from Q depends on the theory of the surface (1/2Q for a membrane, up to 1/Q for a
  // plate). So try many values, and keep the one that fits best.
  for (double loss = 0.001; loss < 0.2; loss *= 1.1) {
    const auto tried = poles_of(resonances, loss, scale, rate_Hz);
    const auto basis = basis_of(tried, kTaps, frequency_Hz, rate_Hz);
    const Eigen::MatrixXd solution = fitted(basis, wanted);
    const double error = (basis * solution.cast<Complex>() - wanted).cwiseAbs().maxCoeff();
    if (error >= fit_error_) continue;
    fit_error_ = error;
    poles = tried;
    weights = solution;
  }
  for (const Complex& pole : poles) {
    pole_re_.push_back(pole.real());
    pole_im_.push_back(pole.imag());
  }
  state_re_.assign(poles.size(), 0);
  state_im_.assign(poles.size(), 0);
  past_.assign(kTaps, 0);
  for (Eigen::Index place = 0; place < wanted.cols(); ++place) {
    Place one;
    for (std::size_t n = 0; n < poles.size(); ++n) {
      one.re.push_back(weights(static_cast<Eigen::Index>(2 * n), place));
      one.im.push_back(weights(static_cast<Eigen::Index>(2 * n + 1), place));
    }
    for (std::size_t k = 0; k < kTaps; ++k)
      one.taps.push_back(weights(static_cast<Eigen::Index>(2 * poles.size() + k), place));
    places_.push_back(std::move(one));
  }
}

void PickupFilter::step(double drive) {
  for (std::size_t k = past_.size(); k-- > 1;) past_[k] = past_[k - 1];
  if (!past_.empty()) past_[0] = drive;
  for (std::size_t n = 0; n < pole_re_.size(); ++n) {
    const double re = state_re_[n], im = state_im_[n];
    state_re_[n] = rest_if_tiny(pole_re_[n] * re - pole_im_[n] * im + drive);
    state_im_[n] = rest_if_tiny(pole_re_[n] * im + pole_im_[n] * re);
  }
}

double PickupFilter::output(std::size_t place) const {
  const Place& p = places_[place];
  double sum = 0;
  for (std::size_t n = 0; n < p.re.size(); ++n) sum += p.re[n] * state_re_[n] - p.im[n] * state_im_[n];
  for (std::size_t k = 0; k < p.taps.size(); ++k) sum += p.taps[k] * past_[k];
  return sum;
}

Complex PickupFilter::response(std::size_t place, double frequency_Hz) const {
  const Place& p = places_[place];
  const Complex delay = std::polar(1.0, -2 * pi * frequency_Hz / rate_Hz_);
  Complex sum = 0, tap = 1;
  for (std::size_t n = 0; n < p.re.size(); ++n) {
    const Complex pole(pole_re_[n], pole_im_[n]), weight(p.re[n], p.im[n]);
    sum += 0.5 * (weight / (1.0 - pole * delay) + std::conj(weight) / (1.0 - std::conj(pole) * delay));
  }
  for (std::size_t k = 0; k < p.taps.size(); ++k, tap *= delay) sum += p.taps[k] * tap;
  return sum;
}

std::vector<std::pair<double, double>> PickupFilter::resonators() const {
  std::vector<std::pair<double, double>> found;
  for (std::size_t n = 0; n < pole_re_.size(); ++n) {
    const Complex turn = std::log(Complex(pole_re_[n], pole_im_[n]));
    found.emplace_back(turn.imag() * rate_Hz_ / (2 * pi), -turn.imag() / (2 * turn.real()));
  }
  return found;
}

void PickupFilter::continue_from(const PickupFilter& other) {
  state_re_ = other.state_re_;
  state_im_ = other.state_im_;
  past_ = other.past_;
}

}  // namespace turnpoint::simulation

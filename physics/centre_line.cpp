#include "physics/centre_line.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "physics/gate.hpp"
#include "physics/modal_field.hpp"
#include "physics/operations.hpp"
#include "physics/smooth_sides.hpp"

namespace turnpoint::physics {
namespace {

using std::numbers::pi;

// The centre line of the model `mode`: integrates the model's equation step by step along the
// strip.
class MarchedLine final : public CentreLine {
 public:
  MarchedLine(const Taper& taper, const MarchEquation& equation) : march_(taper, equation) {}
  Scaled value(double x) const override { return march_.value(x); }
  Scaled slope(double x) const override { return march_.slope(x); }
  void evaluate(std::span<const double> x, std::complex<double> phase, double ln_reference,
                std::span<std::complex<double>> v, std::span<double> ln_amplitude) const override {
    march_.evaluate(x, phase, ln_reference, v, ln_amplitude);
  }
  std::optional<double> last_peak_m() const override { return march_.last_peak_m(); }
  std::optional<double> level_m(double level) const override { return march_.level_m(level); }

 private:
  TaylorMarch march_;
};

}  // namespace

void CentreLine::evaluate(std::span<const double> x, std::complex<double> phase, double ln_reference,
                          std::span<std::complex<double>> v, std::span<double> ln_amplitude) const {
  for (std::size_t i = 0; i < x.size(); ++i) {
    count_operations(2 * function_operations);
    const Scaled one = value(x[i]);
    const double ln = one.ln_magnitude();
    ln_amplitude[i] = ln == ln_zero ? ln_zero : ln - ln_reference;
    v[i] = one.mantissa / phase * std::exp(std::min(700.0, one.ln_scale - ln_reference));
  }
}

double CentreLine::drive_conditioning(double k) const {
  const Scaled v0 = value(0);
  const double magnitude = std::abs(v0.mantissa);
  return magnitude > 0 ? std::hypot(magnitude, std::abs(slope(0).mantissa) / k) / magnitude : 1e300;
}

Surface moving_part(const Surface& surface, double frequency_Hz) {
  const Taper taper(surface);
  const double k = wavenumber_per_m(surface, frequency_Hz);
  const auto turning = taper.position_continued_m(cut_off_half_width_m(surface, frequency_Hz));
  double x = std::clamp(turning.value_or(0), 0.0, surface.length_m), decay = 0;
  while (x < surface.length_m && decay < 45) {
    const double w = taper.half_width_m(x), across = pi / (2 * w);
    decay += 0.5 * w * std::sqrt(std::max(0.0, across * across - k * k));
    x += 0.5 * w;
  }
  Surface part = surface;
  part.length_m = std::min(x, surface.length_m);
  return part;
}

MarchEquation march_equation(const Surface& surface, double frequency_Hz, Losses losses) {
  const Dispersion dispersion(surface);
  const double k = dispersion.wavenumber_per_m(frequency_Hz);
  const std::complex<double> lossy =
      losses == Losses::kept ? dispersion.loss(frequency_Hz, surface.quality_factor) : 1;
  MarchEquation equation;
  equation.a = k * k * lossy * lossy;
  equation.b = pi * pi / 4;
  if (dispersion.clamped_bending()) {
    const double root = k * cut_off_half_width_m(surface, frequency_Hz);
    equation.b = root * root;
  }
  equation.c = pi * pi / 6 - 0.25;
  equation.w_power = 0.5;
  return equation;
}

MarchEquation best_equation(const Surface& surface, double frequency_Hz, Losses losses) {
  MarchEquation equation = march_equation(surface, frequency_Hz, losses);
  const auto* taper = std::get_if<LinearTaper>(&surface.taper);
  if (taper == nullptr || !(taper->slope > 0) || Dispersion(surface).clamped_bending()) return equation;
  // With s the distance from the apex and d the slope, v = J_nu(k s) solves the equation of `mode` if B/d^2 +
  // C + 1/4 = nu^2 and v = g W^-1/2. (B, C and g are those of taylor_march.hpp.)
  const double nu = pi / (2 * std::atan(taper->slope));
  const double m = pi / (2 * taper->slope);
  equation.c = (nu - m) * (nu + m) - 0.25;
  return equation;
}

std::unique_ptr<CentreLine> make_marched_line(const Surface& surface, const MarchEquation& equation) {
  return std::make_unique<MarchedLine>(Taper(surface), equation);
}

std::optional<double> turning_point_m(const Surface& surface, double frequency_Hz) {
  return Taper(smooth_sides(surface)).position_m(cut_off_half_width_m(surface, frequency_Hz));
}

std::unique_ptr<CentreLine> make_centre_line(const Surface& surface, double frequency_Hz, Model model,
                                             Losses losses) {
  validate(surface, frequency_Hz);
  switch (model) {
    case Model::edge:
      throw std::invalid_argument("model edge gives positions only; it has no profile");
    case Model::mode:
      if (Dispersion(surface).clamped_bending()) {
        ModalResolution resolution;
        resolution.across = ModalResolution::Across::cut_off_shape;
        return make_modal_line(surface, frequency_Hz, losses, resolution);
      }
      return make_marched_line(smooth_sides(surface), march_equation(surface, frequency_Hz, losses));
    case Model::modes:
      if (surface.drive == DriveShape::piston && surface.theory != PlateTheory::kirchhoff)
        throw std::domain_error(
            "model modes of a thick plate is not available for drive piston, only for cosine");
      return make_modal_line(surface, frequency_Hz, losses, {});
  }
  throw std::domain_error("model " + std::string(name(model)) + " is not available for this surface");
}

}  // namespace turnpoint::physics

#include "physics/airy_profile.hpp"

#include <cmath>
#include <stdexcept>

#include "physics/airy.hpp"
#include "physics/dispersion.hpp"
#include "physics/root.hpp"

namespace turnpoint::physics {
namespace {

class AiryLine final : public CentreLine {
 public:
  AiryLine(const AiryScale& scale, double length_m) : scale_(scale), length_m_(length_m) {}

  Scaled value(double x) const override {
    const Airy y = airy(scale_.k0_per_m * (x - scale_.turning_point_m));
    return {y.ai, y.ln_scale};
  }
  Scaled slope(double x) const override {
    const Airy y = airy(scale_.k0_per_m * (x - scale_.turning_point_m));
    return {y.dai * scale_.k0_per_m, y.ln_scale};
  }
  std::optional<double> last_peak_m() const override { return on_surface(airy_last_peak); }

  std::optional<double> level_m(double level) const override {
    if (!last_peak_m()) return std::nullopt;
    const double target = std::log(level * airy(airy_last_peak).ai);
    double low = airy_last_peak, high = 2;
    while (log_ai(high) > target) high *= 2;
    const auto tangent = [target](double t) {
      const Airy y = airy(t);
      const double miss = std::log(y.ai) + y.ln_scale - target;
      return Tangent{miss, t - miss * y.ai / y.dai};
    };
    const Bracket bracket{low, high};
    const double t = newton(bracket, bracket.middle(), tangent,
                            [](double next, double at) { return std::abs(next - at) < 1e-15; });
    return on_surface(t);
  }

 private:
  static double log_ai(double t) {
    const Airy y = airy(t);
    return std::log(y.ai) + y.ln_scale;
  }
  std::optional<double> on_surface(double t) const {
    const double x = scale_.turning_point_m + t / scale_.k0_per_m;
    return x >= 0 && x <= length_m_ ? std::optional(x) : std::nullopt;
  }

  AiryScale scale_;
  double length_m_;
};

}  // namespace

AiryScale airy_scale(const Surface& surface, double frequency_Hz) {
  const Taper taper(surface);
  const double k = wavenumber_per_m(surface, frequency_Hz);
  const double w = cut_off_half_width_m(surface, frequency_Hz);
  const auto x0 = taper.position_continued_m(w);
  if (!x0) throw std::domain_error("no turning point on this taper: the Airy profile does not exist");
  return {*x0, std::cbrt(2 * k * k * std::abs(taper.slope(*x0)) / w)};
}

std::unique_ptr<CentreLine> make_airy_line(const Surface& surface, double frequency_Hz) {
  return std::make_unique<AiryLine>(airy_scale(surface, frequency_Hz), surface.length_m);
}

}  // namespace turnpoint::physics

#include "physics/modal_field.hpp"

#include <cmath>

#include "physics/dispersion.hpp"
#include "physics/modal_elements.hpp"
#include "tests/physics/csv_table.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

TEST_CASE("the model modes reproduces the exact mode of a wedge that drives its straight edge",
          "[physics][oracle]") {
  // Columns of wedge.csv (make_wedge.py): slope, frequency, then J_nu(k r) cos(nu theta) at Chebyshev points
  // along the drive edge, then at points of the centre line.
  for (const auto& row : turnpoint::physics_test::oracle("wedge.csv")) {
    Surface s = seed_brass();
    const double d = std::stod(row[0]), f = std::stod(row[1]);
    s.taper = LinearTaper{0.03, d};
    s.length_m = 0.03 / d;
    const int edge_points = 24, line_points = 40;
    std::vector<double> edge, line;
    for (int i = 0; i < edge_points; ++i) edge.push_back(std::stod(row[static_cast<std::size_t>(2 + i)]));
    for (int i = 0; i < line_points; ++i) line.push_back(std::stod(row[static_cast<std::size_t>(26 + i)]));
    double last = 1e300;
    for (const int spare : {1, 2, 3}) {
      ModalResolution resolution;
      resolution.spare_functions = spare;
      // Returns the displacement of the drive edge, by barycentric interpolation between Chebyshev points of
      // eta^2.
      resolution.drive = [&](double eta) {
        double top = 0, bottom = 0;
        for (int i = 0; i < edge_points; ++i) {
          const double angle = M_PI * (i + 0.5) / edge_points;
          const double gap = eta * eta - 0.5 * (1 + std::cos(angle));
          if (std::abs(gap) < 1e-15) return edge[static_cast<std::size_t>(i)];
          const double weight = (i % 2 == 0 ? 1 : -1) * std::sin(angle) / gap;
          top += weight * edge[static_cast<std::size_t>(i)];
          bottom += weight;
        }
        return top / bottom;
      };
      const auto field = make_modal_line(s, f, Losses::left_out, resolution);
      double worst = 0, most = 0;
      for (int i = 0; i < line_points; ++i) {
        const double exact = line[static_cast<std::size_t>(i)];
        const Scaled v = field->value(s.length_m * i / line_points);
        worst = std::max(worst, std::abs(v.mantissa.real() * std::exp(v.ln_scale) - exact));
        most = std::max(most, std::abs(exact));
      }
      CAPTURE(d, f, spare, worst / most);
      CHECK(worst / most < (spare == 1 ? 3e-2 : spare == 2 ? 5e-4 : 2e-5));
      CHECK(worst <= 1.5 * last);  // the error decreases with resolution
      last = worst;
    }
  }
}

TEST_CASE("the last maximum of the model modes agrees with that of a wedge within hundredths of a millimetre",
          "[physics]") {
  Surface s = seed_brass();
  s.quality_factor = 60;
  const auto two = make_centre_line(s, 19600, Model::modes), one = make_centre_line(s, 19600, Model::mode);
  CHECK(std::abs(*two->last_peak_m() - *one->last_peak_m()) < 2e-6);
}

TEST_CASE("a finer resolution of the model modes changes the field of a curved taper by less than 1e-4",
          "[physics]") {
  Surface s = seed_brass();
  s.quality_factor = 60;
  s.taper = ExponentialTaper{0.03, 0.12};
  ModalResolution fine;
  fine.degree = 10;
  fine.radians = 1.5;
  fine.spare_functions = 8;
  const auto a = make_modal_line(s, 30e3, Losses::kept, {}), b = make_modal_line(s, 30e3, Losses::kept, fine);
  double worst = 0, most = 0;
  for (int i = 0; i <= 100; ++i) {
    const Scaled va = a->value(0.003 * i), vb = b->value(0.003 * i);
    const auto exact = vb.mantissa * std::exp(vb.ln_scale);
    worst = std::max(worst, std::abs(va.mantissa * std::exp(va.ln_scale) - exact));
    most = std::max(most, std::abs(exact));
  }
  CHECK(worst < 1e-4 * most);
}

TEST_CASE("the element matrix of a plate equals the integral of the product of two Laplacians", "[physics]") {
  // The reference differentiates X(x) Y(y / W(x)) numerically in x and y. X is a basis function of the
  // element, and Y a transverse function.
  Surface s = aluminium_plate();
  s.taper = ExponentialTaper{0.014, 0.05};
  s.length_m = 0.1;
  const Taper taper(s);
  const ElementBasis along{5, 2};
  const auto across = TransverseBasis::polynomials(2, 2);
  const ModalEquation equation{1, 0, 0};
  const ModalAssembler assembler(taper, across, along, equation, 0.014);
  ModalElement element;
  element.x0 = 0.02;
  element.h = 0.01;
  element.left = element.right = 2;
  const auto k = assembler.matrix(element);
  const auto value = [&](int a, int i, double x, double y) {
    const double w = taper.half_width_m(x), eta = y / w;
    const bool slope = a == 1 || a == 5;
    const double factor = slope ? assembler.slope_factor(element) : 1;
    const double u = (1 - eta * eta) * (1 - eta * eta);
    const double p = i == 0 ? 1 : std::sqrt(5.0) * (1.5 * eta * eta - 0.5);
    return factor * along.at(2 * (x - element.x0) / element.h - 1).value[static_cast<std::size_t>(a)] * u * p;
  };
  const auto laplacian = [&](int a, int i, double x, double y) {
    const double h = 2e-5;  // step of the eighth-order finite differences
    constexpr double c[] = {-205.0 / 72, 8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
    double sum = 2 * c[0] * value(a, i, x, y);
    for (int n = 1; n <= 4; ++n) {
      sum += c[n] * (value(a, i, x + n * h, y) + value(a, i, x - n * h, y) + value(a, i, x, y + n * h) +
                     value(a, i, x, y - n * h));
    }
    return sum / (h * h);
  };
  const Quadrature rule = gauss_legendre(14);
  for (const auto& [a, i, b, j] : {std::array{1, 0, 1, 0}, std::array{0, 1, 2, 0}, std::array{3, 1, 5, 1}}) {
    double sum = 0;
    for (std::size_t p = 0; p < rule.x.size(); ++p) {
      const double x = element.x0 + element.h * rule.x[p], w = taper.half_width_m(x);
      for (std::size_t q = 0; q < rule.x.size(); ++q) {
        const double y = w * rule.x[q];
        sum += element.h * rule.w[p] * w * rule.w[q] * laplacian(a, i, x, y) * laplacian(b, j, x, y);
      }
    }
    const double found = k(2 * a + i, 2 * b + j).real();
    CAPTURE(a, i, b, j, sum, found);
    CHECK(found == Approx(sum).epsilon(1e-5));
  }
}

TEST_CASE("waves on a clamped strip have the wavelength that the dispersion of a clamped strip gives",
          "[physics]") {
  // The dispersion relation of a clamped strip of half-width W is q1 tan(q1 W) + q2 tanh(q2 W) = 0 with q1^2
  // = b^2 - kx^2 and q2^2 = b^2 + kx^2 (b: wavenumber of the wide plate, kx: along the strip).
  Surface s = aluminium_plate();
  s.taper = LinearTaper{0.014, 0};
  s.quality_factor = std::numeric_limits<double>::infinity();
  const double f = 30e3, b = wavenumber_per_m(s, f), w = 0.014;
  double low = 0, high = b;
  for (int i = 0; i < 100; ++i) {
    const double kx = 0.5 * (low + high);
    const double q1 = std::sqrt(b * b - kx * kx), q2 = std::sqrt(b * b + kx * kx);
    // the dispersion relation multiplied by cos(q1 W); positive if kx is too large
    (q1 * std::sin(q1 * w) + q2 * std::tanh(q2 * w) * std::cos(q1 * w) > 0 ? high : low) = kx;
  }
  const auto line = make_modal_line(s, f, Losses::left_out, {});
  double first = 0, last = 0;
  int crossings = 0;
  double before = line->value(0.1).mantissa.real();
  for (double x = 0.1; x < 0.2; x += 1e-5) {  // stay away from the ends and their near fields
    const double now = line->value(x).mantissa.real();
    if (now * before < 0) {
      const double at = x - 1e-5 * now / (now - before);
      if (crossings++ == 0) first = at;
      last = at;
    }
    before = now;
  }
  REQUIRE(crossings >= 3);
  CHECK(M_PI * (crossings - 1) / (last - first) == Approx(low).epsilon(1e-5));
}

TEST_CASE("the model mode of a plate agrees with the converged plate, and converges itself", "[physics]") {
  const Surface s = aluminium_plate();
  for (const double f : {22.4e3, 30e3, 45e3}) {
    ModalResolution fine;
    fine.spare_functions = 6;
    fine.degree = 9;
    const auto truth = make_modal_line(s, f, Losses::kept, fine);
    const auto modes = make_centre_line(s, f, Model::modes), mode = make_centre_line(s, f, Model::mode);
    CHECK(std::abs(*modes->last_peak_m() - *truth->last_peak_m()) < 2e-6);
    CHECK(std::abs(*mode->last_peak_m() - *truth->last_peak_m()) < 2e-5);
    CHECK(std::abs(*mode->level_m(0.5) - *truth->level_m(0.5)) < 1e-5);
    CHECK(std::abs(*mode->level_m(0.5) - *truth->level_m(0.5)) > 1e-8);
  }
}

TEST_CASE("a clamped plate under tension acts like a membrane that is narrower by the boundary layer",
          "[physics]") {
  Surface plate = seed_brass();
  plate.quality_factor = 60;
  Surface membrane = plate;
  // Width of the boundary layer, sqrt(D/N): bending stiffness D, tension per width N.
  const double layer = 0.25e-3;
  plate.modulus_Pa = 1e9;
  plate.modulus_Pa = 1e9 * layer * layer * line_tension_N_per_m(plate) / bending_stiffness_N_m(plate).value();
  plate.edges = Edges::clamped;
  plate.bending = Bending::on;
  membrane.modulus_Pa = plate.modulus_Pa;
  membrane.bending = Bending::on;
  const double wide = make_centre_line(membrane, 20e3, Model::modes)->last_peak_m().value();
  membrane.taper = LinearTaper{0.03 - layer, 0.1};
  membrane.length_m = (0.03 - layer) / 0.1;
  const double narrow = make_centre_line(membrane, 20e3, Model::modes)->last_peak_m().value();
  for (const Model model : {Model::mode, Model::modes}) {
    const double found = make_centre_line(plate, 20e3, model)->last_peak_m().value();
    CAPTURE(name(model), found, wide, narrow);
    CHECK(std::abs(found - narrow) < 0.1 * (wide - narrow));
  }
}

TEST_CASE("the response of a lossless plate grows without bound at its resonances", "[physics]") {
  Surface s = aluminium_plate();
  s.quality_factor = std::numeric_limits<double>::infinity();
  const double f = nearest_resonance_Hz(s, 30e3).value();
  CHECK(std::abs(f - 30e3) < 1500);
  const auto gain = [&](double at) {
    const auto line = make_centre_line(s, at, Model::mode);
    return std::exp(line->value(*line->last_peak_m()).ln_magnitude() - line->value(0).ln_magnitude());
  };
  CHECK(gain(f) > 1e4);
  CHECK(gain(f + 300) < 20);
}

TEST_CASE("modes of curved tapers, of a membrane and a clamped plate, match a solution by collocation",
          "[physics][oracle]") {
  const auto rows = turnpoint::physics_test::oracle("collocation.csv");
  REQUIRE(rows.size() == 4);
  for (const auto& row : rows) {
    const auto number = [&](std::size_t i) { return std::stod(row[i]); };
    Surface s = row[0] == "plate" ? aluminium_plate() : seed_brass();
    s.taper = ExponentialTaper{number(1), number(2)};
    s.length_m = number(3);
    turnpoint::physics_test::set_wave_loss(s, number(4), number(5));
    REQUIRE(number(48) < 1e-5);  // the table's own error, estimated with a coarser grid
    for (const Model model : {Model::mode, Model::modes}) {
      const auto line = make_centre_line(s, number(4), model);
      const Scaled unit = line->value(0);
      double worst = 0, most = 0;
      for (std::size_t i = 0; i <= 20; ++i) {
        const std::complex<double> exact(number(6 + 2 * i), number(7 + 2 * i));
        const Scaled v = line->value(s.length_m * static_cast<double>(i) / 20);
        const auto found = v.mantissa / unit.mantissa * std::exp(v.ln_scale - unit.ln_scale);
        worst = std::max(worst, std::abs(found - exact));
        most = std::max(most, std::abs(exact));
      }
      CAPTURE(row[0], row[2], name(model), worst / most);
      if (model == Model::modes) CHECK(worst < 1e-4 * most);
      // negative control: the one-mode model differs measurably
      if (model == Model::mode) CHECK(worst > 1e-4 * most);
    }
  }
}

// validate() allows this; a loop over the pieces would never reach the end.
TEST_CASE("a table may end a rounding error before the surface does", "[physics]") {
  for (Surface s : {seed_brass(), aluminium_plate()}) {
    s.length_m = 0.3;
    const auto at = [&](double last_m) {
      s.taper = TabulatedTaper{{{0, 0.0151}, {0.1, 0.0121}, {0.2, 0.0091}, {last_m, 0.0061}}};
      validate(s);
      return make_centre_line(s, 20e3, Model::modes)->value(0.1).ln_magnitude();
    };
    CHECK(std::abs(at(std::nextafter(0.3, 0)) - at(0.3)) < 1e-9);
    CHECK(std::abs(at(0.3 * (1 - 0.9e-12)) - at(0.3)) < 1e-9);
  }
}

TEST_CASE("a clamped plate moves as independent finite elements do", "[physics]") {
  for (const auto& row : turnpoint::physics_test::oracle("clamped_taper.csv")) {
    const double f = std::stod(row[0]);
    const auto line = make_modal_line(aluminium_plate(), f, Losses::kept, {});
    double worst = 0, most = 0;
    for (std::size_t i = 1; i < row.size(); ++i) {
      const double v = std::stod(row[i]);
      most = std::max(most, v);
      worst =
          std::max(worst, std::abs(std::exp(line->value(0.01 * static_cast<double>(i)).ln_magnitude()) - v));
    }
    CAPTURE(f, worst / most);
    CHECK(worst / most < 1e-4);
  }
}

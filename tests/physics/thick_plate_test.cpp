#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "physics/dispersion.hpp"
#include "physics/elastic_section.hpp"
#include "physics/mindlin_plate.hpp"
#include "physics/plate_theory.hpp"
#include "physics/section_elements.hpp"
#include "physics/surface.hpp"
#include "physics/warning.hpp"
#include "tests/physics/csv_table.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;
using turnpoint::physics_test::oracle;

namespace {

// Returns a clamped plate with shear modulus 1 and density 1, which are the units of the reference table.
Surface unit_plate(double thickness, double poisson, PlateTheory theory) {
  Surface s = aluminium_plate();
  s.density_kg_m3 = 1;
  s.poisson = poisson;
  s.modulus_Pa = 2 * (1 + poisson);
  s.thickness_m = thickness;
  s.theory = theory;
  return s;
}

double number(const std::string& cell) { return std::stod(cell); }

// Returns the squared wavenumbers along the strip, times W^2, of the waves at a given omega W / c_s, smallest
// magnitude first. Only waves that are symmetric about the centre line and antisymmetric through the
// thickness are included. A value is complex where two evanescent branches have met. The method is
// semi-analytical finite elements: with u = (i k A, b, c) exp(-i k x) and A, b, c made of elements in y and
// z, the eigenvalue problem is linear in k^2 (S. Dong & R. Nelson, J. Appl. Mech. 39 (1972) 739).
std::vector<std::complex<double>> elastic_wavenumbers2(double t, double poisson, double omega, int count) {
  const SectionPencil s = SectionElements(t, poisson).pencil;
  const Eigen::Index na = s.along_mass.rows(), nb = s.mass.rows();
  const double o2 = omega * omega;
  Eigen::MatrixXd fixed = Eigen::MatrixXd::Zero(na + nb, na + nb), by = fixed;
  fixed.topLeftCorner(na, na) = s.shear - o2 * s.along_mass;
  fixed.topRightCorner(na, nb) = s.coupling;
  fixed.bottomRightCorner(nb, nb) = s.plane - o2 * s.mass;
  by.topLeftCorner(na, na) = s.along;
  by.bottomLeftCorner(nb, na) = s.coupling.transpose();
  by.bottomRightCorner(nb, nb) = s.cross;
  // The eigenvalue problem is `fixed` v = -L `by` v. Compute the eigenvalues of fixed^-1 `by`, which are
  // -1/L. The largest of them belong to the L of smallest magnitude.
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(Eigen::MatrixXd(fixed.partialPivLu().solve(by)), false);
  std::vector<std::complex<double>> all;
  for (const std::complex<double> one : solver.eigenvalues()) {
    if (std::abs(one) > 0) all.push_back(-1.0 / one);
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return std::abs(a) < std::abs(b); });
  all.resize(std::min(all.size(), static_cast<std::size_t>(count)));
  return all;
}

}  // namespace

TEST_CASE("the table of elastic cut-offs has the oracle's figures, and those of the library's own elements",
          "[physics]") {
  int compared = 0;
  for (const auto& row : oracle("section.csv")) {
    if (row[0] != "cut") continue;
    const double nu = number(row[1]), t = number(row[2]), omega = number(row[3]);
    CAPTURE(nu, t);
    const ElasticCutOff table(nu);
    CHECK(table.value(t) == Approx(omega).epsilon(2e-5));
    CHECK(table.thickness_per_half_width(t * table.value(t)) == Approx(t).epsilon(1e-13));
    ++compared;
  }
  CHECK(compared == 30);
  // The library's elements for fields are coarser. Their error comes from the singularity at the corner of
  // the clamp, which is stronger for a larger Poisson's ratio.
  for (const double nu : {0.0, 0.13, 0.27, 0.33, 0.42, 0.47, 0.49})
    for (const double t : {0.003, 0.02, 0.07, 0.25, 0.4, 0.55, 1.0, 1.6, 2.0}) {
      CAPTURE(nu, t);
      const double elements = section_cut_off(SectionElements(t, nu).pencil).omega;
      CHECK(ElasticCutOff(nu).value(t) == Approx(elements).epsilon(nu <= 0.33 && t <= 0.4 ? 2e-4 : 2e-3));
    }
  for (const double nu : {0.0, 0.33, 0.49}) {  // beyond the table
    const double last = ElasticCutOff(nu).value(2);
    CHECK(ElasticCutOff(nu).value(5) == last);
    CHECK(last > 0.89 * std::numbers::pi / 2);
    CHECK(last < 0.94 * std::numbers::pi / 2);
  }
  CHECK_THROWS_WITH(ElasticCutOff(0.495), "poisson is 0.495; allowed: 0 to 0.49");
}

TEST_CASE("Mindlin's cut-off half-width is within 0.2 % of plane strain for h/W to 0.4", "[physics]") {
  double five_sixths = 0, kirchhoff = 0;
  for (const auto& row : oracle("section.csv")) {
    if (row[0] != "cut" || number(row[2]) > 0.4 || number(row[1]) > 0.4) continue;
    const double nu = number(row[1]), t = number(row[2]), f = number(row[3]) / (2 * std::numbers::pi);
    CAPTURE(nu, t);
    MindlinPlate plate(unit_plate(t, nu, PlateTheory::mindlin));
    CHECK(plate.cut_off_half_width_m(f) == Approx(1).epsilon(2e-3));
    const Dispersion elastic(unit_plate(t, nu, PlateTheory::elastic));
    CHECK(elastic.cut_off_half_width_m(f) == Approx(1).epsilon(2e-4));
    CHECK(elastic.cut_off_frequency_Hz(elastic.cut_off_half_width_m(f)) == Approx(f).epsilon(1e-12));
    if (nu != 0.33) continue;
    plate.shear_N_per_m *= 5. / 6 / shear_factor(nu);
    five_sixths = std::max(five_sixths, std::abs(plate.cut_off_half_width_m(f) - 1));
    const Dispersion thin(unit_plate(t, nu, PlateTheory::kirchhoff));
    kirchhoff = std::max(kirchhoff, thin.cut_off_half_width_m(f) - 1);
  }
  // Negative controls: the usual shear factor 5/6, and the theory of thin plates.
  CHECK(five_sixths > 8e-3);
  CHECK(kirchhoff > 0.05);
}

TEST_CASE("the cut-off half-widths of a 2 mm aluminium plate agree with plane-strain elasticity",
          "[physics]") {
  Surface s = aluminium_plate();
  const double kirchhoff[][2] = {{22.4e3, 11.0849e-3}, {33e3, 9.1327e-3}, {45e3, 7.8207e-3}};
  for (const auto& row : kirchhoff) CHECK(cut_off_half_width_m(s, row[0]) == Approx(row[1]).epsilon(1e-5));
  // cut_off() of oracles/make_section.py with eight layers, solved for the half-width
  const double elastic[][2] = {{22.4e3, 10.77338e-3}, {33e3, 8.75284e-3}, {45e3, 7.37804e-3}};
  for (const auto theory : {PlateTheory::mindlin, PlateTheory::elastic}) {
    s.theory = theory;
    const double within = theory == PlateTheory::mindlin ? 2e-3 : 1e-5;
    for (const auto& row : elastic) CHECK(cut_off_half_width_m(s, row[0]) == Approx(row[1]).epsilon(within));
  }
}

TEST_CASE(
    "thick-plate theories become Kirchhoff's for thin plates, and their inverse functions agree to rounding",
    "[physics]") {
  for (const auto theory : {PlateTheory::mindlin, PlateTheory::elastic}) {
    Surface s = aluminium_plate();
    s.theory = theory;
    const Dispersion thick(s);
    for (const double w : {14e-3, 7e-3, 2e-3, 1e-4, 1e-6}) {
      CAPTURE(name(theory), w);
      CHECK(thick.cut_off_half_width_m(thick.cut_off_frequency_Hz(w)) == Approx(w).epsilon(1e-12));
      CHECK(thick.frequency_Hz(thick.wavenumber_per_m(1e3 / w)) == Approx(1e3 / w).epsilon(1e-12));
    }
    // The difference from thin-plate theory falls with the thickness.
    double last = 1;
    for (const double h : {1e-3, 1e-4, 1e-5}) {
      s.thickness_m = h;
      s.theory = PlateTheory::kirchhoff;
      const double thin = cut_off_frequency_Hz(s, 7e-3);
      s.theory = theory;
      const double difference = std::abs(cut_off_frequency_Hz(s, 7e-3) / thin - 1);
      CHECK(difference < 0.2 * last + 5e-5);  // 5e-5 is the table's own error
      last = difference;
    }
    CHECK(last < 1e-4);
  }
}

TEST_CASE("waves along a clamped strip match other finite elements and collocation", "[physics]") {
  int waves = 0;
  for (const auto& row : oracle("section.csv")) {
    if (row[0] == "wave") {
      const auto ours = elastic_wavenumbers2(number(row[2]), number(row[1]), number(row[3]), 2);
      REQUIRE(ours.size() == 2);
      for (std::size_t i = 0; i < 2; ++i) {
        const std::complex<double> theirs(number(row[4 + 2 * i]), number(row[5 + 2 * i]));
        const double miss = std::min(std::abs(ours[0] - theirs), std::abs(ours[1] - theirs));
        CAPTURE(row[1], row[2], row[3], theirs);
        CHECK(miss < 2e-3 * (1 + std::abs(theirs)));
      }
      ++waves;
    }
    if (row[0] == "mindlin" &&
        number(row[6]) == 0) {  // only if both squared wavenumbers of this row are real
      const double kappa = number(row[2]), f = number(row[4]) / (2 * std::numbers::pi);
      MindlinPlate plate(unit_plate(number(row[3]), number(row[1]), PlateTheory::mindlin));
      plate.shear_N_per_m *= kappa / shear_factor(number(row[1]));
      for (const std::size_t i : {5, 7}) {
        const double theirs = number(row[i]), step = 1e-6 * (1 + std::abs(theirs));
        const double at = plate.characteristic(f, 1, theirs);
        const double slope = (plate.characteristic(f, 1, theirs + step) - at) / step;
        CAPTURE(row[1], row[3], row[4], theirs);
        // a Newton step from the table's value to the library's root must be tiny
        CHECK(std::abs(at / slope) < 1e-6 * (1 + std::abs(theirs)));
        CHECK(std::abs(plate.characteristic(f, 1, theirs + 0.1) / slope) > 0.05);
      }
      ++waves;
    }
  }
  CHECK(waves == 22);
}

TEST_CASE("a thick-plate theory is refused for surfaces to which it does not apply", "[physics]") {
  Surface s = aluminium_plate();
  s.theory = PlateTheory::mindlin;
  CHECK_NOTHROW(validate(s));
  s.edges = Edges::supported;
  CHECK_THROWS_AS(validate(s), std::invalid_argument);
  s = seed_brass();
  s.theory = PlateTheory::elastic;
  CHECK_THROWS_AS(validate(s), std::invalid_argument);
  s = aluminium_plate();
  s.theory = PlateTheory::elastic;
  s.poisson = 0.5;
  CHECK_THROWS_AS(validate(s), std::invalid_argument);
  CHECK(parse_plate_theory("elastic") == PlateTheory::elastic);
  CHECK_THROWS_AS(parse_plate_theory("thick"), std::invalid_argument);
}

TEST_CASE(
    "shear_shift_m gives the distances between the boundaries of the plate theories, and the tolerance "
    "decides the theory",
    "[physics]") {
  // Expected distances between the boundaries by Kirchhoff's theory and by plane-strain finite elements: 10.3
  // mm at 22.4 kHz, 14.7 mm at 45 kHz.
  Surface s = aluminium_plate();
  const auto to_elastic = [&](double f) {
    s.theory = PlateTheory::mindlin;
    const double rest = shear_shift_m(s, f).value();
    s.theory = PlateTheory::kirchhoff;
    return shear_shift_m(s, f).value() + rest;
  };
  CHECK(to_elastic(22.4e3) == Approx(10.3e-3).margin(0.15e-3));
  CHECK(to_elastic(45e3) == Approx(14.7e-3).margin(0.15e-3));
  s.theory = PlateTheory::mindlin;
  CHECK(std::abs(shear_shift_m(s, 22.4e3).value()) < 0.4e-3);
  s.theory = PlateTheory::elastic;
  CHECK(shear_shift_m(s, 30e3).value() == 0);
  CHECK_FALSE(shear_shift_m(seed_brass(), 30e3));

  s.theory = PlateTheory::kirchhoff;
  const std::vector<double> band{22.4e3, 45e3};
  CHECK(choose_theory(s, band, 20e-3).theory == PlateTheory::kirchhoff);
  CHECK(choose_theory(s, band, 1e-3).theory == PlateTheory::mindlin);
  CHECK(choose_theory(s, band, 0.1e-3).theory == PlateTheory::elastic);
  CHECK(choose_theory(s, band, {}).theory == PlateTheory::mindlin);
  CHECK(choose_theory(s, band, 1e-3).shift_m == Approx(14.7e-3).margin(0.15e-3));
  s.thickness_m = 0.05e-3;
  CHECK(choose_theory(s, {{1e3}}, 1e-3).theory == PlateTheory::kirchhoff);
  CHECK(choose_theory(s, {{1e3}}, {}).theory == PlateTheory::kirchhoff);
  CHECK(choose_theory(seed_brass(), band, 1e-6).theory == PlateTheory::kirchhoff);
}

TEST_CASE("a Kirchhoff plate warns how far shear would move its boundary", "[physics]") {
  const auto warned = [](const Surface& s, double f) {
    const Tone tone{f, 1e-6, 0};
    for (const Warning& one : tone_warnings(s, {&tone, 1})) {
      if (one.code == "thick-plate") return one.text;
    }
    return std::string();
  };
  Surface s = aluminium_plate();
  CHECK(warned(s, 45e3).find("14.9 mm") != std::string::npos);
  s.theory = PlateTheory::mindlin;
  CHECK(warned(s, 45e3).empty());
  s = aluminium_plate();
  s.thickness_m = 0.1e-3;
  CHECK(warned(s, 2.25e3).empty());
}

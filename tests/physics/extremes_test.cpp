// Tests the models at the extremes of their parameters, against references that share no code with them. The
// table "What was tried at the extremes" in physics/README.md lists the cases and the largest errors.
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "physics/boundary_map.hpp"
#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "physics/zone.hpp"
#include "tests/physics/csv_table.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;
using turnpoint::physics_test::oracle;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

double quality(double q) { return q > 0 ? q : std::numeric_limits<double>::infinity(); }

// A membrane in which waves travel at exactly 800 m/s, whatever the taper.
Surface membrane(double q) {
  Surface s = seed_brass();
  s.density_kg_m3 = 1000;
  s.tension_Pa = 640e6;
  s.bending = Bending::off;
  s.quality_factor = quality(q);
  return s;
}

bool warns(const FieldNotes& notes, const char* code) {
  return std::ranges::any_of(notes.warnings, [&](const Warning& w) { return w.code == code; });
}

// Returns the complex number whose parts are in columns i and i + 1.
std::complex<double> complex_at(const std::vector<std::string>& row, std::size_t i) {
  return {std::stod(row[i]), std::stod(row[i + 1])};
}

// The largest difference of v from the exact values, and the largest exact |v|.
struct Miss {
  double worst = 0, most = 0;
  double relative() const { return worst / most; }
};

Miss miss(std::span<const std::complex<double>> v, const std::vector<std::string>& row, std::size_t first,
          double scale = 1) {
  Miss m;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const auto exact = scale * complex_at(row, first + 2 * i);
    m.worst = std::max(m.worst, std::abs(v[i] - exact));
    m.most = std::max(m.most, std::abs(exact));
  }
  return m;
}

double largest(std::span<const std::complex<double>> v) {
  double most = 0;
  for (const auto& one : v) most = std::max(most, std::abs(one));
  return most;
}

Surface strip_of(const std::vector<std::string>& row) {
  const auto number = [&](std::size_t i) { return std::stod(row[i]); };
  const bool plate = row[0] != "membrane";
  Surface s = plate ? aluminium_plate() : membrane(0);
  s.taper = LinearTaper{plate ? 0.014 : 0.03, 0};
  s.drive = row[1] == "piston" ? DriveShape::piston : DriveShape::cosine;
  s.length_m = number(2);
  turnpoint::physics_test::set_wave_loss(s, number(8), number(5));
  if (!plate) return s;
  s.edges = row[0] == "clamped" ? Edges::clamped : Edges::supported;
  s.thickness_m = number(3);
  s.tension_Pa = number(4);
  s.bending = Bending::on;
  turnpoint::physics_test::set_wave_loss(s, number(8), number(5));
  return s;
}

// Returns the plate of make_curved_plate.py, with its taper as a table of measured points.
Surface curved_plate(const std::vector<std::string>& row) {
  const auto number = [&](std::size_t i) { return std::stod(row[i]); };
  Surface s = aluminium_plate();
  const double w0 = number(0), w1 = number(1), length = number(2);
  TabulatedTaper table;
  constexpr int points = 300;
  for (int i = 0; i <= points; ++i) {
    const double t = static_cast<double>(i) / points;
    table.points.push_back({length * t, w1 + (w0 - w1) * (1 + std::cos(M_PI * t)) / 2});
  }
  s.taper = table;
  s.length_m = length;
  s.thickness_m = number(3);
  s.tension_Pa = number(4);
  s.bending = Bending::on;
  turnpoint::physics_test::set_wave_loss(s, number(5), number(6));
  return s;
}

}  // namespace

TEST_CASE("resonances and fields within 1e-13 of one agree with Bessel functions in 40 digits",
          "[physics][oracle]") {
  double resonance_error = 0, gain_error = 0, peak_error = 0;
  for (const auto& row : oracle("resonance.csv")) {
    const auto number = [&](std::size_t i) { return std::stod(row[i]); };
    Surface s = membrane(number(4));
    if (row[0] == "linear") s.taper = LinearTaper{number(2), number(1)};
    if (row[0] == "exponential") s.taper = ExponentialTaper{number(2), number(1)};
    s.length_m = number(3);
    const double resonance = number(5);
    const double found = nearest_resonance_Hz(s, resonance * 1.0001).value();
    CAPTURE(row[0], row[1], row[2], row[3], row[4], resonance, found);
    resonance_error = std::max(resonance_error, std::abs(found / resonance - 1));
    for (std::size_t i = 6; i < row.size(); i += 4) {
      const Tone tone{number(i), 1, 0};
      const double ln_gain = number(i + 1), peak = number(i + 2), conditioning = number(i + 3);
      const Field field = evaluate(s, {&tone, 1}, {&peak, 1}, Model::mode, Normalise::drive);
      const ToneInfo& info = field.tones[0].info;
      CAPTURE(tone.frequency_Hz / resonance - 1, conditioning, info.conditioning);
      const double k = wavenumber_per_m(s, tone.frequency_Hz);
      const double allowed = std::max(1e-12, 8 * eps * k * s.length_m) * conditioning;
      CHECK(std::abs(std::log(info.gain) - ln_gain) < allowed);
      CHECK(std::abs(field.ln_amplitude[0] - ln_gain) < allowed);
      CHECK(std::abs(std::log(info.conditioning / conditioning)) < allowed);
      const FieldNotes notes = describe(s, {&tone, 1}, field);
      CHECK(warns(notes, "ill-conditioned") == (conditioning > 100));
      CHECK(notes.error_bound > std::abs(std::expm1(field.ln_amplitude[0] - ln_gain)));
      gain_error = std::max(gain_error, std::abs(std::log(info.gain) - ln_gain) / conditioning);
      peak_error = std::max(peak_error, std::abs(info.last_peak_m.value() - peak));
    }
  }
  CAPTURE(resonance_error, gain_error, peak_error);
  CHECK(resonance_error < 1e-13);
  CHECK(gain_error < 1e-12);
  CHECK(peak_error < 1e-12);
}

TEST_CASE("fields of uniform strips near their resonances stay within the bound around the closed form",
          "[physics][oracle]") {
  double off_resonance = 0, shape_error = 0, at_resonance = 0;
  for (const auto& row : oracle("strip.csv")) {
    const Surface s = strip_of(row);
    const Tone tone{std::stod(row[8]), 1, 0};
    std::vector<double> x;
    for (int i = 1; i < 10; ++i) x.push_back(s.length_m * (i / 10.37));
    for (const Model model : {Model::mode, Model::modes}) {
      // compare `mode` with the references without a piston, which have a single transverse function, and
      // `modes` with the others
      if ((model == Model::mode) == (row[1] == "piston")) continue;
      if (model == Model::modes && row[0] == "clamped") continue;
      CAPTURE(row[0], row[1], row[5], row[6], row[7], name(model));
      const Field drive = evaluate(s, {&tone, 1}, x, model, Normalise::drive);
      const Field peak = evaluate(s, {&tone, 1}, x, model, Normalise::peak);
      const FieldNotes notes = describe(s, {&tone, 1}, drive);
      const double error = miss(drive.tones[0].v, row, 9).relative();
      CAPTURE(error, notes.error_bound);
      CHECK(error <= notes.error_bound);
      CHECK(warns(notes, "ill-conditioned") == (drive.tones[0].info.conditioning > 100));
      if (row[0] == "clamped" && row[6] != "0") {
        const double resonance = tone.frequency_Hz / (1 + std::stod(row[7]));
        const double found = nearest_resonance_Hz(s, resonance * 1.0005).value();
        CHECK(std::abs(found / resonance - 1) <
              // thin plates have boundary layers, so their error is larger
              (s.thickness_m < 0.4e-3 ? 1e-6 : 2e-9));
      }
      // Errors of the shape alone, which the division by v(0) does not amplify.
      double exact = 0, same_shape = 0;
      for (std::size_t i = 9; i < row.size(); i += 2) exact = std::max(exact, std::abs(complex_at(row, i)));
      const double scale = largest(peak.tones[0].v) / exact;
      for (std::size_t i = 0; i < x.size(); ++i)
        same_shape =
            std::max(same_shape, std::abs(peak.amplitude[i] - scale * std::abs(complex_at(row, 9 + 2 * i))));
      CHECK(same_shape < 1e-4 * scale * exact);
      shape_error = std::max(shape_error, same_shape / (scale * exact));
      double& worst = row[6] == "0" ? off_resonance : at_resonance;
      worst = std::max(worst, error);
    }
  }
  CAPTURE(off_resonance, shape_error, at_resonance);
  CHECK(off_resonance < 1e-3);
  CHECK(at_resonance > 0.5);  // negative control: some of the tested errors are large
}

TEST_CASE("a piston or a cosine on a membrane's straight edge moves it as finite elements say",
          "[physics][oracle]") {
  for (const auto& row : oracle("drive.csv")) {
    const auto number = [&](std::size_t i) { return std::stod(row[i]); };
    Surface s = membrane(number(5));
    s.drive = row[0] == "piston" ? DriveShape::piston : DriveShape::cosine;
    s.length_m = number(2);
    s.taper = LinearTaper{number(1), number(3)};
    REQUIRE(std::stod(row.back()) < 2e-5);  // the table's own error, estimated with a coarser mesh
    std::vector<double> x;
    for (int i = 1; i < 20; ++i) x.push_back(s.length_m * i / 20);
    const Tone tone{number(4), 1, 0};
    const Field modes = evaluate(s, {&tone, 1}, x, Model::modes, Normalise::drive);
    const double error = miss(modes.tones[0].v, row, 6).relative();
    CAPTURE(row[0], row[1], row[2], row[3], row[4], row[5], error);
    CHECK(error < 1e-4);
    const Field mode = evaluate(s, {&tone, 1}, x, Model::mode, Normalise::drive);
    const double one_mode = miss(mode.tones[0].v, row, 6).relative();
    CHECK(one_mode <= describe(s, {&tone, 1}, mode).error_bound);
    CHECK(one_mode > 1e-4);  // negative control: the one-mode model differs measurably
  }
}

TEST_CASE("curved clamped plates, also under tension, move as a solution by collocation says",
          "[physics][oracle]") {
  for (const auto& row : oracle("curved_plate.csv")) {
    const Surface s = curved_plate(row);
    REQUIRE(std::stod(row.back()) < 1e-5);  // the table's own error, estimated with a coarser grid
    std::vector<double> x;
    for (int i = 0; i <= 20; ++i) x.push_back(s.length_m * i / 20);
    const Tone tone{std::stod(row[5]), 1, 0};
    const Field modes = evaluate(s, {&tone, 1}, x, Model::modes, Normalise::drive);
    const double error = miss(modes.tones[0].v, row, 7).relative();
    CAPTURE(row[0], row[1], row[3], row[4], row[5], row[6], error);
    CHECK(error < 1e-4);
    const Field mode = evaluate(s, {&tone, 1}, x, Model::mode, Normalise::drive);
    const double one_mode = miss(mode.tones[0].v, row, 7).relative();
    CAPTURE(one_mode);
    CHECK(one_mode <= describe(s, {&tone, 1}, mode).error_bound);
    CHECK(one_mode > 1e-4);  // negative control: the one-mode model differs measurably
  }
}

TEST_CASE("the tones of a designed profile give the stated residual with Bessel functions and SciPy's fit",
          "[physics][oracle]") {
  Surface s;
  ToneBand band;
  std::vector<std::vector<std::string>> tones;
  double worst_forward = 0;
  int designs = 0;
  for (const auto& row : oracle("profile.csv")) {
    const auto number = [&](std::size_t i) { return std::stod(row[i]); };
    if (row[0] == "surface") {
      s = membrane(number(1));
      s.taper = LinearTaper{0.03, 0.1};
      s.length_m = 0.27;
      band = {number(2), number(3), number(4)};
      tones.clear();
    }
    if (row[0] == "tone") tones.push_back(row);
    if (row[0] != "target") continue;
    ++designs;
    std::vector<ProfilePoint> target;
    for (std::size_t i = 2; i < row.size(); ++i)
      target.push_back({0.001 + 0.005 * static_cast<double>(i - 2), 1e-6 * std::sqrt(number(i))});
    const ProfileDesign design = design_profile(s, target, band);
    double sum = 0, norm = 0;
    for (std::size_t i = 2; i < row.size(); ++i) {
      double square = 0;
      for (const Tone& tone : design.tones) {
        const auto same = std::ranges::find_if(tones, [&](const auto& t) {
          return std::abs(std::stod(t[1]) - tone.frequency_Hz) < 1e-9 * tone.frequency_Hz;
        });
        REQUIRE(same != tones.end());
        square += 1e12 * tone.amplitude_m * tone.amplitude_m * std::stod((*same)[i]);
      }
      sum += (square - number(i)) * (square - number(i));
      norm += number(i) * number(i);
    }
    const double forward = std::sqrt(sum / norm), best = number(1);
    CAPTURE(design.verdict, forward, best);
    CHECK(std::abs(design.residual - best) < 1e-5);
    CHECK(design.reachable == (best < 0.25));
    worst_forward = std::max(worst_forward, std::abs(design.residual - forward));
  }
  CHECK(designs == 6);
  CHECK(worst_forward < 1e-9);
}

TEST_CASE("a taper given by points that meet at the cut-off is as exact as the straight taper", "[physics]") {
  // The turning point is exactly at a point of the table: at the drive edge, inside, and at the clamped end.
  for (const double turning_m : {0.0, 0.1, 0.25}) {
    Surface s = membrane(60);
    s.taper = LinearTaper{0.03, 0.1};
    s.length_m = 0.25;
    const Tone tone{800 / (4 * (0.03 - 0.1 * turning_m)), 1, 0};
    const std::vector<double> x{0, 0.01, 0.1, 0.15, 0.2, 0.245};
    const Field exact = evaluate(s, {&tone, 1}, x, Model::mode, Normalise::drive);
    TabulatedTaper table;
    for (const double at : {0.0, 0.1, 0.25}) table.points.push_back({at, 0.03 - 0.1 * at});
    s.taper = table;
    for (const double f :
         {tone.frequency_Hz, std::nextafter(tone.frequency_Hz, 0), std::nextafter(tone.frequency_Hz, 1e9)}) {
      const Tone near{f, 1, 0};
      const Field found = evaluate(s, {&near, 1}, x, Model::mode, Normalise::drive);
      CAPTURE(turning_m, f - tone.frequency_Hz);
      for (std::size_t i = 0; i < x.size(); ++i)
        CHECK(std::abs(found.tones[0].v[i] - exact.tones[0].v[i]) < 1e-12 * largest(exact.tones[0].v));
      CHECK(std::isfinite(describe(s, {&near, 1}, found).error_bound));
    }
  }
}

TEST_CASE("a thick plate refuses a piston drive, and a profile refuses endless bands", "[physics]") {
  Surface s = aluminium_plate();
  s.drive = DriveShape::piston;
  s.theory = PlateTheory::mindlin;
  CHECK_THROWS_AS(make_centre_line(s, 30e3, Model::modes), std::domain_error);
  s.drive = DriveShape::cosine;
  CHECK_NOTHROW(make_centre_line(s, 30e3, Model::modes));
  const double infinite = std::numeric_limits<double>::infinity();
  std::vector<ProfilePoint> target{{0.1, 1e-6}, {0.2, 1e-7}};
  const Surface brass = seed_brass();
  CHECK_THROWS_AS(design_profile(brass, target, {8000, infinite, 1000}), std::invalid_argument);
  CHECK_THROWS_AS(design_profile(brass, target, {8000, 45000, 1e-300}), std::invalid_argument);
  target[0].amplitude_m = infinite;
  CHECK_THROWS_AS(design_profile(brass, target, {8000, 45000, 1000}), std::invalid_argument);
}

// These tests count memory allocations during the evaluation of a profile. None may depend on the number of
// points.
#include "physics/boundary_map.hpp"
#include "physics/centre_line.hpp"
#include "physics/field.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/count_allocations.hpp"

using namespace turnpoint::physics;

namespace {

long allocated_by(const CentreLine& line, std::size_t points) {
  std::vector<double> x(points), ln(points);
  std::vector<std::complex<double>> v(points);
  for (std::size_t i = 0; i < points; ++i) x[i] = 0.29 * static_cast<double>(i) / static_cast<double>(points);
  const long before = allocations;
  line.evaluate(x, 1.0, 0.0, v, ln);
  return allocations - before;
}

}  // namespace

TEST_CASE("evaluating a profile allocates no memory per point, with any model", "[physics]") {
  for (const bool plate : {false, true}) {
    Surface surface = plate ? aluminium_plate() : seed_brass();
    surface.quality_factor = 60;
    for (const Model model : all_models) {
      if (model == Model::edge) continue;
      const auto line = make_centre_line(surface, 30e3, model);
      CAPTURE(plate, name(model));
      CHECK(allocated_by(*line, 2000) == allocated_by(*line, 20));
    }
  }
}

TEST_CASE("the field of one tone solves its model only once", "[physics]") {
  Surface surface = seed_brass();
  surface.quality_factor = 60;
  const Tone tone{30e3, 1, 0};
  const double x = 0.1;
  const auto allocated = [](const auto& call) {
    const long before = allocations;
    call();
    return allocations - before;
  };
  for (const Model model : {Model::mode, Model::modes}) {
    const long solution = allocated([&] { make_centre_line(surface, 30e3, model); });
    const long field = allocated([&] { evaluate(surface, {&tone, 1}, {&x, 1}, model, Normalise::peak); });
    const long notes = allocated([&] {
      describe(surface, {&tone, 1}, evaluate(surface, {&tone, 1}, {&x, 1}, model, Normalise::peak));
    });
    CAPTURE(name(model), solution, field, notes);
    CHECK(field <= solution + 8);  // a Field has 8 vectors besides the solution
    // negative control: describe() solves the surface several more times, which allocates more memory
    CHECK(notes > field + 3 * solution / (model == Model::mode ? 1 : 100));
  }
}

TEST_CASE("a look-up in a boundary map allocates no memory", "[physics]") {
  const BoundaryMap map(seed_brass(), {Edge::percent(0.5), {}, {}, {}});
  const long before = allocations;
  double sum = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto x = map.boundary_m(10e3 + 20 * i);
    sum += x.value_or(0) + map.frequency_Hz(x.value_or(0.1)).value_or(0);
  }
  CHECK(allocations == before);
  CHECK(sum > 0);
  // Negative control: the counter counts an allocation.
  const auto one = std::make_unique<double>(sum);
  CHECK(allocations == before + 1);
}

#include "physics/operations.hpp"

#include <thread>

#include "physics/field.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

namespace {

template <class Work>
double operations_of(Work work) {
  const double before = operations_done();
  work();
  return operations_done() - before;
}

double operations_of_field(const Surface& surface, double frequency_Hz, int points, Model model) {
  return operations_of([&] {
    evaluate(surface, std::vector{Tone{frequency_Hz, 1, 0}}, linspace_points(surface, points), model,
             Normalise::peak);
  });
}

}  // namespace

TEST_CASE("the count of an elimination and of a factorisation is that of their loops", "[physics]") {
  for (const int size : {1, 2, 5, 12}) {
    for (int eliminated = 0; eliminated <= size; ++eliminated) {
      double loops = 0;  // column by column, the lower triangle of what remains
      for (int i = 0; i < eliminated; ++i)
        for (int row = i + 1; row < size; ++row)
          for (int column = i + 1; column <= row; ++column) loops += 8;
      CAPTURE(size, eliminated);
      CHECK(operations_of([&] { count_elimination(size, eliminated); }) == Approx(loops));
    }
  }
  // to leading order, a factorisation takes size^3 / 3 complex steps, and a right side size^2
  CHECK(operations_of([] { count_factorisation(100, 0); }) == Approx(8e6 / 3));
  CHECK(operations_of([] { count_factorisation(100, 5); }) == Approx(8e6 / 3 + 8 * 5e4));
}

TEST_CASE("the same work counts the same again and on another thread, and other threads do not count here",
          "[physics]") {
  const Surface plate = aluminium_plate();
  for (const Model model : {Model::mode, Model::modes}) {
    const double here = operations_of_field(plate, 30e3, 1000, model);
    CHECK(here > 1e5);
    CHECK(operations_of_field(plate, 30e3, 1000, model) == Approx(here).epsilon(1e-9));
    double there = 0;
    const double meanwhile = operations_of(
        [&] { std::thread([&] { there = operations_of_field(plate, 30e3, 1000, model); }).join(); });
    CHECK(there == Approx(here).epsilon(1e-9));
    CHECK(meanwhile == 0);
  }
}

TEST_CASE("a field of more points, of two modes more or of the better model takes more operations",
          "[physics]") {
  const Surface brass = seed_brass();
  const auto of = [&](double frequency_Hz, int points, Model model) {
    return operations_of_field(brass, frequency_Hz, points, model);
  };
  for (const Model model : {Model::mode, Model::modes}) {
    const double few = of(20e3, 1000, model), many = of(20e3, 2000, model), most = of(20e3, 3000, model);
    CHECK(many - few > 100 * 1000);
    CHECK(most - many == Approx(many - few).epsilon(1e-2));  // points cost the same each
  }
  CHECK(of(40e3, 100, Model::modes) > 2 * of(20e3, 100, Model::modes));
  CHECK(of(20e3, 1000, Model::modes) > 5 * of(20e3, 1000, Model::mode));
}

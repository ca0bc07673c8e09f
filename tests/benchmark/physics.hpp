#pragma once
#include <string>
#include <vector>

#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// What an error is measured against, and so which answers can be compared.
enum class Task {
  field,     ///< the two-dimensional field, by `modes` at a much finer resolution
  equation,  ///< the one-mode equation, in extended precision by an unrelated method
  airy,      ///< the seed's closed Airy profile
  look_up    ///< boundary <-> frequency from a map: the round trip, in metres
};

/// One measured row. `error` is the largest difference of |v|, last maximum at one (look_up: metres);
/// negative: not measured.
struct PhysicsRow {
  Task task = Task::field;
  std::string scene;    ///< "seed brass 19.6 kHz, lossless", ...
  std::string solver;   ///< a rung's name, or a general solver's
  std::string setting;  ///< tolerance or resolution
  int points = 0;
  double seconds = 0;  ///< best of several runs, all points
  double error = -1;
};

/// Every rung on six scenes (the seed's membrane at two frequencies with and without loss, an exponential
/// taper, a clamped plate), and the general solvers that a user would take instead, for about `budget_s`.
std::vector<PhysicsRow> measure_physics(double budget_s);

/// The pictures: error against time, a panel a scene, for the field and for the equation.
std::vector<Picture> physics_pictures(const std::vector<PhysicsRow>& rows);

Report bench_physics(double budget_s);

}  // namespace turnpoint::benchmark

#pragma once
#include <string>
#include <vector>

#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// The reference for the error. Only answers with the same reference can be compared.
enum class Task {
  field,     ///< the two-dimensional field, by `modes` at a much finer resolution
  equation,  ///< the one-mode equation, in extended precision by an unrelated method
  airy,      ///< the seed's closed Airy profile
  look_up    ///< conversion between boundary and frequency by a map: error of the round trip, in metres
};

/// One row of results. `error` is the largest difference of |v| with the last maximum at one (for look_up:
/// metres); negative means not measured.
struct PhysicsRow {
  Task task = Task::field;
  std::string scene;    ///< "seed brass 19.6 kHz, lossless", ...
  std::string solver;   ///< name of a model or of a general solver
  std::string setting;  ///< tolerance or resolution
  int points = 0;
  double seconds = 0;  ///< best of several runs, for all points
  double error = -1;
};

/// Measures every model on six scenes (the 1998 brass membrane at two frequencies with and without loss, an
/// exponential taper, a clamped plate), and general solvers that a user could use instead. Takes about
/// `budget_s`.
std::vector<PhysicsRow> measure_physics(double budget_s);

/// Figures of error against time, one panel per scene, for the field and for the equation.
std::vector<Picture> physics_pictures(const std::vector<PhysicsRow>& rows);

Report bench_physics(double budget_s);

}  // namespace turnpoint::benchmark

#pragma once
#include <string>
#include <vector>

#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// Selects the reference solution for the error. Only errors against the same reference can be compared.
enum class Task {
  /// Reference: the two-dimensional field, computed with the model `modes` at a much finer resolution.
  field,
  /// Reference: the one-mode equation solved in extended precision by a method that shares no code with the
  /// library.
  equation,
  /// Reference: three-dimensional finite elements of a whole plate (tests/physics/oracles/elastic_taper.csv).
  /// The error (m) is that of p50, the boundary at 50 % of the amplitude.
  theory,
  /// Converts a boundary to a frequency and back with a BoundaryMap; the error is that of the result (m).
  look_up
};

/// One row of results. `error` is the largest difference of |v|, with the last maximum scaled to one. For the
/// tasks theory and look_up it is in metres. A negative error means that it was not measured.
struct PhysicsRow {
  Task task = Task::field;
  std::string scene;    ///< such as "seed brass 19.6 kHz, lossless"
  std::string solver;   ///< name of a model or of a general solver
  std::string setting;  ///< tolerance or resolution
  int points = 0;
  double seconds = 0;  ///< time for all points, best of several runs
  double error = -1;
};

/// Measures every model on six scenes (the 1998 brass membrane at two frequencies with and without loss, an
/// exponential taper, a clamped plate), the plate theories at three frequencies, and general solvers that a
/// user could use instead. Takes about `budget_s`.
std::vector<PhysicsRow> measure_physics(double budget_s);

/// Returns figures that plot the error against the time, with one panel per scene: one figure for each of the
/// tasks `field`, `theory` and `equation`.
std::vector<Picture> physics_pictures(const std::vector<PhysicsRow>& rows);

Report bench_physics(double budget_s);

}  // namespace turnpoint::benchmark

#pragma once
// The table behind a BoundaryMap: where an edge lies, as a ratio of half-widths against frequency.
#include <array>
#include <optional>
#include <vector>

#include "physics/boundary_map.hpp"

namespace turnpoint::physics {

// ratio(f) = W(edge) / (cut-off half-width at f). One constant when `closed`, else Chebyshev pieces in ln f.
struct EdgeTable {
  static constexpr int degree = 12;
  struct Piece {
    double low, high;  // ln f
    std::array<double, degree + 1> coefficient;
  };
  double low_Hz = 0;   // frequencies at which the edge lies on the surface
  double high_Hz = 0;  // infinity on a linear taper that runs to its apex
  double constant = 1;
  std::vector<Piece> pieces;  // ascending; gaps are frequencies without the edge
  double error_m = 0;         // largest error seen at check points between the nodes
  bool closed = true;

  std::optional<double> ratio(double frequency_Hz) const noexcept;
};

// Builds and validates the table; throws std::domain_error when the edge exists at no frequency.
EdgeTable make_edge_table(const Surface& surface, const MapOptions& options, Model model);

}  // namespace turnpoint::physics

#pragma once
// The table from which a BoundaryMap reads the position of an edge. It stores a ratio of half-widths as a
// function of frequency.
#include <array>
#include <optional>
#include <vector>

#include "physics/boundary_map.hpp"
#include "physics/statement.hpp"

namespace turnpoint::physics {

// A table of ratio(f) = W(edge) / (cut-off half-width at f). If `closed` is true, the ratio is `constant`;
// otherwise each piece is a Chebyshev series in ln f.
struct EdgeTable {
  static constexpr int degree = 12;
  struct Piece {
    double low, high;  // the piece covers ln f from low to high
    std::array<double, degree + 1> coefficient;
  };
  double low_Hz = 0;  // lowest frequency at which the edge lies on the surface
  // highest frequency at which the edge lies on the surface; infinity on a linear taper that ends at its apex
  double high_Hz = 0;
  double constant = 1;
  std::vector<Piece> pieces;  // ascending; in a gap between two pieces the edge does not exist
  double error_m = 0;         // largest error at the check points, which lie between the nodes
  bool closed = true;

  std::optional<double> ratio(double frequency_Hz) const noexcept;
};

Refused no_such_edge(const Edge& edge);

// The table without its pieces: between which frequencies the edge exists takes a fraction of the time.
// Throws Refused if it exists at no frequency.
EdgeTable edge_limits(const Surface& surface, const MapOptions& options, Model model);

// Builds and validates the table. Throws Refused if the edge exists at no frequency.
EdgeTable make_edge_table(const Surface& surface, const MapOptions& options, Model model);

}  // namespace turnpoint::physics

#include <cstdio>

#include "physics/boundary_map.hpp"
#include "physics/field.hpp"
using namespace turnpoint::physics;
int main() {
  const Surface plate = aluminium_plate();
  const BoundaryMap map(plate, {parse_edge("p50"), {}, {}, {}});
  const double f = map.frequency_Hz(0.150).value();
  std::printf("a boundary at 150 mm: %.1f Hz, %.3f um at the drive edge for 1 um at the last maximum\n", f,
              1e6 * drive_amplitude_m(plate, f, 1e-6));
}

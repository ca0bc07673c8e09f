#pragma once
// The ways to define where the boundary of a smooth zone lies.
#include <string>
#include <string_view>

namespace turnpoint::physics {

// The ways to define where a zone ends, by the tone's displacement v along the centre line:
//   turning   where the local cut-off of the first transverse mode equals the tone's frequency (1998 paper,
//             eq. 17)
//   peak      last maximum of |v|
//   percent   outermost point at which |v| is `level` times its last maximum, 0 < level < 1
//   friction  outermost point where friction, averaged over the fingertip, crosses `level`, 0 < level < 1
struct Edge {
  enum class Kind { turning, peak, percent, friction };
  Kind kind = Kind::turning;
  double level = 0;

  static Edge turning() { return {Kind::turning, 0}; }
  static Edge peak() { return {Kind::peak, 0}; }
  static Edge percent(double level) { return {Kind::percent, level}; }
  static Edge friction(double level) { return {Kind::friction, level}; }
  bool operator==(const Edge&) const = default;
};

// Reads "turning", "peak", "p70" (two digits, 01 ... 99) or "friction=0.7". For other texts it throws
// std::invalid_argument, with a list of what is allowed. `format` writes these texts.
Edge parse_edge(std::string_view text);
std::string format(const Edge& edge);

}  // namespace turnpoint::physics

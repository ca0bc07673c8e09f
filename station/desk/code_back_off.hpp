#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

namespace turnpoint::desk {

/// Decides how long a keypad refuses codes after wrong ones. After the first and the second wrong code,
/// another one is accepted at once. The third wrong code starts a wait of 5 s, and each further one doubles
/// the wait, up to 5 min. The right code ends the wait. Trying all ten thousand codes of four digits
/// therefore takes over a month. Pure: the caller passes the time (s, monotonic).
class CodeBackOff {
 public:
  static constexpr int free_tries = 2;
  static constexpr double first_s = 5, longest_s = 300;

  void wrong(double now_s) {
    ++wrong_;
    if (wrong_ <= free_tries) return;
    const double wait_s = std::ldexp(first_s, std::min(wrong_ - free_tries - 1, 10));
    until_s_ = now_s + std::min(wait_s, longest_s);
  }
  void right() { *this = {}; }
  /// Seconds until the next code is accepted; 0 if one is accepted now.
  double wait_s(double now_s) const { return std::max(0.0, until_s_ - now_s); }
  int wrong_tries() const { return wrong_; }

 private:
  int wrong_ = 0;
  double until_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace turnpoint::desk

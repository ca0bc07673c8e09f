#include "station/sensing/sample_loops_avx2.hpp"

namespace turnpoint::sensing {

const SampleLoops& best_loops() noexcept {
  static const SampleLoops& chosen = __builtin_cpu_supports("avx2") ? avx2_loops() : generic_loops();
  return chosen;
}

}  // namespace turnpoint::sensing

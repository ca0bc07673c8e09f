#include "station/drive/oscillator_avx2.hpp"

namespace turnpoint::drive {

const Kernels& best_kernels() noexcept {
  static const Kernels& chosen = __builtin_cpu_supports("avx2") ? avx2_kernels() : generic_kernels();
  return chosen;
}

}  // namespace turnpoint::drive

#include "station/drive/oscillator.hpp"

namespace turnpoint::drive {

const Kernels& avx2_kernels() noexcept;

const Kernels& best_kernels() noexcept {
  static const Kernels& chosen =
      __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? avx2_kernels() : generic_kernels();
  return chosen;
}

}  // namespace turnpoint::drive

#include "station/audio/oscillator_avx2.hpp"

namespace turnpoint::audio {

const Kernels& best_kernels() noexcept {
  static const Kernels& chosen = __builtin_cpu_supports("avx2") ? avx2_kernels() : generic_kernels();
  return chosen;
}

}  // namespace turnpoint::audio

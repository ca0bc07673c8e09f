// Compiled with -mavx2; called only where oscillator_dispatch_x86.cpp has found it. No fused multiply-add
// here: the loops give the same bits everywhere.
#include "station/drive/oscillator_avx2.hpp"
#include "station/drive/oscillator_kernels.hpp"

namespace turnpoint::drive {

const Kernels& avx2_kernels() noexcept {
  static constexpr Kernels kernels{"avx2", steady, gliding};
  return kernels;
}

}  // namespace turnpoint::drive

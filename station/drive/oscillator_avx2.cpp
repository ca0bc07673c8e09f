// Compiled with -mavx2 -mfma; called only where oscillator_dispatch_x86.cpp has found both.
#include "station/drive/oscillator_kernels.hpp"

namespace turnpoint::drive {

const Kernels& avx2_kernels() noexcept;

const Kernels& avx2_kernels() noexcept {
  static constexpr Kernels kernels{"avx2", steady, gliding, steady_float, gliding_float};
  return kernels;
}

}  // namespace turnpoint::drive

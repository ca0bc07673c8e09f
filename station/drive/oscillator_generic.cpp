#include "station/drive/oscillator_kernels.hpp"

namespace turnpoint::drive {

const Kernels& generic_kernels() noexcept {
  static constexpr Kernels kernels{"generic", steady, gliding, steady_float, gliding_float};
  return kernels;
}

}  // namespace turnpoint::drive

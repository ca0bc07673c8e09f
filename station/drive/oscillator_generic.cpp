#include "station/drive/oscillator_kernels.hpp"

namespace turnpoint::drive {

const Kernels& generic_kernels() noexcept {
  static constexpr Kernels kernels{"generic", steady, gliding};
  return kernels;
}

}  // namespace turnpoint::drive

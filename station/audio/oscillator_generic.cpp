#include "station/audio/oscillator_kernels.hpp"

namespace turnpoint::audio {

const Kernels& generic_kernels() noexcept {
  static constexpr Kernels kernels{"generic", steady, gliding};
  return kernels;
}

}  // namespace turnpoint::audio

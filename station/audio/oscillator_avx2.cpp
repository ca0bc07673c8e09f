// The oscillator's inner loops for processors with AVX2. This file is compiled with -mavx2, and its code is
// called only if oscillator_dispatch_x86.cpp has detected AVX2. It must not use fused multiply-add, because
// the loops must give the same bits on every processor.
#include "station/audio/oscillator_avx2.hpp"
#include "station/audio/oscillator_kernels.hpp"

namespace turnpoint::audio {

const Kernels& avx2_kernels() noexcept {
  static constexpr Kernels kernels{"avx2", steady, gliding};
  return kernels;
}

}  // namespace turnpoint::audio

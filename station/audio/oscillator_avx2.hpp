#pragma once
#include "station/audio/oscillator.hpp"

namespace turnpoint::audio {

/// The oscillator's inner loops for AVX2. Call it only on processors with AVX2.
const Kernels& avx2_kernels() noexcept;

}  // namespace turnpoint::audio

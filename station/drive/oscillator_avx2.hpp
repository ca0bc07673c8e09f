#pragma once
#include "station/drive/oscillator.hpp"

namespace turnpoint::drive {

/// The oscillator's inner loops for AVX2. Call it only on processors with AVX2.
const Kernels& avx2_kernels() noexcept;

}  // namespace turnpoint::drive

#pragma once
#include "station/drive/oscillator.hpp"

namespace turnpoint::drive {

/// Only for processors with AVX2.
const Kernels& avx2_kernels() noexcept;

}  // namespace turnpoint::drive

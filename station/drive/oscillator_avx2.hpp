#pragma once
#include "station/drive/oscillator.hpp"

namespace turnpoint::drive {

/// The AVX2 version of the loops. Call it only on processors with AVX2.
const Kernels& avx2_kernels() noexcept;

}  // namespace turnpoint::drive

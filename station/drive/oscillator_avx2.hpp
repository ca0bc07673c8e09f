#pragma once
#include "station/drive/oscillator.hpp"

namespace turnpoint::drive {

/// Only for processors with AVX2 and FMA.
const Kernels& avx2_kernels() noexcept;
void steady_float_avx2(float* sum, int frames, Partial partial) noexcept;
void gliding_float_avx2(float* sum, int frames, Partial partial, const double* shape) noexcept;

}  // namespace turnpoint::drive

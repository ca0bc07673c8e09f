// The float loops with fused multiply-add, compiled with -mavx2 -mfma -ffp-contract=fast: their bits are
// nobody's reference, their speed is what they are for.
#include "station/drive/oscillator_avx2.hpp"
#include "station/drive/oscillator_kernels.hpp"

namespace turnpoint::drive {

void steady_float_avx2(float* sum, int frames, Partial partial) noexcept {
  steady_float(sum, frames, partial);
}

void gliding_float_avx2(float* sum, int frames, Partial partial, const double* shape) noexcept {
  gliding_float(sum, frames, partial, shape);
}

}  // namespace turnpoint::drive

// The loops for processors with AVX2. This file is compiled with -mavx2, and its code is called only if
// sample_loops_dispatch_x86.cpp has detected AVX2. It must not use fused multiply-add, because the loops must
// give the same bits on every processor.
#include "station/sensing/sample_loops_avx2.hpp"
#include "station/sensing/sample_loops_code.hpp"

namespace turnpoint::sensing {

const SampleLoops& avx2_loops() noexcept {
  static constexpr SampleLoops made = loops<32>("avx2");
  return made;
}

}  // namespace turnpoint::sensing

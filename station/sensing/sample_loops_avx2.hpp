#pragma once
#include "station/sensing/sample_loops.hpp"

namespace turnpoint::sensing {

/// The loops for AVX2. Call it only on processors with AVX2.
const SampleLoops& avx2_loops() noexcept;

}  // namespace turnpoint::sensing

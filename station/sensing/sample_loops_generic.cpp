#include "station/sensing/sample_loops_code.hpp"

namespace turnpoint::sensing {

const SampleLoops& generic_loops() noexcept {
  static constexpr SampleLoops made = loops<16>("generic");  // every 64-bit processor has such registers
  return made;
}

}  // namespace turnpoint::sensing

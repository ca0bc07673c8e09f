#include "station/drive/oscillator.hpp"

namespace turnpoint::drive {

const Kernels& best_kernels() noexcept { return generic_kernels(); }

}  // namespace turnpoint::drive

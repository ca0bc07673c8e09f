#include "station/audio/oscillator.hpp"

namespace turnpoint::audio {

const Kernels& best_kernels() noexcept { return generic_kernels(); }

}  // namespace turnpoint::audio

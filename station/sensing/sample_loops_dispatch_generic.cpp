#include "station/sensing/sample_loops.hpp"

namespace turnpoint::sensing {

const SampleLoops& best_loops() noexcept { return generic_loops(); }

}  // namespace turnpoint::sensing

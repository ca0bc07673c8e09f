#pragma once

namespace turnpoint::ui {

/// Marks the upper halves of the vector registers as unused. Qt's software renderer leaves them in use, and a
/// thread inherits that from the one that starts it. Instructions of the baseline, for which this program is
/// compiled, then wait for each other: on one processor the simulated sessions of the designer took seven
/// times as long. Call this first in each thread that the thread of the screen starts and that computes.
inline void clear_upper_halves() noexcept {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx")) __asm__ volatile("vzeroupper");
#endif
}

}  // namespace turnpoint::ui

#pragma once

namespace turnpoint::core {

/// The largest number of parts of a trial's intervals. Each part is a burst of the drive, and all bursts of a
/// trial are scheduled at once.
inline constexpr int kMostParts = 16;

/// How often at most a participant can ask for the intervals of a trial again, if the task allows it.
inline constexpr int kMostAgain = 20;

/// A silence that is shorter than this does not count as a rest of the finger, in s.
inline constexpr double kRest_s = 0.5;

/// The time over which the duty of a rig limits the vibration, in s.
inline constexpr double kExposureWindow_s = 60;

}  // namespace turnpoint::core

#include "tests/endurance/faults.hpp"

namespace endurance {

const char* name(Fault fault) {
  static constexpr const char* kNames[kFaults] = {
      "amplifier line", "stop pressed", "converter gone", "audio silent", "underrun",          "touch gone",
      "lines gone",     "disarm",       "repeat",         "pause",        "end session",       "clock jump",
      "disk full",      "kill",         "kill in write",  "power cut",    "power cut in write"};
  return kNames[static_cast<int>(fault)];
}

// std::uniform_int_distribution is not used, because its results differ between implementations, and these
// draws must be the same everywhere.
std::int64_t Course::between(std::int64_t low, std::int64_t high) {
  return low + static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(high - low + 1));
}

std::int64_t Course::seconds(double low, double high) {
  return between(static_cast<std::int64_t>(low * 1e9), static_cast<std::int64_t>(high * 1e9));
}

std::int64_t Course::until_next_ns() { return seconds(0.5 * mean_interval_s_, 1.5 * mean_interval_s_); }

Fault Course::next() {
  const auto drawn = between(0, kFaults - 1);
  ++count[static_cast<std::size_t>(drawn)];
  return static_cast<Fault>(drawn);
}

}  // namespace endurance

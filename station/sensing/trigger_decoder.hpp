#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "station/sensing/capture_block.hpp"

namespace turnpoint::sensing {

/// A trigger code that was found on a captured channel.
struct DecodedTrigger {
  double frame = 0;  ///< captured frame at which the code begins
  int code = 0;
  double amplitude = 0;  ///< amplitude of the code; 1 is full scale
};

/// Finds the codes of audio/trigger_code.hpp on one captured channel. It knows only the form of a code, not
/// which codes were sent or when, so it also finds codes that should not be there. A code is accepted if its
/// amplitude is at least `least_amplitude`, its correlation with its ideal wave is at least 0.9 (its check
/// bits are then right), and the bits before and after it are silent. This tolerates high-pass filtering, and
/// noise down to 10 dB below the code. Allocates nothing after the constructor, except for the codes that it
/// finds.
class TriggerDecoder {
 public:
  TriggerDecoder(int channel, std::int64_t bit_frames, double least_amplitude = 0.02);

  /// Takes the blocks in order. After a gap, only codes that begin after the gap are found.
  void push(const CaptureBlock& block);
  /// Removes and returns the codes found so far. A code is found two bits after its end.
  std::vector<DecodedTrigger> take();

 private:
  struct Candidate {
    DecodedTrigger trigger;
    std::int64_t frame = 0;
    double likeness = 0;
  };
  void push(std::int64_t value);
  std::int64_t sum(std::int64_t from, std::int64_t to) const;
  std::int64_t energy(std::int64_t from, std::int64_t to) const;
  bool starts_at(std::int64_t frame) const;
  std::optional<Candidate> candidate(std::int64_t frame) const;
  std::int64_t correlation(std::int64_t frame, std::uint32_t pattern) const;
  void conclude();

  const int channel_;
  const std::int64_t half_;
  const std::int64_t least_sum_;
  // Running sums of all values, and of their squares, up to each frame, in ring buffers. The sums of squares
  // may overflow; their differences are still right.
  std::vector<std::int64_t> sums_;
  std::vector<std::uint64_t> squares_;
  std::int64_t next_ = 0, origin_ = 0;
  std::int64_t sum_ = 0;
  std::uint64_t square_ = 0;
  std::optional<Candidate> best_;
  std::vector<DecodedTrigger> found_;
};

/// Finds the rising edges of pulses on one captured channel, such as those of a scanner. An edge counts when
/// the level rises above `high`, provided that it was below half of `high` since the previous edge.
class EdgeFinder {
 public:
  EdgeFinder(int channel, double high) : channel_(channel), high_(high) {}
  /// Takes a block and returns the captured frames of its edges.
  std::vector<std::int64_t> push(const CaptureBlock& block);

 private:
  int channel_;
  double high_;
  bool up_ = false;
};

}  // namespace turnpoint::sensing

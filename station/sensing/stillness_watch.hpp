#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "station/sensing/aligned_blocks.hpp"
#include "station/sensing/pick_up.hpp"

namespace turnpoint::sensing {

/// A vibration of a surface that should be still.
struct Disturbance {
  double frequency_Hz = 0;
  /// level relative to what the pick-up captures of a tone at full scale, at its best frequency
  double level_dB = 0;
};

/// Listens for a tone while the amplifier is off. Looks at 50 ms in every quarter of a second, with the
/// pick-up that responds best, in the band in which it is calibrated: the carrier of the force cells and
/// noises of the room are outside of it. For an ordinary thread; not thread-safe.
class StillnessWatch {
 public:
  /// A louder tone is a disturbance: 0.3 % of full drive.
  static constexpr double loudest_dB = -50;

  /// Without a calibrated pick-up, nothing is ever found.
  StillnessWatch(int rate_Hz, int channels, const std::vector<PickUp>& pick_ups);

  /// Takes frames that were captured while the amplifier was off and the plate had come to rest.
  void push(const CaptureBlock& block);
  /// Returns the tone that was too loud in two looks in a row, once.
  std::optional<Disturbance> take();

 private:
  void look(const AlignedBlock& block);

  int rate_Hz_;
  std::optional<PickUp> pick_up_;
  double low_Hz_ = 0, high_Hz_ = 0, full_scale_ = 0;
  std::optional<AlignedBlocks> blocks_;
  std::vector<double> window_;
  int blocks_taken_ = 0;  ///< number of blocks since the last look began
  bool heard_ = false;    ///< the last look found a tone
  std::optional<Disturbance> found_;
};

}  // namespace turnpoint::sensing

// The state of an IntervalProof. interval_proof.cpp takes the captured frames, and interval_measure.cpp
// computes the result from them.
#pragma once
#include <complex>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "station/sensing/aligned_blocks.hpp"
#include "station/sensing/glide_proof.hpp"
#include "station/sensing/interval_proof.hpp"
#include "station/sensing/joint_fit.hpp"
#include "station/sensing/lock_in.hpp"
#include "station/sensing/planned_lines.hpp"
#include "station/sensing/tone_sums.hpp"

namespace turnpoint::sensing {

constexpr double kShortest_s = 0.01;  // a shorter steady stretch is not measured
// time that the plate needs to follow a change: 7 time constants at Q 60
constexpr double kSettle_s = 0.005;

/// A window of captured frames to which all tones are fitted. Nothing changes in the burst during a window.
struct Window {
  std::size_t stretch = 0;
  std::int64_t first = 0, end = 0;  // first captured frame, and the one after the last
  bool valid = false;
  std::vector<std::uint64_t> phase;  // played phase of each line at the first frame, in 2^-64 cycles
  std::vector<std::complex<double>> amplitude;  // captured complex amplitudes, [pick-up][line]
  std::vector<double> residual;                 // mean squares of what the tones do not explain, after the
                                                // high-pass filter, [pick-up]
};

struct Measured {
  Stretch plan;
  std::vector<PlannedLine> lines;
  std::unique_ptr<ToneSums> sums;  // null once all frames of the stretch have been received
};

/// The lock-in that looks for the moment at which a ramp of the burst passes half its level.
struct RampWatch {
  bool planned = false;
  std::size_t stretch = 0;                ///< the steady tones before or after the ramp
  std::int64_t first = 0, end = 0;        ///< captured frames in which it looks
  double half_frame = 0;                  ///< captured frame at which the planned envelope is at half its level
  std::unique_ptr<HannWindow> hann;
  std::vector<std::complex<double>> points;  ///< of the main pick-up, [point][line]
  std::int64_t first_point = 0;
};

struct IntervalProof::State {
  explicit State(const IntervalPlan& plan);

  std::size_t pick_ups() const { return plan_.pick_ups.size(); }
  std::int64_t frames_of(double seconds) const { return std::llround(seconds * plan_.rate_Hz); }
  void add_parts();
  void add_stretch(Stretch plan);
  void add_glide(const Glide& glide, std::int64_t end_frame);
  void size_buffers();
  void change(const drive::Change& change, const drive::Format& format);
  void end_stretch_at(std::int64_t frame);
  void end_windows_at(std::int64_t end) noexcept;
  std::int64_t block_at_or_after(std::int64_t playback_frame) const;
  std::int64_t block_at_or_before(std::int64_t playback_frame) const;
  void add_windows(std::size_t stretch);
  std::int64_t needed_until() const noexcept;
  void add_onset();
  void add_offset();
  double planned_delay_frames(const std::vector<PlannedLine>& lines) const;
  void watch_ramp(RampWatch& watch, std::int64_t first, std::int64_t end);

  void end_at(std::int64_t playback_frame) noexcept;

  void take(const AlignedBlock& block);
  void follow(RampWatch& watch, const AlignedBlock& block, const ToneSums& sums) noexcept;
  void accumulate(const AlignedBlock& block, Window& window, const ToneSums& sums) noexcept;
  void finish(Window& window, const ToneSums& sums) noexcept;
  void keep_if_worst(const Window& window) noexcept;

  void conclude(std::optional<bool> in_contact);
  void measure_tones();
  void measure_tone(std::size_t stretch, const PlannedLine& line, std::size_t place);
  void measure_residual();
  void measure_products();
  void measure_brief();
  std::span<const double> unexplained();
  std::optional<double> ramp_error_us(const RampWatch& watch, bool rising) const;
  void find_lost();
  void judge_tones(const Limits& level);
  void judge_glides(const Limits& level);
  void judge_rest();
  std::optional<double> found_elsewhere(const ToneProof& tone);

  IntervalPlan plan_;
  LockInShape shape_;
  AlignedBlocks blocks_;
  PlannedTones tones_;
  std::vector<Measured> stretches_;
  std::vector<Window> windows_;
  std::vector<GlideProof> glides_;
  std::size_t current_glide_ = 0;
  int live_changes_ = 0;
  bool unplanned_ = false;            // a live change came that cannot be measured
  std::size_t current_ = 0;           // index of the window that is being filled
  std::int64_t begin_ = 0, end_ = 0;  // the burst's first captured frame, and the one after its last
  bool cut_ = false;                  // the burst was stopped
  std::int64_t next_ = 0;             // first captured frame that has not been received
  std::vector<std::uint8_t> good_;    // for each aligned block of the burst: 1 if it was captured
  std::size_t main_ = 0;              // index of the pick-up that captures the planned tones most strongly

  JointFit fit_;
  // sums of sample times sinusoid in the current window, [pick-up][line]
  std::vector<std::complex<double>> products_;
  std::vector<double> energy_;
  std::int64_t summed_ = 0;  // number of frames that products_ and energy_ contain
  std::vector<std::uint64_t> phases_, increments_;
  std::vector<double> raw_, worst_raw_;  // samples of the main pick-up in the current and in the worst window
  std::optional<std::size_t> worst_;  // window with the largest residual
  bool fit_subtracted_ = false;

  RampWatch onset_, offset_;

  IntervalResult result_;
  bool vibrates_ = false;
  std::vector<Finding> findings_;
};

}  // namespace turnpoint::sensing

#pragma once
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "station/core/proof.hpp"
#include "station/core/records.hpp"
#include "station/core/texts.hpp"
#include "station/rig/rig.hpp"
#include "station/system/condition.hpp"

namespace turnpoint::session {

using core::CheckRow;
using core::Verdict;

/// One check of the self-test: what was measured, and how it was judged.
struct Check {
  core::Phrase name;
  Verdict verdict = Verdict::passed;
  std::optional<double> value,
      limit;           ///< measured value and its limit; empty if the check measures no number
  std::string unit;    ///< unit of value and limit; "" if there is no number
  core::Phrase what;  ///< what was found, as a sentence for the operator
};

/// Returns the row that is stored for a check. It is in English.
CheckRow row_of(const Check& check);

/// A part of the rig does not work. Says so in the language of the screen; what() is in English.
class PartFailed : public std::runtime_error {
 public:
  explicit PartFailed(core::Phrase why);
  const core::Phrase& why() const { return why_; }

 private:
  core::Phrase why_;
};

/// The following structs are readings of the self-test. In each, `missing` says why nothing could be
/// measured; it is empty after a measurement.

/// The external monitor (a circuit, see deploy/README.md) must shut the gate of the amplifier if the
/// station's heartbeat signal stops. This reading was taken after the heartbeat was stopped while the enable
/// line was high.
struct GateReading {
  std::optional<core::Phrase> missing;
  bool opened = false;  ///< the gate was open while the heartbeat ran
  std::optional<double>
      dropped_s;  ///< time from the stop of the heartbeat until the gate was shut; empty: never
};

/// The result of asking somebody to press and release the stop button or a response button.
struct PressReading {
  std::optional<core::Phrase> missing;
  std::string button;  ///< name of the button; "" for the stop button
  bool pressed = false, released = false;
};

/// A quiet tone on one transducer at several levels, as the pick-ups measured it.
struct ToneReading {
  std::optional<core::Phrase> missing;
  std::string transducer;
  double frequency_Hz = 0;
  double ratio_dB = 0;  ///< measured level of the tone relative to its calibration
  /// largest difference between the levels relative to the calibration; empty if a level was not measured
  std::optional<double> nonlinearity_dB = {};
  core::Proof proof = core::Proof::unproven;
  core::ProofCause cause = core::ProofCause::none;
};

/// The reading of one force cell while no finger is on the surface.
struct CellReading {
  std::optional<core::Phrase> missing;
  core::Phrase cell;                  ///< name of the cell: "a", "b" or "lateral"
  std::optional<core::Phrase> fault;  ///< why the cell could not be read; empty if it was read
  double zero_N = 0, noise_mN = 0;     ///< mean force, and the standard deviation of the force signal
};

/// How the mixer of the sound card differs from its levels during the calibration.
struct MixerReading {
  std::size_t controls = 0;             ///< number of controls whose levels the calibration holds; 0: none
  std::vector<core::Phrase> changes;  ///< one sentence for each control that differs
};

/// Reads the mixers of the cards with which a rig plays and captures (audio::mixer_levels). Controls of
/// another card that captures have "capture: " before their names. Empty if there is no card or it cannot be
/// read.
std::map<std::string, std::string> mixer_levels(const rig::Rig& rig);

/// Compares the mixers with their levels during the calibration (`rig.mixer`).
MixerReading read_mixer(const rig::Rig& rig);

/// The wall clock, and by how much it was set (by a person or a time service) during the self-test.
struct ClockReading {
  system::WallClock clock;
  std::optional<double> jump_s;
};

/// Limits of the self-test. The monostable in deploy/README.md shuts the gate after 100 to 120 ms; with other
/// logic families, after up to 220 ms.
inline constexpr double kGateLimit_s = 0.25;
inline constexpr double kZeroLimit_N = 1;    ///< a tenth of a cell's rated load
inline constexpr double kNoiseLimit_mN = 2;  ///< the same limit as for the tare before a trial
inline constexpr double kToneLimit_dB = 1;   ///< a stimulus with a larger deviation is refused
/// The response of the pick-ups may differ by this much between three levels. From the first limit on, the
/// check says so, but passes.
inline constexpr double kLinearityFlag_dB = 0.1, kLinearityLimit_dB = 0.5;
inline constexpr double kHottest_C = 80;  ///< above this temperature, boards reduce their clock frequency
inline constexpr double kLeastDisk_MiB = 200;  ///< free disk space that a session needs
inline constexpr double kLongestPress_s = 20;  ///< how long the self-test waits for a press or a release

/// Each of these functions judges one reading; they use no device.
Check judged(const GateReading& reading);
Check judged(const PressReading& reading);
Check judged(const ToneReading& reading);
/// Judges whether the response to a tone is the same at all its levels; empty if they were not measured.
std::optional<Check> judged_linearity(const ToneReading& reading);
/// Returns two checks: one of the cell's zero and one of its noise.
std::vector<Check> judged(const CellReading& reading);
Check judged(const MixerReading& reading);
Check judged_temperature(std::optional<double> hottest_C);
Check judged(const ClockReading& reading);
Check judged(const system::Disk& disk);

/// The rig under test. Each function measures one part and may take seconds. If the part does not work at
/// all, the function throws PartFailed, or another std::exception with what the system says.
class SelfTestRig {
 public:
  virtual ~SelfTestRig() = default;
  virtual GateReading drop_heartbeat() = 0;
  virtual PressReading press_stop() = 0;
  virtual std::vector<PressReading> press_buttons() = 0;
  /// Returns one reading for each transducer, of a tone at three levels.
  virtual std::vector<ToneReading> play_tones() = 0;
  /// Must be called after play_tones(), during which the cells are captured.
  virtual std::vector<CellReading> read_cells() = 0;
  virtual MixerReading mixer() = 0;
  virtual std::optional<double> hottest_C() = 0;
  virtual ClockReading clock() = 0;
  virtual system::Disk disk() = 0;
};

/// Runs all checks. A part that throws has failed; the other parts are still checked.
std::vector<Check> self_test(SelfTestRig& rig);

/// True if no check failed. Checks that were not possible count as not failed.
bool passed(const std::vector<Check>& checks);

}  // namespace turnpoint::session

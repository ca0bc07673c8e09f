#pragma once
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "station/audio/alsa_capture.hpp"
#include "station/audio/engine.hpp"
#include "station/core/texts.hpp"
#include "station/io/converter.hpp"
#include "station/rig/calibration.hpp"
#include "station/rig/rig.hpp"
#include "station/sensing/force_calibration.hpp"
#include "station/simulation/setup.hpp"

namespace turnpoint::maintenance {

inline constexpr double kGravity_m_s2 = 9.81;  ///< converts the masses of weights to forces

/// Where the operator taps the plate, to show its resonances.
enum class Tap { none, from_above, along };

/// One step of the calibration with dead weights: a weight, a reading without one, or a tap.
struct WeightStep {
  bool tare = false;  ///< true for a reading with nothing on the surface
  double mass_g = 0, position_mm = 0;
  /// mass that hangs on the string and so pulls along the surface; negative if it pulls towards the wide edge
  double pull_g = 0;
  core::Phrase remark = {};  ///< why the step is repeated; usually empty
  Tap tap = Tap::none;

  /// text() is what the operator is asked to do; name() is what messages call a weight.
  core::Phrase text() const;
  core::Phrase name() const;
};

/// The steps for a surface of this length: a tare (a reading without a weight), then 20, 50, 100 and 200 g at
/// five places; then 20, 50 and 100 g over a pulley in both directions at two places, with 200 g standing on
/// the surface. Each place begins with a tare of its own.
std::vector<WeightStep> weight_steps(double length_mm);

/// Means of the signals of the strain-gauge bridges while nothing moved.
struct BridgeReading {
  /// Bridge / reference; from a converter with a clock of its own, the reading in the unit of its driver.
  std::array<double, 3> ratio{}, quadrature{}, sd{};
  double reference = 0;  ///< amplitude; 1 is full scale, 0: a converter with a clock of its own
};

/// Reads the bridges of a rig: with a card, or in the simulated laboratory, where it also puts the weights on
/// the surface.
class BridgeReader {
 public:
  virtual ~BridgeReader() = default;
  /// Reads the bridges during this step. Throws std::runtime_error, which names the wire if one is
  /// disconnected, or the device if frames were lost.
  virtual BridgeReading read(const WeightStep& step) = 0;
  /// Takes a quick reading, over a tenth of a second. Throws like read().
  virtual BridgeReading glance() { return {}; }
  /// Waits for a tap for a few seconds, and returns the frequency with which the plate rings; empty if it
  /// does not. Throws like read(). Taps are asked for only if the reader can notice them.
  virtual std::optional<double> tapped_Hz(Tap) { return std::nullopt; }
  virtual bool notices_taps() const { return false; }
};

/// Returns the frequency with which the most deflected of three cells rings (sensing/tap.hpp); empty if it
/// does not. `readings` has one list per cell, of `rate_Hz` readings a second.
std::optional<double> ringing_of(const std::array<std::vector<double>, 3>& readings, double rate_Hz);

/// The sound card of a rig whose force cells are read. `pause` is called to wait while nothing new was
/// captured.
struct BridgeDevices {
  std::unique_ptr<audio::Stream> stream;
  std::unique_ptr<audio::Capture> capture;
  std::function<void()> pause;
};
std::unique_ptr<BridgeReader> card_bridges(const rig::Rig& rig, BridgeDevices devices);

/// Reads cells on a converter with a clock of its own. `open` opens it.
std::unique_ptr<BridgeReader> converter_bridges(
    const rig::CellConverter& converter,
    const std::function<std::unique_ptr<io::Converter>(const io::Config&)>& open = io::open);

/// Opens the reader for the rig's force cells. Only the carrier is played, and the amplifier stays off.
/// `laboratory` changes the simulated laboratory; for tests. Throws core::UsageError for a rig without force
/// cells.
std::unique_ptr<BridgeReader> open_bridges(const rig::Rig& rig,
                                           const std::function<void(simulation::Setup&)>& laboratory = {});

/// The result of a calibration with dead weights.
struct ForceResult {
  rig::ForceCells cells;
  /// the readings with a weight; the tares (readings without a weight) are left out
  std::vector<WeightStep> steps;
  std::vector<sensing::WeightResidual> residuals;
  /// weights that were weighed again, because at first they did not agree with the others
  std::vector<WeightStep> repeated;
  /// for normal force, lateral force and moment: rms residual divided by the expected value; see
  /// sensing::WeightFit
  std::array<double, 3> misfit{};
  /// largest change of a reading without a weight, from one tare to another
  double zero_moved_mN = 0;
  /// lowest resonance of the plate on its cells; empty if no tap was measured
  std::optional<double> resonance_Hz;
  /// standard deviations of forces, position and friction for a finger at the middle of the surface that
  /// presses with 0.5 N and is dragged with 0.25 N
  sensing::ForceSd sd;
};

/// Asks for each step and reads the bridges. `ready` shows the step to the operator and returns false to
/// leave it out. If a reading fails, `failed` gets the reason and returns true to repeat the step; otherwise
/// the error is thrown. A weight that does not agree with the others is asked for once more, with a remark.
/// The last two steps are taps, from above and along the plate; a tap that is left out, or that is not
/// repeated although nothing rang, leaves the resonance unknown. Throws core::UsageError if too many steps
/// were left out, if a cell does not respond, if a weight still does not agree, or if the zero moved.
ForceResult weigh(const rig::Rig& rig, BridgeReader& bridges,
                  const std::function<bool(const WeightStep&)>& ready,
                  const std::function<bool(const core::Phrase&)>& failed);

/// Adds the force cells to the newest valid calibration of the rig, and writes it: to `path`, or beside the
/// rig file with today's date if `path` is empty. Returns the path.
std::string write_forces(const rig::Rig& rig, const rig::ForceCells& cells, const std::string& path);

}  // namespace turnpoint::maintenance

#pragma once
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "station/calibration/calibration.hpp"
#include "station/drive/alsa_capture.hpp"
#include "station/drive/engine.hpp"
#include "station/iio/converter.hpp"
#include "station/plant/setup.hpp"
#include "station/rig/rig.hpp"
#include "station/sensing/force_calibration.hpp"

namespace turnpoint::maintenance {

/// One step of the calibration with dead weights.
struct WeightStep {
  bool tare = false;  ///< nothing on the surface
  double mass_g = 0, position_mm = 0;
  double pull_g = 0;        ///< weight on the string; negative pulls towards the wide edge
  std::string remark = {};  ///< why the step is repeated; usually empty

  /// What the operator is asked to do, and what the step is called in messages.
  std::string text() const;
  std::string name() const;
};

/// The steps for a surface of this length: a tare, then 20, 50, 100 and 200 g at five places; then 20, 50 and
/// 100 g over a pulley in both directions at two places, with 200 g standing on the surface. Each place
/// begins with a tare of its own.
std::vector<WeightStep> weight_steps(double length_mm);

/// Means of the bridges while nothing moved.
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
  /// Throws std::runtime_error that names the wire, if one is off, or the device, if frames were lost.
  virtual BridgeReading read(const WeightStep& step) = 0;
  /// What the bridges read at this moment, over a tenth of a second. Throws like read().
  virtual BridgeReading glance() { return {}; }
};

/// The card of a rig whose cells are read. `pause` is called while nothing has been captured.
struct BridgeDevices {
  std::unique_ptr<drive::Stream> stream;
  std::unique_ptr<drive::Capture> capture;
  std::function<void()> pause;
};
std::unique_ptr<BridgeReader> card_bridges(const rig::Rig& rig, BridgeDevices devices);

/// Reads cells on a converter with a clock of its own. `open` opens it.
std::unique_ptr<BridgeReader> converter_bridges(
    const rig::CellConverter& converter,
    const std::function<std::unique_ptr<iio::Converter>(const iio::Config&)>& open = iio::open);

/// Opens the reader for the rig's force cells. Only the carrier is played, and the amplifier stays off.
/// `laboratory` changes the simulated laboratory; for tests. Throws terms::UsageError for a rig without force
/// cells.
std::unique_ptr<BridgeReader> open_bridges(const rig::Rig& rig,
                                           const std::function<void(plant::Setup&)>& laboratory = {});

/// The result of a calibration with dead weights.
struct ForceResult {
  rig::ForceCells cells;
  std::vector<WeightStep> steps;  ///< the weights, without the tares
  std::vector<sensing::WeightResidual> residuals;
  std::vector<WeightStep> repeated;  ///< weights that did not agree with the others at first
  std::array<double, 3> misfit{};    ///< see sensing::WeightFit
  double zero_moved_mN = 0;          ///< largest change of the zero between two tares
  sensing::ForceSd
      sd;  ///< of forces, position and friction in the middle, with 0.5 N normal and 0.25 N lateral
};

/// Asks for each step and reads the bridges. `ready` shows the step to the operator and returns false to
/// leave it out. If a reading fails, `failed` gets the reason and returns true to repeat the step; otherwise
/// the error is thrown. A weight that does not agree with the others is asked for once more, with a remark.
/// Throws terms::UsageError if too many steps were left out, if a cell does not respond, if a weight still
/// does not agree, or if the zero moved.
ForceResult weigh(const rig::Rig& rig, BridgeReader& bridges,
                  const std::function<bool(const WeightStep&)>& ready,
                  const std::function<bool(const std::string&)>& failed);

/// Adds the force cells to the newest valid calibration of the rig, and writes it: to `path`, or beside the
/// rig file with today's date if `path` is empty. Returns the path.
std::string write_forces(const rig::Rig& rig, const rig::ForceCells& cells, const std::string& path);

}  // namespace turnpoint::maintenance

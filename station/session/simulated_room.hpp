#pragma once
#include <complex>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "station/rig/rig.hpp"
#include "station/session/vibration_watch.hpp"
#include "station/simulation/plant.hpp"

namespace turnpoint::session {

/// Returns the laboratory that a rig with a [capture] table describes: its surface, pick-ups, force cells and
/// wires. Throws std::logic_error if the rig captures nothing.
simulation::Setup laboratory_of(const rig::Rig& rig);

/// The simulated laboratory behind the converter of a rig whose [capture] is `sim:`: the plate moves as its
/// model says, pick-ups near the drive edge record it, and force cells feel the finger. In trials that follow
/// the finger it loads the plate with the impedance of the rig's [finger], because they are planned with
/// friction over the displacement under the finger. All other trials are planned with friction over the
/// displacement without a finger (protocols/finger.md): their table contains what the finger takes, so here
/// it takes nothing.
class SimulatedRoom {
 public:
  /// Throws std::logic_error if the rig captures nothing. A test may `change` the laboratory.
  explicit SimulatedRoom(const rig::Rig& rig, const std::function<void(simulation::Setup&)>& change = {});

  /// Announces the frequencies that these bursts contain. Call this before the bursts are played.
  void expect(std::span<const audio::PreparedBurst> bursts);
  /// Passes played samples, beginning with `first_frame` (interleaved, full scale 2^31), to the simulated
  /// surface. Returns what is captured meanwhile. Frames may be left out while nothing is played.
  sensing::CaptureBlock advance(std::int64_t first_frame, std::span<const std::int32_t> played);

  /// The simulated participant touches the surface from now on for this many frames, and strokes it. Without
  /// force cells, nobody touches it.
  void touch(std::int64_t frames);
  void lift(std::int64_t frames) { plant_.lift(frames); }  ///< Lifts the finger after this many frames.

  /// Sets the movement that the participant is asked to make.
  void ask_for(const sensing::MovementWindow& window) { window_ = window; }
  /// Returns the settings and calibrations with which the station evaluates the captured samples: the rig's
  /// calibrations of pick-ups and force cells or, if the rig has none, the exact values of the simulation.
  CaptureSetup capture() const;
  simulation::Plant& plant() { return plant_; }
  /// While the wire from the marker's output is broken, its captured channel is silent.
  void break_marker_wire(bool broken) { marker_broken_ = broken; }

 private:
  rig::Capture rig_;
  std::complex<double> impedance_Ns_per_m_;  ///< of the finger, in trials that follow it
  simulation::Plant plant_;
  sensing::MovementWindow window_;
  bool marker_broken_ = false;
  std::vector<double> played_, captured_;
  std::vector<std::int32_t> samples_;
};

}  // namespace turnpoint::session

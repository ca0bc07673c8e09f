#pragma once
#include <functional>
#include <optional>

#include "station/desk/preview.hpp"
#include "station/maintenance/panel_latency.hpp"
#include "station/setup/prepare.hpp"
#include "station/setup/station_request.hpp"

namespace turnpoint::cli {

/// Functions that only a program with a screen provides; turnpoint starts turnpoint-ui for them. Each returns
/// when its window is closed.
struct Screens {
  /// Runs a session and asks on the screen for what the request leaves open (language, participant's code).
  /// If an already prepared session is given (a resumed one), the request is ignored.
  std::function<session::Summary(setup::RunRequest, std::optional<session::Setup>)> session;
  /// Shows the operator's start page and runs the sessions started there, one after another.
  std::function<void(const setup::StationRequest&)> station;
  /// Shows the scenes of a protocol with sliders for their factors.
  std::function<void(const desk::PreviewRequest&)> preview;
  /// Measures taps against a reference until the operator accepts the result; empty if none was accepted.
  std::function<std::optional<calibration::PanelLatency>(const maintenance::LatencyRequest&)> latency;
};

}  // namespace turnpoint::cli

#pragma once
#include <functional>
#include <optional>

#include "station/app/panel_latency.hpp"
#include "station/app/prepare.hpp"
#include "station/app/preview.hpp"
#include "station/app/station_request.hpp"

namespace turnpoint::cli {

/// What only a program with a screen can do; turnpoint hands over to turnpoint-ui. Each comes back when its
/// window is closed.
struct Screens {
  /// Runs a session, asking on the screen for what the request leaves open (language, participant's code). A
  /// session that is already prepared (one that goes on) comes whole, and its request is not looked at.
  std::function<session::Summary(app::RunRequest, std::optional<session::Setup>)> session;
  /// The operator's start page, and the sessions begun there, one after another.
  std::function<void(const app::StationRequest&)> station;
  /// The scenes of a protocol with sliders for their factors.
  std::function<void(const app::PreviewRequest&)> preview;
  /// Taps against a reference, until the operator keeps what was measured; none where nothing was.
  std::function<std::optional<calibration::PanelLatency>(const app::LatencyRequest&)> latency;
};

}  // namespace turnpoint::cli

#pragma once
#include <functional>
#include <optional>
#include <string>

#include "station/core/usage_error.hpp"
#include "station/maintenance/panel_latency.hpp"
#include "station/session/prepare.hpp"
#include "station/view/preview.hpp"

namespace turnpoint::cli {

/// Thrown if there is no screen on which to open a window. The message does not say what to do instead,
/// because that differs from command to command.
struct NoScreen : core::UsageError {
  using UsageError::UsageError;
};

/// The options of `turnpoint design`.
struct DesignRequest {
  std::string file;  ///< the protocol file to change; it need not exist; "" for a new one
  std::string rig;
};

/// Functions that need a screen. Only turnpoint-ui provides them; turnpoint starts turnpoint-ui to call them.
/// Each returns when its window is closed.
struct Screens {
  /// Runs a session. If the request leaves the participant's language or code open, asks for it on the
  /// screen. To resume a session, pass its prepared setup; the request is then ignored.
  std::function<session::Summary(session::RunRequest, std::optional<session::Setup>)> session;
  /// Shows the operator's start page and runs the sessions started there, one after another.
  std::function<void(const session::StationRequest&)> station;
  /// Shows the scenes of a protocol with sliders for their factors.
  std::function<void(const view::PreviewRequest&)> preview;
  /// Shows forms in which a protocol file is made or changed.
  std::function<void(const DesignRequest&)> design;
  /// Measures the latency of the touch panel, with a button or a photodiode as the reference, until the
  /// operator accepts the result; empty if the operator accepts none.
  std::function<std::optional<rig::PanelLatency>(const maintenance::LatencyRequest&)> latency;
};

}  // namespace turnpoint::cli

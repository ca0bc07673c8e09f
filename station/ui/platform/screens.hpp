#pragma once
#include <optional>

#include "station/desk/preview.hpp"
#include "station/maintenance/panel_latency.hpp"
#include "station/session/session.hpp"
#include "station/setup/prepare.hpp"
#include "station/setup/station_request.hpp"

namespace turnpoint::ui {

// What the program does with a screen. Each makes the application object, so one call a process; each returns
// when its window is closed, and throws terms::UsageError where there is no screen to open.

/// Runs one session: asks for what the request leaves open (language, consent, participant's code), shows the
/// session's pages and takes its inputs. The session runs on a thread of its own; what it throws is shown as
/// a fault page and thrown again from here. Throws text::BadInput for files that do not fit. `prepared` is a
/// session that goes on: it asks nothing, and `request` is not looked at.
session::Summary run_on_screen(setup::RunRequest request, std::optional<session::Setup> prepared);

/// The operator's start page, and the sessions begun there.
void run_station(const setup::StationRequest& request);

/// The scenes of a protocol with sliders for their factors.
void show_preview(const desk::PreviewRequest& request);

/// Taps on the panel against the rig's reference line; what the operator keeps, none where the page was left.
std::optional<calibration::PanelLatency> measure_latency(const maintenance::LatencyRequest& request);

}  // namespace turnpoint::ui

#pragma once
#include <optional>

#include "station/app/panel_latency.hpp"
#include "station/app/prepare.hpp"
#include "station/app/preview.hpp"
#include "station/app/station_request.hpp"
#include "station/session/session.hpp"

namespace turnpoint::ui {

// What the program does with a screen. Each makes the application object, so one call a process; each returns
// when its window is closed, and throws terms::UsageError where there is no screen to open.

/// Runs one session: asks for what the request leaves open (language, consent, participant's code), shows the
/// session's pages and takes its inputs. The session runs on a thread of its own; what it throws is shown as
/// a fault page and thrown again from here. Throws text::BadInput for files that do not fit. `prepared` is a
/// session that goes on: it asks nothing, and `request` is not looked at.
session::Summary run_on_screen(app::RunRequest request, std::optional<session::Setup> prepared);

/// The operator's start page, and the sessions begun there.
void run_station(const app::StationRequest& request);

/// The scenes of a protocol with sliders for their factors.
void show_preview(const app::PreviewRequest& request);

/// Taps on the panel against the rig's reference line; what the operator keeps, none where the page was left.
std::optional<calibration::PanelLatency> measure_latency(const app::LatencyRequest& request);

}  // namespace turnpoint::ui

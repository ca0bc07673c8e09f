#pragma once
#include <optional>

#include "station/cli/screens.hpp"
#include "station/maintenance/panel_latency.hpp"
#include "station/session/prepare.hpp"
#include "station/session/session.hpp"
#include "station/view/preview.hpp"

namespace turnpoint::ui {

// The commands that need a screen. Each makes the application object, so a process can call only one of them.
// Each returns when its window is closed, and throws cli::NoScreen if there is no screen.

/// Runs one session. Asks for what the request leaves open (language, consent, participant's code), shows the
/// session's pages and takes its inputs. The session runs on its own thread. If it throws, the exception is
/// shown as a fault page and thrown again from here. Throws core::BadInput for files that do not fit. If
/// `prepared` contains a resumed session, nothing is asked and `request` is ignored.
session::Summary run_on_screen(session::RunRequest request, std::optional<session::Setup> prepared);

/// Shows the operator's start page, and runs the sessions started from it.
void run_station(const session::StationRequest& request);

/// Shows the scenes of a protocol with sliders for their factors.
void show_preview(const view::PreviewRequest& request);

/// Shows forms in which a protocol file is made or changed.
void show_design(const cli::DesignRequest& request);

/// Measures the latency of the touch panel from taps, against the rig's reference line. Returns the result
/// that the operator accepts; empty if the operator leaves the page.
std::optional<rig::PanelLatency> measure_latency(const maintenance::LatencyRequest& request);

}  // namespace turnpoint::ui

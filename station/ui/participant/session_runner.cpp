#include "station/ui/participant/session_runner.hpp"

#include <fmt/format.h>

#include <QScreen>
#include <filesystem>
#include <utility>

#include "station/core/texts.hpp"
#include "station/session/open_touch.hpp"
#include "station/system/clocks.hpp"
#include "station/ui/platform/vector_state.hpp"
#include "station/view/report_pages.hpp"

namespace turnpoint::ui {

namespace {

/// Interval at which the page reports that its event loop is running. After two seconds without such a
/// report, the amplifier guard switches the amplifier off.
constexpr int kLife_ms = 250;

/// True for pages on which a late frame would matter, so that late frames are counted.
bool is_trial(PageModel::Kind kind) {
  using Kind = PageModel::Kind;
  return kind == Kind::Cue || kind == Kind::Stimulus || kind == Kind::Pause || kind == Kind::Response ||
         kind == Kind::Feedback || kind == Kind::Adjust;
}

}  // namespace

SessionRunner::SessionRunner(QObject* parent)
    : QObject(parent),
      bridge_(system::monotonic_ns, [this](session::Input input) { inputs_.push(std::move(input)); }),
      live_(bridge_),
      frames_(system::monotonic_ns) {
  connect(&life_, &QTimer::timeout, this, [this] { inputs_.page_alive(system::monotonic_ns()); });
  connect(this, &SessionRunner::over, &life_, &QTimer::stop);
  connect(&bridge_, &SessionBridge::shown, this, [this] {
    const auto kind = bridge_.page()->kind();
    // The page changes again while it shows the signal, but only its first frame is the flash.
    const auto flash_ns = bridge_.page()->page().flash_ns;
    if (flash_ns && flash_ns != std::exchange(flash_ns_, flash_ns)) return frames_.timed();
    if (is_trial(kind)) return frames_.asked();
    const int lost = frames_.end();
    // Late frames are reported on the page between trials. If a fault or a pause interrupts a trial, another
    // page follows and the frames are not reported, because the trial is repeated.
    if (kind == PageModel::Kind::Interval) bridge_.frames_lost(lost);
  });
  connect(&frames_, &FrameWatch::presented, this,
          [this](qint64 time_ns) { bridge_.signal_shown(time_ns, *flash_ns_); });
  connect(&bridge_, &SessionBridge::acknowledged, this, [this] {
    if (is_trial(bridge_.page()->kind())) frames_.asked();
  });
}

SessionRunner::~SessionRunner() {
  if (running()) ask_to_stop();
}

void SessionRunner::watch(QQuickWindow* window) {
  bridge_.watch(window);
  frames_.follow(window, window->screen() != nullptr ? window->screen()->refreshRate() : 0);
}

void SessionRunner::begin(session::Setup setup, const std::string& language) {
  if (thread_.joinable()) thread_.join();
  setup_ = std::move(setup);
  language_ = language;
  inputs_.drain();
  summary_.reset();
  failure_ = nullptr;
  over_ = false;
  report_.save_in((std::filesystem::absolute(setup_.database).parent_path() / "figures").string());
  report_.clear();
  open_touch();
  // Until the session shows its first page, nothing of an earlier session may be on the screen.
  session::Page empty;
  empty.language = setup_.language;
  empty.run_mode = store::name(setup_.run_mode);
  bridge_.show(empty);
  live_.take(std::optional<view::FingerGauges>{});
  *stored_ = 0;
  view_ = std::make_unique<view::LiveView>(
      setup_.protocol, setup_.rig, [this](view::LiveState state) { live_.take(std::move(state)); }, language_,
      [this](view::FingerGauges gauges) { live_.take(std::optional(std::move(gauges))); }, stored_);
  inputs_.page_alive(system::monotonic_ns());
  life_.start(kLife_ms);
  thread_ = std::jthread([this] { run(); });
}

/// Runs the session. The session thread calls this.
void SessionRunner::run() {
  clear_upper_halves();
  try {
    summary_ = session::run(setup_, &bridge_, inputs_, view_.get());
  } catch (...) {
    failure_ = std::current_exception();
    show_failure();
  }
  over_ = true;
  *stored_ = -1;
  try {
    if (summary_ && summary_->trials > 0 && !leaving_)
      report_.take(view::report_pages(summary_->database, summary_->session_id, language_));
  } catch (const std::exception& error) {
    // The session is complete and stored, even if its report cannot be made.
    view::ReportPages pages;
    pages.title = core::text("report.none", language_);
    pages.sections = {{{}, {}, {core::phrase_of(error)}}};
    report_.take(pages);
  }
  Q_EMIT over();
}

/// Opens the reader for the kernel's time stamps of touches, if the rig file names a touch panel.
void SessionRunner::open_touch() {
  touch_ = session::open_touch(setup_.rig, [this](io::TouchPanelState state) {
    if (state == io::TouchPanelState::back) return;
    inputs_.push({system::monotonic_ns(),
                  session::Fault{session::FaultKind::touch_gone, "the touch panel was disconnected"}});
  });
  if (!touch_) return bridge_.set_kernel_time({});
  bridge_.set_kernel_time(
      [this](double x, double y, std::int64_t seen_ns) { return touch_->claim(x, y, seen_ns); });
}

/// Runs on the session thread. Shows on the screen what ended the session, because nobody may be looking at a
/// terminal.
void SessionRunner::show_failure() {
  session::Page page;
  page.kind = session::PageKind::failed;
  page.language = setup_.language;
  page.run_mode = store::name(setup_.run_mode);
  try {
    std::rethrow_exception(failure_);
  } catch (const session::TooEarly& refused) {
    page.early = refused.early();
  } catch (const std::exception& error) {
    // for the operator; the participant's page does not show it
    page.fault.detail = core::say(core::phrase_of(error), language_);
  }
  bridge_.show(page);
}

void SessionRunner::ask_to_stop() {
  if (!running()) return;
  inputs_.push({system::monotonic_ns(),
                session::input::Stop{"the program was stopped by a signal, or its window was closed"}});
}

std::function<std::string()> SessionRunner::kept() const {
  return [stored = stored_] {
    if (*stored < 0) return std::string("no session was running");
    return fmt::format(
        "trials stored since the session began or was resumed: {}; later answers are lost; `turnpoint "
        "resume` "
        "continues the session",
        stored->load());
  };
}

std::optional<session::Summary> SessionRunner::finish() {
  leaving_ = true;
  ask_to_stop();
  if (thread_.joinable()) thread_.join();
  if (failure_) std::rethrow_exception(failure_);
  return summary_;
}

}  // namespace turnpoint::ui

#include "moc_session_runner.cpp"

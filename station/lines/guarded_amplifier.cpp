#include "station/lines/guarded_amplifier.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <exception>
#include <mutex>
#include <thread>

#include "station/lines/guard_orders.hpp"
#include "station/lines/published.hpp"
#include "station/system/clocks.hpp"
#include "station/system/rights.hpp"

namespace turnpoint::lines {
namespace {

using terms::FaultKind;
using Ask = GuardOrders::Ask;

constexpr int guard_priority = 75;
constexpr std::int64_t open_again_ns = 100'000'000;
// interval at which the levels of the fault and stop lines are read while the enable line is high
constexpr std::int64_t look_ns = 500'000;
static_assert(terms::fault_kinds.size() <= 32, "each kind of fault needs a bit in GuardOrders::Taken::trips");

/// The guard's state, copied for ordinary threads to read.
struct Report {
  drive::AmplifierState state = drive::AmplifierState::disarmed;
  Guard::Fault fault;
  std::int64_t reaction_ns = -1;
  bool gate = false;
};
/// The reason why the lines were lost, truncated to the size of the array.
using Reason = std::array<char, 160>;

/// Owns the lines and the guard's rules. All members belong to the guard's thread; other threads read only
/// what it publishes.
class GuardThread {
 public:
  GuardThread(OpenLines open, const GuardLines& roles, const GuardOptions& options)
      : orders(options.scheduler_point), open_(std::move(open)), roles_(roles), guard_(options.config) {
    take_up();
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  ~GuardThread() {
    thread_.request_stop();
    orders.wake();
    thread_.join();
  }

  GuardOrders orders;
  Published<Report> report;
  Published<Reason> gone;
  std::atomic<std::int64_t> audio_ns{-1}, session_ns{-1}, page_ns{-1};
  std::atomic<bool> holds_heartbeat{false};

 private:
  void publish() noexcept { report.store({guard_.state(), guard_.fault(), reaction_ns_, gate_}); }

  bool wants_high() const noexcept { return guard_.outputs().enable == 1; }

  void drive_enable() {
    lines_->drive(roles_.enable, wants_high() ? 1 : 0);
    if (driven_high_ && !wants_high()) lowered_ns_ = system::monotonic_ns();
    driven_high_ = wants_high();
  }

  bool fault_at(bool level) const noexcept { return level != roles_.fault_active_low; }
  bool stop_at(bool level) const noexcept { return level != roles_.stop_active_low; }

  void read_levels() {
    const std::int64_t now = system::monotonic_ns();
    if (roles_.fault >= 0) guard_.fault_line(now, fault_at(lines_->level(roles_.fault)));
    if (roles_.stop >= 0) guard_.stop_line(now, stop_at(lines_->level(roles_.stop)));
    if (roles_.gate >= 0) gate_ = lines_->level(roles_.gate);
  }

  void take_signs() noexcept {
    if (const auto at = audio_ns.load(); at >= 0) guard_.audio_alive(at);
    if (const auto at = session_ns.load(); at >= 0) guard_.session_alive(at);
    if (const auto at = page_ns.load(); at >= 0) guard_.page_alive(at);
  }

  /// Opens the lines, whose outputs are low at first, and reads whether a stop or a fault is already active.
  void take_up() {
    lines_ = open_();
    driven_high_ = false;
    drive_enable();
    read_levels();
    publish();
  }

  /// Stops using lines of which one was lost. The heartbeat ends, so the external monitor switches the
  /// amplifier off. The enable line is set low first: it may be on another chip than the line that was lost.
  void let_go(const char* why) noexcept {
    set_low();
    guard_.trip(system::monotonic_ns(), FaultKind::lines_gone);
    lines_.reset();
    next_open_ns_ = system::monotonic_ns() + open_again_ns;
    Reason reason{};
    std::strncpy(reason.data(), why, reason.size() - 1);
    gone.store(reason);
    publish();
  }

  /// Handles an edge. If the edge means a fault or a stop, it first sets the enable line low; everything else
  /// comes afterwards.
  void edge(const Edge& edge) {
    if (edge.line == roles_.gate) return look();
    const bool fault = edge.line == roles_.fault;
    const bool active = fault ? fault_at(edge.rising) : stop_at(edge.rising);
    if (active) {
      lines_->drive(roles_.enable, 0);
      // If look() read the new level before this edge arrived, the enable line has been low since
      // `lowered_ns_`.
      reaction_ns_ = (driven_high_ ? system::monotonic_ns() : lowered_ns_) - edge.time_ns;
    }
    fault ? guard_.fault_line(edge.time_ns, active) : guard_.stop_line(edge.time_ns, active);
    drive_enable();
    publish();
  }

  /// Reads the levels of the lines. Edges alone are not enough: a busy real-time thread can delay the kernel
  /// thread that delivers them.
  void look() {
    read_levels();
    drive_enable();
    publish();
    next_look_ns_ = system::monotonic_ns() + look_ns;
  }

  void beat() {
    take_signs();
    guard_.tick(system::monotonic_ns());
    look();
    // look() has just set the enable line, so its actual level can now be compared with the level that was
    // set.
    if (const auto level = roles_.read_back ? lines_->read_back(roles_.enable) : std::nullopt)
      guard_.enable_line(system::monotonic_ns(), *level);
    drive_enable();
    if (roles_.heartbeat >= 0 && !holds_heartbeat.load())
      lines_->drive(roles_.heartbeat, guard_.outputs().heartbeat);
    publish();
  }

  std::optional<Guard::Refusal> obey(const GuardOrders::Taken& taken) {
    const std::int64_t now = system::monotonic_ns();
    for (const FaultKind kind : terms::fault_kinds)
      if (taken.trips >> static_cast<unsigned>(kind) & 1) guard_.trip(now, kind);
    std::optional<Guard::Refusal> refusal;
    if (taken.ask != Ask::nothing && !lines_) {
      refusal = {FaultKind::lines_gone};
    } else if (taken.ask != Ask::nothing) {
      take_signs();
      read_levels();
      refusal = taken.ask == Ask::arm      ? guard_.arm(now)
                : taken.ask == Ask::enable ? guard_.enable(now)
                                           : guard_.clear();
    }
    if (taken.disable) guard_.disable();
    if (taken.disarm) guard_.disarm();
    if (lines_) drive_enable();
    return refusal;
  }

  /// Looks for commands. Every command gets an answer, whatever happens to the lines, because a thread is
  /// waiting for the answer.
  void look_at_orders() noexcept {
    const auto taken = orders.take();
    if (!taken) return;
    std::optional<Guard::Refusal> refusal;
    try {
      refusal = obey(*taken);
    } catch (const std::exception& error) {
      let_go(error.what());
      refusal = {FaultKind::lines_gone};
    }
    publish();
    orders.done(*taken, refusal);
  }

  /// Waits for edges and commands until it is time to read the levels or to toggle the heartbeat.
  void watch() {
    const auto until_ns =
        wants_high() ? std::min(guard_.next_tick_ns(), next_look_ns_) : guard_.next_tick_ns();
    const auto wait_ns = std::max<std::int64_t>(0, until_ns - system::monotonic_ns());
    if (const auto seen = lines_->wait(wait_ns, orders.descriptor())) edge(*seen);
    const auto now = system::monotonic_ns();
    if (now >= guard_.next_tick_ns()) return beat();
    if (wants_high() && now >= next_look_ns_) look();
  }

  /// Tries at intervals to open lost lines again. Meanwhile it answers commands, however many come.
  void look_for_lines() {
    const std::int64_t left_ns = std::max<std::int64_t>(0, next_open_ns_ - system::monotonic_ns());
    pollfd order{orders.descriptor(), POLLIN, 0};
    ::poll(&order, 1, static_cast<int>(left_ns / 1'000'000) + 1);
    if (system::monotonic_ns() >= next_open_ns_) take_up();
  }

  void run(const std::stop_token& stop) noexcept {
    static_cast<void>(system::become_realtime(guard_priority));
    while (!stop.stop_requested()) {
      try {
        lines_ ? watch() : look_for_lines();
      } catch (const std::exception& error) {
        let_go(error.what());
      }
      look_at_orders();
    }
    set_low();
  }

  void set_low() noexcept {
    try {
      if (lines_) lines_->drive(roles_.enable, 0);
    } catch (const std::exception&) {  // the chip has been removed, and the line with it
    }
  }

  OpenLines open_;
  GuardLines roles_;
  Guard guard_;
  std::unique_ptr<Lines> lines_;   ///< null while the lines are lost
  std::int64_t next_open_ns_ = 0;  ///< when to try again to open lost lines
  std::int64_t next_look_ns_ = 0;
  bool driven_high_ = false;
  std::int64_t lowered_ns_ = 0;  ///< time at which the enable line was last set from high to low
  std::int64_t reaction_ns_ = -1;
  bool gate_ = false;  ///< level of the line GuardLines::gate when it was last read
  std::jthread thread_;
};

class GuardedAmplifier final : public drive::Amplifier {
 public:
  GuardedAmplifier(OpenLines open, const GuardLines& roles, const GuardOptions& options)
      : has_gate_(roles.gate >= 0 && roles.heartbeat >= 0), guard_(std::move(open), roles, options) {}

  Refusal arm() override { return ask(Ask::arm); }
  Refusal enable() override { return ask(Ask::enable); }
  Refusal clear() override { return ask(Ask::clear); }
  void disarm() noexcept override { guard_.orders.disarm(); }
  void disable() noexcept override { guard_.orders.disable(); }
  void trip(FaultKind kind, std::string_view detail) noexcept override {
    // post the command first: the guard must act at once, and does not need the detail
    guard_.orders.trip(kind);
    const std::lock_guard lock(details_mutex_);
    details_[static_cast<std::size_t>(kind)] = detail;
  }

  void audio_alive() noexcept override { guard_.audio_ns.store(system::monotonic_ns()); }
  void session_alive() noexcept override { guard_.session_ns.store(system::monotonic_ns()); }
  void page_alive(std::int64_t time_ns) noexcept override { guard_.page_ns.store(time_ns); }

  void hold_heartbeat() noexcept override { guard_.holds_heartbeat.store(true); }
  void resume_heartbeat() noexcept override { guard_.holds_heartbeat.store(false); }
  std::optional<bool> gate() const noexcept override {
    return has_gate_ ? std::optional(guard_.report.load().gate) : std::nullopt;
  }

  drive::AmplifierState state() const noexcept override { return guard_.report.load().state; }
  drive::AmplifierFault fault() const override {
    const auto fault = guard_.report.load().fault;
    return {{fault.kind, detail_of(fault.kind, fault.detail)}, fault.time_ns};
  }
  std::int64_t reaction_ns() const noexcept override { return guard_.report.load().reaction_ns; }

 private:
  Refusal ask(Ask what) {
    const auto refusal = guard_.orders.ask(what);
    if (!refusal) return std::nullopt;
    return terms::Fault{refusal->kind, refusal->latched ? "the fault is latched; clear it first"
                                                        : detail_of(refusal->kind, "")};
  }

  std::string detail_of(FaultKind kind, const char* constant) const {
    if (kind == FaultKind::lines_gone) return guard_.gone.load().data();
    if (*constant != '\0') return constant;
    const std::lock_guard lock(details_mutex_);
    return details_[static_cast<std::size_t>(kind)];
  }

  mutable std::mutex details_mutex_;  ///< never locked by the guard thread
  /// details of faults that ordinary threads reported
  std::array<std::string, terms::fault_kinds.size()> details_;
  bool has_gate_;
  GuardThread guard_;
};

}  // namespace

std::unique_ptr<drive::Amplifier> guard_amplifier(OpenLines open, const GuardLines& roles,
                                                  GuardOptions options) {
  return std::make_unique<GuardedAmplifier>(std::move(open), roles, options);
}

}  // namespace turnpoint::lines

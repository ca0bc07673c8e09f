#include "station/io/guarded_amplifier.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <type_traits>

#include "station/io/guard.hpp"
#include "station/system/clocks.hpp"
#include "station/system/rights.hpp"
#include "station/system/wake_up.hpp"

namespace turnpoint::io {

/// A value that one thread publishes and any thread can read consistently. The writer never waits. A reader
/// that overlaps with a write starts again (a sequence lock whose words are atomics).
template <typename T>
class Published {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  void store(const T& value) noexcept {
    std::array<std::uint64_t, words> raw{};
    std::memcpy(raw.data(), &value, sizeof value);
    const auto version = version_.load(std::memory_order_relaxed);
    version_.store(version + 1, std::memory_order_relaxed);
    // A reader that sees one of these words also sees the odd version number, so it knows that a write is in
    // progress and reads again.
    for (std::size_t k = 0; k < words; ++k) words_[k].store(raw[k], std::memory_order_release);
    version_.store(version + 2, std::memory_order_release);
  }

  T load() const noexcept {
    std::array<std::uint64_t, words> raw{};
    for (;;) {
      const auto before = version_.load(std::memory_order_acquire);
      for (std::size_t k = 0; k < words; ++k) raw[k] = words_[k].load(std::memory_order_acquire);
      if (before % 2 == 0 && version_.load(std::memory_order_relaxed) == before) break;
    }
    T value;
    std::memcpy(static_cast<void*>(&value), raw.data(), sizeof value);
    return value;
  }

 private:
  static constexpr std::size_t words = (sizeof(T) + 7) / 8;
  std::atomic<std::uint32_t> version_{0};
  std::array<std::atomic<std::uint64_t>, words> words_{};
};

/// Commands from ordinary threads to the guard's thread, and its answers. An ordinary thread waits until its
/// command has been carried out; the guard waits for nobody. A command that only switches off takes effect
/// once it is posted, even if its caller never runs again.
class GuardOrders {
 public:
  /// Commands of an operator or the session that may be refused.
  enum class Ask : std::uint32_t { nothing, arm, enable, clear };

  /// What the guard finds when it looks for commands. Commands that switch off take precedence over the
  /// others.
  struct Taken {
    std::uint32_t ticket = 0;
    Ask ask = Ask::nothing;
    bool disable = false, disarm = false;
    std::uint32_t trips = 0;  ///< faults that switch the amplifier off; bit k is for core::FaultKind k
  };

  /// `scheduler_point` (may be empty) is called on the caller's thread between the steps of a command. A test
  /// can stall the thread there.
  explicit GuardOrders(std::function<void()> scheduler_point)
      : scheduler_point_(std::move(scheduler_point)) {}

  // Gives a command and waits for the answer. For ordinary threads. If several threads call it, they take
  // turns.
  std::optional<Guard::Refusal> ask(Ask what);
  void disable() noexcept { post(off_, disable_bit); }
  void disarm() noexcept { post(off_, disarm_bit); }
  void trip(core::FaultKind kind) noexcept { post(trips_, 1u << static_cast<unsigned>(kind)); }

  // Takes the waiting commands, if any. For the guard's thread.
  std::optional<Taken> take() noexcept;
  void done(const Taken& taken, std::optional<Guard::Refusal> refusal) noexcept;

  /// Wakes the guard's thread without giving it a command.
  void wake() noexcept { wake_.ring(); }
  int descriptor() const noexcept { return wake_.descriptor(); }

 private:
  static constexpr std::uint32_t disable_bit = 1, disarm_bit = 2;

  void post(std::atomic<std::uint32_t>& order, std::uint32_t bits) noexcept;
  void await(std::uint32_t ticket) noexcept;
  void scheduler_point() const noexcept;

  std::function<void()> scheduler_point_;
  std::mutex asking_;  ///< held by the thread that waits in ask(); the guard never locks it
  std::atomic<Ask> ask_{Ask::nothing};
  std::atomic<std::uint32_t> off_{0}, trips_{0};
  std::atomic<std::uint32_t> posted_{0}, handled_{0};
  /// answer to the latest ask(); written before handled_ reaches the ticket of that call
  std::optional<Guard::Refusal> refusal_;
  system::WakeUp wake_;
};

std::optional<Guard::Refusal> GuardOrders::ask(Ask what) {
  const std::lock_guard lock(asking_);
  ask_.store(what);
  scheduler_point();
  const auto ticket = posted_.fetch_add(1) + 1;
  wake_.ring();
  await(ticket);
  return refusal_;
}

void GuardOrders::post(std::atomic<std::uint32_t>& order, std::uint32_t bits) noexcept {
  // From here on the guard will carry out the command, at its next tick at the latest, even if this thread
  // stops.
  order.fetch_or(bits);
  scheduler_point();
  const auto ticket = posted_.fetch_add(1) + 1;
  wake_.ring();
  await(ticket);
}

void GuardOrders::await(std::uint32_t ticket) noexcept {
  scheduler_point();
  for (auto handled = handled_.load(); static_cast<std::int32_t>(handled - ticket) < 0;
       handled = handled_.load())
    handled_.wait(handled);
  scheduler_point();
}

void GuardOrders::scheduler_point() const noexcept {
  if (scheduler_point_) scheduler_point_();
}

std::optional<GuardOrders::Taken> GuardOrders::take() noexcept {
  wake_.clear();
  const auto ticket = posted_.load();
  const auto ask = ask_.exchange(Ask::nothing);
  const auto off = off_.exchange(0), trips = trips_.exchange(0);
  if (ticket == handled_.load() && ask == Ask::nothing && off == 0 && trips == 0) return std::nullopt;
  return Taken{ticket, ask, (off & disable_bit) != 0, (off & disarm_bit) != 0, trips};
}

void GuardOrders::done(const Taken& taken, std::optional<Guard::Refusal> refusal) noexcept {
  if (taken.ask != Ask::nothing) refusal_ = refusal;
  handled_.store(taken.ticket);
  handled_.notify_all();
}

namespace {

using core::FaultKind;
using Ask = GuardOrders::Ask;

constexpr int guard_priority = 75;
constexpr std::int64_t open_again_ns = 100'000'000;
// interval at which the levels of the fault and stop lines are read while the enable line is high
constexpr std::int64_t look_ns = 500'000;
static_assert(core::fault_kinds.size() <= 32, "each kind of fault needs a bit in GuardOrders::Taken::trips");

/// The guard's state, copied for ordinary threads to read.
struct Report {
  audio::AmplifierState state = audio::AmplifierState::disarmed;
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
    for (const FaultKind kind : core::fault_kinds)
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

class GuardedAmplifier final : public audio::Amplifier {
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

  audio::AmplifierState state() const noexcept override { return guard_.report.load().state; }
  audio::AmplifierFault fault() const override {
    const auto fault = guard_.report.load().fault;
    return {{fault.kind, detail_of(fault.kind, fault.detail)}, fault.time_ns};
  }
  std::int64_t reaction_ns() const noexcept override { return guard_.report.load().reaction_ns; }

 private:
  Refusal ask(Ask what) {
    const auto refusal = guard_.orders.ask(what);
    if (!refusal) return std::nullopt;
    return core::Fault{refusal->kind, refusal->latched ? "the fault is latched; clear it first"
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
  std::array<std::string, core::fault_kinds.size()> details_;
  bool has_gate_;
  GuardThread guard_;
};

}  // namespace

std::unique_ptr<audio::Amplifier> guard_amplifier(OpenLines open, const GuardLines& roles,
                                                  GuardOptions options) {
  return std::make_unique<GuardedAmplifier>(std::move(open), roles, options);
}

}  // namespace turnpoint::io

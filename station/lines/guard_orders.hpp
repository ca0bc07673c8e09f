#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>

#include "station/lines/guard.hpp"
#include "station/system/wake_up.hpp"

namespace turnpoint::lines {

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
    std::uint32_t trips = 0;  ///< faults that switch the amplifier off; bit k is for terms::FaultKind k
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
  void trip(terms::FaultKind kind) noexcept { post(trips_, 1u << static_cast<unsigned>(kind)); }

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

}  // namespace turnpoint::lines

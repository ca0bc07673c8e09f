#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <stdexcept>

#include "station/io/guard.hpp"
#include "station/session/monitor.hpp"
#include "station/session/stage.hpp"
#include "tests/endurance/faults.hpp"
#include "tests/endurance/watch.hpp"

namespace endurance {

/// Violations that a run commits on purpose. The checks must detect each of them.
enum class Plant { none, deaf_guard, never_off, lost_trial, careless_disk, leak };

/// Simulates the death of the process. It is thrown after the files were copied in the state in which this
/// death leaves them.
struct Died : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The part of the simulated laboratory that remains when the station's process ends.
struct World {
  explicit World(Course c, Plant p) : course(std::move(c)), plant(p) {}

  Course course;
  Plant plant = Plant::none;
  Violations violations;
  AmplifierWatch amplifier{violations};
  TrialWatch trials{violations};
  MemoryWatch memory;
  std::int64_t now_ns = 0;      ///< virtual time since the beginning of the run
  std::int64_t end_ns = 0;      ///< the run ends when `session_ns` reaches this time
  std::int64_t session_ns = 0;  ///< total time in which a session was running
  /// wall clock minus virtual time; people can change the wall clock
  std::int64_t wall_offset_ns = 1'700'000'000'000'000'000;
  std::int64_t next_fault_ns = 0;
};

/// What happens to the files when the process dies or the disk is full. The class Station provides these
/// functions.
struct Disk {
  std::function<void(Fault)> die;  ///< copies the files as this kind of death leaves them
  /// Does what `die` does, after this many further file operations.
  std::function<void(Fault, int)> die_later;
  std::function<void(std::int64_t)> bytes_left;
  std::function<bool()> dead;
};

/// The room during the life of one process of the station. Time, drive and observer are those of the virtual
/// stage. The amplifier is the station's own guard, on a line that AmplifierWatch observes. A Course (a
/// random sequence of faults) decides when faults come. The room also plays the operator, who repairs and
/// arms (sometimes too early), and the participant, who sees the pages.
class Room : public turnpoint::session::Stage, public turnpoint::session::Display {
 public:
  using Input = turnpoint::session::Input;

  Room(World& world, Disk disk, std::unique_ptr<turnpoint::session::Stage> inner, int rate_Hz);
  ~Room() override;

  std::int64_t now_ns() override { return inner_->now_ns(); }
  std::optional<Input> wait_until(std::int64_t deadline_ns) override;
  std::vector<Input> drain() override;
  void wait_for(const std::function<bool()>&) override {}
  std::vector<turnpoint::session::Onset> present(std::span<const turnpoint::audio::PreparedBurst> intervals,
                                                 std::int64_t earliest_ns) override;
  std::optional<std::int64_t> glide(const turnpoint::audio::ToneSet& to, double seconds) override {
    return inner_->glide(to, seconds);
  }
  std::int64_t silence(bool awaits_heard) override;
  Refusal arm() override;
  void disarm() override;
  Refusal clear() override;
  turnpoint::audio::AmplifierState amplifier() const override { return guard_.state(); }
  Refusal open_amplifier() override;
  void close_amplifier() override { closing_ = world_.plant != Plant::never_off; }
  const std::vector<std::string>& buttons() const override { return inner_->buttons(); }
  std::string missing() const override { return missing_; }
  turnpoint::session::Triggers& triggers() override { return inner_->triggers(); }
  std::optional<turnpoint::session::ClockFit> clock_fit() override { return inner_->clock_fit(); }
  std::string realtime_rights() const override { return "none"; }
  void finish() override;

  void show(const turnpoint::session::Page& page) override;
  std::int64_t world_ns() const { return born_ns_ + inner_->now_ns(); }
  std::int64_t age_ns() const { return inner_->now_ns(); }

 private:
  struct Planned {
    std::int64_t time_ns = 0;
    std::function<void()> happens;
  };

  void attend();
  void line();
  void plan(std::int64_t in_ns, std::function<void()> happens);
  void push(turnpoint::session::input::Any content);
  void strike(Fault fault);
  void strike_line(const char* what, void (turnpoint::io::Guard::*change)(std::int64_t, bool) noexcept);
  void strike_device();
  void strike_underrun();
  void strike_chip();
  void tell_guard_fault();

  World& world_;
  Disk disk_;
  std::unique_ptr<turnpoint::session::Stage> inner_;
  turnpoint::io::Guard guard_;
  std::string missing_;  ///< why the GPIO chip is missing; empty if it is present
  double ns_per_frame_;
  std::int64_t born_ns_;
  std::vector<Planned> planned_;
  std::deque<Input> inputs_;
  /// start and end of each stimulus of the current trial
  std::vector<std::pair<std::int64_t, std::int64_t>> stimuli_;
  std::int64_t quiet_ns_ = 0, opened_ns_ = 0;
  bool closing_ = false, arm_planned_ = false, fault_told_ = false;
};

}  // namespace endurance

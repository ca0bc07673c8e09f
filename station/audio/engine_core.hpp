#pragma once
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

#include "station/audio/engine.hpp"
#include "station/audio/ring.hpp"
#include "station/system/rights.hpp"

namespace turnpoint::audio {

/// What real-time and synchronous streams have in common. The control thread sends commands through one ring
/// and receives events through another; the audio side renders blocks. `process`, `pass`, `heard`, `lose` and
/// `report` are for the audio side, everything else is for one control thread.
class EngineCore {
 public:
  explicit EngineCore(const StreamConfig& config);

  /// Returns the earliest frame at which a burst can still start. Called only after the burst has been
  /// checked, because checking takes time.
  using Earliest = std::function<std::int64_t()>;
  std::uint32_t schedule(const Burst& burst, const Earliest& earliest_frame);
  std::vector<Scheduled> schedule_together(std::span<const PreparedBurst> bursts,
                                           const Earliest& earliest_frame);
  void change(std::uint32_t burst, const Change& change);
  void stop(std::uint32_t burst, const Ramp& ramp, std::optional<std::int64_t> frame);
  /// For one thread, which need not be the control thread: gives gains to a burst that follows them. Returns
  /// false if the audio side has not taken the last 64. Wait-free.
  [[nodiscard]] bool follow(const GainPeriod& gains) noexcept { return gains_->push(gains); }
  std::optional<Event> poll();
  Counters counters() const noexcept;
  /// Memory that the audio side uses in addition to this object, so that it can be locked.
  std::vector<system::MemoryRange> memory() const;

  /// Takes the waiting commands and renders frames, beginning with `frame`.
  void process(std::int64_t frame, std::span<std::int32_t> samples) noexcept;
  /// Like process(), but without computing samples: only handles commands and events.
  void pass(std::int64_t frame, std::int64_t frames) noexcept;
  /// Records that every frame before `frame` has been played, unless lose() has reported it as lost.
  void heard(std::int64_t frame) noexcept { atomics_.heard.store(frame); }
  /// Skips lost frames and sends the event that reports them. Rendering continues at `next_frame`, which must
  /// not be before the end of the frames already rendered.
  void lose(const Event& event, std::int64_t next_frame) noexcept;
  /// Sends an event of the output to the control thread and updates the counters.
  void report(const Event& event) noexcept;

 private:
  enum class CommandKind : std::int32_t { start, change, stop };
  struct Command {
    CommandKind kind = CommandKind::start;
    std::uint32_t burst = 0;
    std::int64_t frame = 0;
    Ramp ramp;
    PreparedChange change;
    PreparedBurst start;
  };
  /// A burst that was sent to the audio side but has not yet been heard or reported as damaged.
  struct Open {
    PreparedBurst burst;
    /// end of the burst as scheduled; once the end has been rendered, the actual end
    std::int64_t end_frame = 0;
    bool begun = false, rendered = false, damaged = false;
  };
  struct Atomics {
    std::atomic<std::int64_t> frames{0}, heard{0}, bursts{0}, missed{0}, underruns{0}, lost_frames{0},
        saturated{0}, device_losses{0}, events_dropped{0};
  };

  void take_commands() noexcept;
  void report_until(std::int64_t frame) noexcept;
  void send(const Command& command);
  void gather();
  void follow(Event& event);
  std::uint32_t damage(std::int64_t first_frame, std::int64_t end_frame);
  Open* find(std::uint32_t burst);
  void check_room(const PreparedBurst& burst) const;

  StreamConfig config_;
  std::uint32_t last_id_ = 0;
  std::vector<Open> open_;  ///< open bursts in the order in which they were sent
  std::deque<Event> gathered_;
  std::unique_ptr<Command> outgoing_ = std::make_unique<Command>();
  std::unique_ptr<Command> incoming_ = std::make_unique<Command>();
  std::unique_ptr<Ring<Command, 32>> commands_ = std::make_unique<Ring<Command, 32>>();
  std::unique_ptr<Ring<Event, 256>> events_ = std::make_unique<Ring<Event, 256>>();
  std::unique_ptr<Ring<GainPeriod, 64>> gains_ = std::make_unique<Ring<GainPeriod, 64>>();
  Atomics atomics_;
  Synth synth_;
};

}  // namespace turnpoint::audio

#include "station/rehearsal/rehearsal.hpp"

#include <algorithm>
#include <deque>
#include <optional>

#include "station/core/texts.hpp"
#include "station/procedure/program.hpp"
#include "station/trial/machine.hpp"
#include "station/trial/question.hpp"
#include "station/trial/rows.hpp"
#include "station/trial/slider.hpp"
#include "station/trial/timing.hpp"

namespace turnpoint::rehearsal {

namespace {

using trial::TrialSpec;

// The simulated participant reads each page for this time, as in a session on the virtual clock.
constexpr std::int64_t page_ns = 1'000'000'000;
// Safeguard against a procedure that never ends and that the protocol reader failed to refuse.
constexpr int most_trials = 100'000;

std::int64_t ns(double s) { return static_cast<std::int64_t>(s * 1e9); }

/// What the participant does in a trial: gives an answer, or makes a setting and finishes it at some time.
struct Doing {
  simulation::Reply reply;
  std::optional<double> setting;
  simulation::Setting made;  ///< for a setting
};

/// Runs one trial on a simulated clock, which advances to each event of the trial's state machine. Intervals
/// begin when the machine asks for them, and the answer comes at the observer's response time.
class Bench {
 public:
  Bench(const protocol::Protocol& protocol, const protocol::Block& block, const TrialSpec& spec,
        std::int64_t now_ns)
      : protocol_(protocol),
        spec_(spec),
        parts_(trial::parts_of(protocol, spec)),
        machine_(trial::timing_of(protocol, block, spec, parts_)),
        now_ns_(now_ns) {}

  const trial::Result& run(const Doing& doing) {
    perform(machine_.start(now_ns_), doing);
    while (!machine_.done()) {
      const auto wake_ns = machine_.wake_ns();
      if (!answers_.empty() && (!wake_ns || answers_.front().time_ns <= *wake_ns)) {
        const auto answer = answers_.front();
        answers_.pop_front();
        handle(answer, doing);
      } else if (wake_ns) {
        handle({*wake_ns, trial::EventKind::tick, 0}, doing);
      } else {
        throw std::logic_error("rehearsal: a trial waits for an event that never comes");
      }
    }
    return machine_.result();
  }

  std::int64_t now_ns() const { return now_ns_; }

 private:
  void handle(const trial::Event& event, const Doing& doing) {
    now_ns_ = std::max(now_ns_, event.time_ns);
    perform(machine_.handle(event), doing);
  }

  void perform(const std::vector<trial::Action>& actions, const Doing& doing) {
    for (const auto& action : actions) {
      if (action.kind != trial::ActionKind::present) continue;
      const auto onset_ns = present(std::max(now_ns_, action.time_ns), doing);
      const auto times = trial::simulated_times(protocol_, spec_, parts_.back(), onset_ns);
      const int again = machine_.result().again;
      const auto events = doing.setting ? trial::simulated_events(times, spec_, doing.made, again)
                                        : trial::simulated_events(times, doing.reply, again);
      answers_.assign(events.begin(), events.end());
      for (auto& answer : answers_) answer.time_ns = std::max(now_ns_, answer.time_ns);
    }
  }

  /// Presents all parts without any fault. Returns the onset of the last one.
  std::int64_t present(std::int64_t onset_ns, const Doing& doing) {
    for (int i = 0; i < static_cast<int>(parts_.size()); ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (i > 0) onset_ns += ns(parts_[at - 1].length_s + parts_[at].silence_s);
      perform(machine_.handle({onset_ns, trial::EventKind::onset, i}), doing);
      perform(machine_.handle({now_ns_, trial::EventKind::heard, i}), doing);
    }
    return onset_ns;
  }

  const protocol::Protocol& protocol_;
  const TrialSpec& spec_;
  std::vector<trial::Part> parts_;
  trial::Machine machine_;
  std::int64_t now_ns_;
  std::deque<trial::Event> answers_;  ///< what the participant will do, in order of time
};

Doing done_by(const Rehearser& rehearser, const TrialSpec& spec, const protocol::Protocol& protocol,
              std::uint64_t seed) {
  if (spec.strokes) {
    Doing doing;
    doing.reply.choice = 0;  // 0: the finger moves as the protocol asks
    return doing;
  }
  if (!spec.slider) return {rehearser.answer(spec, trial::question_of(spec, protocol, seed)), {}, {}};
  const auto set = rehearser.adjust(spec, trial::adjustment_of(spec, protocol, seed));
  trial::Slider slider(*spec.slider, spec.level.value_or(spec.slider->low));
  // Ignore slider movements after the tones have ended: the participant could not feel their effect.
  const auto last = trial::parts_of(protocol, spec).back();
  const double sounds_s =
      last.length_s - 1e-9 * static_cast<double>(trial::simulated_times(protocol, spec, last, 0).slider_ns);
  for (const auto& move : set.moves)
    if (move.time_s < sounds_s) slider.move(move.value);
  Doing doing;
  doing.reply.choice = 0, doing.made = set;
  doing.setting = slider.setting();
  return doing;
}

}  // namespace

Rehearsal rehearse(const protocol::Protocol& protocol, const protocol::Visit& visit, std::uint64_t seed,
                   const Rehearser& rehearser, const procedure::EarlierTrials& earlier) {
  Rehearsal rehearsal;
  procedure::StandIns programs;
  trial::Director director(protocol, visit, seed, &programs, earlier);
  std::int64_t now_ns = 0;
  while (const auto* block = director.block()) {
    const auto begun_ns = now_ns;
    auto& record = rehearsal.blocks.emplace_back();
    record.start = trial::block_start(*block, director.block_index(), director.attempt());
    now_ns += page_ns;
    int trials = 0;
    while (const auto spec = director.next()) {
      auto row = trial::row_of(*spec, protocol, rehearsal.trials);
      Bench bench(protocol, *block, *spec, now_ns);
      const auto doing = done_by(rehearser, *spec, protocol, seed);
      const auto& result = bench.run(doing);
      trial::fill_result(row, result, *spec, protocol, 0, doing.setting ? doing.setting : doing.reply.value);
      trial::TrialEnd end{row.outcome, result.response, row.given.correct, {}};
      if (result.response) end.setting = doing.setting;
      director.record(end);
      director.spend(row.timing.duration_s);
      now_ns = bench.now_ns();
      record.trials.push_back(std::move(row));
      if (block->break_after && ++trials % block->break_after->trials == 0) director.rested();
      if (++rehearsal.trials > most_trials)
        throw core::Failure(
            core::phrase("block \"%1\" does not end: a simulated observer leaves too many trials unanswered",
                         {core::plain(block->name)}));
    }
    for (auto& estimate : director.estimates()) rehearsal.estimates.push_back(std::move(estimate));
    director.finish_block();
    rehearsal.block_s.push_back(static_cast<double>(now_ns - begun_ns) * 1e-9);
  }
  rehearsal.long_runs = director.long_runs();
  rehearsal.duration_s = static_cast<double>(now_ns) * 1e-9;
  return rehearsal;
}

Rehearser rehearser(const simulation::Observer& observer) {
  return {
      [observer](const trial::TrialSpec&, const simulation::Question& q) { return observer.answer(q); },
      [observer](const trial::TrialSpec&, const simulation::Adjustment& a) { return observer.adjust(a); }};
}

}  // namespace turnpoint::rehearsal

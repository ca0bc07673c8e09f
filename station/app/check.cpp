#include "station/app/check.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "station/app/parallel.hpp"
#include "station/observer/observer.hpp"
#include "station/protocol/design_advice.hpp"
#include "station/session/director.hpp"
#include "station/session/rows.hpp"

namespace turnpoint::app {

namespace {

using protocol::Protocol;

// What people need beside the stimuli, for an estimate: reading an instruction, exploring before they decide
// (a share of the time that the tones last), one setting of a slider, feedback.
constexpr double instruction_s = 12, explored_share = 0.5, setting_s = 15, feedback_s = 0.8;

struct Sitting {
  double duration_s = 0;
  std::vector<std::string> names, instructions;
  std::vector<bool> practice;
  std::vector<double> trials;
};

double stimulus_s(const Protocol& protocol, const session::TrialSpec& trial) {
  const auto& task = protocol.task;
  const double longest_s = task.duration_s ? *task.duration_s : protocol.timing.explore_s.value_or(0);
  switch (task.kind) {
    case protocol::TaskKind::adjustment:
      return std::min(setting_s, longest_s);
    case protocol::TaskKind::single_interval:
      return task.foreperiod_s ? trial.foreperiod_s : explored_share * longest_s;
    default:
      break;
  }
  const auto n = static_cast<double>(trial.intervals.size());
  return n * longest_s + (n - 1) * task.gap_s.value_or(0);
}

void run_block(session::Director& director, const Protocol& protocol, const observer::Observer& observer,
               std::uint64_t seed, Sitting& sitting) {
  const auto& block = *director.block();
  int since_break = 0;
  while (const auto trial = director.next()) {
    const auto reply = observer.answer(session::question_of(*trial, protocol, seed));
    const double answer_s = std::clamp(reply.response_time_s, 0.0, std::max(trial->deadline_s, 0.0));
    const bool answered = reply.choice && reply.response_time_s <= trial->deadline_s;
    sitting.duration_s += stimulus_s(protocol, *trial) + answer_s + trial->iti_s;
    if (block.feedback == protocol::Feedback::trial) sitting.duration_s += feedback_s;
    sitting.trials.back() += 1;
    if (block.break_after && ++since_break == block.break_after->trials) {
      sitting.duration_s += block.break_after->min_s;
      since_break = 0;
    }
    session::TrialEnd end;
    end.outcome = answered ? terms::Outcome::answered : terms::Outcome::timeout;
    if (answered) end.response = reply.choice;
    if (answered && trial->correct) end.correct = reply.choice == trial->correct;
    director.record(end);
    // A procedure without a rule that ends it would be refused; this only guards the estimate.
    if (sitting.trials.back() > 20000) return;
  }
}

Sitting simulate(const Protocol& protocol, int index, std::uint64_t seed) {
  Sitting sitting;
  session::Director director(protocol, index, seed);
  const observer::Observer observer{observer::Parameters{}};
  double repeated = 0;
  while (const auto* block = director.block()) {
    const auto fixed = block->fixed.find("instruction");
    const auto* instruction =
        fixed == block->fixed.end() ? nullptr : std::get_if<std::string>(&fixed->second);
    sitting.names.push_back(block->name);
    sitting.instructions.push_back(instruction ? *instruction : "");
    sitting.practice.push_back(block->practice);
    sitting.trials.push_back(std::exchange(repeated, 0));
    sitting.duration_s += instruction_s;
    const int here = director.block_index();
    run_block(director, protocol, observer, seed, sitting);
    if (sitting.trials.back() > 20000) return sitting;
    director.finish_block();
    const bool again = director.block() && director.block_index() == here;
    if (!again) continue;
    // Practice that is repeated is one block of as many trials as were needed.
    repeated = sitting.trials.back();
    sitting.names.pop_back(), sitting.instructions.pop_back(), sitting.practice.pop_back(),
        sitting.trials.pop_back();
  }
  return sitting;
}

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
  };
  return {at(0.05), at(0.5), at(0.95)};
}

void estimate(const Protocol& protocol, int sessions, const std::stop_token& stop, Check& check) {
  std::vector<double> durations, trials;
  std::vector<std::vector<double>> by_block;
  std::vector<Sitting> sittings(static_cast<std::size_t>(sessions));
  in_parallel(sessions, processors(), {}, [&](int i) {
    if (stop.stop_requested()) throw protocol::Abandoned();
    const auto at = static_cast<std::size_t>(i);
    // Sequence index 0 throughout: the blocks of all rows are the same, in another order.
    sittings[at] = simulate(protocol, 0, static_cast<std::uint64_t>(i));
  });
  for (int i = 0; i < sessions; ++i) {
    const auto& sitting = sittings[static_cast<std::size_t>(i)];
    if (i == 0) {
      by_block.resize(sitting.names.size());
      for (std::size_t b = 0; b < sitting.names.size(); ++b)
        check.blocks.push_back({sitting.names[b], sitting.instructions[b], sitting.practice[b], {}});
    }
    double sum = 0;
    for (std::size_t b = 0; b < sitting.trials.size(); ++b) {
      sum += sitting.trials[b];
      if (b < by_block.size()) by_block[b].push_back(sitting.trials[b]);
    }
    durations.push_back(sitting.duration_s);
    trials.push_back(sum);
  }
  for (std::size_t b = 0; b < check.blocks.size(); ++b) check.blocks[b].trials = spread_of(by_block[b]);
  check.trials = spread_of(trials);
  check.duration_s = spread_of(durations);
  check.simulated_sessions = sessions;
}

}  // namespace

Check check(const std::string& protocol_path, const std::string& rig_path, const CheckOptions& options,
            const std::stop_token& stop) {
  Check check;
  std::optional<Protocol> protocol;
  std::optional<rig::Rig> rig;
  const auto gather = [&](auto&& load) {
    try {
      load();
    } catch (const text::BadInput& bad) {
      check.problems.insert(check.problems.end(), bad.problems().begin(), bad.problems().end());
    }
  };
  gather([&] { protocol = protocol::load(protocol_path); });
  gather([&] { rig = rig::load(rig_path); });
  if (!check.problems.empty()) return check;
  check.id = protocol->id, check.title = protocol->title, check.rig_name = rig->name;
  check.protocol_defaults = protocol->defaults_used;
  check.rig_defaults = rig->defaults_used;
  check.survey = protocol::survey(*protocol, *rig, stop);
  check.problems = check.survey.problems;
  check.warnings = check.survey.warnings;
  check.notes = protocol::notes(*protocol);
  try {
    estimate(*protocol, options.sessions, stop, check);
    if (stop.stop_requested()) throw protocol::Abandoned();
    if (check.problems.empty()) check.cues = cue_guard(*protocol, *rig, check.survey, stop);
  } catch (const protocol::Abandoned&) {
    throw;
  } catch (const std::exception& error) {
    // What the procedures cannot do must stop a session before anybody sits down.
    check.problems.push_back({{protocol_path, 0, 0}, error.what(), ""});
  }
  if (!check.cues.not_compared.empty())
    check.warnings.push_back(
        {{protocol_path, 0, 0},
         "the cues of " + check.cues.not_compared + " are not known: nothing is known of leaks",
         "fewer combinations of factors in one scene"});
  if (check.duration_s.median > 60 * rig->limits.session_minutes)
    check.warnings.push_back({{protocol_path, 0, 0},
                              "the session will last about " +
                                  std::to_string(std::lround(check.duration_s.median / 60)) +
                                  " minutes, longer than the rig's session_minutes",
                              "at most " + std::to_string(std::lround(rig->limits.session_minutes))});
  return check;
}

}  // namespace turnpoint::app

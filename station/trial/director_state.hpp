// The state of a Director, shared by director.cpp and director_trials.cpp. Other files must not include it.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "station/procedure/procedure.hpp"
#include "station/protocol/tasks.hpp"
#include "station/trial/director.hpp"
#include "station/trial/orders.hpp"

namespace turnpoint::trial {

struct Director::State {
  static constexpr int no_procedure = -1;

  const protocol::Protocol& protocol;
  std::uint64_t seed;
  procedure::Programs* programs;
  procedure::EarlierTrials earlier;
  std::vector<protocol::Block> blocks;
  std::vector<std::vector<IntervalOrder>> orders_by_task;  ///< all that each task can have
  std::size_t block_task = 0;    ///< the task of trials of the block that no procedure chooses
  std::vector<int> task_trials;  ///< how many of the block's trials that count asked each task
  std::size_t block = 0;
  /// number of the current attempt at the block, and of the first attempt since the session was started or
  /// restarted
  int attempt = 0, first_attempt = 0;
  /// number of trials of the block so far that count; part of the key of the next trial's random draws
  int trial = 0;
  int shown = 0, right = 0;
  double spent_s = 0;        ///< duration of the block's trials so far that count
  bool last_counts = false;  ///< whether the last trial counts
  /// tasks of which a trial has been presented since the block's beginning or a rest
  std::set<std::size_t> adapted;
  int warmups = 0, warmups_given = 0;
  int done = 0;
  std::string ended;
  std::vector<const procedure::Spec*> specs;
  std::vector<std::unique_ptr<procedure::Procedure>> procedures;
  std::vector<double> practice_levels;
  /// trials of the blocks that measure a friction table, by block
  std::map<std::size_t, std::vector<Stroke>> strokes;
  std::optional<TrialSpec> current;
  int current_procedure = no_procedure;
  int last_procedure = no_procedure;  ///< that of the last trial of a procedure in this block
  std::vector<int> pass;  ///< procedures whose turn is yet to come in this pass, if they come in passes

  /// How many of the last trials of the block had the same value. Values are compared as text.
  struct Run {
    int limit = 0, length = 0;
    std::string value;
  };
  std::map<std::string, Run> runs;  ///< the block's limits of runs, by the keys of procedure::Spec::max_run
  std::map<std::string, Director::LongRun> long_runs;
  /// Trials of this block that present the intervals in the order of another trial, which has theirs.
  std::map<int, int> swapped_orders;
  /// How the current trial differs from the one that would come without limits of runs. record() applies it,
  /// so that a trial that is made twice is the same.
  struct Deviation {
    std::size_t place = 0;        ///< that of the procedure's list
    std::optional<int> order_of;  ///< the trial with which it changes orders of intervals
    int redraws = 0;              ///< number of draws of its factors that have been given up
    int catches = 0;              ///< 1: it comes instead of a catch trial, -1: it is such a catch trial
  };
  Deviation deviation;
  /// How often values come in the present repeats of lists, and in all of their rest.
  struct Left {
    std::map<std::string, int> soon, all;
  };
  std::map<std::pair<int, std::string>, Left> left_of_lists;  ///< kept while one trial is made
  int catches_owed = 0;  ///< number of catch trials that have been put off

  State(const protocol::Protocol& p, const protocol::Visit& visit, std::uint64_t s,
        procedure::Programs* starts, procedure::EarlierTrials before)
      : protocol(p),
        seed(s),
        programs(starts),
        earlier(std::move(before)),
        blocks(protocol::block_order(p, visit)),
        task_trials(protocol::tasks_of(p).size()) {
    for (const auto* one : protocol::tasks_of(p)) orders_by_task.push_back(orders_of(one->task));
    enter_block();
  }

  /// The protocol as the task of a trial sees it.
  const protocol::Protocol& seen_by(std::size_t task) const { return protocol::of_task(protocol, task); }
  /// The orders of the block's task. Limits of runs, which look at them, do not go with several tasks.
  const std::vector<IntervalOrder>& orders() const { return orders_by_task[block_task]; }
  const protocol::Block* now() const {
    return ended.empty() && block < blocks.size() ? &blocks[block] : nullptr;
  }
  core::Draws draws(core::Stream stream, int key) const {
    return core::Draws({seed, stream, static_cast<int>(block), attempt, key});
  }

  // These functions handle blocks and procedures (director.cpp).
  void enter_block();
  const procedure::Spec* find_spec(const std::string& name) const;
  procedure::Context context_for() const;
  void learn(const TrialEnd& end);
  int block_expected(const protocol::Block& b) const;
  int trials_of(const protocol::Block& b) const;
  int left_in_block() const;
  int left_of_procedures(const protocol::Block& b) const;
  bool time_is_up() const;
  double trial_s() const;

  // These functions make one trial (director_trials.cpp).
  bool timeouts_are_data() const;
  void set_times(TrialSpec& spec) const;
  protocol::Factors drawn_factors() const;
  protocol::FactorValue drawn_value(const protocol::Factor& factor, int number) const;
  std::optional<int> pick_procedure();
  bool catch_due() const;
  TrialSpec blank(core::TrialType type) const;
  const IntervalOrder& presented_order(int key) const;
  int order_number(const TrialSpec& spec) const;
  void complete(TrialSpec& spec) const;
  bool is_fresh(std::size_t task) const;
  std::optional<SliderSpan> slider(std::size_t of_task, int key) const;
  TrialSpec warmup_trial() const;
  TrialSpec catch_trial() const;
  std::optional<TrialSpec> practice_trial() const;
  std::optional<TrialSpec> strokes_trial() const;
  void set_proposal(const procedure::Proposal& proposal, const procedure::Spec& from,
                    protocol::Factors& factors) const;
  TrialSpec procedure_trial(int index) const;
  std::optional<TrialSpec> make();

  // These functions limit runs (director_runs.cpp).
  void set_limits_of_runs();
  std::string value_of(const std::string& key, const TrialSpec& spec) const;
  int order_key(int of_trial) const;
  int too_long(const TrialSpec& spec) const;
  bool can_follow(const std::map<std::string, int>& left, const std::string& key, const TrialSpec& spec,
                  int spare) const;
  bool leaves_order(const TrialSpec& spec, int spare);
  static bool lists(const procedure::Spec& from, const std::string& key);
  const Left& lists_left(const TrialSpec& spec, const std::string& key);
  bool leaves_lists(const TrialSpec& spec, const std::string& key, int spare);
  bool draws_factors(const TrialSpec& spec) const;
  std::optional<TrialSpec> with_short_runs(const TrialSpec& first);
  void apply_deviation();
  void count_runs(const TrialSpec& spec);
};

}  // namespace turnpoint::trial

#include "station/view/sample_pages.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "station/procedure/program.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/interludes.hpp"
#include "station/protocol/tasks.hpp"
#include "station/session/pages.hpp"
#include "station/session/session.hpp"
#include "station/trial/director.hpp"
#include "station/trial/machine.hpp"
#include "station/trial/rows.hpp"
#include "station/trial/timing.hpp"

namespace turnpoint::view {

namespace {

using trial::Phase;

class Sampler {
 public:
  Sampler(const protocol::Protocol& protocol, const rig::Rig& rig, const std::string& language)
      : setup_(setup_for(protocol, rig, language)),
        pages_(setup_),
        director_(setup_.protocol, {}, 1, &programs_) {}

  std::vector<SamplePage> make() {
    const auto& blocks = director_.all_blocks();
    for (std::size_t next = 0; next <= blocks.size(); ++next) {
      for (const auto* interlude : protocol::interludes_before(setup_.protocol, blocks, next, {}))
        if (interludes_.insert(interlude->name).second) add(*interlude);
      if (next < blocks.size()) add(blocks[next]);
    }
    session::Summary summary;
    summary.status = core::SessionStatus::completed;
    if (setup_.protocol.payoff) summary.points = 0;
    add("design.page.end", pages_.end(summary, director_));
    return std::move(all_);
  }

 private:
  static session::Setup setup_for(const protocol::Protocol& protocol, const rig::Rig& rig,
                                  const std::string& language) {
    session::Setup setup;
    setup.protocol = protocol;
    setup.rig = rig;
    setup.language = language;
    setup.run_mode = core::RunMode::live;
    return setup;
  }

  void add(const char* name, session::Page page) { all_.push_back({name, std::move(page)}); }

  void add(const protocol::Interlude& interlude) {
    const bool consent = interlude.kind == protocol::InterludeKind::consent;
    for (const auto& item : interlude.items) {
      auto page = pages_.question(item, director_);
      page.back = !consent && &item != &interlude.items.front();
      add(consent ? "design.page.consent" : "design.page.question", std::move(page));
    }
    for (const auto& explanation : interlude.pages) {
      auto page = pages_.explanation(explanation, director_);
      page.back = &explanation != &interlude.pages.front();
      add("design.page.explanation", std::move(page));
    }
    if (!interlude.farewell.empty())
      add("design.page.farewell", pages_.farewell(interlude.farewell, director_));
  }

  /// A block differs from an earlier one for the participant if it asks for something else.
  void add(const protocol::Block& block) {
    const auto instruction = block.fixed.find("instruction");
    const auto* word =
        instruction == block.fixed.end() ? nullptr : std::get_if<std::string>(&instruction->second);
    const auto asked = protocol::tasks_in(setup_.protocol, block);
    const auto told = std::tuple(block.kind, block.practice, word == nullptr ? std::string() : *word, asked);
    if (!blocks_.insert(told).second) return;
    auto alone = setup_.protocol;
    alone.plan = {block};
    trial::Director director(alone, {}, 1, &programs_);
    auto spec = director.next();
    if (!spec) return;
    auto page = pages_.instructions(block, director);
    pages_.add_mark(page, *spec);
    add("design.page.instructions", std::move(page));
    const bool judged =
        block.feedback == protocol::Feedback::trial || block.kind == protocol::BlockKind::training;
    // a trial of each of its tasks
    constexpr int most_trials = 1000;
    std::set<std::size_t> seen;
    for (int i = 0; spec && i < most_trials && seen.size() < std::max<std::size_t>(1, asked.size()); ++i) {
      const auto task = std::tuple(block.kind, word == nullptr ? std::string() : *word, spec->task);
      if (seen.insert(spec->task).second && tasks_.insert(task).second) add_trial(*spec, block, director);
      if (judged && feedback_.insert(task).second) add_feedback(*spec, block, director);
      if (asked.size() < 2) break;
      trial::TrialEnd end;
      end.response = 0, end.correct = spec->correct == 0;
      if (spec->slider) end.setting = spec->level;
      director.record(end);
      spec = director.next();
    }
    session::BlockScore score;
    score.trials = 10, score.right = 8, score.times_s = {0.5};
    if (auto over = pages_.block_over(block, score, 0, director); over && over_.insert(told).second)
      add("design.page.block_over", *std::move(over));
    if (block.break_after && !rest_) {
      rest_ = true;
      add("design.page.rest", pages_.rest(block, block.break_after->min_s, director));
    }
  }

  /// The last part of a trial.
  int last_of(const trial::TrialSpec& spec) const {
    return std::max(0, static_cast<int>(trial::parts_of(setup_.protocol, spec).size()) - 1);
  }

  void add_trial(const trial::TrialSpec& spec, const protocol::Block& block,
                 const trial::Director& director) {
    const auto phase = [&](Phase of, int interval) {
      return pages_.of_phase(of, interval, spec, block, {}, director);
    };
    const auto& task = protocol::of_task(setup_.protocol, spec.task).task;
    const int last = last_of(spec);
    add("design.page.cue", phase(Phase::cue, 0));
    const auto parts = trial::parts_of(setup_.protocol, spec);
    for (int i = 0; i <= last; ++i) {
      const auto interval_of = [&](int part) { return parts.at(static_cast<std::size_t>(part)).interval; };
      const bool begins = i == 0 || interval_of(i) != interval_of(i - 1);
      // The pages of the parts of an interval differ only if the last one takes the answer.
      if (!begins && (i < last || !protocol::explored(task))) continue;
      if (i > 0 && begins && task.gap_s) add("design.page.gap", phase(Phase::gap, i - 1));
      auto page = phase(Phase::stimulus, i);
      if (spec.slider && i == last)
        pages_.add_slider(page, *spec.slider, spec.level.value_or(spec.slider->low), false);
      page.again = task.again > 0 && i == last && protocol::explored(task);
      add("design.page.interval", std::move(page));
    }
    if (spec.strokes) return;
    const bool answered = spec.slider || (task.kind == protocol::TaskKind::single_interval &&
                                          protocol::explored(task) && !task.value);
    auto answer = phase(Phase::response, last);
    answer.again = task.again > 0;
    if (!answered) add("design.page.answer", std::move(answer));
    if (task.confidence) add("design.page.confidence", phase(Phase::confidence, last));
    trial::Result late;
    late.outcome = core::Outcome::timeout;
    if (!spec.slider && spec.deadline_s > 0)
      add("design.page.late", pages_.of_phase(Phase::late, last, spec, block, late, director));
  }

  void add_feedback(const trial::TrialSpec& spec, const protocol::Block& block,
                    const trial::Director& director) {
    for (const bool right : {true, false}) {
      trial::Result result;
      result.outcome = core::Outcome::answered;
      result.correct = right;
      auto page = pages_.of_phase(Phase::feedback, last_of(spec), spec, block, result, director);
      if (spec.strokes) page.text = pages_.movement(right ? "ok" : "hard");
      if (const auto points = trial::points_of(result, spec, setup_.protocol))
        pages_.add_points(page, *points, block.practice ? std::nullopt : points);
      add("design.page.feedback", std::move(page));
    }
  }

  const session::Setup setup_;
  const session::Pages pages_;
  procedure::StandIns programs_;  // no separate program is started
  const trial::Director director_;
  std::vector<SamplePage> all_;
  std::set<std::string> interludes_;
  std::set<std::tuple<protocol::BlockKind, bool, std::string, std::vector<std::size_t>>> blocks_, over_;
  std::set<std::tuple<protocol::BlockKind, std::string, std::size_t>> tasks_, feedback_;
  bool rest_ = false;
};

}  // namespace

std::vector<SamplePage> sample_pages(const protocol::Protocol& protocol, const rig::Rig& rig,
                                     const std::string& language) {
  return Sampler(protocol, rig, language).make();
}

}  // namespace turnpoint::view

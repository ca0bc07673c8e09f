#include <algorithm>
#include <map>
#include <set>

#include "station/core/number.hpp"
#include "station/procedure/description.hpp"
#include "station/protocol/advice_list.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/conditions.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/reading.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/tasks.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

using core::Findings;

// Reports each source of trials in which this factor has no value. If no source sets the factor at all, it is
// reported only once, at its declaration.
void check_values(const std::vector<Source>& sources, const std::string& name, const Reading& reading) {
  const auto* factor = find_factor(reading.protocol.factors, name);
  if (factor && (!factor->levels.empty() || factor->draw != FactorDraw::levels)) return;
  const auto sets = [&](const Source& source) { return source.sets.count(name) > 0; };
  const bool set_somewhere = std::any_of(sources.begin(), sources.end(), sets);
  for (const auto& source : sources) {
    if (sets(source)) continue;
    reading.findings.add(
        factor && !set_somewhere ? factor->place : source.block->place,
        phrase("in block \"%1\", %2, \"%3\" has no value",
               {plain(source.block->name), source.what, plain(name)}),
        phrase(
            "set this factor with a procedure (\"level\" or \"with\") or fixed levels, or give it \"levels\" "
            "or \"draw\""));
    if (!set_somewhere) return;
  }
}

// Reports levels at which two answers are right, because such trials cannot be scored.
void check_answers(const std::vector<Source>& sources, const Reading& reading) {
  const auto& answers = reading.protocol.task.correct_answer;
  for (const auto& source : sources) {
    for (const double level : source.levels) {
      auto factors = any_factors(reading.protocol);
      factors[source.level] = level;
      const auto right = [&](const auto& answer) { return holds(answer.second, factors); };
      if (std::count_if(answers.begin(), answers.end(), right) < 2) continue;
      const auto last = std::find_if(answers.rbegin(), answers.rend(), right);
      return reading.findings.add(
          last->second.left.place,
          answers.size() > 2
              ? phrase("at %1 = %2 two answers are right", {plain(source.level), plain(core::number(level))})
              : phrase("at %1 = %2 both answers are right",
                       {plain(source.level), plain(core::number(level))}),
          phrase("write comparisons that cannot both be true"));
    }
  }
}

// Reports a rating of a signal that all trials have, or that none has: then there is no ROC. Trials whose
// signal depends on other factors than the level are not counted here.
void check_present(const std::vector<Source>& sources, const Reading& reading) {
  const auto& present = reading.protocol.task.present;
  if (!present) return;
  bool with = false, without = false;
  for (const auto& source : sources) {
    if (source.block->practice) continue;
    for (const auto* side : {&present->left, &present->right})
      for (const auto& name : factors_in(*side))
        if (name != source.level) return;
    auto factors = any_factors(reading.protocol);
    for (const double level : source.levels) {
      factors[source.level] = level;
      (holds(*present, factors) ? with : without) = true;
    }
  }
  if (with != without)
    reading.findings.add(present->left.place,
                         with ? phrase("every trial has a signal") : phrase("no trial has a signal"),
                         phrase("levels with a signal and levels without one, such as 0"));
}

/// What to do about a key that judges answers where none is right.
core::Phrase instead_of_judging(const Task& task) {
  if (task.kind == TaskKind::adjustment) return phrase("use another kind of task");
  if (task.kind == TaskKind::comparison)
    return phrase("leave it out: in a comparison no answer is right or wrong");
  return phrase("set \"correct\" in %1", {plain(table_of(task))});
}

/// True if the file has a task, or several.
bool has_task(const Reading& reading) { return reading.places.has("task") || reading.places.has("tasks"); }

// Points and goals need answers that are right or wrong: points in some task, a goal in some task of each
// block that has it.
void check_goals(const Reading& reading) {
  const auto& protocol = reading.protocol;
  if (!has_task(reading)) return;
  const auto all = as_tasks_see(reading);
  const auto judged = [&](const Protocol& one) {
    return (one.task.kind != TaskKind::adjustment && scored(one.task)) ||
           reading.places.has(key_of(one.task, "correct"));
  };
  const auto report = [&](const std::string& key, const Task& task) {
    reading.findings.add(reading.places.of(key),
                         phrase("\"%1\" judges answers, but no answer is correct", {plain(key)}),
                         instead_of_judging(task));
  };
  if (protocol.payoff && std::none_of(all.begin(), all.end(), judged)) report("payoff", all.front().task);
  for (const auto& [name, instruction] : protocol.instructions) {
    if (!instruction.goal) continue;
    std::map<std::string, std::vector<const Protocol*>> asked;  // by each block that has the goal
    for (const auto& one : all)
      for (const auto& block : all_blocks(one))
        if (const auto fixed = block.fixed.find("instruction");
            fixed != block.fixed.end() && fixed->second == FactorValue(name))
          asked[block.name].push_back(&one);
    if (asked.empty()) asked[""].push_back(&all.front());
    for (const auto& [block, tasks] : asked)
      if (std::none_of(tasks.begin(), tasks.end(), [&](const auto* one) { return judged(*one); })) {
        report("instructions." + name + ".goal", tasks.front()->task);
        break;
      }
  }
}

// Without correct answers, a procedure cannot follow right answers, and practice cannot be passed. Reports
// such procedures and blocks.
void check_scored(const Reading& reading) {
  const auto& protocol = reading.protocol;
  const auto& task = protocol.task;
  const bool stated = reading.places.has(key_of(task, "correct"));
  if (!has_task(reading) || task.kind == TaskKind::adjustment || scored(task) || stated) return;
  for (const auto& spec : protocol.procedures) {
    if (procedure::follows_answers(spec) && judges(task))
      reading.findings.add(
          reading.places.of(key_of(spec, "kind")),
          phrase("the procedure \"%1\" needs answers that are right or wrong", {plain(spec.name)}),
          plain("kind = \"constant-stimuli\""));
    else if (procedure::follows_answers(spec) && spec.tracks.empty())
      reading.findings.add(
          reading.places.of(task.name.empty() ? "task" : "tasks." + task.name),
          phrase("the procedure \"%1\" depends on correct answers, but no answer is correct",
                 {plain(spec.name)}),
          phrase("set \"correct\" in %1, or \"tracks\" in the procedure", {plain(table_of(task))}));
  }
  for (const auto& part : protocol.plan) {
    const auto& block = block_of(part);
    // blocks of strokes judge movements, so they need no correct answers
    if (block.kind != BlockKind::trials) continue;
    for (const auto* key : {"pass", "feedback"})
      if (key == std::string("pass") ? block.pass.has_value() : block.feedback != Feedback::none)
        reading.findings.add(
            reading.places.of(key_of(part, key)),
            phrase("block \"%1\" judges answers, but no answer is correct", {plain(block.name)}),
            instead_of_judging(task));
  }
}

// Checks the method of limits, which needs one answer that becomes more frequent as the level rises.
void check_limits(const Reading& reading) {
  const auto& protocol = reading.protocol;
  const auto& task = protocol.task;
  for (const auto& spec : protocol.procedures) {
    if (spec.kind != procedure::Kind::limits) continue;
    const auto report = [&](const char* key, const core::Phrase& what, const core::Phrase& allowed) {
      reading.findings.add(reading.places.of(key_of(spec, key)),
                           phrase("procedure \"%1\": %2", {plain(spec.name), what}), allowed);
    };
    if (task.kind != TaskKind::single_interval && task.kind != TaskKind::same_different) {
      report("kind", phrase("in this kind of task no answer becomes more frequent as the level rises"),
             phrase("use %1 or \"same-different\" in [task]", {plain("kind = \"single-interval\"")}));
      continue;
    }
    const auto rule = answer_rule(protocol, spec.level);
    if (rule.kind != AnswerKind::side && rule.kind != AnswerKind::presence) continue;
    const auto& risen = task.choices.at(static_cast<std::size_t>(rule.positive)).id;
    if (!spec.tracks.empty() && spec.tracks != risen)
      report(
          "tracks",
          phrase("the answer \"%1\" does not become more frequent as the level rises", {plain(spec.tracks)}),
          plain("tracks = \"" + risen + "\""));
    const bool magnitude = task.kind == TaskKind::single_interval && rule.kind == AnswerKind::presence;
    if (magnitude && spec.min && *spec.min < 0)
      report("min",
             phrase("below 0 the answer \"%1\" becomes more frequent as the level falls", {plain(risen)}),
             phrase("use levels of 0 and above"));
  }
}

// Checks procedures with a criterion, which need a task of yes and no, and follow "yes".
void check_detection(const Reading& reading) {
  const auto& protocol = reading.protocol;
  const auto& task = protocol.task;
  for (const auto& spec : protocol.procedures) {
    if (!spec.signal_detection || task.choices.empty()) continue;
    const auto rule = answer_rule(protocol, spec.level);
    const bool scored = !task.correct_answer.empty();
    if (task.kind != TaskKind::single_interval || (scored && rule.kind != AnswerKind::presence)) {
      reading.findings.add(
          reading.places.of(key_of(spec, "function")),
          phrase("procedure \"%1\": signal detection needs a task in which people say whether there was a "
                 "signal",
                 {plain(spec.name)}),
          phrase("use %1 in [task], with one answer that is right at level 0 and another that is right above",
                 {plain("kind = \"single-interval\"")}));
      continue;
    }
    const auto& yes = task.choices.at(static_cast<std::size_t>(rule.positive)).id;
    if (scored && spec.tracks != yes)
      reading.findings.add(
          reading.places.of(key_of(spec, "tracks")),
          phrase("procedure \"%1\": the answer \"%2\" means \"no\"", {plain(spec.name), plain(spec.tracks)}),
          plain("tracks = \"" + yes + "\""));
  }
}

void check_adjustment(const Reading& reading) {
  const auto& protocol = reading.protocol;
  const bool adjusting = protocol.task.kind == TaskKind::adjustment;
  for (const auto& part : protocol.plan) {
    const auto& block = block_of(part);
    for (const auto& name : block.procedures) {
      const auto* spec = find_procedure(protocol, name);
      if (!spec) continue;
      if ((spec->kind == procedure::Kind::adjustment) != adjusting)
        reading.findings.add(
            reading.places.of(key_of(*spec, "kind")),
            phrase("the procedure \"%1\" does not fit the kind of task", {plain(name)}),
            adjusting ? plain("kind = \"adjustment\"") : phrase("use any kind except \"adjustment\""));
      else if (adjusting && spec->level != protocol.task.adjusts)
        reading.findings.add(
            reading.places.of(key_of(*spec, "level")),
            phrase("the procedure \"%1\" sets \"%2\"", {plain(name), plain(spec->level)}),
            phrase("it must set the factor that the slider moves: \"%1\"", {plain(protocol.task.adjusts)}));
    }
  }
}

// Returns what is wrong with an interval of a comparison that should present `factor` alone: another factor
// of the procedure that it presents, and the scene through which it does so, or that `factor` is missing.
core::Phrase wrong_interval(const procedure::Spec& spec, const Protocol& protocol, std::size_t interval,
                            const std::string& factor) {
  const auto& scenes = protocol.task.intervals[interval];
  std::vector<std::string> names{spec.level};
  names.insert(names.end(), spec.against.begin(), spec.against.end());
  for (const auto& name : names) {
    if (name == factor) continue;
    auto alone = spec;
    alone.level = name;
    alone.against.clear();
    for (const auto& part : parts_of(protocol.task, scenes))
      for (const auto& scene : part.scenes) {
        if (presented(protocol, alone, {scene}) != name) continue;
        const auto known = protocol.scenes.find(scene);
        const auto base = known == protocol.scenes.end() ? "" : known->second.base;
        if (!base.empty() && presented(protocol, alone, {base}) == name)
          return phrase(
              "interval %1 presents \"%2\": the scene \"%3\" depends on it, as its base \"%4\" does",
              {plain(interval + 1), plain(name), plain(scene), plain(base)});
        return phrase("interval %1 presents \"%2\": the scene \"%3\" depends on it",
                      {plain(interval + 1), plain(name), plain(scene)});
      }
  }
  return phrase("interval %1 does not present \"%2\"", {plain(interval + 1), plain(factor)});
}

// Each interval of a comparison must present the factor that its procedure sets for it, and no other of them.
void check_intervals(const procedure::Spec& spec, const Reading& reading) {
  const auto& intervals = reading.protocol.task.intervals;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const auto& factor = i == 0 ? spec.level : spec.against[i - 1];
    if (presented(reading.protocol, spec, intervals[i]) != factor)
      reading.findings.add(
          reading.places.of(key_of(spec, i == 0 ? "level" : "against")),
          wrong_interval(spec, reading.protocol, i, factor),
          phrase(
              "name the factors in the order of \"intervals\", each with a scene that depends on it alone"));
  }
}

// A comparison needs procedures that set a stimulus for each of its intervals, and only they can ask for one.
void check_comparisons(const Reading& reading) {
  const auto& protocol = reading.protocol;
  const bool comparing = protocol.task.kind == TaskKind::comparison;
  std::set<std::string> used;
  for (const auto& part : protocol.plan) {
    const auto& block = block_of(part);
    used.insert(block.procedures.begin(), block.procedures.end());
    if (comparing && block.kind == BlockKind::trials && !block.practice && !block.level.empty())
      reading.findings.add(
          reading.places.of(key_of(part, "level")),
          phrase("block \"%1\" has fixed levels, which give no scale", {plain(block.name)}),
          phrase("name a procedure of %1 in \"procedures\"", {plain("kind = \"comparisons\"")}));
    if (comparing && block.catch_trials)
      reading.findings.add(reading.places.of(key_of(part, "catch")),
                           phrase("in a comparison no answer is right or wrong"), phrase("leave it out"));
  }
  for (const auto& spec : protocol.procedures) {
    if (!used.contains(spec.name)) continue;
    if ((spec.kind == procedure::Kind::comparisons) != comparing)
      reading.findings.add(reading.places.of(key_of(spec, "kind")),
                           phrase("the procedure \"%1\" does not fit the kind of task", {plain(spec.name)}),
                           comparing ? plain("kind = \"comparisons\"")
                                     : phrase("use %1 in [task]", {plain("kind = \"comparison\"")}));
    else if (comparing && spec.against.size() + 1 != protocol.task.intervals.size())
      reading.findings.add(
          reading.places.of(key_of(spec, "against")),
          phrase("the procedure \"%1\" sets %2 stimuli, but a trial has %3 intervals",
                 {plain(spec.name), plain(spec.against.size() + 1), plain(protocol.task.intervals.size())}),
          phrase("name one factor for each interval: the first in \"level\""));
    else if (comparing)
      check_intervals(spec, reading);
  }
}

bool has_change(const Task& task) {
  return std::any_of(task.intervals.begin(), task.intervals.end(),
                     [](const auto& scenes) { return scenes.size() > 1; });
}

// Returns the name of a block without a deadline, if any. A block uses the deadline of its instruction or, if
// that has none, the deadline of [timing].
std::optional<std::string> block_without_deadline(const Protocol& protocol) {
  for (const auto& block : all_blocks(protocol)) {
    const auto fixed = block.fixed.find("instruction");
    const auto* name = fixed == block.fixed.end() ? nullptr : std::get_if<std::string>(&fixed->second);
    const auto found = name ? protocol.instructions.find(*name) : protocol.instructions.end();
    // an unknown instruction is reported at the place where it is used
    const bool unknown = name && found == protocol.instructions.end();
    if (!unknown && (!name || !found->second.deadline_s)) return block.name;
  }
  return std::nullopt;
}

/// A change to the second scene after the end of the tones cannot be presented.
void check_foreperiod(const Reading& reading) {
  const auto change = latest_change(reading.protocol);
  if (change && change->change_s >= change->whole_s)
    reading.findings.add(
        reading.places.of(key_of(reading.protocol.task, "foreperiod_s")),
        phrase("the second scene can begin %1 s after the tones begin, but they last only %2 s",
               {plain(core::number(change->change_s)), plain(core::number(change->whole_s))}),
        phrase("a foreperiod that is shorter than the tones for all values of the factors"));
}

// The length of a cue must not give away the right answer, or whether there is a signal.
void check_cue(const Reading& reading) {
  const auto& task = reading.protocol.task;
  const auto deciding = deciding_factors(task);
  for (const auto& name : factors_in(task.cue_s))
    if (deciding.contains(name))
      return reading.findings.add(
          task.cue_s.place,
          phrase("the length of the cue depends on \"%1\", which decides the right answer", {plain(name)}),
          phrase("other factors"));
}

/// True if a scene comes before the one that the slider moves.
bool has_standard(const Task& task) {
  const auto parts = parts_of(task);
  return parts.size() > 1 || (!parts.empty() && parts.front().scenes.size() > 1);
}

void check_timing(core::TableReader& file, const Reading& reading) {
  const auto* table = file.take("timing");
  if (!table || table->kind != core::Value::Kind::table) return;
  const auto& protocol = reading.protocol;
  const auto& timing = protocol.timing;
  const auto place = [&](const char* key) {
    const auto* entry = table->find(key);
    return entry ? entry->value.place : table->place;
  };
  auto& findings = reading.findings;
  const auto& task = protocol.task;
  const auto task_place = task.name.empty() ? table->place : reading.places.of("tasks." + task.name);
  if (explored(task) && !table->find("explore_s") && !task.duration_s)
    findings.add(
        task_place, phrase("nothing ends the interval: [timing] has no \"explore_s\""),
        phrase("set it to the longest time that the tones last, in seconds (or set \"duration_s\" in %1)",
               {plain(table_of(task))}));
  const auto all = as_tasks_see(reading);
  const bool none_explored =
      std::none_of(all.begin(), all.end(), [](const Protocol& one) { return explored(one.task); });
  if (none_explored && table->find("explore_s"))
    findings.add(
        place("explore_s"),
        phrase("\"explore_s\" does not apply to intervals that last for the \"duration_s\" of [task]"),
        phrase("leave it out; a single interval without \"duration_s\" lasts until the answer instead"));
  if (timing.signal && protocol.task.kind == TaskKind::adjustment)
    findings.add(
        place("response_signal"),
        phrase("a slider is not set at a signal: \"response_signal\" does not apply to \"adjustment\""),
        phrase("use \"deadline_s\""));
  if (timing.signal && protocol.task.again > 0)
    findings.add(
        reading.places.of(key_of(protocol.task, "again")),
        phrase("nobody can ask for the intervals again and answer at a signal: \"again\" does not apply "
               "with \"response_signal\""),
        phrase("leave it out, or use \"deadline_s\""));
  if (protocol.task.again > 0 && protocol.task.kind == TaskKind::adjustment && !has_standard(protocol.task))
    findings.add(
        reading.places.of(key_of(protocol.task, "again")),
        phrase("nothing comes before the scene that the slider moves, so there is nothing to feel again"),
        phrase("leave it out, or use an interval that begins with a standard"));
  if (timing.response_zero == ResponseZero::change && !has_change(task))
    findings.add(place("response_zero"),
                 task.name.empty()
                     ? phrase("\"response_zero\" is \"change\", but no interval has a second scene")
                     : phrase("\"response_zero\" is \"change\", but no interval of %1 has a second scene",
                              {plain(table_of(task))}),
                 phrase("use an interval of two scenes: %1", {plain("intervals = [[\"a\", \"b\"]]")}));
  check_foreperiod(reading);
  if (!table->find("deadline_s") && !table->find("response_signal"))
    if (const auto block = block_without_deadline(protocol))
      findings.add(table->place,
                   phrase("block \"%1\" has no deadline: [timing] has no \"deadline_s\"", {plain(*block)}),
                   phrase("set \"deadline_s\" here, or in the block's [instructions.NAME]"));
  // Reports anticipation_s if it is not shorter than a deadline. If the deadline is shorter than any person's
  // response, the deadline is to blame; otherwise it is anticipation_s, which is normally about 0.15 s.
  const double anticipation_s = bounds(timing.anticipation_s, protocol.factors).second;
  const auto check_anticipation = [&](const std::string& key, const Linear& deadline) {
    const double deadline_s = bounds(deadline, protocol.factors).first;
    if (anticipation_s >= deadline_s)
      findings.add(deadline_s < shortest_deadline_s ? reading.places.of(key) : place("anticipation_s"),
                   phrase("\"anticipation_s\" must be shorter than the deadline of %1 s",
                          {plain(core::number(deadline_s))}));
  };
  if (timing.deadline_s) check_anticipation("timing.deadline_s", *timing.deadline_s);
  for (const auto& [name, instruction] : protocol.instructions)
    if (instruction.deadline_s) {
      const auto key = "instructions." + name + ".deadline_s";
      check_anticipation(key, *instruction.deadline_s);
      if (timing.signal)
        findings.add(reading.places.of(key),
                     phrase("a deadline does not apply if there is a response signal"),
                     phrase("answers count from the signal to the end of its \"window_s\""));
    }
}

/// Checks the protocol as one of its tasks sees it.
void check_one(core::TableReader& file, const Reading& reading) {
  check_timing(file, reading);
  check_signal(reading);
  check_follow(reading);
  check_scored(reading);
  check_cue(reading);
  check_limits(reading);
  check_detection(reading);
  check_adjustment(reading);
  check_comparisons(reading);
  const auto sources = sources_of(reading.protocol);
  const auto needed = factors_used(reading.protocol);
  for (const auto& name : needed) check_values(sources, name, reading);
  check_answers(sources, reading);
  check_present(sources, reading);
}

}  // namespace

void check_whole(core::TableReader& file, Reading& reading) {
  check_goals(reading);
  check_tasks(reading);
  for (auto& one : as_tasks_see(reading)) {
    const Reading part{
        one,           reading.findings, reading.places, reading.declared_scenes, reading.families,
        reading.tasks, reading.asks};
    check_one(file, part);
  }
  if (reading.tasks.empty()) return;
  std::vector<core::Problem> once;
  for (auto& problem : reading.findings.problems) add_once(std::move(problem), once);
  reading.findings.problems = std::move(once);
}

void check_tasks(const Reading& reading) {
  if (reading.tasks.empty()) return;
  std::set<std::string> asked;
  bool known =
      true;  // otherwise some procedure or block does not say which task it asks, as has been reported
  for (const auto& [name, task] : reading.asks) known = known && !task.empty();
  for (const auto& part : reading.protocol.plan) {
    const auto& block = block_of(part);
    if (block.kind != BlockKind::trials) continue;
    known = known && (block.level.empty() || !block.task.empty());
    std::set<std::string> here;
    if (!block.task.empty()) here.insert(block.task);
    for (const auto& name : block.procedures)
      if (const auto found = reading.asks.find(name); found != reading.asks.end()) here.insert(found->second);
    asked.insert(here.begin(), here.end());
    if (here.size() < 2) continue;
    if (block.catch_trials)
      reading.findings.add(
          reading.places.of(key_of(part, "catch")),
          phrase("block \"%1\" asks several tasks, so catch trials do not know theirs", {plain(block.name)}),
          phrase("leave it out, or add a procedure with easy levels"));
    for (const auto& task : reading.tasks)
      if (here.contains(task.name) && !reading.places.has(key_of(task, "cue")))
        reading.findings.add(
            reading.places.of("tasks." + task.name),
            phrase("block \"%1\" asks several tasks, but nothing tells people that \"%2\" comes",
                   {plain(block.name), plain(task.name)}),
            phrase("give it a \"cue\", which the page shows before each trial"));
    for (const auto& name : block.procedures)
      if (const auto* spec = find_procedure(reading.protocol, name); spec && !spec->max_run.empty())
        reading.findings.add(
            reading.places.of(key_of(*spec, "order")),
            phrase("block \"%1\" asks several tasks, whose answers do not make runs together",
                   {plain(block.name)}),
            phrase("leave out \"max_run\", or give each task blocks of its own"));
  }
  for (const auto& task : reading.tasks)
    if (known && !asked.contains(task.name))
      reading.findings.add(reading.places.of("tasks." + task.name),
                           phrase("no block asks the task \"%1\"", {plain(task.name)}),
                           phrase("add a procedure with %1 to a block, or remove the task",
                                  {plain("task = \"" + task.name + "\"")}));
}

}  // namespace turnpoint::protocol

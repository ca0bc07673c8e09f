#include "station/protocol/design_advice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "station/core/number.hpp"
#include "station/protocol/advice_list.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/tasks.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

using core::number;
using core::Problem;
using procedure::Kind;

/// A displacement below this is far too small to be felt.
constexpr double least_displacement_um = 0.001;

std::string trimmed(const std::string& text) {
  const auto from = text.find_first_not_of(" \t\n\r");
  return from == std::string::npos ? "" : text.substr(from, text.find_last_not_of(" \t\n\r") - from + 1);
}

/// A label that a participant reads: its key without the language, what it stands for, and the label.
struct Label {
  std::string key, name;
  const Localised* text;
};

/// The labels of a set, of which no two may be alike.
void check_labels(AdviceList& advice, const std::string& language, const std::vector<Label>& labels) {
  std::set<std::string> seen;
  for (const auto& [key, name, text] : labels) {
    const auto found = text->find(language);
    const auto label = found == text->end() ? "" : trimmed(found->second);
    const auto whole = key + "." + language;
    if (label.empty())
      advice.add(whole, phrase("the label of \"%1\" is blank", {plain(name)}),
                 phrase("write what the participant reads on the button"));
    else if (!seen.insert(label).second)
      advice.add(whole, phrase("two answers have the label \"%1\"", {plain(label)}),
                 phrase("give each answer a different label"));
  }
}

void check_words(AdviceList& advice) {
  const auto& task = advice.protocol.task;
  const auto number_of = [](std::size_t i) { return std::to_string(i); };
  std::vector<Label> choices, degrees, points;
  for (std::size_t i = 0; !judges(task) && i < task.choices.size(); ++i)
    choices.push_back(
        {key_of(task, "choices.") + number_of(i) + ".label", task.choices[i].id, &task.choices[i].label});
  for (std::size_t i = 0; task.confidence && i < task.confidence->labels.size(); ++i)
    degrees.push_back(
        {key_of(task, "confidence.labels.") + number_of(i), number_of(i + 1), &task.confidence->labels[i]});
  const auto& anchors = task.value ? task.value->anchors : task.anchors;
  for (std::size_t i = 0; i < anchors.size(); ++i)
    points.push_back({key_of(task, "rating.labels.") + number_of(i) + ".text", core::number(anchors[i].at),
                      &anchors[i].text});
  for (const auto& language : advice.protocol.languages) {
    for (const auto* labels : {&choices, &degrees, &points}) check_labels(advice, language, *labels);
    const auto question = task.question.find(language);
    if (question != task.question.end() && trimmed(question->second).empty())
      advice.add(key_of(task, "question.") + language, phrase("the question is blank"),
                 phrase("write what the participant is asked"));
  }
}

void check_ramps(AdviceList& advice) {
  const auto& protocol = advice.protocol;
  for (const auto& part : parts_of(protocol.task)) {
    const double shortest_s = length_range_s(protocol, part).first;
    for (const auto& name : part.scenes) {
      const auto scene = protocol.scenes.find(name);
      const double ramp_ms = scene == protocol.scenes.end() ? 0 : scene->second.ramp_ms;
      if (shortest_s <= 0 || 2e-3 * ramp_ms < shortest_s) continue;
      const bool stated = advice.places.has("scene." + name + ".ramp_ms") && ramp_ms > 500;
      return advice.add(stated                                      ? "scene." + name + ".ramp_ms"
                        : part.duration_s                           ? key_of(protocol.task, "parts")
                        : length_of(protocol.task, part) != nullptr ? key_of(protocol.task, "duration_s")
                                                                    : "timing.explore_s",
                        phrase("the ramps of scene \"%1\" take as long as its tones, %2 s",
                               {plain(name), plain(number(shortest_s))}),
                        phrase("the tones must last longer than both ramps together"));
    }
  }
}

bool same(const std::optional<Linear>& a, const std::optional<Linear>& b) {
  return a && b && a->constant == b->constant && a->terms == b->terms && a->products == b->products &&
         a->absolute == b->absolute;
}

void check_scenes(AdviceList& advice) {
  for (const auto& name : scenes_used(advice.protocol)) {
    const auto& scene = advice.protocol.scenes.at(name);
    const auto key = "scene." + name + ".";
    for (const auto& [displacement, of] :
         {std::pair{&scene.displacement_um, "displacement_um"},
          std::pair{&scene.displacement_under_finger_um, "displacement_under_finger_um"}})
      if (*displacement && bounds(**displacement, advice.protocol.factors).second < least_displacement_um)
        advice.add(key + of, phrase("nobody feels a displacement of %1 um", {plain((*displacement)->source)}),
                   phrase("use about 0.2 to 3 um"));
    for (std::size_t i = 0; i < scene.tones.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const auto &a = scene.tones[i], &b = scene.tones[j];
        if (same(a.frequency_Hz, b.frequency_Hz) ||
            (same(a.boundary_mm, b.boundary_mm) && a.edge.name == b.edge.name &&
             a.edge.friction == b.edge.friction))
          advice.add(key + "tones." + std::to_string(i),
                     phrase("this tone is the same as another tone of the scene"),
                     phrase("use one stronger tone, or place this tone elsewhere"));
      }
  }
}

void check_task(AdviceList& advice) {
  const auto& protocol = advice.protocol;
  const auto& task = protocol.task;
  for (const auto& interval : task.intervals)
    if (interval.size() == 2 && interval[0] == interval[1])
      advice.add(key_of(task, "intervals"),
                 phrase("the scene \"%1\" is followed by itself, so nothing changes", {plain(interval[0])}),
                 phrase("use two different scenes"));
  const auto* slider = find_factor(protocol.factors, task.adjusts);
  if (slider && slider->range && task.step && *task.step >= slider->range->second - slider->range->first)
    advice.add(
        key_of(task, "step"),
        phrase("a step of %1 is as large as the slider's whole range", {plain(number(*task.step))}),
        phrase("use steps well below %1", {plain(number(slider->range->second - slider->range->first))}));
  const auto& plan = protocol.plan;
  for (const auto& part : plan)
    if (task.kind == TaskKind::adjustment && block_of(part).feedback != Feedback::none)
      advice.add(key_of(part, "feedback"), phrase("a setting of the slider is neither right nor wrong"),
                 phrase("set %1", {plain("feedback = \"none\"")}));
}

/// Returns the largest number of trials in a block, including catch trials; empty if the answers decide when
/// the block ends.
std::optional<double> most_trials(const Protocol& protocol, const Block& block) {
  if (block.trials) return *block.trials;
  double trials = static_cast<double>(block.levels.size());
  for (const auto& name : block.procedures) {
    const auto* spec = find_procedure(protocol, name);
    if (!spec) return std::nullopt;
    if (!spec->values.empty())
      trials += static_cast<double>(procedure::list_trials(*spec));
    else if (spec->stop.trials && spec->stop.rule == procedure::StopRule::any)
      trials += *spec->stop.trials;
    else
      return std::nullopt;
  }
  return block.catch_trials ? trials / (1 - block.catch_trials->rate) : trials;
}

void check_counts(AdviceList& advice, const std::variant<Block, Sequence>& part) {
  const auto& block = block_of(part);
  std::size_t levels = block.levels.size();
  const procedure::Spec* constant = nullptr;
  for (const auto& name : block.procedures)
    if (const auto* spec = find_procedure(advice.protocol, name);
        spec && spec->kind == Kind::constant_stimuli)
      levels += spec->values.size(), constant = spec;
  const auto trials = static_cast<std::size_t>(block.trials.value_or(0));
  if (block.trials && trials < levels)
    advice.add(key_of(part, "trials"),
               phrase("the block has %1 levels but only %2 trials, so some levels are never presented",
                      {plain(levels), plain(trials)}),
               phrase("allow at least %1 trials", {plain(levels)}));
  else if (block.trials && constant && block.procedures.size() == 1 && !block.practice &&
           !block.catch_trials && trials < levels * static_cast<std::size_t>(constant->repeats) &&
           trials % levels != 0)
    advice.add(key_of(part, "trials"),
               phrase("%1 trials cannot be divided evenly among %2 levels", {plain(trials), plain(levels)}),
               phrase("use a multiple of %1, or leave out \"trials\"", {plain(levels)}));
  const auto most = most_trials(advice.protocol, block);
  if (block.break_after && most && block.break_after->trials >= *most)
    advice.add(
        key_of(part, "break_after"),
        phrase("there will be no break: the block has only %1 trials", {plain(number(std::floor(*most)))}),
        phrase("have the break after fewer trials"));
}

/// Compares the points of the answer "unsure" with those of a guess, for which it stands in the analysis.
/// People who win by it say it of what they have felt, too, and people who lose by it guess.
void check_unsure_points(AdviceList& advice, const Payoff& payoff) {
  const auto& protocol = advice.protocol;
  const bool stated = advice.places.has("payoff.unsure");
  if (protocol.task.unsure.empty()) {
    if (stated && protocol.task.name.empty())  // another of several tasks may have it
      advice.add("payoff.unsure", phrase("\"unsure\" has no effect: the task has no such answer"),
                 phrase("set \"unsure\" in [task], or leave it out here"));
    return;
  }
  const auto* key = stated                              ? "payoff.unsure"
                    : advice.places.has("payoff.wrong") ? "payoff.wrong"
                                                        : "payoff.right";
  const double p = chance(protocol);
  std::vector<const Linear*> points{&payoff.right, &payoff.wrong, &payoff.unsure};
  if (payoff.fast) points.push_back(&payoff.fast->points);
  for (const auto& factors : corners(points, protocol.factors)) {
    const auto of = [&](const Linear& worth) { return evaluate(worth, factors); };
    const double right = of(payoff.right), wrong = of(payoff.wrong), unsure = of(payoff.unsure);
    const double guess = p * right + (1 - p) * wrong;
    const double fast = guess + p * std::max(0.0, payoff.fast ? of(payoff.fast->points) : 0.0);
    const double rounding = 1e-9 * (std::fabs(right) + std::fabs(wrong) + std::fabs(unsure));
    const bool more = unsure > fast + rounding;
    if (!more && unsure > guess - rounding) continue;
    const auto worth = plain(number(unsure, 3)), of_guess = plain(number(more ? fast : guess, 3));
    return advice.add(
        key,
        more ? phrase("an \"unsure\" answer is worth %1 points, more than a guess (%2 on average): it pays "
                      "to give it although one has felt something",
                      {worth, of_guess})
             : phrase("an \"unsure\" answer is worth %1 points, less than a guess (%2 on average): it pays "
                      "to guess instead",
                      {worth, of_guess}),
        phrase("points for \"unsure\" that a guess wins on average: %1", {of_guess}));
  }
}

/// Compares the points of trials with each other: whether it pays to be right, and to answer at all.
void check_payoff(AdviceList& advice) {
  const auto& protocol = advice.protocol;
  if (!protocol.payoff) return;
  const auto& payoff = *protocol.payoff;
  const auto of = [&](const Linear& points) { return bounds(points, protocol.factors); };
  const auto right = of(payoff.right), wrong = of(payoff.wrong), late = of(payoff.late);
  if (right.second <= wrong.first)
    advice.add("payoff.right", phrase("a right answer is never worth more than a wrong one"),
               phrase("more than %1 points", {plain(number(wrong.first))}));
  const double p = chance(protocol);
  if (const double guess = p * right.second + (1 - p) * wrong.second; late.first > guess)
    advice.add(
        advice.places.has("payoff.late") ? "payoff.late" : "payoff.wrong",
        phrase("a missed deadline is worth %1 points, more than a guess (%2 on average): it pays not to "
               "answer",
               {plain(number(late.first)), plain(number(guess, 3))}),
        phrase("fewer points for \"late\" than for a guess"));
  if (payoff.fast && of(payoff.fast->points).second <= 0)
    advice.add("payoff.fast", phrase("a fast answer is not worth more than a slow one"),
               phrase("points above 0"));
  check_unsure_points(advice, payoff);
}

/// Warns of a block whose procedures may end before its time is up.
void check_lasting(AdviceList& advice, const std::variant<Block, Sequence>& part) {
  const auto& block = block_of(part);
  const auto trials = most_trials(advice.protocol, block);
  if (!block.lasts_s || !trials) return;
  double shortest_s = std::numeric_limits<double>::infinity();
  for (const auto task : tasks_in(advice.protocol, block))
    shortest_s = std::min(shortest_s, quick_trial_s(of_task(advice.protocol, task), shortest_deadline_s));
  if (*trials * shortest_s < *block.lasts_s)
    advice.add(key_of(part, "lasts_s"),
               phrase("the %1 trials of the block can be over before %2 s",
                      {plain(number(std::floor(*trials))), plain(number(*block.lasts_s))}),
               phrase("plan %1 trials or more, such as by \"repeats\" of the procedure",
                      {plain(number(std::ceil(*block.lasts_s / shortest_s)))}));
}

void check_blocks(AdviceList& advice) {
  const auto& protocol = advice.protocol;
  double practice = 0, rest = 0;
  std::string practice_key;
  for (const auto& part : protocol.plan) {
    const auto& block = block_of(part);
    check_counts(advice, part);
    check_lasting(advice, part);
    if (block.kind != BlockKind::trials) continue;
    if (advice.places.has(key_of(part, "interleave")) && block.procedures.size() < 2)
      advice.add(key_of(part, "interleave"),
                 phrase("\"interleave\" has no effect in a block with one procedure"),
                 phrase("use two or more procedures"));
    const auto* sequence = std::get_if<Sequence>(&part);
    if (sequence && sequence->mirror && sequence->cycles < 2)
      advice.add("sequence." + sequence->name + ".mirror",
                 phrase("\"mirror\" has no effect with a single cycle"), phrase("set cycles to 2 or more"));
    for (const auto& name : block.procedures)
      if (const auto* spec = find_procedure(protocol, name);
          sequence && spec &&
          std::find(spec->balance.begin(), spec->balance.end(), sequence->over) != spec->balance.end())
        advice.add(
            key_of(*spec, "balance"),
            phrase("the sequence \"%1\" holds \"%2\" constant in each block, but \"balance\" would change it",
                   {plain(sequence->name), plain(sequence->over)}),
            phrase("remove one of the two"));
    const double trials = most_trials(protocol, block).value_or(1e9);
    (block.practice ? practice : rest) += trials;
    if (block.practice)
      practice_key = key_of(part, advice.places.has(key_of(part, "trials")) ? "trials" : "practice");
  }
  if (practice > 0 && rest == 0)
    advice.add(key_of(protocol.plan.back(), "practice"),
               phrase("all blocks are practice: nothing is measured"),
               phrase("add a block without \"practice\""));
  else if (practice > rest)
    advice.add(practice_key, phrase("there are more practice trials than other trials"),
               phrase("plan fewer practice trials"));
}

/// Finds instructions that no block shows.
void check_shown(AdviceList& advice) {
  const auto blocks = all_blocks(advice.protocol);
  for (const auto& [name, instruction] : advice.protocol.instructions) {
    const auto shows = [&, wanted = FactorValue(name)](const Block& block) {
      const auto fixed = block.fixed.find("instruction");
      return fixed != block.fixed.end() && fixed->second == wanted;
    };
    if (std::none_of(blocks.begin(), blocks.end(), shows))
      advice.add("instructions." + name, phrase("no block shows the instruction \"%1\"", {plain(name)}),
                 phrase("set %1 in a block, or use a sequence over a factor named \"instruction\"",
                        {plain("instruction = \"" + name + "\"")}));
  }
}

/// Compares goals and target accuracies with guessing.
void check_goals(AdviceList& advice) {
  for (const auto& [name, instruction] : advice.protocol.instructions) {
    if (instruction.goal && instruction.goal->accuracy_above.value_or(1) < chance(advice.protocol))
      advice.add("instructions." + name + ".goal", phrase("guessing already reaches this goal"),
                 phrase("above %1", {plain(number(chance(advice.protocol), 3))}));
    const auto& target = instruction.target_accuracy;
    if (target && target->second <= chance(advice.protocol))
      advice.add("instructions." + name + ".target_accuracy",
                 phrase("guessing already reaches this target accuracy"),
                 phrase("between %1 and %2", {plain(number(chance(advice.protocol), 3)), plain("1")}));
  }
}

void check_analysis(AdviceList& advice) {
  const auto& analysis = advice.protocol.analysis;
  const auto moves = [](const auto& term) { return term.second != 0; };
  if (analysis.difficulty && analysis.difficulty->products.empty() &&
      std::none_of(analysis.difficulty->terms.begin(), analysis.difficulty->terms.end(), moves))
    advice.add("analysis.difficulty", phrase("\"difficulty\" is the same in all trials"),
               phrase("write arithmetic that depends on a factor"));
  std::set<std::string> seen;
  for (const auto& word : analysis.show.value_or(std::vector<std::string>{}))
    if (!seen.insert(word).second)
      advice.add("analysis.show", phrase("\"%1\" appears twice in \"%2\"", {plain(word), plain("show")}),
                 phrase("list each only once"));
}

}  // namespace

void advise_on_plan(AdviceList& advice) {
  const auto& protocol = advice.protocol;
  const bool is_task = protocol.by_task.empty(), is_whole = !is_task || protocol.task.name.empty();
  if (is_task) check_words(advice), check_ramps(advice);
  if (is_whole) check_scenes(advice);
  if (is_task) check_task(advice);
  if (is_whole) check_blocks(advice), check_shown(advice);
  if (is_task) check_goals(advice), check_payoff(advice);
  if (is_whole) check_analysis(advice);
}

namespace {

constexpr std::size_t most_repeats = 10000;  // largest number of repeats that a protocol may ask for
// Larger numbers of combinations are reduced to this one. Otherwise the product for a hundred factors with
// many levels would overflow.
constexpr std::size_t most_cells = 1'000'000'000'000;

/// Reports a procedure whose `repeats` cannot be spread evenly over `cells` combinations of factors; `what`
/// describes these combinations.
void note_uneven(AdviceList& notes, const procedure::Spec& spec, std::size_t cells,
                 const core::Phrase& cell_names) {
  const auto repeats = static_cast<std::size_t>(spec.repeats), least = repeats / cells;
  if (repeats % cells == 0) return;
  const auto even = (least + 1) * cells;
  notes.add(key_of(spec, "balance"),
            phrase("each level is combined with each of the %1 %2 %3 or %4 times",
                   {plain(cells), cell_names, plain(least), plain(least + 1)}),
            even > most_repeats ? phrase("use fewer factors or fewer levels")
                                : phrase("for equal counts, set repeats = %1", {plain(even)}));
}

/// The first factor that decides the right answer and sets the pause after the trial; empty if there is none.
std::optional<std::string> telling_pause(const Protocol& protocol) {
  if (!protocol.timing.iti_s.expression) return std::nullopt;
  const auto pause = factors_in(*protocol.timing.iti_s.expression);
  for (const auto& name : deciding_factors(protocol.task))
    if (std::find(pause.begin(), pause.end(), name) != pause.end()) return name;
  return std::nullopt;
}

}  // namespace

std::vector<Problem> notes(const Protocol& protocol) {
  std::vector<Problem> of_tasks;
  for (const auto& one : protocol.by_task)
    for (auto& note : notes(one)) add_once(std::move(note), of_tasks);
  if (!protocol.by_task.empty()) return of_tasks;
  AdviceList notes(protocol);
  for (const auto& spec : protocol.procedures) {
    std::size_t crossed = 1;
    std::string all;
    for (const auto& name : spec.balance) {
      const auto levels = find_factor(protocol.factors, name)->levels.size();
      note_uneven(notes, spec, levels, phrase("values of \"%1\"", {plain(name)}));
      crossed = std::min(crossed * levels, most_cells);
      if (name != spec.balance.back()) all += (all.empty() ? "\"" : ", \"") + name + "\"";
    }
    if (spec.balance.size() > 1)
      note_uneven(notes, spec, crossed,
                  phrase("combinations of %1 and \"%2\"", {plain(all), plain(spec.balance.back())}));
    std::map<double, int> times;
    for (const double value : spec.values) ++times[value];
    for (const auto& [value, listed] : times) {
      if (listed > 1)
        notes.add(levels_key(spec),
                  listed == 2
                      ? phrase("the level %1 is listed twice, so it is presented twice as often",
                               {plain(number(value))})
                      : phrase("the level %1 is listed %2 times, so it is presented %3 times as often",
                               {plain(number(value)), plain(listed), plain(listed)}));
    }
  }
  if (const auto name = telling_pause(protocol))
    notes.add(
        "timing.iti_s",
        phrase("the pause after a trial depends on \"%1\", which decides the right answer: it is a feedback",
               {plain(*name)}));
  if (protocol.timing.iti_s.high == 0) notes.add("timing.iti_s", phrase("there is no pause between trials"));
  if (const auto& gap_s = protocol.task.gap_s; gap_s && bounds(*gap_s, protocol.factors).second == 0)
    notes.add(key_of(protocol.task, "gap_s"), phrase("there is no pause between the intervals of a trial"));
  if (protocol.task.foreperiod_s && protocol.task.foreperiod_s->high == 0)
    notes.add(key_of(protocol.task, "foreperiod_s"),
              phrase("the second scene begins at once, without a foreperiod"));
  return std::move(notes.found);
}

}  // namespace turnpoint::protocol

#include "station/session/pages.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "station/core/number.hpp"
#include "station/core/texts.hpp"
#include "station/procedure/procedure.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/interludes.hpp"
#include "station/protocol/tasks.hpp"
#include "station/scene/planner.hpp"
#include "station/trial/timing.hpp"

namespace turnpoint::session {

namespace {

using trial::Phase;

/// Returns the position of the mark to which the trial's question refers: the value of the factor `mark_mm`.
std::optional<double> mark_of(const trial::TrialSpec& spec) {
  const auto found = spec.factors.find("mark_mm");
  if (found == spec.factors.end()) return std::nullopt;
  const auto* value = std::get_if<double>(&found->second);
  return value ? std::optional(*value) : std::nullopt;
}

std::string instruction_of(const protocol::Block& block) {
  const auto found = block.fixed.find("instruction");
  if (found == block.fixed.end()) return "";
  const auto* name = std::get_if<std::string>(&found->second);
  return name ? *name : "";
}

PageKind kind_of(Phase phase) {
  switch (phase) {
    case Phase::cue:
      return PageKind::cue;
    case Phase::stimulus:
      return PageKind::stimulus;
    case Phase::gap:
      return PageKind::pause;
    case Phase::response:
      return PageKind::response;
    case Phase::confidence:
      return PageKind::confidence;
    case Phase::feedback:
    case Phase::late:
      return PageKind::feedback;
    default:
      return PageKind::interval;
  }
}

/// The letters by which the questions of ABX and match-to-sample tasks refer to the intervals. They are the
/// same in every language.
std::vector<std::string> interval_names(protocol::TaskKind kind) {
  if (kind == protocol::TaskKind::abx) return {"A", "B", "X"};
  if (kind == protocol::TaskKind::match_to_sample) return {"X", "A", "B"};
  return {};
}

/// Keeps the order of a number's parts in a text that is written from right to left.
std::string isolated(const std::string& number) { return "\u2068" + number + "\u2069"; }

/// A number with the decimal sign of the language, as on the page where numbers are typed.
std::string written(std::string number, const std::string& language) {
  static const std::set<std::string> comma{"az", "be", "bg", "bs", "ca", "cs", "da", "de", "el", "es", "et",
                                           "eu", "fi", "fr", "gl", "hr", "hu", "hy", "id", "is", "it", "ka",
                                           "kk", "lt", "lv", "mk", "mn", "nb", "nl", "nn", "no", "pl", "pt",
                                           "ro", "ru", "sk", "sl", "sq", "sr", "sv", "tr", "uk", "uz", "vi"};
  static const std::set<std::string> point{"de-CH", "de-LI", "es-MX", "es-US"};
  const auto code = language.substr(0, language.find('-'));
  const std::string sign = code == "ar" || code == "fa"                        ? "\u066B"
                           : comma.contains(code) && !point.contains(language) ? ","
                                                                               : ".";
  if (const auto at = number.find('.'); at != std::string::npos) number.replace(at, 1, sign);
  return number;
}

/// What points are worth, as pages write it.
std::string amount(double points, const protocol::Payoff& payoff, const std::string& language) {
  const auto number = fmt::format("{:.{}f}", std::fabs(points * payoff.worth), payoff.decimals);
  const bool negative = points < 0 && number.find_first_not_of("0.") != std::string::npos;
  return (negative ? "\u2212" : "") + written(number, language);
}

std::string in_words(const protocol::Goal& goal, const std::string& language) {
  std::string words;
  const auto add = [&](const char* key, double value) {
    words += (words.empty() ? "" : "\n") +
             core::say(core::phrase(key, {core::plain(written(core::number(value, 4), language))}), language);
  };
  if (goal.accuracy_above) add("goal_right", 100 * *goal.accuracy_above);
  if (goal.median_time_below_s) add("goal_time", *goal.median_time_below_s);
  return words;
}

}  // namespace

Pages::Pages(const Setup& setup) : setup_(setup) {}

std::string Pages::text(const protocol::Localised& localised) const {
  const auto found = localised.find(setup_.language);
  if (found != localised.end()) return found->second;
  return localised.empty() ? "" : localised.begin()->second;
}

Page Pages::blank(PageKind kind, const protocol::Block* block, const trial::Director* director) const {
  Page page;
  page.offers_again = std::ranges::any_of(protocol::tasks_of(setup_.protocol),
                                          [](const auto* seen) { return seen->task.again > 0; });
  page.kind = kind;
  page.language = setup_.language;
  page.run_mode = store::name(setup_.run_mode);
  page.surface = rig::outline_of(setup_.rig);
  if (block != nullptr) page.instruction = instruction_of(*block);
  if (director != nullptr) {
    page.trials_done = director->trials_done();
    page.trials_total = director->trials_expected();
  }
  return page;
}

Page Pages::instructions(const protocol::Block& block, const trial::Director& director) const {
  auto page = blank(PageKind::instructions, &block, &director);
  page.title = core::text(block.practice ? "practice" : "get_ready", setup_.language);
  const auto found = setup_.protocol.instructions.find(page.instruction);
  if (found != setup_.protocol.instructions.end()) page.text = text(found->second.text);
  if (block.kind != protocol::BlockKind::trials) {
    const bool training = block.kind == protocol::BlockKind::training;
    page.title = core::text(training ? "training" : "measuring", setup_.language);
    page.text = core::text(training ? "training_text" : "measuring_text", setup_.language);
    return page;
  }
  for (const auto task : protocol::tasks_in(setup_.protocol, block))
    page.text += (page.text.empty() ? "" : "\n\n") + question_in(task, nullptr);
  if (const auto* goal = goal_of(block)) page.text += "\n\n" + in_words(*goal, setup_.language);
  return page;
}

/// The question of a task in a trial; without one, an ellipsis stands for the value that it shows.
std::string Pages::question_in(std::size_t of_task, const trial::TrialSpec* spec) const {
  const auto& task = protocol::of_task(setup_.protocol, of_task).task;
  auto question = text(task.question);
  if (task.question_shows.empty()) return question;
  std::string value = "\u2026";
  if (const auto found = spec ? spec->factors.find(task.question_shows) : protocol::Factors::const_iterator();
      spec && found != spec->factors.end()) {
    const auto* number = std::get_if<double>(&found->second);
    value = number ? written(core::number(*number), setup_.language) : std::get<std::string>(found->second);
  }
  for (auto at = question.find("%1"); at != std::string::npos; at = question.find("%1", at + value.size()))
    question.replace(at, 2, value);
  return question;
}

/// The goal of a block; null if it has none.
const protocol::Goal* Pages::goal_of(const protocol::Block& block) const {
  const auto found = setup_.protocol.instructions.find(instruction_of(block));
  return found != setup_.protocol.instructions.end() && found->second.goal ? &*found->second.goal : nullptr;
}

std::string Pages::score_in_words(double points) const {
  const auto& payoff = *setup_.protocol.payoff;
  const auto worth = core::plain(amount(points, payoff, setup_.language));
  if (payoff.text.empty()) return core::say(core::phrase("points", {worth}), setup_.language);
  return core::say(core::phrase(text(payoff.text), {worth}), setup_.language);
}

void Pages::add_points(Page& page, double points, std::optional<double> score) const {
  page.text += "  " + isolated(std::string(points > 0 ? "+" : "") +
                               amount(points, *setup_.protocol.payoff, setup_.language));
  if (score) page.text += "\n" + score_in_words(*score);
}

std::optional<Page> Pages::block_over(const protocol::Block& block, const BlockScore& score, double points,
                                      const trial::Director& director) const {
  const auto* goal = goal_of(block);
  if (block.kind != protocol::BlockKind::trials || score.trials == 0 ||
      (goal == nullptr && block.feedback != protocol::Feedback::block))
    return std::nullopt;
  auto page = blank(PageKind::instructions, &block, &director);
  page.title = core::text("block_over", setup_.language);
  page.instruction.clear();
  page.surface = {};  // the page shows no surface
  const auto accuracy = score.accuracy(), time_s = score.median_time_s();
  const auto line = [&](const char* key, std::vector<core::Phrase> values = {}) {
    page.text +=
        (page.text.empty() ? "" : "\n") + core::say(core::phrase(key, std::move(values)), setup_.language);
  };
  line("block_right", {core::plain(core::number(std::round(100 * *accuracy)))});
  if (time_s) line("block_time", {core::plain(written(fmt::format("{:.2f}", *time_s), setup_.language))});
  if (goal != nullptr) {
    const bool met = (!goal->accuracy_above || *accuracy > *goal->accuracy_above) &&
                     (!goal->median_time_below_s || (time_s && *time_s < *goal->median_time_below_s));
    page.text += "\n" + in_words(*goal, setup_.language);
    line(met ? "goal_met" : "goal_missed");
  }
  if (setup_.protocol.payoff && !block.practice) page.text += "\n" + score_in_words(points);
  return page;
}

void Pages::add_mark(Page& page, const trial::TrialSpec& first) const { page.mark_mm = mark_of(first); }

Page Pages::of_phase(Phase phase, int part, const trial::TrialSpec& spec, const protocol::Block& block,
                     const trial::Result& result, const trial::Director& director) const {
  const auto parts = trial::parts_of(setup_.protocol, spec);
  const auto at = static_cast<std::size_t>(part);
  const int interval = parts.at(at).interval;
  const bool last = at + 1 == parts.size();
  const bool within = phase == Phase::gap && !last && parts[at + 1].interval == interval;
  auto page = blank(kind_of(within ? Phase::stimulus : phase), &block, &director);
  const auto& task = protocol::of_task(setup_.protocol, spec.task).task;
  const bool explored = task.kind == protocol::TaskKind::single_interval && protocol::explored(task);
  if (spec.strokes) {
    const bool hush = phase == Phase::interval;
    page.text = hush ? "" : core::text("stroke_now", setup_.language);
    page.correct = result.correct;
    return page;
  }
  page.mark_mm = mark_of(spec);
  page.interval = {interval + 1, static_cast<int>(spec.intervals.size()), interval_names(task.kind)};
  page.text = question_in(spec.task, &spec);
  if (phase == Phase::cue) page.cue = text(task.cue);
  page.answers_open = phase == Phase::response || (phase == Phase::stimulus && explored && last);
  for (const auto& choice : task.choices)
    page.answers.push_back({choice.id, task.rating ? choice.id : text(choice.label)});
  if (!task.unsure.empty()) page.answers.push_back({protocol::kUnsure, text(task.unsure)});
  for (const auto& anchor : task.anchors)
    page.answers.at(static_cast<std::size_t>(anchor.at) - 1).caption = text(anchor.text);
  if (task.value && page.answers_open) add_value(page, *task.value);
  if (task.value && page.answers_open && task.modulus) {
    page.value.first = core::text("first_is", setup_.language);
    page.value.first.replace(page.value.first.find("%1"), 2,
                             written(core::number(*task.modulus), setup_.language));
  }
  if (phase == Phase::confidence) {
    page.text = text(task.confidence->question);
    page.answers_open = true;
    page.answers.clear();
    for (const auto& label : task.confidence->labels)
      page.answers.push_back({std::to_string(page.answers.size() + 1), text(label)});
  }
  if (phase == Phase::feedback) {
    page.correct = result.correct;
    page.text = result.correct ? core::text(*result.correct ? "right" : "wrong", setup_.language) : "";
  }
  if (phase == Phase::late) {
    const bool early = result.outcome == core::Outcome::anticipation;
    page.text = core::text(early ? "too_early" : "too_late", setup_.language);
    const auto found = setup_.protocol.instructions.find(page.instruction);
    if (!early && found != setup_.protocol.instructions.end() && !found->second.late_message.empty())
      page.text = text(found->second.late_message);
  }
  return page;
}

std::string Pages::movement(const std::string& word) const {
  static const std::map<std::string, const char*> keys{
      {"ok", "movement_ok"},     {"strokes", "movement_strokes"}, {"light", "movement_light"},
      {"hard", "movement_hard"}, {"slow", "movement_slow"},       {"fast", "movement_fast"}};
  return core::text(keys.at(word), setup_.language);
}

void Pages::add_value(Page& page, const protocol::ValueAnswer& value) const {
  page.kind = value.typed ? PageKind::number : PageKind::line;
  page.answers.clear();
  page.value = {value.low, value.high, value.decimals, {}, {}, ""};
  for (const auto& anchor : value.anchors) {
    page.value.places.push_back((anchor.at - value.low) / (value.high - value.low));
    page.value.texts.push_back(text(anchor.text));
  }
}

Page Pages::question(const protocol::Item& item, const trial::Director& director) const {
  auto page = blank(PageKind::question, nullptr, &director);
  page.text = text(item.question);
  page.answers_open = true;
  for (const auto& choice : item.choices)
    page.answers.push_back({choice.id, item.rating ? choice.id : text(choice.label)});
  for (const auto& anchor : item.anchors)
    page.answers.at(static_cast<std::size_t>(anchor.at) - 1).caption = text(anchor.text);
  if (item.value) add_value(page, *item.value);
  return page;
}

Page Pages::explanation(const protocol::ExplanationPage& explanation, const trial::Director& director) const {
  auto page = blank(PageKind::explanation, nullptr, &director);
  page.text = text(explanation.text);
  if (!explanation.picture.empty())
    page.picture = protocol::picture_path(setup_.protocol, explanation.picture);
  for (const auto& example : explanation.examples)
    page.answers.push_back({example.scene, text(example.label)});
  return page;
}

Page Pages::farewell(const protocol::Localised& words, const trial::Director& director) const {
  auto page = blank(PageKind::explanation, nullptr, &director);
  page.text = text(words);
  return page;
}

void Pages::add_slider(Page& page, const trial::SliderSpan& span, double setting, bool moved) const {
  page.kind = PageKind::adjust;
  page.answers.clear();
  page.slider = {setting, span.shown_low, span.shown_high, span.step, moved};
}

Page Pages::between_trials(const protocol::Block* block, const trial::Director& director) const {
  return blank(PageKind::interval, block, &director);
}

Page Pages::rest(const protocol::Block& block, double min_s, const trial::Director& director) const {
  auto page = blank(PageKind::rest, &block, &director);
  page.title = core::text("rest", setup_.language);
  page.text = core::text("rest_text", setup_.language);
  page.remaining_s = min_s;
  return page;
}

Page Pages::practice_again(const protocol::Block& block, const trial::Director& director) const {
  auto page = instructions(block, director);
  page.title = core::text("practice_again", setup_.language);
  return page;
}

Page Pages::fault(const Fault& fault, const trial::Director& director) const {
  auto page = blank(PageKind::fault, nullptr, &director);
  const auto text = core::fault_text(fault.kind, setup_.language);
  page.title = core::text("please_wait", setup_.language);
  page.fault = fault;
  page.text = text.happened;
  page.safe = text.safe;
  page.to_do = text.to_do;
  return page;
}

Page Pages::paused(const trial::Director& director) const {
  auto page = blank(PageKind::paused, nullptr, &director);
  page.title = core::text("paused", setup_.language);
  return page;
}

Page Pages::end(const Summary& summary, const trial::Director& director) const {
  auto page = blank(PageKind::end, nullptr, &director);
  const bool whole = summary.status == core::SessionStatus::completed;
  page.title = core::text(whole ? "thanks" : "thanks_early", setup_.language);
  page.resumable = summary.status == core::SessionStatus::interrupted;
  // at the end the exact total is known; with adaptive procedures it was an estimate before
  if (whole) page.trials_total = page.trials_done;
  if (summary.points) {
    page.text = core::text(page.resumable ? "stopped_text" : "thanks_text", setup_.language) + "\n\n" +
                score_in_words(*summary.points);
  }
  const auto add = [&page](const char* key, const std::string& value) {
    page.summary.push_back({{key, "", {}}, value});
  };
  add("operator.trials", std::to_string(summary.trials));
  add("report.too_late", std::to_string(summary.timeouts));
  add("report.too_early", std::to_string(summary.anticipations));
  add("report.void", std::to_string(summary.voided));
  if (summary.accuracy) add("report.right", core::number(100 * *summary.accuracy, 3) + " %");
  if (summary.points) add("report.score", core::number(*summary.points, 6));
  for (const auto& e : summary.estimates)
    page.summary.push_back({{"", e.procedure + ", ", {procedure::parameter_name(e.parameter)}}, in_words(e)});
  for (const auto& end : summary.early_ends) add("report.ended_early", core::say(end, setup_.language));
  return page;
}

}  // namespace turnpoint::session

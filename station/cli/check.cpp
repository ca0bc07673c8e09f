#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/long_work.hpp"
#include "station/cli/shared_options.hpp"
#include "station/cli/sound.hpp"
#include "station/core/number.hpp"
#include "station/protocol/combinations.hpp"
#include "station/protocol/interludes.hpp"
#include "station/protocol/triggers.hpp"
#include "station/rehearsal/check.hpp"
#include "station/session/places.hpp"
#include "station/session/prepare.hpp"
#include "station/session/programs.hpp"
#include "station/system/fonts.hpp"

namespace turnpoint::cli {

namespace check_command {

using core::number;

struct Options {
  std::string protocol, rig, calibration;
  std::optional<int> sessions;
  bool progress = false;
};

Json problems_json(const std::vector<core::Problem>& problems) {
  Json list = Json::array();
  for (const auto& problem : problems)
    list.push_back({{"file", problem.place.file},
                    {"line", problem.place.line > 0 ? Json(problem.place.line) : Json(nullptr)},
                    {"column", problem.place.line > 0 ? Json(problem.place.column) : Json(nullptr)},
                    {"what", core::say(problem.what, "en")},
                    {"allowed", core::say(problem.allowed, "en")}});
  return list;
}

Json spread_json(const rehearsal::Spread& spread) {
  return {{"low", json_number(spread.low)},
          {"median", json_number(spread.median)},
          {"high", json_number(spread.high)},
          {"error", json_number(spread.error)}};
}

Json scenes_json(const protocol::Survey& survey) {
  Json list = Json::array();
  for (const auto& sight : survey.sights) {
    Json factors = Json::object();
    for (const auto& [name, value] : sight.factors)
      std::visit([&factors, &name = name](const auto& v) { factors[name] = v; }, value);
    list.push_back({{"scene", sight.scene},
                    {"block", sight.block},
                    {"factors", factors},
                    {"lowest_Hz", json_number(sight.lowest_Hz)},
                    {"highest_Hz", json_number(sight.highest_Hz)},
                    {"boundary_mm", json_number(sight.boundary_mm)},
                    {"displacement_um", json_number(sight.displacement_um)},
                    {"lowest_friction", json_number(sight.lowest_friction)},
                    {"model", sight.model},
                    {"error_bound_mm", json_number(sight.error_bound_mm)},
                    {"uncertainty_mm", json_number(sight.uncertainty_mm)},
                    {"inside_tolerance", sight.inside_tolerance}});
  }
  return list;
}

struct Extremes {
  double lowest_Hz = 0, highest_Hz = 0, displacement_um = 0, error_bound_mm = 0, uncertainty_mm = 0;
};

Extremes extremes_of(const protocol::Survey& survey) {
  Extremes found;
  for (const auto& sight : survey.sights) {
    found.lowest_Hz = found.lowest_Hz == 0 ? sight.lowest_Hz : std::min(found.lowest_Hz, sight.lowest_Hz);
    found.highest_Hz = std::max(found.highest_Hz, sight.highest_Hz);
    found.displacement_um = std::max(found.displacement_um, sight.displacement_um);
    found.error_bound_mm = std::max(found.error_bound_mm, sight.error_bound_mm);
    found.uncertainty_mm = std::max(found.uncertainty_mm, sight.uncertainty_mm);
  }
  return found;
}

Json to_json(const rehearsal::Check& check, const std::string& signal) {
  Json blocks = Json::array(), cues = Json::array(), triggers = Json::array();
  for (const auto& code : check.triggers)
    triggers.push_back({{"event", protocol::name(code.event)},
                        {"condition", code.condition.empty() ? Json(nullptr) : Json(code.condition)},
                        {"code", code.code}});
  for (const auto& block : check.blocks)
    blocks.push_back({{"visit", block.visit.empty() ? Json(nullptr) : Json(block.visit)},
                      {"name", block.name},
                      {"instruction", block.instruction.empty() ? Json(nullptr) : Json(block.instruction)},
                      {"practice", block.practice},
                      {"trials", spread_json(block.trials)},
                      {"duration_s", spread_json(block.duration_s)}});
  for (const auto& cue : check.cues.reports)
    cues.push_back({{"cue", cue.cue},
                    {"task", cue.task.empty() ? Json(nullptr) : Json(cue.task)},
                    {"low", json_number(cue.low)},
                    {"high", json_number(cue.high)},
                    {"unit", cue.unit},
                    {"accuracy", json_number(cue.accuracy)},
                    {"chance", json_number(cue.chance)},
                    {"accuracy_error", json_number(cue.error)},
                    {"above_chance", cue.above_chance()}});
  Json runs = Json::array();
  for (const auto& of : check.runs)
    runs.push_back({{"of", of.of},
                    {"limit", of.limit},
                    {"longest", of.longest},
                    {"sessions", of.sessions},
                    {"sessions_with_longer", of.longer},
                    {"share_low", json_number(of.share_longer.low)},
                    {"share_high", json_number(of.share_longer.high)}});
  const auto extremes = extremes_of(check.survey);
  const bool planned = !check.survey.sights.empty();
  return {
      {"problems", problems_json(check.problems)},
      {"warnings", problems_json(check.warnings)},
      {"notes", problems_json(check.notes)},
      {"id", check.id},
      {"measures", check.measures},
      {"rig", check.rig_name},
      {"trials", json_number(check.trials.median)},
      {"trials_range", {json_number(check.trials.low), json_number(check.trials.high)}},
      {"duration_s", json_number(check.duration_s.median)},
      {"duration_range_s", {json_number(check.duration_s.low), json_number(check.duration_s.high)}},
      {"trials_error", json_number(check.trials.error)},
      {"duration_error_s", json_number(check.duration_s.error)},
      {"longest_trial_again_s",
       check.longest_trial_again_s ? json_number(*check.longest_trial_again_s) : Json(nullptr)},
      {"longest_session_again_s",
       check.longest_session_again_s ? json_number(*check.longest_session_again_s) : Json(nullptr)},
      {"simulated_sessions", check.simulated_sessions},
      {"wanted_sessions", check.wanted_sessions},
      {"stopped", signal.empty() ? Json(nullptr) : Json(signal)},
      {"blocks", blocks},
      {"different_places", check.different_places},
      {"dropout_after_h", json_number(check.dropout_after_h)},
      {"runs", runs},
      {"frequencies",
       {{"lowest_Hz", planned ? json_number(extremes.lowest_Hz) : Json(nullptr)},
        {"highest_Hz", planned ? json_number(extremes.highest_Hz) : Json(nullptr)}}},
      {"displacement_um", planned ? json_number(extremes.displacement_um) : Json(nullptr)},
      {"share_under_finger", check.finger
                                 ? Json{json_number(check.finger->least), json_number(check.finger->most)}
                                 : Json(nullptr)},
      {"level_uncertainty_dB", json_number(check.finger ? check.finger->level_sd_dB : std::nullopt)},
      {"sound", json_sound(check.sound)},
      {"models", check.survey.models},
      {"combinations", check.survey.combinations},
      {"scenes", scenes_json(check.survey)},
      {"triggers", triggers},
      {"cues", cues},
      {"cues_not_compared", check.cues.not_compared.empty() ? Json(nullptr) : Json(check.cues.not_compared)},
      {"defaults", {{"protocol", check.protocol_defaults}, {"rig", check.rig_defaults}}}};
}

std::string range(const rehearsal::Spread& spread, double unit) {
  const auto shown = [&](double value) { return number(std::round(value / unit * 10) / 10, 4); };
  const auto low = shown(spread.low), median = shown(spread.median), high = shown(spread.high);
  return low == high ? median : median + " (" + low + " to " + high + ")";
}

long percent(double share) { return std::lround(100 * share); }

std::string between(double least, double most) {
  return percent(least) == percent(most) ? fmt::format("{}", percent(most))
                                         : fmt::format("{} to {}", percent(least), percent(most));
}

void print_cues(std::ostream& out, const rehearsal::CueGuard& cues) {
  if (cues.stopped)
    fmt::print(out,
               "Cues: stopped after {} of them; it is not known whether the others give the answer away\n",
               cues.reports.size());
  if (cues.stopped && cues.reports.empty()) return;
  if (!cues.not_compared.empty())
    fmt::print(out, "Cues: NOT COMPARED ({}): it is not known whether unwanted cues give the answer away\n",
               cues.not_compared);
  if (!cues.nothing_to_tell.empty())
    fmt::print(out, "Cues: there are none to compare: {}\n", cues.nothing_to_tell);
  if (cues.reports.empty()) return;
  std::string named;
  double least = 1, most = 0;
  for (const auto& cue : cues.reports) {
    least = std::min(least, cue.chance), most = std::max(most, cue.chance);
    if (!cue.above_chance()) continue;
    named += fmt::format("\n  {}{}: {} % right{} (chance {} %)", cue.task.empty() ? "" : cue.task + ", ",
                         cue.cue, percent(cue.accuracy),
                         cue.error > 0 ? fmt::format(" +- {} %", number(100 * cue.error, 2)) : "",
                         percent(cue.chance));
    if (!cue.unit.empty())
      named += fmt::format(", {} to {} {}", number(cue.low, 3), number(cue.high, 3), cue.unit);
  }
  if (!named.empty())
    return fmt::print(
        out,
        "Cues: an observer who uses only one of these cues, with the best rule, does better than chance:{}\n",
        named);
  fmt::print(out,
             "Cues: an observer who uses only one cue stays near chance ({} %), for each of the {} cues\n",
             between(least, most), cues.reports.size());
}

/// The parts of a session without trials, in the order in which they come.
void print(std::ostream& out, const std::vector<rehearsal::CheckedInterlude>& parts,
           const std::string& visit) {
  for (const auto& part : parts) {
    using Kind = protocol::InterludeKind;
    const auto count = [&](const char* one) {
      return fmt::format(": {} {}{}", part.pages, one, part.pages == 1 ? "" : "s");
    };
    fmt::print(out, "  {}{} {}{}\n", visit, protocol::name(part.kind), part.name,
               part.kind == Kind::questionnaire ? count("question")
               : part.kind == Kind::explanation ? count("page")
                                                : "");
  }
}

void print(std::ostream& out, const rehearsal::Check& check, const std::string& path) {
  const bool known = check.cues.not_compared.empty() && !check.cues.stopped;
  fmt::print(out, "{} {} on \"{}\": {}\n", path, known ? "is good" : "can run", check.rig_name, check.title);
  for (const auto& line : check.measures) fmt::print(out, "Measures in {}\n", line);
  for (const auto& block : check.blocks) {
    const auto visit = block.visit.empty() ? "" : block.visit + ": ";
    print(out, block.before, visit);
    fmt::print(out, "  {}{}{}{}: {} trials, {} minutes\n", visit,
               block.practice ? "practice block " : "block ", block.name,
               block.instruction.empty() ? "" : " (" + block.instruction + ")", range(block.trials, 1),
               range(block.duration_s, 60));
    print(out, block.after, visit);
  }
  if (check.simulated_sessions > 0)
    fmt::print(
        out,
        "{}Trials: {}. Duration: {} minutes, with the time that a person needs to read, explore and set. "
        "Medians of {}{} simulated sessions; in brackets the range of nine sessions in ten; with other "
        "sessions, "
        "these numbers would differ by up to {} trials and {} minutes\n",
        check.blocks.empty() || check.blocks.front().visit.empty() ? "" : "The longest session: ",
        range(check.trials, 1), range(check.duration_s, 60), check.simulated_sessions,
        check.simulated_sessions < check.wanted_sessions ? fmt::format(" of {}", check.wanted_sessions) : "",
        number(check.trials.error, 2), number(check.duration_s.error / 60, 2));
  if (check.longest_session_again_s)
    fmt::print(
        out,
        "If people ask for every trial as often as \"again\" allows: up to {} s for a trial and {} minutes "
        "for the session, without the pauses that the rig's limits may add\n",
        number(*check.longest_trial_again_s, 3), number(*check.longest_session_again_s / 60, 2));
  if (check.different_places > 1)
    fmt::print(
        out, "Places in the counterbalancing: {} different ones; {}\n", check.different_places,
        check.dropout_after_h
            ? fmt::format("a participant who has not completed is replaced {} h after the last session",
                          number(*check.dropout_after_h))
            : std::string("a participant who drops out is not replaced (no [assignment])"));
  for (const auto& of : check.runs)
    fmt::print(
        out,
        "Runs: at most {} trials in a row have {} in {} of {} simulated sessions in which one answer of ten "
        "is "
        "missing; in {} to {} % of all sessions a run is longer (95 %)\n",
        of.limit,
        of.of == procedure::kRightAnswer ? "the same right answer" : fmt::format("the same \"{}\"", of.of),
        of.sessions - of.longer, of.sessions, number(100 * of.share_longer.low, 2),
        number(100 * of.share_longer.high, 2));
  const auto extremes = extremes_of(check.survey);
  std::string models;
  for (const auto& model : check.survey.models) models += (models.empty() ? "" : ", ") + model;
  fmt::print(
      out,
      "Tones: {} to {} kHz; the surface moves at most {} um; models: {} ({} of {} combinations planned)\n",
      number(1e-3 * extremes.lowest_Hz, 4), number(1e-3 * extremes.highest_Hz, 4),
      number(extremes.displacement_um, 3), models, check.survey.sights.size(), check.survey.combinations);
  if (check.finger)
    fmt::print(out,
               "Finger: it leaves {} % of the displacement at the last maxima of the lowest and the highest "
               "tone; {}\n",
               between(check.finger->least, check.finger->most),
               check.finger->level_sd_dB
                   ? fmt::format("the level there is uncertain by {} dB (one standard deviation)",
                                 number(*check.finger->level_sd_dB, 2))
                   : std::string("how uncertain the level there is, the rig file does not say"));
  fmt::print(out, "Boundaries: model error at most {} mm, {}\n", number(extremes.error_bound_mm, 2),
             uncertainty_in_words(1e-3 * extremes.uncertainty_mm));
  fmt::print(out, "Sound: {}\n",
             check.stopped && !check.sound ? "stopped before it was computed" : in_words(check.sound));
  if (!check.triggers.empty()) fmt::print(out, "Trigger codes:");
  for (const auto& code : check.triggers)
    fmt::print(out, "{} {}{} = {}", code.code == check.triggers.front().code ? "" : ",",
               protocol::name(code.event), code.condition.empty() ? "" : " (" + code.condition + ")",
               code.code);
  if (!check.triggers.empty()) fmt::print(out, "\n");
  print_cues(out, check.cues);
  if (!check.protocol_defaults.empty()) fmt::print(out, "Defaults used:\n");
  for (const auto& line : check.protocol_defaults) fmt::print(out, "  {}\n", line);
  for (const auto& line : check.rig_defaults) fmt::print(out, "  rig: {}\n", line);
}

void check(const Options& options, Context& context) {
  const auto rig = session::rig_or_default(options.rig, context.err);
  std::optional<rig::Rig> calibrated;
  const auto load_rig = [&](const std::string& path) {
    calibrated = session::calibrated_rig(path, options.calibration, context.err);
    return *calibrated;
  };
  LongWork work(options.progress);
  rehearsal::CheckOptions wanted{options.sessions, true, true, load_rig, system::drawable};
  wanted.steps.finish = work.stop();
  wanted.try_programs = session::problems_of;
  wanted.steps.progress = [&work](const char* what, int done, int of) { work.show(what, done, of); };
  rehearsal::Check result;
  try {
    result = rehearsal::check(options.protocol, rig, wanted);
  } catch (const protocol::Abandoned&) {
    fmt::print(context.err, "turnpoint: stopped by {} while the scenes were planned; nothing was computed\n",
               work.end(context));
    return;
  }
  const auto signal = work.end(context);
  if (result.problems.empty())
    for (const auto& name : rig::unproven_transducers(calibrated.value()))
      result.notes.push_back({{rig, 0, 0},
                              core::plain("no pick-up is calibrated for the transducer \"" + name +
                                          "\", so its stimuli will be unproven"),
                              core::plain("add [[pickup]] to the calibration")});
  if (!result.problems.empty()) context.exit_code = 2;
  for (const auto& problem : result.problems) fmt::print(context.err, "{}\n", format(problem));
  for (const auto& warning : result.warnings) fmt::print(context.err, "warning: {}\n", format(warning));
  for (const auto& note : result.notes) fmt::print(context.err, "note: {}\n", format(note));
  if (context.json)
    print_json(context.out, to_json(result, signal));
  else if (result.problems.empty())
    print(context.out, result, options.protocol);
  if (!signal.empty())
    fmt::print(context.err, "turnpoint: stopped by {} after {} of {} simulated sessions\n", signal,
               result.simulated_sessions, result.wanted_sessions);
}

}  // namespace check_command

void add_check(CommandLine& app, Context& context) {
  using namespace check_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "check", "List all mistakes in a protocol file, or describe its session if there are none");
  add_protocol(*command, options->protocol)->required();
  add_rig(*command, options->rig);
  add_calibration(*command, options->calibration);
  command
      ->add_option("--sessions", options->sessions,
                   "Number of sessions to simulate in order to predict trials and duration; 0 for none; by "
                   "default as many as are needed to know both to 3 %")
      ->check(range(0, rehearsal::kMostSessions));
  add_progress(*command, options->progress);
  add_json(*command, context);
  command->footer("Example: turnpoint check demo");
  command->callback([options, &context] { check(*options, context); });
}

}  // namespace turnpoint::cli

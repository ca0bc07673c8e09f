#include "station/simulation/power.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/setup/places.hpp"
#include "station/setup/prepare.hpp"
#include "station/simulation/cue_guard.hpp"
#include "station/simulation/power_figure.hpp"
#include "station/system/write_file.hpp"
#include "station/text/number.hpp"

namespace turnpoint::cli {

namespace power_command {

using text::number;

struct Options {
  std::string protocol, rig, calibration, observer = "sim", out;
  int observers = 1000, intervals = 200;
  std::uint64_t seed = 1;
};

Json to_json(const simulation::Recovery& recovery) {
  Json coverage = nullptr;
  if (recovery.coverage)
    coverage = {{"value", recovery.coverage->value},
                {"intervals", recovery.coverage->trials},
                {"low", recovery.coverage->interval.low},
                {"high", recovery.coverage->interval.high}};
  return {{"source", recovery.source},
          {"parameter", recovery.parameter},
          {"unit", recovery.unit},
          {"truth", json_number(recovery.truth)},
          {"sessions", recovery.sessions},
          {"estimated", recovery.estimates.size()},
          {"heavy_tailed", recovery.heavy_tailed},
          {"mean", recovery.heavy_tailed ? Json(nullptr) : json_number(recovery.mean)},
          {"sd", recovery.heavy_tailed ? Json(nullptr) : json_number(recovery.sd)},
          {"median", json_number(recovery.median)},
          {"lower_quartile", json_number(recovery.lower_quartile)},
          {"upper_quartile", json_number(recovery.upper_quartile)},
          {"bias", json_number(recovery.bias)},
          {"coverage", coverage},
          {"interval_width", json_number(recovery.interval_width)}};
}

Json to_json(const std::vector<simulation::CueReport>& cues) {
  Json list = Json::array();
  for (const auto& cue : cues)
    list.push_back({{"cue", cue.cue},
                    {"accuracy", json_number(cue.accuracy)},
                    {"chance", json_number(cue.chance)},
                    {"accuracy_error", json_number(cue.error)},
                    {"above_chance", cue.above_chance()}});
  return list;
}

Json to_json(const simulation::Power& power, const std::vector<simulation::CueReport>& cues,
             const std::string& protocol, const std::vector<std::string>& files) {
  Json recoveries = Json::array();
  for (const auto& recovery : power.recoveries) recoveries.push_back(to_json(recovery));
  return {{"protocol", protocol},
          {"observers", power.observers},
          {"sessions_with_intervals", power.interval_sessions},
          {"trials", json_number(power.trials)},
          {"minutes", json_number(power.minutes)},
          {"accuracy", json_number(power.accuracy)},
          {"recoveries", recoveries},
          {"cues", to_json(cues)},
          {"files", files}};
}

void print(std::ostream& out, const simulation::Power& power) {
  fmt::print(out, "{} simulated sessions, on average {} trials and {} minutes each{}\n", power.observers,
             number(power.trials, 4), number(power.minutes, 3),
             power.accuracy ? fmt::format(", {} % right", number(100 * *power.accuracy, 3)) : "");
  constexpr auto line = "{:<22} {:<34} {:>9} {:>9} {:>9} {:>9} {:>9} {:>20} {:>9} {:>9}  {}\n";
  fmt::print(out, line, "source", "number", "truth", "mean", "bias", "SD", "median", "quartiles", "width",
             "coverage", "sessions");
  for (const auto& r : power.recoveries) {
    // Print no more digits than the spread between the simulated sessions justifies.
    const double spread = r.upper_quartile - r.lower_quartile;
    const auto shown = [spread](const std::optional<double>& value) {
      return value ? text::estimated(*value, spread) : std::string("n/a");
    };
    const auto moment = [&](double value) { return r.heavy_tailed ? std::string("-") : shown(value); };
    const auto quartiles = shown(r.lower_quartile) + " to " + shown(r.upper_quartile);
    fmt::print(out, line, r.source, fmt::format("{} ({})", r.parameter, r.unit.empty() ? "no unit" : r.unit),
               shown(r.truth), moment(r.mean), shown(r.bias), moment(r.sd), shown(r.median), quartiles,
               shown(r.interval_width), r.coverage ? fmt::format("{:.3f}", r.coverage->value) : "n/a",
               fmt::format("{} of {}", r.estimates.size(), r.sessions));
  }
  fmt::print(out,
             "Truth: the parameters of the simulated observer. Bias: mean - truth (for slopes and spreads, "
             "whose distribution has a long tail: median - truth)\n");
  fmt::print(out,
             "Median width and coverage are those of the 95 % intervals of the first {} sessions, or of all "
             "sessions if the intervals come from a posterior\n",
             power.interval_sessions);
}

void print(std::ostream& out, const std::vector<simulation::CueReport>& cues) {
  if (cues.empty()) return;
  fmt::print(out, "An observer who uses only one cue, with the best rule for it:\n");
  for (const auto& cue : cues)
    fmt::print(out, "  {:<30} {:>5} % right (chance {} %){}\n", cue.cue, number(100 * cue.accuracy, 3),
               number(100 * cue.chance, 3), cue.above_chance() ? ", above chance" : "");
}

/// Returns a function that shows the progress in one line, which it overwrites each time. Returns an empty
/// function if standard error is not a terminal.
std::function<void(int, int)> progress() {
  if (::isatty(STDERR_FILENO) == 0) return {};
  return [](int done, int of) {
    if (done % std::max(1, of / 200) != 0 && done != of) return;
    fmt::print(stderr, "\r{} of {} sessions{}", done, of, done == of ? "\n" : "");
  };
}

void power(const Options& options, Context& context) {
  const auto protocol = protocol::load(options.protocol);
  const auto rig = setup::calibrated_rig(setup::rig_or_default(options.rig, context.err), options.calibration,
                                         context.err);
  const auto survey = protocol::survey(protocol, rig);
  if (!survey.problems.empty()) throw text::BadInput(survey.problems);
  const auto cues = simulation::cue_guard(protocol, rig, survey).reports;
  simulation::PowerOptions wanted;
  wanted.observers = options.observers;
  wanted.interval_sessions = options.intervals;
  wanted.observer = observer::parse(options.observer);
  wanted.seed = options.seed;
  wanted.progress = progress();
  const auto result = simulation::power(protocol, wanted);
  std::vector<std::string> files;
  if (!options.out.empty()) {
    system::make_folder(options.out);
    files.push_back((std::filesystem::path(options.out) / (protocol.id + "-power.svg")).string());
    system::write_file(files.back(), plot::render(simulation::figure_of(result, protocol.title)));
  }
  const auto document = to_json(result, cues, protocol.id, files);
  if (!options.out.empty()) {
    const auto path = (std::filesystem::path(options.out) / (protocol.id + "-power.json")).string();
    system::write_file(path, document.dump(2) + "\n");
    files.push_back(path);
  }
  if (context.json)
    context.out << to_json(result, cues, protocol.id, files).dump(2) << "\n";
  else
    print(context.out, result), print(context.out, cues);
  for (const auto& file : files)
    if (!context.json) fmt::print(context.out, "wrote {}\n", file);
}

}  // namespace power_command

void add_power(CommandLine& app, Context& context) {
  using namespace power_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "power", "Predict what a study would find: bias, spread and interval coverage from simulated sessions");
  add_protocol(*command, options->protocol);
  add_rig(*command, options->rig, "used to predict unwanted cues that an observer could use");
  add_calibration(*command, options->calibration);
  command->add_option("--observers", options->observers, "Simulated sessions")
      ->capture_default_str()
      ->check(range(1, 1'000'000));
  command
      ->add_option("--intervals", options->intervals,
                   "Number of sessions for which 95 % intervals are computed as well")
      ->capture_default_str()
      ->check(range(0, 1'000'000));
  command
      ->add_option(
          "--observer", options->observer,
          "sim[:threshold=...,slope=...,lapse=...,bias=...,criterion=...,bound=...]: the simulated observer; "
          "protocols/README.md lists all keys")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Seed of the first session, 0 to 2^53")
      ->check(range(0, 9007199254740992));
  command->add_option("--out", options->out, "Folder for the figure and the numbers");
  add_json(*command, context);
  command->footer(
      "Example: turnpoint power friction-2ifc --observers 100 --observer sim:threshold=-18,slope=1.2 --out "
      "power");
  command->callback([options, &context] { power(*options, context); });
}

}  // namespace turnpoint::cli

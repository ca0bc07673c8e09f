#include "station/simulation/power.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/long_work.hpp"
#include "station/cli/power_part.hpp"
#include "station/cli/shared_options.hpp"
#include "station/programs/programs.hpp"
#include "station/setup/places.hpp"
#include "station/setup/prepare.hpp"
#include "station/simulation/cue_guard.hpp"
#include "station/simulation/parallel.hpp"
#include "station/simulation/power_figure.hpp"
#include "station/system/write_file.hpp"
#include "station/text/number.hpp"

namespace turnpoint::cli {

namespace power_command {

using text::number;

struct Options {
  std::string protocol, rig, calibration, observer = "sim", out, part;
  std::vector<std::string> join;
  int observers = 1000, intervals = 200;
  std::uint64_t seed = 1;
  bool progress = false;
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

/// The result of a power study, either from sessions that this process simulated or from the files of its
/// parts.
struct Found {
  simulation::Power power;
  std::vector<simulation::CueReport> cues;
  std::string id, title;  ///< id and title of the protocol
  std::string signal;     ///< the signal that stopped the work; usually ""
};

Json to_json(const Found& found, const std::vector<std::string>& files) {
  const auto& power = found.power;
  Json recoveries = Json::array();
  for (const auto& recovery : power.recoveries) recoveries.push_back(to_json(recovery));
  return {{"protocol", found.id},
          {"observers", power.observers},
          {"wanted_observers", power.asked},
          {"stopped", found.signal.empty() ? Json(nullptr) : Json(found.signal)},
          {"sessions_with_intervals", power.interval_sessions},
          {"trials", json_number(power.trials)},
          {"minutes", json_number(power.minutes)},
          {"accuracy", json_number(power.accuracy)},
          {"recoveries", recoveries},
          {"cues", to_json(found.cues)},
          {"files", files}};
}

void print(std::ostream& out, const simulation::Power& power) {
  fmt::print(out, "{}{} simulated sessions, on average {} trials and {} minutes each{}\n", power.observers,
             power.observers < power.asked ? fmt::format(" of {}", power.asked) : "", number(power.trials, 4),
             number(power.minutes, 3),
             power.accuracy ? fmt::format(", {} % right", number(100 * *power.accuracy, 3)) : "");
  const auto named = [](const simulation::Recovery& r) {
    return fmt::format("{} ({})", r.parameter, r.unit.empty() ? "no unit" : r.unit);
  };
  std::size_t widest = 34;
  for (const auto& r : power.recoveries) widest = std::max(widest, named(r).size());
  constexpr auto line = "{:<22} {:<{}} {:>9} {:>9} {:>9} {:>9} {:>9} {:>20} {:>9} {:>9}  {}\n";
  fmt::print(out, line, "source", "number", widest, "truth", "mean", "bias", "SD", "median", "quartiles",
             "width", "coverage", "sessions");
  for (const auto& r : power.recoveries) {
    // Print no more digits than the spread between the simulated sessions justifies.
    const double spread = r.upper_quartile - r.lower_quartile;
    const auto shown = [spread](const std::optional<double>& value) {
      return value ? text::estimated(*value, spread) : std::string("n/a");
    };
    const auto moment = [&](double value) { return r.heavy_tailed ? std::string("-") : shown(value); };
    const auto quartiles = shown(r.lower_quartile) + " to " + shown(r.upper_quartile);
    fmt::print(out, line, r.source, named(r), widest, shown(r.truth), moment(r.mean), shown(r.bias),
               moment(r.sd), shown(r.median), quartiles, shown(r.interval_width),
               r.coverage ? fmt::format("{:.3f}", r.coverage->value) : "n/a",
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

simulation::Part part_of(const std::string& text, int observers) {
  simulation::Part part;
  const auto* end = text.data() + text.size();
  const auto [slash, no_number] = std::from_chars(text.data(), end, part.number);
  const bool two = no_number == std::errc{} && slash != end && *slash == '/';
  const auto [rest, no_count] = std::from_chars(two ? slash + 1 : end, end, part.of);
  if (!two || no_count != std::errc{} || rest != end || part.number < 1 || part.number > part.of)
    throw UsageError(fmt::format("--part {}: this is not a part; write 1/8 to 8/8 for eight parts", text));
  if (part.of > observers)
    throw UsageError(
        fmt::format("--part {}: {} sessions cannot be divided into {} parts; use fewer parts, or "
                    "more --observers",
                    text, observers, part.of));
  return part;
}

/// Prints the result, and writes the files of --out.
void show(const Found& found, const Options& options, Context& context) {
  std::vector<std::string> files;
  if (!options.out.empty()) {
    system::make_folder(options.out);
    files.push_back((std::filesystem::path(options.out) / (found.id + "-power.svg")).string());
    system::write_file(files.back(), plot::render(simulation::figure_of(found.power, found.title)));
    const auto path = (std::filesystem::path(options.out) / (found.id + "-power.json")).string();
    system::write_file(path, to_json(found, files).dump(2, ' ', false, kInvalidBytes) + "\n");
    files.push_back(path);
  }
  if (context.json)
    context.out << to_json(found, files).dump(2, ' ', false, kInvalidBytes) << "\n";
  else
    print(context.out, found.power), print(context.out, found.cues);
  for (const auto& file : files)
    if (!context.json) fmt::print(context.out, "wrote {}\n", file);
}

void join(const Options& options, Context& context) {
  auto all = join_parts(options.join);
  const auto protocol = protocol::parse(all.protocol, all.path);
  all.options.observer = observer::parse(all.observer);
  simulation::complete(protocol, all.options, all.sessions);
  show({simulation::power_of(protocol, all.options, all.sessions), all.cues, protocol.id, protocol.title, ""},
       options, context);
}

void power(const Options& options, Context& context) {
  if (!options.join.empty()) return join(options, context);
  if (options.protocol.empty())
    throw UsageError("power: protocol is missing; `turnpoint help power` shows an example");
  PowerPart part;
  auto& wanted = part.options;
  wanted.observers = options.observers;
  wanted.interval_sessions = options.intervals;
  if (programs::is_program(options.observer))
    throw UsageError(
        "--observer " + options.observer +
        ": a power study does not run separate programs; use sim:..., or simulate sessions one by one "
        "with `turnpoint run --observer program:...`");
  wanted.observer = observer::parse(part.observer = options.observer);
  wanted.seed = options.seed;
  wanted.threads = simulation::processors();
  if (!options.part.empty()) wanted.part = part_of(options.part, options.observers);
  const auto protocol = protocol::load(options.protocol);
  part.protocol = protocol.source, part.path = protocol.path;
  const auto rig = setup::calibrated_rig(setup::rig_or_default(options.rig, context.err), options.calibration,
                                         context.err);
  LongWork work(options.progress);
  simulation::Steps steps;
  steps.finish = wanted.stop = work.stop();
  steps.progress = [&work](const char* what, int done, int of) { work.show(what, done, of); };
  wanted.progress = steps.counted("simulated sessions");
  try {
    const auto survey = protocol::survey(protocol, rig, steps.finish, steps.counted("scenes planned"));
    if (!survey.problems.empty()) throw text::BadInput(survey.problems);
    part.sessions = simulation::simulate_sessions(protocol, wanted);
    if (wanted.part.number == 1) part.cues = simulation::cue_guard(protocol, rig, survey, {}, steps).reports;
  } catch (const protocol::Abandoned&) {  // stopped before the first session
  }
  const auto signal = work.end(context);
  part.whole = signal.empty();
  if (!signal.empty())
    fmt::print(context.err, "turnpoint: stopped by {} after {} of {} simulated sessions\n", signal,
               part.sessions.size(), simulation::sessions_of(wanted.part, wanted.observers));
  if (!options.part.empty())
    context.out << to_json(part).dump(-1, ' ', false, kInvalidBytes) << "\n";
  else if (!part.sessions.empty())
    show({simulation::power_of(protocol, wanted, part.sessions), part.cues, protocol.id, protocol.title,
          signal},
         options, context);
}

}  // namespace power_command

void add_power(CommandLine& app, Context& context) {
  using namespace power_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "power", "Predict what a study would find: bias, spread and interval coverage from simulated sessions");
  auto* protocol = add_protocol(*command, options->protocol);
  auto* rig = add_rig(*command, options->rig, "used to predict unwanted cues that an observer could use");
  auto* calibration = add_calibration(*command, options->calibration);
  auto* observers = command->add_option("--observers", options->observers, "Simulated sessions")
                        ->capture_default_str()
                        ->check(range(1, 1'000'000));
  auto* intervals = command
                        ->add_option("--intervals", options->intervals,
                                     "Number of sessions for which 95 % intervals are computed as well")
                        ->capture_default_str()
                        ->check(range(0, 1'000'000));
  auto* observer =
      command
          ->add_option(
              "--observer", options->observer,
              "sim[:threshold=...,slope=...,lapse=...,bias=...,criterion=...,bound=...]: the simulated "
              "observer; protocols/README.md lists all keys")
          ->capture_default_str();
  auto* seed = command->add_option("--seed", options->seed, "Seed of the first session, 0 to 2^53")
                   ->check(range(0, 9007199254740992));
  auto* out =
      command->add_option("--out", options->out, "Folder for the figure and the numbers")->value("FOLDER");
  auto* part = command
                   ->add_option("--part", options->part,
                                "K/N: simulate only the K-th of N parts, and print it as a file for --join")
                   ->excludes(out);
  auto* join =
      command
          ->add_option(
              "--join", options->join,
              "Files of all parts, in any order: print what one machine would have found in all sessions")
          ->value("FILE");
  for (const auto* other : {protocol, rig, calibration, observers, intervals, observer, seed, part})
    join->excludes(other);
  add_progress(*command, options->progress);
  add_json(*command, context);
  command->footer(
      "Example: turnpoint power friction-2ifc --observers 100 --observer sim:threshold=-18,slope=1.2 --out "
      "power");
  command->callback([options, &context] { power(*options, context); });
}

}  // namespace turnpoint::cli

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/long_work.hpp"
#include "station/cli/shared_options.hpp"
#include "station/core/number.hpp"
#include "station/core/read_file.hpp"
#include "station/core/usage_error.hpp"
#include "station/protocol/tasks.hpp"
#include "station/rehearsal/cue_guard.hpp"
#include "station/rehearsal/parallel.hpp"
#include "station/rehearsal/power.hpp"
#include "station/rehearsal/power_figure.hpp"
#include "station/rehearsal/power_session.hpp"
#include "station/rehearsal/reward.hpp"
#include "station/report/words.hpp"
#include "station/session/places.hpp"
#include "station/session/prepare.hpp"
#include "station/session/programs.hpp"
#include "station/system/write_file.hpp"
#include "station/trial/question.hpp"

namespace turnpoint::cli {

/// The simulated sessions of one part of a power study, and all that is needed to join it with the others. It
/// is kept in a JSON file. Joined parts give the result that one machine would have had, to the last bit.
struct PowerPart {
  std::string protocol;  ///< the text of the protocol file
  std::string path;      ///< path of the protocol file, for messages
  std::string observer;  ///< the simulated observer as the user wrote it
  rehearsal::PowerOptions options;
  std::vector<rehearsal::SessionOutcome> sessions;
  /// for each unwanted cue, what an observer could achieve with it alone; set in the first part only
  std::vector<rehearsal::CueReport> cues;
  bool reward = false;  ///< the observer has the boundaries that earn the most
  std::vector<rehearsal::BestReward> rewards;  ///< the same in all parts
  bool whole = true;  ///< false if a signal stopped the work
};

Json to_json(const PowerPart& part);

/// Reads the files of all parts of a study, in any order, and joins them into one. Throws UsageError if a
/// file is not such a part, or if a part is incomplete, is missing, appears twice, or belongs to another
/// study.
PowerPart join_parts(const std::vector<std::string>& files);

namespace {

using core::UsageError;
using rehearsal::SessionOutcome;

constexpr auto kind = "part of a power study";

/// Like json_number(), but writes infinity and NaN as texts, not as null.
Json exact(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

double number(const Json& json) {
  if (!json.is_string()) return json.get<double>();
  const auto text = json.get<std::string>();
  if (text == "nan") return std::numeric_limits<double>::quiet_NaN();
  return text == "-inf" ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
}

/// Returns everything that all parts of one power study have in common.
Json study_of(const PowerPart& part) {
  return {{"program", TURNPOINT_VERSION},
          {"protocol", part.protocol},
          {"observer", part.observer},
          {"observers", part.options.observers},
          {"reward", part.reward},
          {"intervals", part.options.interval_sessions},
          {"replicates", part.options.replicates},
          {"people", part.options.people},
          {"task", part.options.task},
          {"between", part.options.between},
          {"seed", part.options.seed},
          {"parts", part.options.part.of}};
}

Json drifts_json(const std::map<double, double>& drifts) {
  Json json = Json::array();
  for (const auto& [difficulty, drift] : drifts) json.push_back({exact(difficulty), exact(drift)});
  return json;
}

Json lags_json(const std::map<double, rehearsal::GeneratingValues::Lag>& lags) {
  Json json = Json::array();
  for (const auto& [lag_s, lag] : lags)
    json.push_back({exact(lag_s), exact(lag.time_s), exact(lag.trials[0]), exact(lag.yes[0]),
                    exact(lag.trials[1]), exact(lag.yes[1])});
  return json;
}

Json comparisons_json(const std::map<std::vector<double>, std::array<double, 2>>& comparisons) {
  Json json = Json::array();
  for (const auto& [stimuli, answers] : comparisons) {
    Json compared = Json::array();
    for (const double stimulus : stimuli) compared.push_back(exact(stimulus));
    json.push_back({compared, exact(answers[0]), exact(answers[1])});
  }
  return json;
}

Json measures_json(const rehearsal::Measures& measures) {
  Json json = Json::array();
  for (const auto& one : measures)
    json.push_back({one.condition, one.measure, one.unit, exact(one.value)});
  return json;
}

Json to_json(const SessionOutcome& session) {
  Json findings = Json::array(), conditions = Json::object();
  for (const auto& f : session.findings) {
    const Json interval = f.interval ? Json{exact(f.interval->low), exact(f.interval->high)} : Json(nullptr);
    findings.push_back({{"source", f.source},
                        {"parameter", f.parameter},
                        {"unit", f.unit},
                        {"value", exact(f.value)},
                        {"interval", interval},
                        {"claimed", f.claimed ? Json(*f.claimed) : Json(nullptr)}});
  }
  for (const auto& [name, sum] : session.generating.sums())
    conditions[name] = {{"deadline_s", exact(sum.deadline_s)},
                        {"caution", sum.caution ? exact(*sum.caution) : Json(nullptr)},
                        {"one_bound", sum.one_bound},
                        {"trials", sum.trials},
                        {"correct", exact(sum.correct)},
                        {"drifts", drifts_json(sum.drifts)},
                        {"lags", lags_json(sum.lags)},
                        {"comparisons", comparisons_json(sum.comparisons)}};
  return {{"trials", session.presented},
          {"scored", session.scored},
          {"right", session.right},
          {"duration_s", session.duration_s},
          {"findings", findings},
          {"conditions", conditions},
          {"model_p", session.model_p ? exact(*session.model_p) : Json(nullptr)},
          {"separated", session.separated ? Json(*session.separated) : Json(nullptr)},
          {"excluded", session.person ? Json(session.person->excluded) : Json(nullptr)},
          {"measures", session.person ? measures_json(session.person->measures) : Json(nullptr)},
          {"truths", measures_json(session.truths)}};
}

rehearsal::Measures measures_of(const Json& json) {
  rehearsal::Measures measures;
  for (const auto& one : json)
    measures.push_back({"", one.at(0), one.at(1), one.at(2), number(one.at(3))});
  return measures;
}

SessionOutcome session_of(const Json& json) {
  SessionOutcome session;
  session.presented = json.at("trials"), session.scored = json.at("scored"), session.right = json.at("right");
  session.duration_s = json.at("duration_s");
  for (const auto& f : json.at("findings")) {
    session.findings.push_back(
        {f.at("source"), f.at("parameter"), f.at("unit"), number(f.at("value"))});
    if (const auto& claimed = f.at("claimed"); !claimed.is_null())
      session.findings.back().claimed = claimed.get<bool>();
    const auto& ends = f.at("interval");
    if (ends.is_null()) continue;
    auto& interval = session.findings.back().interval.emplace();
    interval.low = number(ends.at(0)), interval.high = number(ends.at(1));
  }
  std::map<std::string, rehearsal::GeneratingValues::Sum> sums;
  for (const auto& [name, sum] : json.at("conditions").items())
  {
    auto& read = sums[name];
    read.deadline_s = number(sum.at("deadline_s")), read.one_bound = sum.at("one_bound");
    if (const auto& caution = sum.at("caution"); !caution.is_null()) read.caution = number(caution);
    read.trials = sum.at("trials"), read.correct = number(sum.at("correct"));
    for (const auto& one : sum.at("drifts")) read.drifts[number(one.at(0))] = number(one.at(1));
    for (const auto& one : sum.at("lags"))
      read.lags[number(one.at(0))] = {number(one.at(1)),
                                      {number(one.at(2)), number(one.at(4))},
                                      {number(one.at(3)), number(one.at(5))}};
    for (const auto& one : sum.at("comparisons")) {
      std::vector<double> stimuli;
      for (const auto& stimulus : one.at(0)) stimuli.push_back(number(stimulus));
      read.comparisons[stimuli] = {number(one.at(1)), number(one.at(2))};
    }
  }
  if (const auto& p = json.at("model_p"); !p.is_null()) session.model_p = number(p);
  if (const auto& separated = json.at("separated"); !separated.is_null())
    session.separated = separated.get<bool>();
  if (const auto& excluded = json.at("excluded"); !excluded.is_null()) {
    auto& person = session.person.emplace();
    person.excluded = excluded;
    person.measures = measures_of(json.at("measures"));
  }
  session.truths = measures_of(json.at("truths"));
  session.generating = rehearsal::GeneratingValues::of_sums(sums);
  return session;
}

Json cue_json(const rehearsal::CueReport& cue) {
  return {{"cue", cue.cue},
          {"task", cue.task},
          {"accuracy", exact(cue.accuracy)},
          {"chance", exact(cue.chance)},
          {"error", exact(cue.error)}};
}

Json trade_json(const rehearsal::Trade& trade) {
  return {{"points_per_minute", exact(trade.points_per_minute)},
          {"right", exact(trade.right)},
          {"response_time_s", exact(trade.response_time_s)}};
}

Json rewards_json(const std::vector<rehearsal::BestReward>& rewards) {
  Json list = Json::array();
  for (const auto& reward : rewards)
    list.push_back({{"block", reward.block},
                    {"caution", exact(reward.caution)},
                    {"at_end", reward.at_end},
                    {"best", trade_json(reward.best)},
                    {"own", trade_json(reward.own)}});
  return list;
}

rehearsal::Trade trade_of(const Json& json) {
  return {number(json.at("points_per_minute")), number(json.at("right")), number(json.at("response_time_s"))};
}

std::vector<rehearsal::BestReward> rewards_of(const Json& json) {
  std::vector<rehearsal::BestReward> rewards;
  for (const auto& one : json)
    rewards.push_back({one.at("block"), number(one.at("caution")), one.at("at_end"), trade_of(one.at("best")),
                       trade_of(one.at("own"))});
  return rewards;
}

PowerPart part_of(const Json& json) {
  PowerPart part;
  const auto& study = json.at("study");
  part.path = json.at("path"), part.whole = json.at("whole"), part.reward = study.at("reward");
  part.rewards = rewards_of(json.at("rewards"));
  part.protocol = study.at("protocol"), part.observer = study.at("observer");
  part.options.observers = study.at("observers"), part.options.interval_sessions = study.at("intervals");
  part.options.replicates = study.at("replicates"), part.options.seed = study.at("seed");
  part.options.task = study.at("task");
  part.options.people = study.at("people"), part.options.between = study.at("between").get<simulation::Spread>();
  part.options.part = {json.at("part"), study.at("parts")};
  for (const auto& session : json.at("sessions")) part.sessions.push_back(session_of(session));
  for (const auto& cue : json.at("cues")) {
    auto& report = part.cues.emplace_back();
    report.task = cue.at("task");
    report.cue = cue.at("cue"), report.accuracy = number(cue.at("accuracy"));
    report.chance = number(cue.at("chance")), report.error = number(cue.at("error"));
  }
  return part;
}

/// Reads the file of one part, and checks that it belongs to the same study as the first file. `first`
/// describes that study; if it is null, this is the first file.
PowerPart read_part(const std::string& file, const std::string& first_file, Json& first) {
  const std::string remedy = "; such files are written by turnpoint power --part";
  try {
    const auto json = Json::parse(core::read_file(file));
    if (!json.is_object() || json.value("kind", "") != kind)
      throw UsageError(fmt::format("{} is not a {}{}", file, kind, remedy));
    if (first.is_null()) first = json.at("study");
    for (const auto& [key, value] : first.items()) {
      if (json.at("study").at(key) == value) continue;
      if (key == "protocol")
        throw UsageError(fmt::format("{} and {} are of different protocols", first_file, file));
      throw UsageError(fmt::format("{} and {} are of different studies: \"{}\" is {} and {}", first_file,
                                   file, key, value.dump(), json.at("study").at(key).dump()));
    }
    if (const auto version = first.at("program").get<std::string>(); version != TURNPOINT_VERSION)
      throw UsageError(
          fmt::format("{} was made by version {}; this is {}", file, version, TURNPOINT_VERSION));
    auto part = part_of(json);
    const auto& options = part.options;
    if (options.part.number < 1 || options.part.number > options.part.of ||
        options.part.of > options.observers)
      throw UsageError(fmt::format("{} is damaged: there is no part {} of {}", file, options.part.number,
                                   options.part.of));
    const auto count = static_cast<std::size_t>(rehearsal::sessions_of(options.part, options.observers));
    if (!part.whole || part.sessions.size() != count)
      throw UsageError(fmt::format("{} was stopped after {} of {} sessions; run part {}/{} again", file,
                                   part.sessions.size(), count, options.part.number, options.part.of));
    return part;
  } catch (const Json::exception&) {
    throw UsageError(fmt::format("{} is an incomplete or damaged {}{}", file, kind, remedy));
  } catch (const std::system_error& error) {
    throw UsageError(error.what());
  }
}

}  // namespace

Json to_json(const PowerPart& part) {
  Json sessions = Json::array(), cues = Json::array();
  for (const auto& session : part.sessions) sessions.push_back(to_json(session));
  for (const auto& cue : part.cues) cues.push_back(cue_json(cue));
  return {{"kind", kind},
          {"part", part.options.part.number},
          {"study", study_of(part)},
          {"path", part.path},
          {"whole", part.whole},
          {"cues", cues},
          {"rewards", rewards_json(part.rewards)},
          {"sessions", sessions}};
}

PowerPart join_parts(const std::vector<std::string>& files) {
  PowerPart whole;
  Json study;
  std::vector<std::string> from;  // the file of each part; "" if it was not seen yet
  for (const auto& file : files) {
    auto part = read_part(file, files.front(), study);
    const auto [number, of] = part.options.part;
    if (from.empty()) {
      from.resize(static_cast<std::size_t>(of));
      whole = part;
      whole.sessions.assign(static_cast<std::size_t>(part.options.observers), {});
    }
    auto& known = from[static_cast<std::size_t>(number - 1)];
    if (!known.empty())
      throw UsageError(fmt::format("{} and {} are both part {} of {}", known, file, number, of));
    known = file;
    if (number == 1) whole.cues = part.cues, whole.path = part.path;
    for (std::size_t i = 0; i < part.sessions.size(); ++i)
      whole.sessions[static_cast<std::size_t>(number - 1) + i * static_cast<std::size_t>(of)] =
          std::move(part.sessions[i]);
  }
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < from.size(); ++i)
    if (from[i].empty()) missing.push_back(i + 1);
  if (!missing.empty())
    throw UsageError(fmt::format("of {} parts, {} {} missing: {}", from.size(), missing.size(),
                                 missing.size() == 1 ? "is" : "are", fmt::join(missing, ", ")));
  whole.options.part = {};
  return whole;
}

namespace power_command {

using core::number;

struct Options {
  std::string protocol, rig, calibration, observer = "sim", out, part, task;
  std::vector<std::string> join;
  int observers = 1000, intervals = 200, people = 0;
  std::string between;
  bool reward = false;
  std::uint64_t seed = 1;
  bool progress = false;
};

/// `of`: the name of the number of which this is a share.
template <class Proportion>
Json share_json(const std::optional<Proportion>& share, const char* of) {
  if (!share) return nullptr;
  return {{"value", share->value},
          {of, share->trials},
          {"low", share->interval.low},
          {"high", share->interval.high}};
}

Json to_json(const rehearsal::Recovery& recovery) {
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
          {"coverage", share_json(recovery.coverage, "intervals")},
          {"interval_width", json_number(recovery.interval_width)},
          {"claimed", share_json(recovery.claimed, "of")}};
}

Json to_json(const std::vector<rehearsal::CueReport>& cues) {
  Json list = Json::array();
  for (const auto& cue : cues)
    list.push_back({{"cue", cue.cue},
                    {"task", cue.task.empty() ? Json(nullptr) : Json(cue.task)},
                    {"accuracy", json_number(cue.accuracy)},
                    {"chance", json_number(cue.chance)},
                    {"accuracy_error", json_number(cue.error)},
                    {"above_chance", cue.above_chance()}});
  return list;
}

/// The result of a power study, either from sessions that this process simulated or from the files of its
/// parts.
struct Found {
  rehearsal::Power power;
  std::vector<rehearsal::CueReport> cues;
  std::vector<rehearsal::BestReward> rewards;  ///< empty without --reward
  std::string id, title;  ///< id and title of the protocol
  std::string task;       ///< of a protocol with several: the one that this is about
  std::string signal;     ///< the signal that stopped the work; usually ""
};

Json to_json(const Found& found, const std::vector<std::string>& files) {
  const auto& power = found.power;
  Json recoveries = Json::array();
  for (const auto& recovery : power.recoveries) recoveries.push_back(to_json(recovery));
  return {{"protocol", found.id},
          {"task", found.task.empty() ? Json(nullptr) : Json(found.task)},
          {"observers", power.observers},
          {"wanted_observers", power.asked},
          {"stopped", found.signal.empty() ? Json(nullptr) : Json(found.signal)},
          {"sessions_with_intervals", power.interval_sessions},
          {"trials", json_number(power.trials)},
          {"minutes", json_number(power.minutes)},
          {"accuracy", json_number(power.accuracy)},
          {"misfits", share_json(power.misfits, "of")},
          {"separated", share_json(power.separated, "of")},
          {"people", power.people},
          {"recoveries", recoveries},
          {"rewards", rewards_json(found.rewards)},
          {"cues", to_json(found.cues)},
          {"files", files}};
}

void print(std::ostream& out, const Found& found) {
  const auto& power = found.power;
  if (!found.task.empty()) fmt::print(out, "Task {}\n", found.task);
  fmt::print(out, "{}{} simulated sessions, on average {} trials and {} minutes each{}\n", power.observers,
             power.observers < power.asked ? fmt::format(" of {}", power.asked) : "", number(power.trials, 4),
             number(power.minutes, 3),
             power.accuracy
                 ? fmt::format(", {} % of the scored answers right", number(100 * *power.accuracy, 3))
                 : "");
  if (power.people > 0)
    fmt::print(out, "{} studies of {} people each, analysed as turnpoint report --study does\n",
               power.observers / power.people, power.people);
  if (power.misfits)
    fmt::print(out, "The check of the diffusion model finds a misfit in {} % of {} sessions\n",
               number(100 * power.misfits->value, 3), power.misfits->trials);
  if (power.separated)
    fmt::print(out,
               "In {} % of {} sessions the answers set no limit to some distances on the scale. The prior then "
               "decides places and intervals, and coverage can be far from 95 %\n",
               number(100 * power.separated->value, 3), power.separated->trials);
  const auto named = [](const rehearsal::Recovery& r) {
    return core::say(report::in_unit(core::plain(r.parameter), core::plain(r.unit)), "en");
  };
  std::size_t widest = 34;
  for (const auto& r : power.recoveries) widest = std::max(widest, named(r).size());
  constexpr auto line = "{:<22} {:<{}} {:>9} {:>9} {:>9} {:>9} {:>9} {:>20} {:>9} {:>9} {:>9}  {}\n";
  fmt::print(out, line, "source", "number", widest, "truth", "mean", "bias", "SD", "median", "quartiles",
             "width", "coverage", "claimed", power.people > 0 ? "studies" : "sessions");
  for (const auto& r : power.recoveries) {
    // Print no more digits than the spread between the simulated sessions justifies.
    const double spread = r.upper_quartile - r.lower_quartile;
    const auto shown = [spread](const std::optional<double>& value) {
      return value ? core::estimated(*value, spread) : std::string("n/a");
    };
    const auto moment = [&](double value) { return r.heavy_tailed ? std::string("-") : shown(value); };
    const auto quartiles = shown(r.lower_quartile) + " to " + shown(r.upper_quartile);
    fmt::print(out, line, r.source, named(r), widest, shown(r.truth), moment(r.mean), shown(r.bias),
               moment(r.sd), shown(r.median), quartiles, shown(r.interval_width),
               r.coverage ? fmt::format("{:.3f}", r.coverage->value) : "n/a",
               r.claimed ? fmt::format("{:.3f}", r.claimed->value) : "n/a",
               fmt::format("{} of {}", r.estimates.size(), r.sessions));
  }
  fmt::print(out,
             "Truth: the parameters of the simulated observer. Bias: mean - truth (for slopes and spreads, "
             "whose distribution has a long tail: median - truth)\n");
  fmt::print(out, "Claimed: how often a difference is found, because its interval excludes 0 (of a ratio: because the model "
                  "with one rate is rejected), or by its corrected p value if the protocol asks for that. If the truth "
                  "is 0, these are false alarms\n");
  if (power.people == 0)
    fmt::print(out,
               "Median width and coverage are those of the 95 % intervals of the first {} sessions, or of all "
               "sessions if the intervals come from a posterior\n",
               power.interval_sessions);
  else
    fmt::print(out, "Truth is the mean over all simulated people\n");
}

std::string named(const rehearsal::CueReport& cue) {
  return cue.task.empty() ? cue.cue : cue.task + ": " + cue.cue;
}

void print(std::ostream& out, const std::vector<rehearsal::CueReport>& cues) {
  if (cues.empty()) return;
  fmt::print(out, "An observer who uses only one cue, with the best rule for it:\n");
  for (const auto& cue : cues)
    fmt::print(out, "  {:<30} {:>5} % right (chance {} %){}\n", named(cue), number(100 * cue.accuracy, 3),
               number(100 * cue.chance, 3), cue.above_chance() ? ", above chance" : "");
}

void print(std::ostream& out, const std::vector<rehearsal::BestReward>& rewards) {
  if (rewards.empty()) return;
  fmt::print(out, "The observer above has in each block the decision boundaries that earn the most points per minute:\n");
  for (const auto& reward : rewards) {
    fmt::print(out, "  {}: {} times --observer's bound: {} points a minute, {} % right, {} s; with its own bound {}, {} %, {} s\n",
               reward.block, number(reward.caution, 2), number(reward.best.points_per_minute, 3),
               number(100 * reward.best.right, 3), number(reward.best.response_time_s, 3),
               number(reward.own.points_per_minute, 3), number(100 * reward.own.right, 3),
               number(reward.own.response_time_s, 3));
    if (reward.at_end)
      fmt::print(out, "    {}\n", reward.caution < 1
                                      ? "this is the lowest that is tried: it pays to guess at once"
                                      : "this is the highest that is tried: waiting costs nothing");
  }
}

rehearsal::Part part_of(const std::string& text, int observers) {
  rehearsal::Part part;
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
    const auto figure = rehearsal::figure_of(found.power, found.title);
    if (!figure.charts.empty()) {
      files.push_back((std::filesystem::path(options.out) / (found.id + "-power.svg")).string());
      system::write_file(files.back(), report::render(figure));
    }
    const auto path = (std::filesystem::path(options.out) / (found.id + "-power.json")).string();
    system::write_file(path, to_json(found, files).dump(2, ' ', false, kInvalidBytes) + "\n");
    files.push_back(path);
  }
  if (context.json)
    print_json(context.out, to_json(found, files));
  else
    print(context.out, found), print(context.out, found.rewards), print(context.out, found.cues);
  for (const auto& file : files)
    if (!context.json) fmt::print(context.out, "wrote {}\n", file);
}

void join(const Options& options, Context& context) {
  if (options.reward) throw UsageError("--reward cannot be used with --join: the parts say which observer they have");
  auto all = join_parts(options.join);
  const auto protocol = protocol::parse(all.protocol, all.path);
  all.options.observer = simulation::parse(all.observer);
  all.options.cautions = rehearsal::cautions_of(all.rewards);
  rehearsal::complete(protocol, all.options, all.sessions);
  show({rehearsal::power_of(protocol, all.options, all.sessions), all.cues, all.rewards, protocol.id,
        protocol.title, protocol::of_task(protocol, all.options.task).task.name, ""},
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
  if (session::is_program(options.observer))
    throw UsageError(
        "--observer " + options.observer +
        ": a power study does not run separate programs; use sim:..., or simulate sessions one by one "
        "with `turnpoint run --observer program:...`");
  wanted.observer = simulation::parse(part.observer = options.observer);
  wanted.people = options.people;
  if ((options.people > 0) == options.between.empty())
    throw UsageError(
        "--people and --between belong together: how much people differ decides how many a study needs; write "
        "for example --people 8 --between bound=0.15,residual=0.1");
  if (options.people > 0) {
    wanted.between = simulation::parse_spread(options.between);
    wanted.replicates = 40;  // a study takes no intervals from single people
    if (options.observers % options.people != 0)
      throw UsageError(fmt::format("--people {}: {} observers do not make whole studies; use {} or {}",
                                   options.people, options.observers,
                                   options.observers / options.people * options.people,
                                   (options.observers / options.people + 1) * options.people));
    core::Draws draws({});
    simulation::draw_person(wanted.observer, wanted.between, draws);  // refuses what nobody can differ in
  }
  wanted.seed = options.seed;
  wanted.threads = rehearsal::processors();
  if (!options.part.empty()) wanted.part = part_of(options.part, options.observers);
  const auto protocol = protocol::load(options.protocol);
  part.protocol = protocol.source, part.path = protocol.path;
  wanted.task = protocol::chosen_task(protocol, options.task);
  const auto rig = session::calibrated_rig(session::rig_or_default(options.rig, context.err),
                                           options.calibration, context.err);
  for (const auto& note : trial::observer_notes(protocol, simulation::Observer{wanted.observer}))
    fmt::print(context.err, "note: {}\n", core::format(note));
  LongWork work(options.progress);
  rehearsal::Steps steps;
  steps.finish = wanted.stop = work.stop();
  steps.progress = [&work](const char* what, int done, int of) { work.show(what, done, of); };
  wanted.progress = steps.counted("simulated sessions");
  part.reward = options.reward;
  try {
    const auto survey = protocol::survey(protocol, rig, steps.finish, steps.counted("scenes planned"));
    if (!survey.problems.empty()) throw core::BadInput(survey.problems);
    if (options.reward) {
      auto tried = wanted;
      tried.progress = steps.counted("simulated sessions with other boundaries");
      part.rewards = rehearsal::best_rewards(protocol, tried);
    }
    wanted.cautions = rehearsal::cautions_of(part.rewards);
    part.sessions = rehearsal::simulate_sessions(protocol, wanted);
    if (wanted.part.number == 1) part.cues = rehearsal::cue_guard(protocol, rig, survey, {}, steps).reports;
  } catch (const protocol::Abandoned&) {  // stopped before the first session
  }
  const auto signal = work.end(context);
  part.whole = signal.empty();
  if (!signal.empty())
    fmt::print(context.err, "turnpoint: stopped by {} after {} of {} simulated sessions\n", signal,
               part.sessions.size(), rehearsal::sessions_of(wanted.part, wanted.observers));
  if (!options.part.empty())
    context.out << to_json(part).dump(-1, ' ', false, kInvalidBytes) << "\n";
  else if (!part.sessions.empty())
    show({rehearsal::power_of(protocol, wanted, part.sessions), part.cues, part.rewards, protocol.id,
          protocol.title, protocol::of_task(protocol, wanted.task).task.name, signal},
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
  auto* task = command->add_option("--task", options->task,
                                   "Of a protocol with several tasks: the one whose estimates are simulated");
  auto* people = command
                     ->add_option("--people", options->people,
                                  "Simulate studies with this number of people, and report what each study finds")
                     ->check(range(3, 1000));
  auto* between = command
                      ->add_option("--between", options->between,
                                   "How much people differ: standard deviations of the observer's parameters, "
                                   "such as bound=0.15,residual=0.1 (of the logarithm; of threshold, bias and "
                                   "criterion in their own unit)")
                      ->value("KEY=SD,...");
  command->add_flag(
      "--reward", options->reward,
      "The observer has the decision boundaries that earn the most points per minute; print what they earn");
  auto* observer =
      command
          ->add_option(
              "--observer", options->observer,
              "sim[:threshold=...,slope=...,lapse=...,bias=...,criterion=...,bound=...]: the simulated "
              "observer; protocols/check-and-power.md lists all keys")
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
  for (const auto* other : {protocol, rig, calibration, observers, intervals, people, between, observer, seed, part, task})
    join->excludes(other);
  people->excludes(intervals);
  add_progress(*command, options->progress);
  add_json(*command, context);
  command->footer(
      "Example: turnpoint power friction-2ifc --observers 100 --observer sim:threshold=-18,slope=1.2 --out "
      "power");
  command->callback([options, &context] { power(*options, context); });
}

}  // namespace turnpoint::cli

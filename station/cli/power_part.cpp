#include "station/cli/power_part.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <system_error>

#include "station/system/read_file.hpp"
#include "station/terms/usage_error.hpp"

namespace turnpoint::cli {

namespace {

using simulation::SessionOutcome;
using terms::UsageError;

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
          {"intervals", part.options.interval_sessions},
          {"replicates", part.options.replicates},
          {"seed", part.options.seed},
          {"parts", part.options.part.of}};
}

Json to_json(const SessionOutcome& session) {
  Json findings = Json::array(), conditions = Json::object();
  for (const auto& f : session.findings) {
    const Json interval = f.interval ? Json{exact(f.interval->low), exact(f.interval->high)} : Json(nullptr);
    findings.push_back({{"source", f.source},
                        {"parameter", f.parameter},
                        {"unit", f.unit},
                        {"value", exact(f.value)},
                        {"interval", interval}});
  }
  for (const auto& [name, sum] : session.generating.sums())
    conditions[name] = {{"deadline_s", exact(sum.deadline_s)},
                        {"one_deadline", sum.one_deadline},
                        {"trials", sum.trials},
                        {"correct", exact(sum.correct)}};
  return {{"trials", session.presented},      {"scored", session.scored}, {"right", session.right},
          {"duration_s", session.duration_s}, {"findings", findings},     {"conditions", conditions}};
}

SessionOutcome session_of(const Json& json) {
  SessionOutcome session;
  session.presented = json.at("trials"), session.scored = json.at("scored"), session.right = json.at("right");
  session.duration_s = json.at("duration_s");
  for (const auto& f : json.at("findings")) {
    session.findings.push_back(
        {f.at("source"), f.at("parameter"), f.at("unit"), number(f.at("value")), std::nullopt});
    const auto& ends = f.at("interval");
    if (ends.is_null()) continue;
    auto& interval = session.findings.back().interval.emplace();
    interval.low = number(ends.at(0)), interval.high = number(ends.at(1));
  }
  std::map<std::string, simulation::GeneratingValues::Sum> sums;
  for (const auto& [name, sum] : json.at("conditions").items())
    sums[name] = {number(sum.at("deadline_s")), sum.at("one_deadline"), sum.at("trials"),
                  number(sum.at("correct"))};
  session.generating = simulation::GeneratingValues::of_sums(sums);
  return session;
}

Json cue_json(const simulation::CueReport& cue) {
  return {{"cue", cue.cue},
          {"accuracy", exact(cue.accuracy)},
          {"chance", exact(cue.chance)},
          {"error", exact(cue.error)}};
}

PowerPart part_of(const Json& json) {
  PowerPart part;
  const auto& study = json.at("study");
  part.path = json.at("path"), part.whole = json.at("whole");
  part.protocol = study.at("protocol"), part.observer = study.at("observer");
  part.options.observers = study.at("observers"), part.options.interval_sessions = study.at("intervals");
  part.options.replicates = study.at("replicates"), part.options.seed = study.at("seed");
  part.options.part = {json.at("part"), study.at("parts")};
  for (const auto& session : json.at("sessions")) part.sessions.push_back(session_of(session));
  for (const auto& cue : json.at("cues")) {
    auto& report = part.cues.emplace_back();
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
    const auto json = Json::parse(system::read_file(file));
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
    const auto count = static_cast<std::size_t>(simulation::sessions_of(options.part, options.observers));
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

}  // namespace turnpoint::cli

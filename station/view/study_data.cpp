#include "station/view/study_data.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "station/core/usage_error.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/conditions.hpp"
#include "station/protocol/protocol.hpp"
#include "station/protocol/tasks.hpp"
#include "station/protocol/visits.hpp"
#include "station/report/stored_estimates.hpp"
#include "station/report/stored_trials.hpp"
#include "station/store/places.hpp"
#include "station/store/read.hpp"
#include "station/view/report_data.hpp"

namespace turnpoint::view {

namespace {

/// A session, and the file in which it was found.
struct Found {
  std::string database;
  store::SessionRecord session;
};

/// Returns all sessions with trials that the choice allows. A session that several files contain is returned
/// once.
std::vector<Found> sessions_of(const StudyChoice& choice, int& copies) {
  std::vector<Found> all;
  std::set<std::string> seen;
  for (const auto& database : choice.databases) {
    store::SessionFilter filter;
    filter.protocol_id = choice.protocol_id;
    for (auto& session : store::list_sessions(database, filter)) {
      if (session.trials == 0) continue;
      const auto& start = session.start;
      if (!choice.mode.empty() && store::name(start.run_mode) != choice.mode) continue;
      if (!choice.protocol_version.empty() && start.protocol_version != choice.protocol_version &&
          !start.protocol_sha256.starts_with(choice.protocol_version))
        continue;
      if (seen.insert(session.session_id).second)
        all.push_back({database, std::move(session)});
      else
        ++copies;
    }
  }
  return all;
}

/// Throws if the sessions differ in something, such as the protocol, for which the study must choose one
/// value.
void require_one(const std::vector<Found>& all, const std::string& what, const std::string& option,
                 const std::function<std::string(const store::SessionStart&)>& of) {
  std::map<std::string, int> counts;
  for (const auto& found : all) ++counts[of(found.session.start)];
  if (counts.size() < 2) return;
  std::vector<std::string> list;
  for (const auto& [name, count] : counts)
    list.push_back(fmt::format("{} ({} session{})", name, count, count == 1 ? "" : "s"));
  throw core::UsageError(
      fmt::format("the sessions have different {}: {}; choose with {}", what, fmt::join(list, ", "), option));
}

void require_one_study(const StudyChoice& choice, const std::vector<Found>& all) {
  if (all.empty())
    throw store::StoreError(
        store::ErrorKind::missing,
        fmt::format("{}: there is no such session with trials to report", fmt::join(choice.databases, ", ")));
  require_one(all, "protocols", "--protocol", [](const auto& start) { return start.protocol_id; });
  require_one(all, "versions of the protocol", "--protocol-version",
              [](const auto& start) { return start.protocol_version; });
  require_one(all, "protocol texts of the same version", "--protocol-version SHA-256",
              [](const auto& start) { return start.protocol_sha256.substr(0, 12); });
  require_one(all, "modes", "--mode",
              [](const auto& start) { return std::string(store::name(start.run_mode)); });
}

/// Returns the name CODE@STATION for each person of each file. If the stored name contains no station, the
/// station of the person's first session is added.
std::map<std::pair<std::string, std::string>, std::string> full_names(const std::vector<Found>& all) {
  std::map<std::pair<std::string, std::string>, std::string> names;
  for (const auto& found : all) {
    const auto& person = found.session.person;
    names.try_emplace({found.database, person}, person.find('@') == std::string::npos
                                                    ? person + "@" + found.session.start.station_id
                                                    : person);
  }
  return names;
}

/// Groups sessions by participant. The same code at two stations stands for two people, unless their file
/// says that they are one person.
std::map<std::string, std::vector<Found>> by_person(std::vector<Found> all) {
  const auto code_of = [](const std::string& person) { return person.substr(0, person.rfind('@')); };
  const auto names = full_names(all);
  std::map<std::string, std::set<std::string>> same_code;
  for (const auto& [where, name] : names) same_code[code_of(name)].insert(name);
  std::map<std::string, std::vector<Found>> people;
  for (auto& found : all) {
    const auto& name = names.at({found.database, found.session.person});
    people[same_code[code_of(name)].size() > 1 ? name : code_of(name)].push_back(std::move(found));
  }
  for (auto& [person, sessions] : people)
    std::stable_sort(sessions.begin(), sessions.end(), [](const Found& a, const Found& b) {
      return a.session.session_index < b.session.session_index;
    });
  return people;
}

/// The trials of all sessions of one participant, and the procedures' own estimates of each session.
struct PersonData {
  report::SessionData all;
  std::vector<report::SessionEstimate> estimates;
  std::vector<report::SessionEarlyEnd> early_ends;
};

/// Adds what the procedures of a session estimated themselves.
void add_own(const std::string& database, const store::StoredSession& stored,
             const protocol::Protocol& protocol, std::size_t task, PersonData& all) {
  report::SessionData own;
  add_own_estimates(database, stored, protocol, own);
  report::keep_estimates_of(protocol::of_task(protocol, task), own);
  const auto& id = stored.session.session_id;
  for (auto& estimate : own.estimates) all.estimates.push_back({id, std::move(estimate)});
  for (auto& end : own.early_ends) all.early_ends.push_back({id, std::move(end)});
}

PersonData data_of(const std::string& person, const std::vector<Found>& sessions,
                   const protocol::Protocol& protocol, std::size_t task) {
  PersonData data;
  auto& all = data.all;
  std::vector<core::BlockRecord> blocks;
  int trials = 0, first_block = 0;
  // The numbers of someone with one session are those of its report.
  if (!sessions.empty()) all.seed = sessions.front().session.start.seed;
  for (const auto& found : sessions) {
    auto stored = store::read_session(found.database, found.session.session_id);
    add_own(found.database, stored, protocol, task, data);
    int last_block = first_block;
    for (auto& block : stored.blocks) {
      block.start.block_index += first_block;
      last_block = std::max(last_block, block.start.block_index);
      for (auto& row : block.trials) row.tones.clear(), row.trial_index += trials;
      blocks.push_back(std::move(block));
    }
    first_block = last_block + 1, trials += found.session.trials;
    all.run_mode = store::name(found.session.start.run_mode);
  }
  all.title = protocol.title;
  all.participant = person;
  report::add_other_trials(blocks, protocol, task, all);
  report::add_trials(report::of_task(std::move(blocks), protocol, task), protocol::of_task(protocol, task),
                     all);
  all.finger.clear();  // forces cannot be combined over sessions
  return data;
}

bool completed(const Found& found) { return found.session.status == core::SessionStatus::completed; }

/// True if the participant began the same session again: the same planned session or, if none are planned,
/// any later one. `sessions` are in the order in which they were begun.
bool superseded(const std::vector<Found>& sessions, std::size_t place) {
  if (completed(sessions[place])) return false;
  const auto& number = sessions[place].session.start.planned_session;
  return std::any_of(sessions.begin() + static_cast<std::ptrdiff_t>(place) + 1, sessions.end(),
                     [&](const Found& later) { return later.session.start.planned_session == number; });
}

/// The sessions of one participant that count.
struct Counted {
  std::vector<Found> sessions;
  bool incomplete = false;  ///< true if a session was neither completed nor begun again
};

Counted counted(const std::vector<Found>& sessions, report::SessionCounts& counts) {
  Counted result;
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    ++counts.found;
    if (superseded(sessions, i)) {
      ++counts.superseded;
      continue;
    }
    const bool whole = completed(sessions[i]);
    if (!whole) ++counts.incomplete, result.incomplete = true;
    if (whole || counts.incomplete_count) result.sessions.push_back(sessions[i]);
  }
  return result;
}

/// True if a participant with these sessions has done all that are planned.
bool has_completed(const std::vector<Found>& sessions, const core::Assignment& assignment) {
  std::set<int> numbers;
  for (const auto& found : sessions)
    if (const auto number = store::session_done(found.session, assignment)) numbers.insert(*number);
  return static_cast<int>(numbers.size()) >= assignment.sessions;
}

report::Study head_of(const StudyChoice& choice, const std::vector<Found>& all, int copies) {
  report::Study study;
  const auto& start = all.front().session.start;
  std::set<std::string> stations, versions;
  for (const auto& found : all) {
    stations.insert(found.session.start.station_id);
    versions.insert(found.session.start.software_version);
  }
  study.facts = {{"Protocol", start.protocol_id + " " + start.protocol_version},
                 {"Protocol SHA-256", start.protocol_sha256},
                 {"Databases", fmt::format("{}", fmt::join(choice.names, ", "))},
                 {"Sessions", std::to_string(all.size())},
                 {"Stations", fmt::format("{}", fmt::join(stations, ", "))},
                 {"Recorded by version", fmt::format("{}", fmt::join(versions, ", "))}};
  if (copies > 0)
    study.statements.push_back(
        {"copies",
         core::phrase(copies == 1 ? "statement.one_copy" : "statement.copies", {core::plain(copies)})});
  return study;
}

}  // namespace

report::Study study_data(const StudyChoice& choice, const StudySink& sink, const StudyProgress& progress) {
  int copies = 0;
  auto all = sessions_of(choice, copies);
  require_one_study(choice, all);
  auto study = head_of(choice, all, copies);
  const auto first = store::read_session(all.front().database, all.front().session.session_id);
  const auto stored = protocol::parse(first.session.start.protocol_text, first.session.start.protocol_path);
  const auto design = protocol::design(stored);
  study.design_rows = design.rows;
  const auto whole = report::by_group(stored);
  const auto task = protocol::chosen_task(whole, choice.task);
  const auto& protocol = protocol::of_task(whole, task);
  const auto rules = protocol.exclusion.value_or(protocol::Exclusion{});
  study.rules = report::rules_in_words(rules);
  const auto people = by_person(std::move(all));
  int done = 0;
  study.groups_of_conditions = protocol::groups_of_conditions(protocol);
  study.sessions.incomplete_count = protocol.analysis.count_incomplete;
  for (const auto& [person, sessions] : people) {
    if (!progress(done, static_cast<int>(people.size()))) {
      study.statements.push_back(
          {"stopped", core::phrase("statement.stopped", {core::plain(done), core::plain(people.size())})});
      break;
    }
    ++done;
    const auto used = counted(sessions, study.sessions);
    auto [data, estimates, early_ends] = data_of(person, used.sessions, whole, task);
    data.run_mode = store::name(sessions.front().session.start.run_mode);
    data.replicates = report::kStudyReplicates;
    auto result = report::study_person(data, rules, used.incomplete);
    if (used.sessions.empty()) result.excluded.push_back("no session that counts");
    for (const auto& found : used.sessions) result.sessions.push_back(found.session.session_id);
    result.estimates = std::move(estimates);
    result.early_ends = std::move(early_ends);
    result.group = sessions.front().session.start.group;
    result.row = sessions.back().session.sequence_index % study.design_rows;
    result.completed = has_completed(sessions, design);
    sink(result, data);
    study.persons.push_back(std::move(result));
    data.trials.clear(), data.other_trials.clear();
    study.settings = std::move(data);
  }
  for (auto& [name, text] : study.facts)
    if (const auto& n = study.sessions; name == "Sessions" && n.counted() != n.found)
      text = fmt::format("{} of {} count; {} were begun again later, {} were not completed", n.counted(),
                         n.found, n.superseded, n.incomplete);
  if (!protocol.task.name.empty()) study.facts.emplace_back("Task", protocol.task.name);
  report::finish_study(study);
  return study;
}

}  // namespace turnpoint::view

#include "station/session/planned_session.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "station/core/texts.hpp"
#include "station/protocol/sources.hpp"
#include "station/store/open.hpp"
#include "station/store/people.hpp"
#include "station/store/read.hpp"
#include "station/store/station.hpp"

namespace turnpoint::session {

std::string describe(const EarlySession& early) {
  return fmt::format(
      "participant {} had session {} on {}, and the protocol asks for at least {} day{} between sessions: "
      "session {} is allowed from {}",
      early.participant, early.last_number, early.last_day, early.min_days, early.min_days == 1 ? "" : "s",
      early.number, early.allowed_from);
}

namespace {

using core::phrase, core::plain;
using std::chrono::sys_days;

/// Returns the day of an ISO 8601 date or date and time; empty if the text does not begin with one.
std::optional<sys_days> day_of(const std::string& date) {
  int year = 0;
  unsigned month = 0, day = 0;
  const auto read = [&](std::size_t from, std::size_t length, auto& number) {
    if (date.size() < from + length) return false;
    const auto* end = date.data() + from + length;
    const auto [stopped, error] = std::from_chars(date.data() + from, end, number);
    return error == std::errc() && stopped == end;
  };
  if (!read(0, 4, year) || !read(5, 2, month) || !read(8, 2, day)) return std::nullopt;
  const std::chrono::year_month_day found{std::chrono::year(year), std::chrono::month(month),
                                          std::chrono::day(day)};
  return found.ok() ? std::optional(sys_days(found)) : std::nullopt;
}

std::string text_of(const sys_days& day) {
  const std::chrono::year_month_day date(day);
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                     static_cast<unsigned>(date.day()));
}

/// True if this session counts as done.
bool counts(const store::SessionRecord& session, const protocol::Protocol& protocol, core::RunMode mode) {
  if (session.start.run_mode != mode || !session.start.planned_session) return false;
  if (session.status == core::SessionStatus::completed) return true;
  return protocol.sessions->incomplete == protocol::Unfinished::count && session.trials > 0 &&
         session.status != core::SessionStatus::running;
}

/// The sessions that a person has had with a protocol.
std::vector<store::SessionRecord> sessions_of(store::Database& database, const store::Bearer& person,
                                              const std::string& protocol_id) {
  const auto mine = store::People(database).same_as(person);
  store::SessionFilter filter;
  filter.protocol_id = protocol_id;
  auto sessions = store::list_sessions(database, filter);
  std::erase_if(sessions, [&](const auto& session) {
    const store::Bearer bearer{session.start.station_id, session.start.participant};
    return std::find(mine.begin(), mine.end(), bearer) == mine.end();
  });
  return sessions;
}

/// Refuses a session that comes too early after the last one.
void check_days(const Setup& setup, const std::vector<const store::SessionRecord*>& done,
                const std::string& today, NextSession& next) {
  const int min_days = setup.protocol.sessions->min_days;
  const auto now = day_of(today);
  if (min_days == 0 || !now || setup.run_mode == core::RunMode::simulated) return;
  const store::SessionRecord* last = nullptr;
  for (const auto* session : done)
    if (!last || day_of(session->start.started_local) >= day_of(last->start.started_local)) last = session;
  const auto before = last ? day_of(last->start.started_local) : std::nullopt;
  if (!before) return;
  const auto first = *before + std::chrono::days(min_days);
  if (*now >= first) return;
  EarlySession early{setup.participant, next.number.value_or(0),
                     text_of(first),    last->start.planned_session.value_or(0),
                     text_of(*before),  min_days};
  if (!setup.early.empty())
    next.overruled = describe(early);
  else
    next.problem = plain(describe(early)), next.too_early = std::move(early),
    next.allowed =
        plain("come back on that day, or give the reason to begin earlier with --early; it is stored");
}

}  // namespace

protocol::Visit visit_of(const store::SessionRecord& session) {
  return {session.sequence_index, session.start.planned_session.value_or(1)};
}

NextSession next_session(const Setup& setup, const std::vector<store::SessionRecord>& earlier,
                         const std::string& today) {
  NextSession next;
  if (!setup.protocol.sessions) {
    if (setup.planned_session || !setup.early.empty())
      next.problem = phrase("refusal.no_planned", {plain(setup.protocol.id)}),
      next.allowed = phrase("refusal.add_sessions");
    return next;
  }
  const int count = setup.protocol.sessions->count;
  std::vector<const store::SessionRecord*> done;
  std::set<int> numbers;
  for (const auto& session : earlier)
    if (counts(session, setup.protocol, setup.run_mode))
      done.push_back(&session), numbers.insert(*session.start.planned_session);
  int number = 1;
  while (numbers.count(number) > 0) ++number;
  next.number = setup.planned_session.value_or(number);
  if (*next.number > count) {
    next.problem =
        setup.planned_session
            ? phrase("refusal.few_sessions", {plain(*next.number), plain(count)})
            : phrase("refusal.all_done", {plain(setup.participant), plain(count), plain(setup.protocol.id)});
    next.allowed = phrase("refusal.repeat_session", {plain(count)});
    return next;
  }
  check_days(setup, done, today, next);
  return next;
}

NextSession next_session(const Setup& setup) {
  std::vector<store::SessionRecord> earlier;
  if (setup.protocol.sessions && std::filesystem::exists(setup.database)) {
    auto database = store::open_reader(setup.database);
    earlier =
        sessions_of(database, {store::station_name(setup.database), setup.participant}, setup.protocol.id);
  }
  return next_session(setup, earlier, local_time());
}

procedure::EarlierTrials earlier_trials(const std::string& database_path, const protocol::Protocol& protocol,
                                        const store::SessionRecord& session) {
  procedure::EarlierTrials earlier;
  const auto continues = [](const auto& spec) { return spec.continues; };
  if (!protocol.sessions || std::ranges::none_of(protocol.procedures, continues) ||
      !std::filesystem::exists(database_path))
    return earlier;
  const auto& start = session.start;
  auto database = store::open_reader(database_path);
  // Of several sessions with the same number, the newest counts.
  std::map<int, const store::SessionRecord*> before;
  const auto all = sessions_of(database, {start.station_id, start.participant}, protocol.id);
  for (const auto& other : all) {
    if (!counts(other, protocol, start.run_mode) || other.session_index >= session.session_index ||
        *other.start.planned_session >= start.planned_session.value_or(0))
      continue;
    auto& newest = before[*other.start.planned_session];
    if (newest == nullptr || newest->session_index < other.session_index) newest = &other;
  }
  for (const auto& [number, other] : before) {
    if (other->start.protocol_version != protocol.version)
      throw core::Refusal(phrase("refusal.other_version", {plain(start.participant), plain(number),
                                                           plain(other->start.protocol_version),
                                                           plain(protocol.id), plain(protocol.version)}));
    trial::add_earlier_trials(protocol, store::read_session(database, *other).blocks, earlier);
  }
  for (const auto& [name, trials] : earlier) {
    const auto& spec = *protocol::find_procedure(protocol, name);
    procedure::continue_from(trials, spec, *procedure::make_procedure(spec, {}, {}));
  }
  return earlier;
}

procedure::EarlierTrials earlier_trials(const Setup& setup, const NextSession& next) {
  store::SessionRecord session;
  session.start.participant = setup.participant;
  session.start.station_id = store::station_name(setup.database);
  session.start.run_mode = setup.run_mode;
  session.start.planned_session = next.number;
  session.session_index = std::numeric_limits<int>::max();
  return earlier_trials(setup.database, setup.protocol, session);
}

std::string local_time() {
  const auto now = ::time(nullptr);
  tm parts{};
  ::localtime_r(&now, &parts);
  char text[40];
  const auto n = ::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S%z", &parts);
  return {text, n};
}

}  // namespace turnpoint::session

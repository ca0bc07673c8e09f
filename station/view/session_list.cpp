#include "station/view/session_list.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>

#include "station/core/fault.hpp"
#include "station/core/letters.hpp"
#include "station/store/read.hpp"

namespace turnpoint::view {

namespace {

using core::lower;

}  // namespace

core::Phrase reason_of_end(const std::string& stored) {
  using core::phrase, core::plain;
  if (stored == core::kLostReason) return phrase("operator.ended_lost");
  if (stored == core::kAbandonedReason) return phrase("operator.ended_empty");
  if (stored == core::kStoppedReason) return phrase("operator.ended_asked");
  if (const std::string last = core::kVoidsLast; stored.starts_with(core::kVoidsReason)) {
    const auto at = stored.find(last);
    if (at == std::string::npos) return phrase("operator.ended_voids");
    return phrase("operator.ended_voids_last", {reason_of_end(stored.substr(at + last.size()))});
  }
  for (const auto kind : core::fault_kinds) {
    const std::string fault = core::describe(kind);
    if (stored == fault) return core::phrase_of({kind, ""});
    if (stored.starts_with(fault + ": ")) return core::phrase_of({kind, stored.substr(fault.size() + 2)});
  }
  return plain(stored);
}

std::vector<SessionLine> session_lines(const std::string& database) {
  if (!std::filesystem::exists(database)) return {};
  auto sessions = store::list_sessions(database);
  std::stable_sort(sessions.begin(), sessions.end(), [](const auto& a, const auto& b) {
    return a.last_activity_realtime_ns > b.last_activity_realtime_ns;
  });
  std::vector<SessionLine> lines;
  for (const auto& session : sessions) {
    const auto& start = session.start;
    // If the program was killed, its session is still marked as running. Treat it as interrupted.
    const bool ended = session.status != store::SessionStatus::interrupted &&
                       session.status != store::SessionStatus::running;
    lines.push_back(
        {session.session_id, session.person, start.participant, start.protocol_id,
         start.protocol_id + " " + start.protocol_version, start.started_local, store::name(start.run_mode),
         session.status == store::SessionStatus::running ? "not ended" : store::name(session.status),
         reason_of_end(session.status_reason), session.trials, session.annotations,
         !ended && session.trials > 0});
  }
  return lines;
}

void put_in_order(std::vector<SessionLine>& newest_first, SessionOrder order) {
  if (order == SessionOrder::newest) return;
  const auto key = order == SessionOrder::study ? &SessionLine::protocol_id : &SessionLine::person;
  std::stable_sort(newest_first.begin(), newest_first.end(),
                   [key](const auto& a, const auto& b) { return a.*key < b.*key; });
}

bool matches(const SessionLine& session, const std::string& search) {
  auto text = session.person + " " + session.participant + " " + session.protocol + " " + session.started +
              " " + session.run_mode + " " + session.status;
  for (const auto& note : session.notes) text += " " + note;
  text = lower(text);
  std::istringstream words(lower(search));
  for (std::string word; words >> word;)
    if (text.find(word) == std::string::npos) return false;
  return true;
}

}  // namespace turnpoint::view

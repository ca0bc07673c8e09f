#include "station/desk/session_list.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>

#include "station/store/read.hpp"

namespace turnpoint::desk {

namespace {

std::string lower(std::string text) {
  for (auto& letter : text) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return text;
}

}  // namespace

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
        {session.session_id, session.person, start.participant,
         start.protocol_id + " " + start.protocol_version, start.started_local, store::name(start.run_mode),
         session.status == store::SessionStatus::running ? "not ended" : store::name(session.status),
         session.status_reason, session.trials, session.annotations, !ended && session.trials > 0});
  }
  return lines;
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

}  // namespace turnpoint::desk

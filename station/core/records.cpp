#include "station/core/records.hpp"

#include <algorithm>

namespace turnpoint::core {

const char* name(SessionStatus status) {
  switch (status) {
    case SessionStatus::running:
      return "running";
    case SessionStatus::completed:
      return "completed";
    case SessionStatus::interrupted:
      return "interrupted";
    case SessionStatus::stopped:
      return "stopped";
    case SessionStatus::abandoned:
      return "abandoned";
  }
  return "";
}

std::string place_name(const std::string& name, int occasion) {
  return name + " " + std::to_string(occasion);
}

std::vector<const EventRow*> standing_answers(const std::vector<EventRow>& events) {
  std::vector<const EventRow*> standing;
  for (const auto& event : events) {
    if (!event.answers.empty()) standing.push_back(&event);
    if (event.kind != kBackEvent) continue;
    const auto last = std::find_if(standing.rbegin(), standing.rend(), [&](const EventRow* one) {
      const auto& answer = one->answers.front();
      return place_name(answer.questionnaire, answer.occasion) == event.value;
    });
    if (last != standing.rend()) standing.erase(std::next(last).base());
  }
  return standing;
}

}  // namespace turnpoint::core

#include "station/records/records.hpp"

namespace turnpoint::records {

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

}  // namespace turnpoint::records

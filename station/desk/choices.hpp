#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/simulation/check.hpp"

namespace turnpoint::desk {

/// A protocol file that an operator may choose.
struct ProtocolEntry {
  std::string path, id, version, title;
  std::vector<std::string> languages;
  std::string problem;  ///< why the file cannot be used; then all other fields except `path` are empty
};

/// The protocol files of a folder by name, including unusable ones. Throws std::system_error if the folder
/// cannot be read.
std::vector<ProtocolEntry> list_protocols(const std::string& folder);

/// Participant codes in the database, in alphabetical order; empty if there is no database yet.
std::vector<std::string> known_participants(const std::string& database);

/// The age of the last good backup of the database, according to its record.
struct BackupNote {
  /// ahead: in the future, because the clock was set back since
  enum class State { none, recent, old, ahead } state = State::none;
  int hours = 0;
  bool operator==(const BackupNote&) const = default;
};
/// A backup is old after 7 days.
BackupNote backup_note(const std::string& database);

/// A session that could be continued.
struct InterruptedNote {
  std::string session_id, participant, protocol_id;
  int trials = 0;
  double age_s = 0;
};
std::optional<InterruptedNote> interrupted_note(const std::string& database);

/// The result of a check in words for a page: a description of the session, and unwanted cues.
struct CheckWords {
  std::vector<std::string> problems, warnings;
  std::vector<std::pair<std::string, std::string>> facts;  ///< (label, value)
  /// A cue, how often an observer who uses only this cue would be right, and whether that is notably above
  /// chance.
  struct Cue {
    std::string name, says;
    bool leaks = false;
  };
  std::vector<Cue> cues;
};
CheckWords words_of(const simulation::Check& check);

/// "3 min", "2 h", "4 days": an age as people say it.
std::string age_in_words(double age_s);

}  // namespace turnpoint::desk

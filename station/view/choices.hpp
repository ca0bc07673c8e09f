#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/core/texts.hpp"
#include "station/rehearsal/check.hpp"

namespace turnpoint::view {

/// What a page says about a cue that could give answers away: its name, and what the researcher can do about
/// it.
struct CueAdvice {
  core::Phrase name, advice;
};
/// Returns what a page says about a cue. `cue` is the name of a rehearsal::CueReport. Throws
/// std::logic_error for any other name.
CueAdvice cue_advice(const std::string& cue);

/// A protocol file that an operator may choose.
struct ProtocolEntry {
  std::string path, id, version, title;
  std::vector<std::string> languages;
  /// why the file cannot be used; if there are any, all other fields except `path` are empty
  std::vector<core::Phrase> problems;
};

/// Returns the protocol files of a folder in the order of their names, including those that cannot be used.
/// Throws std::system_error if the folder cannot be read.
std::vector<ProtocolEntry> list_protocols(const std::string& folder);

/// The folder in which the station saves new studies: the folder with the protocols or, if the program may
/// not write there, the folder `protocols` beside the database.
std::string folder_for_studies(const std::string& protocols, const std::string& database);

/// Returns the protocols of the station: those in its folder, and then those that it has saved beside the
/// database because it may not write in its folder.
std::vector<ProtocolEntry> list_studies(const std::string& protocols, const std::string& database);

/// Participant codes in the database, in alphabetical order; empty if there is no database yet.
std::vector<std::string> known_participants(const std::string& database);

/// The age of the last good backup. It comes from the record that store::last_backup() reads beside the
/// database.
struct BackupNote {
  /// ahead: the backup's time is in the future, because the clock has been set back since
  enum class State { none, recent, old, ahead } state = State::none;
  int hours = 0;
  bool operator==(const BackupNote&) const = default;
};
/// Reads the age of the last backup. A backup is old after 7 days.
BackupNote backup_note(const std::string& database);

/// A session that could be continued.
struct InterruptedNote {
  std::string session_id, participant, protocol_id;
  int trials = 0;
  double age_s = 0;
};
std::optional<InterruptedNote> interrupted_note(const std::string& database);

/// The result of a check as texts for a page: what the session consists of, and which cues could give answers
/// away. Problems, warnings and remarks are about places of a file.
struct CheckWords {
  std::vector<core::Phrase> problems, warnings;
  std::vector<std::string> languages;  ///< those in which a session can be offered on this machine
  /// what the session consists of, as pairs of a label and a value
  std::vector<std::pair<core::Phrase, core::Phrase>> facts;
  /// An unwanted cue: `says` is the proportion correct of an observer who uses nothing but this cue, and
  /// `leaks` is true if that proportion is clearly above chance.
  struct Cue {
    core::Phrase name, says;
    bool leaks = false;
    /// what the researcher can do about the cue; says nothing if the cue does not give answers away
    core::Phrase advice;
  };
  std::vector<Cue> cues;
  /// What the check says about one place of the protocol or of the rig. Problems come first, notes last.
  struct Remark {
    enum class Kind { problem, warning, note } kind = Kind::problem;
    std::string file;  ///< name of the file, without its folder
    int line = 0;      ///< line in the file; 0: the file as a whole
    core::Phrase what, hint;
  };
  std::vector<Remark> remarks;
  /// For each part of the session, by the words for its kind and its name: how many trials it has and how
  /// long it takes, or how many pages it has. The blocks of a sequence have the name of the sequence; a part
  /// that comes several times is said once. Empty if there are problems.
  std::map<std::pair<std::string, std::string>, core::Phrase> lengths;
};
CheckWords words_of(const rehearsal::Check& check);

/// Formats an age as people say it: "3 min old", "2 h old", "4 days old".
std::string age_in_words(double age_s);

}  // namespace turnpoint::view

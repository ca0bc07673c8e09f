#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "station/core/reader.hpp"
#include "station/protocol/key_places.hpp"
#include "station/protocol/protocol.hpp"
#include "station/protocol/protocol_keys.hpp"

// The functions with which load() and parse() read a protocol file, one for each part of the file. A function
// reads its tables into the protocol and reports problems. Call the functions in the order of their
// declaration, because later ones rely on earlier ones.
namespace turnpoint::protocol {

/// The declared keys of a table of a protocol file, such as `task.rating`.
inline const core::Keys& keys_of(const std::string& path) { return core::below(protocol_keys(), path); }

/// While a part of the file is read that asks one of several tasks, `protocol.task` is that task.
struct Reading {
  Protocol& protocol;
  core::Findings& findings;
  const KeyPlaces& places;
  /// names of all scenes in the file, even of those that could not be read
  std::vector<std::string> declared_scenes;
  /// for each table with `for_each`, by its name: the names of the procedures that were made from it
  std::map<std::string, std::vector<std::string>> families = {};
  /// the tasks of a file with several, and which of them each procedure asks, by name
  std::vector<Task> tasks = {};
  std::map<std::string, std::string> asks = {};
};

void read_header(core::TableReader& file, Reading& reading);  ///< Reads `format`, [protocol] and [random].
void read_factors(core::TableReader& file, Reading& reading);
void read_scenes(core::TableReader& file, Reading& reading);
void read_instructions(core::TableReader& file, Reading& reading);
void read_task(core::TableReader& file, Reading& reading);  ///< Reads [task], or all of [tasks].
/// Reads which of several tasks a procedure or block asks. Reports a problem if it does not say so, or if
/// there are not several. Returns the only task if there are not, and one without a name if it is not known
/// which.
Task read_asked(core::TableReader& reader, const Reading& reading);
/// The protocol as each of its tasks sees it, as far as it has been read.
std::vector<Protocol> as_tasks_see(const Reading& reading);
void read_timing(core::TableReader& file, Reading& reading);
void read_payoff(core::TableReader& file, Reading& reading);
void read_procedures(core::TableReader& file, Reading& reading);
void read_sessions(core::TableReader& file, Reading& reading);
void read_plan(core::TableReader& file, Reading& reading);
void read_interludes(core::TableReader& file, Reading& reading);
/// Reads the keys of a block of strokes (kind "training" or "friction-table").
void read_strokes(core::TableReader& block_reader, const std::string& kind, Block& block,
                  const Reading& reading);
/// Reads the keys "sessions" and "groups".
void read_audience(core::TableReader& reader, Audience& audience, const Reading& reading);
void read_break(core::TableReader& block_reader, Block& block, const Reading& reading);
void read_analysis(core::TableReader& file, Reading& reading);
void read_exclusion(core::TableReader& file, Reading& reading);
void read_triggers(core::TableReader& file, Reading& reading);
void read_sensing(core::TableReader& file, Reading& reading);
void read_resume(core::TableReader& file, Reading& reading);

/// Checks what can be checked only when the whole file has been read: values of factors in each trial,
/// answers, pass criteria, deadlines.
void check_whole(core::TableReader& file, Reading& reading);
/// Checks what concerns several tasks: that each is asked, and what blocks of several cannot have.
void check_tasks(const Reading& reading);
/// Checks that a response signal that is part of the stimulus (a tone or a buzz) fits into it.
void check_signal(const Reading& reading);
/// Checks that scenes that follow the finger are whole intervals: not one end of a change, a buzz, or what a
/// friction table is measured with.
void check_follow(const Reading& reading);
/// Checks sessions and groups: that each has blocks, and that nothing depends on what a session does not
/// have.
void check_visits(const Reading& reading);

/// Reads a text in each declared language. Reports a problem for a missing or an undeclared language.
Localised read_localised(core::TableReader& reader, const std::string& key, const Reading& reading);
Localised localised_from(const core::Value& value, const std::string& key, const Reading& reading);

/// Reads the points or the line of a scale, with their labels.
Scale read_scale(const core::Value& table, const std::string& path, const Reading& reading);
/// Reads low, high and decimals of a number that is typed.
ValueAnswer read_typed(core::TableReader& reader);
/// Reads the list `choices`.
std::vector<Choice> read_choice_list(core::TableReader& reader, const std::string& path,
                                     const Reading& reading);
/// Reads the name of a scene. Reports a problem if the file has no such scene.
std::string read_scene_name(core::TableReader& reader, const std::string& key, const Reading& reading);

/// Reads what a scene's gain follows, from its table `follow`.
Follow read_follow(const core::Value& table, const std::string& path, core::Findings& findings,
                   const Reading& reading);

/// Reads a number or an expression of factors; empty if the key is not there.
std::optional<Linear> read_expression(core::TableReader& reader, const std::string& key,
                                      const Reading& reading);

/// Reads a number, an expression of factors, or { uniform = [low, high] }.
std::optional<Distribution> read_distribution(core::TableReader& reader, const std::string& key,
                                              const Reading& reading);

/// Reads a value of a factor and checks it against the factor's range or levels.
std::optional<FactorValue> read_factor_value(const core::Value& value, const Factor& factor,
                                             core::Findings& findings);

/// Returns the factor that `key` names. If there is no such factor or it is not numeric, reports a problem
/// and returns nullptr.
const Factor* read_numeric_factor(core::TableReader& reader, const std::string& key, const Reading& reading);

}  // namespace turnpoint::protocol

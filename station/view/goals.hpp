#pragma once
#include <string>
#include <vector>

namespace turnpoint::view {

/// Something that a researcher can want to measure, and the shipped protocol that measures it.
struct Goal {
  const char* word;  ///< stands for the goal on a command line
  const char* file;  ///< name of the shipped protocol, without .toml
};

/// All goals, in the order in which they are offered.
const std::vector<Goal>& goals();
/// Returns the goal with this word; nullptr if there is none.
const Goal* find_goal(const std::string& word);
/// Returns what the goal measures, in a language of the station.
std::string describe(const Goal& goal, const std::string& language);

/// Turns the text of the goal's shipped protocol into that of a study: gives it its own id, and version
/// 0.1.0, because nothing has been measured with it yet.
std::string study_from(const Goal& goal, const std::string& source, const std::string& id);

}  // namespace turnpoint::view

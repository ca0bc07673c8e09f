#pragma once
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"

// A file with several tasks. Whatever is about one trial, or about one analysis, looks at the protocol as its
// task sees it (Protocol::by_task), so that it knows of one task only. A file with one task has one such
// protocol: itself.
namespace turnpoint::protocol {

/// The protocol as the task with this number sees it.
inline const Protocol& of_task(const Protocol& protocol, std::size_t task) {
  return protocol.by_task.empty() ? protocol : protocol.by_task.at(task);
}

/// The protocol as each of its tasks sees it.
std::vector<const Protocol*> tasks_of(const Protocol& protocol);

/// The number of the task that trials of this procedure ask or, without a procedure, those of this block: the
/// task of its fixed levels, or of its first procedure.
std::size_t task_of(const Protocol& protocol, const std::string& procedure, const std::string& block);

/// The numbers of all tasks that a block asks, in the order of its procedures.
std::vector<std::size_t> tasks_in(const Protocol& protocol, const Block& block);

/// The protocol with one task, its procedures and its blocks alone, to be read or checked like a file with
/// that task. `asks` says which task each procedure asks.
Protocol with_task(const Protocol& whole, const Task& task, const std::map<std::string, std::string>& asks);

/// The number of the task with this name. Throws core::UsageError that lists the tasks if the name is
/// unknown, or "" although the file has several.
std::size_t chosen_task(const Protocol& protocol, const std::string& name);

/// How messages call the table of a task: `[task]` or `[tasks.NAME]`.
std::string table_of(const Task& task);

/// The factors that decide which answer is right, or whether there is a signal.
std::set<std::string> deciding_factors(const Task& task);

/// The path in KeyPlaces of a task's key, such as `task.duration_s` or `tasks.detect.duration_s`.
std::string key_of(const Task& task, const std::string& key);

/// Adds a problem, unless it is there already: what is about the whole file is found with each task.
void add_once(core::Problem problem, std::vector<core::Problem>& problems);

}  // namespace turnpoint::protocol

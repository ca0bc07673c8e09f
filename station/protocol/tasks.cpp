#include "station/protocol/tasks.hpp"

#include <algorithm>
#include <utility>

#include "station/core/usage_error.hpp"
#include "station/protocol/sources.hpp"

namespace turnpoint::protocol {

std::vector<const Protocol*> tasks_of(const Protocol& protocol) {
  if (protocol.by_task.empty()) return {&protocol};
  std::vector<const Protocol*> all;
  for (const auto& one : protocol.by_task) all.push_back(&one);
  return all;
}

std::size_t task_of(const Protocol& protocol, const std::string& procedure, const std::string& block) {
  const auto& all = protocol.by_task;
  for (std::size_t i = 0; i < all.size() && !procedure.empty(); ++i)
    if (find_procedure(all[i], procedure)) return i;
  for (const auto& part : protocol.plan) {
    if (all.empty() || block_of(part).name != block) continue;
    const auto tasks = tasks_in(protocol, block_of(part));
    return tasks.empty() ? 0 : tasks.front();
  }
  return 0;
}

std::vector<std::size_t> tasks_in(const Protocol& protocol, const Block& block) {
  std::vector<std::size_t> tasks;
  const auto add = [&](std::size_t task) {
    if (std::find(tasks.begin(), tasks.end(), task) == tasks.end()) tasks.push_back(task);
  };
  if (protocol.by_task.empty()) return {0};
  for (std::size_t i = 0; i < protocol.by_task.size(); ++i)
    if (!block.task.empty() && protocol.by_task[i].task.name == block.task) add(i);
  for (const auto& name : block.procedures) add(task_of(protocol, name, ""));
  return tasks;
}

Protocol with_task(const Protocol& whole, const Task& task, const std::map<std::string, std::string>& asks) {
  auto one = whole;
  one.by_task.clear();
  one.task = task;
  const auto other = [&](const std::string& procedure) {
    const auto found = asks.find(procedure);
    return found == asks.end() || found->second != task.name;
  };
  std::erase_if(one.procedures, [&](const auto& spec) { return other(spec.name); });
  std::erase_if(one.plan, [&](auto& part) {
    auto* sequence = std::get_if<Sequence>(&part);
    auto& block = sequence ? sequence->block : std::get<Block>(part);
    if (block.kind != BlockKind::trials) return false;
    // a block of several tasks has no catch trials; if it has, that has been reported
    if (std::erase_if(block.procedures, other) > 0) block.catch_trials.reset();
    return block.procedures.empty() && block.task != task.name;
  });
  return one;
}

std::size_t chosen_task(const Protocol& protocol, const std::string& name) {
  const auto all = tasks_of(protocol);
  std::string known;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i]->task.name == name) return i;
    known += (known.empty() ? "" : ", ") + all[i]->task.name;
  }
  if (all.size() == 1) throw core::UsageError("--task " + name + ": the protocol has one task");
  throw core::UsageError(
      (name.empty() ? "the protocol has several tasks" : "there is no task \"" + name + "\"") +
      ("; choose one with --task: " + known));
}

std::string table_of(const Task& task) { return task.name.empty() ? "[task]" : "[tasks." + task.name + "]"; }

std::set<std::string> deciding_factors(const Task& task) {
  std::set<std::string> names;
  const auto add = [&](const Comparison& comparison) {
    for (const auto* side : {&comparison.left, &comparison.right})
      for (const auto& name : factors_in(*side)) names.insert(name);
  };
  for (const auto& [id, comparison] : task.correct_answer) add(comparison);
  if (task.present) add(*task.present);
  return names;
}

std::string key_of(const Task& task, const std::string& key) {
  return (task.name.empty() ? "task." : "tasks." + task.name + ".") + key;
}

void add_once(core::Problem problem, std::vector<core::Problem>& problems) {
  const auto same = [words = core::format(problem)](const auto& other) {
    return core::format(other) == words;
  };
  if (std::none_of(problems.begin(), problems.end(), same)) problems.push_back(std::move(problem));
}

}  // namespace turnpoint::protocol

#include "station/session/programs.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "station/session/program_observer.hpp"
#include "station/session/program_procedure.hpp"

namespace turnpoint::session {

using core::phrase, core::plain;

std::string path_of(const std::string& program, const std::string& protocol_path) {
  return (std::filesystem::absolute(protocol_path).parent_path() / program).lexically_normal().string();
}

std::unique_ptr<procedure::Procedure> Programs::procedure(const procedure::Spec& spec,
                                                          const core::DrawKey& key) {
  return std::make_unique<ProgramProcedure>(
      spec, key, path_of(spec.program.file, protocol_path_), [this, name = spec.name](const Identity& it) {
        add_started({"procedure", name, it.name, it.version, it.path, it.sha256});
      });
}

simulation::Respondent Programs::respondent(const std::string& observer) {
  if (!is_program(observer)) return simulation::Observer(simulation::parse(observer));
  const auto program =
      std::make_shared<ProgramObserver>(parse_program("--observer", observer), [this](const Identity& it) {
        add_started({"observer", "", it.name, it.version, it.path, it.sha256});
      });
  return {[program](const simulation::Question& question) { return program->answer(question); },
          [program](const simulation::Adjustment& adjustment) { return program->adjust(adjustment); }};
}

void Programs::add_started(const core::ProgramRow& program) {
  if (std::ranges::find(started_, program) == started_.end()) started_.push_back(program);
}

std::vector<core::ProgramRow> Programs::take_started() { return std::exchange(started_, {}); }

std::vector<core::Problem> problems_of(const protocol::Protocol& protocol) {
  std::vector<core::Problem> problems;
  Programs programs(protocol.path);
  for (const auto& spec : protocol.procedures) {
    if (spec.kind != procedure::Kind::program) continue;
    try {
      const auto procedure = programs.procedure(spec, procedure::key_of(protocol.seed.value_or(0), 0, 0, 0));
      if (!procedure->next())
        problems.push_back(
            {spec.program.place,
             phrase("procedure \"%1\": the program is done before its first trial", {plain(spec.name)}),
             phrase("a program that gives at least one level")});
    } catch (const core::ProgramFailed& failed) {
      problems.push_back({spec.program.place,
                          phrase("procedure \"%1\": %2", {plain(spec.name), plain(failed.what())}),
                          phrase("a program that works as protocols/programs.md says")});
    }
  }
  return problems;
}

}  // namespace turnpoint::session

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/core/number.hpp"
#include "station/procedure/trace.hpp"
#include "station/protocol/protocol.hpp"
#include "station/session/programs.hpp"

namespace turnpoint::cli {

namespace trace_command {

struct Options {
  std::string protocol, procedure, answers;
  std::uint64_t seed = 0;
};

const procedure::Spec& find(const protocol::Protocol& protocol, const std::string& name) {
  std::string known;
  for (const auto& spec : protocol.procedures) {
    if (spec.name == name) return spec;
    known += (known.empty() ? "" : ", ") + spec.name;
  }
  throw UsageError(
      fmt::format("--procedure {}: the protocol has no such procedure; its procedures are {}", name, known));
}

/// Returns the numbers of levels of the factors with which the procedure runs.
procedure::Context context_of(const protocol::Protocol& protocol) {
  procedure::Context context;
  for (const auto& factor : protocol.factors) context.factor_levels[factor.name] = factor.levels.size();
  return context;
}

void trace(const Options& options, Context& context) {
  const auto protocol = protocol::load(options.protocol);
  const auto& spec = find(protocol, options.procedure);
  session::Programs programs(protocol.path);
  auto around = context_of(protocol);
  around.programs = &programs;
  const auto result = procedure::trace(
      spec, around, options.answers, {options.seed ? options.seed : protocol.seed.value_or(0), {}, 0, 0, 0});
  if (context.json) {
    Json estimates = Json::object();
    for (const auto& [parameter, e] : result.estimates)
      estimates[parameter] = {{"mode", json_number(e.mode)},
                              {"mean", json_number(e.mean)},
                              {"sd", json_number(e.sd)},
                              {"interval", json_interval(e.interval)},
                              {"basis", e.basis.empty() ? Json(nullptr) : Json(e.basis)}};
    Json json{{"levels", json_numbers(result.levels)},
              {"next", json_number(result.next)},
              {"estimates", estimates},
              {"entropy_nats", json_number(result.entropy_nats)},
              {"reversals", json_numbers(result.reversals)}};
    if (spec.second)
      json["second"] = json_numbers(result.second), json["next_second"] = json_number(result.next_second);
    print_json(context.out, json);
    return;
  }
  for (std::size_t i = 0; i < result.levels.size(); ++i)
    fmt::print(context.out, "{:>4} {:>10} {}{}\n", i + 1, core::number(result.levels[i]),
               spec.second ? fmt::format("{:>10} ", core::number(result.second[i])) : "", options.answers[i]);
  fmt::print(context.out, "next {}{}\n",
             result.next ? core::number(*result.next) : "none, because the procedure has stopped",
             result.next_second ? ", " + spec.second->level + " " + core::number(*result.next_second) : "");
  for (const auto& [parameter, e] : result.estimates)
    fmt::print(context.out, "{}: mode {}, mean {}{}{}\n", parameter, core::number(e.mode),
               core::number(e.mean), e.sd ? ", SD " + core::number(*e.sd) : "",
               e.basis.empty() ? "" : ", " + e.basis);
}

}  // namespace trace_command

void add_trace(CommandLine& app, Context& context) {
  using namespace trace_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("trace", "Show the levels that a procedure chooses for given answers");
  add_protocol(*command, options->protocol)->required();
  command->add_option("--procedure", options->procedure, "Name of the procedure")->required();
  command
      ->add_option("--answers", options->answers,
                   "Answers as a row of 1 (correct, or the tracked answer) and 0, as in 1011")
      ->required();
  command
      ->add_option("--seed", options->seed,
                   "Seed for shuffling levels, 0 to 2^53; by default the seed in the protocol file, or 0")
      ->check(range(0, 9007199254740992));
  add_json(*command, context);
  command->footer("Example: turnpoint trace friction-2ifc --procedure threshold --answers 11101");
  command->callback([options, &context] { trace(*options, context); });
}

}  // namespace turnpoint::cli

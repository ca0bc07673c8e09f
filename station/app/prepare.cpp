#include "station/app/prepare.hpp"

#include <algorithm>
#include <regex>

namespace turnpoint::app {

namespace {

using text::Problem;

void check_participant(const std::string& code, std::vector<Problem>& problems) {
  static const std::regex allowed("[A-Za-z0-9][A-Za-z0-9_-]{0,31}");
  if (!std::regex_match(code, allowed))
    problems.push_back(
        {{},
         "--participant \"" + code + "\" is not a code",
         "1 to 32 letters, digits, - and _ are allowed, the first a letter or digit; no names"});
}

std::string choose_language(const std::string& wanted, const protocol::Protocol& protocol,
                            std::vector<Problem>& problems) {
  if (wanted.empty()) return protocol.languages.front();
  const auto& known = protocol.languages;
  if (std::find(known.begin(), known.end(), wanted) != known.end()) return wanted;
  std::string list;
  for (const auto& language : known) list += (list.empty() ? "" : ", ") + language;
  problems.push_back({{}, "--language " + wanted + ": the protocol does not have it", "it has " + list});
  return wanted;
}

/// A live session needs what a pilot may do without: a measured friction table.
void check_live(const rig::Rig& rig, std::vector<Problem>& problems) {
  if (!rig.friction.measured)
    problems.push_back({{rig.path, 0, 0},
                        "--mode live: the rig's friction is the illustrative curve",
                        "give [friction] a measured table_csv, or run with --mode pilot"});
  if (rig.reproduction)
    problems.push_back({{rig.path, 0, 0},
                        "--mode live: this rig reproduces a historical one",
                        "live sessions need a rig with reproduction = false"});
}

}  // namespace

session::Setup prepare(const RunRequest& request) {
  session::Setup setup;
  std::vector<Problem> problems;
  const auto gather = [&problems](auto&& load) {
    try {
      load();
    } catch (const text::BadInput& bad) {
      problems.insert(problems.end(), bad.problems().begin(), bad.problems().end());
    }
  };
  gather([&] { setup.rig = rig::load(request.rig); });
  gather([&] { setup.protocol = protocol::load(request.protocol); });
  check_participant(request.participant, problems);
  if (!problems.empty()) throw text::BadInput(problems);

  setup.language = choose_language(request.language, setup.protocol, problems);
  const auto on_rig = protocol::check_against(setup.protocol, setup.rig);
  problems.insert(problems.end(), on_rig.begin(), on_rig.end());
  if (request.observer.empty() && request.mode == "live") check_live(setup.rig, problems);
  if (!problems.empty()) throw text::BadInput(problems);

  setup.participant = request.participant;
  setup.database = request.database;
  setup.observer = request.observer;
  setup.seed = request.seed;
  setup.consent_version = request.consent_version;
  setup.run_mode = !request.observer.empty() ? store::RunMode::simulated
                   : request.mode == "live"  ? store::RunMode::live
                                             : store::RunMode::pilot;
  return setup;
}

}  // namespace turnpoint::app

#include "station/session/prepare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>
#include <regex>
#include <utility>

#include "station/core/number.hpp"
#include "station/core/texts.hpp"
#include "station/core/toml.hpp"
#include "station/core/usage_error.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/survey.hpp"
#include "station/protocol/tasks.hpp"
#include "station/rig/apply.hpp"
#include "station/scene/sound.hpp"
#include "station/session/exposure.hpp"
#include "station/session/planned_session.hpp"
#include "station/session/programs.hpp"
#include "station/session/self_test.hpp"

namespace turnpoint::session {
namespace {

using core::phrase, core::plain;
using core::Problem;

const std::string kLiveOption = "--mode live: ";

void check_participant(const std::string& code, std::vector<Problem>& problems) {
  static const std::regex allowed("[A-Za-z0-9][A-Za-z0-9_-]{0,31}");
  if (!std::regex_match(code, allowed))
    problems.push_back({{}, phrase("refusal.not_a_code", {plain(code)}), phrase("refusal.code_rule")});
}

std::string choose_language(const std::string& wanted, const protocol::Protocol& protocol,
                            std::vector<Problem>& problems) {
  if (wanted.empty()) return protocol.languages.front();
  const auto& known = protocol.languages;
  if (std::find(known.begin(), known.end(), wanted) != known.end()) return wanted;
  std::string list;
  for (const auto& language : known) list += (list.empty() ? "" : ", ") + language;
  problems.push_back({{},
                      phrase("refusal.other_language", {plain(wanted)}),
                      phrase("refusal.has_languages", {plain(list)})});
  return wanted;
}

/// True if the calibration contains a transducer response, as a live session requires. A calibration may
/// contain nothing but the latency of the touch panel.
bool has_response(const Setup& setup) {
  return !setup.calibration_text.empty() &&
         !rig::parse_calibration(setup.calibration_text, "calibration").transducers.empty();
}

/// Returns a problem if some tones have no measured sound level and their computed bound is unknown or
/// exceeds the recommended limit.
std::optional<core::Phrase> unmeasured_sound(const Setup& setup, const protocol::Sight& sight) {
  const auto measured = [&](const physics::Tone& tone) {
    return session::sound_measured(tone.frequency_Hz, setup.sound);
  };
  if (std::all_of(sight.tones.begin(), sight.tones.end(), measured)) return std::nullopt;
  const auto bound = scene::sound_bound(setup.rig, sight.tones, sight.field_model);
  if (bound && bound->level_dB <= bound->allowed_dB) return std::nullopt;
  if (!bound) return phrase("refusal.sound_unknown");
  return phrase("refusal.sound_bound", {plain(fmt::format("{:.1f}", 1e-3 * bound->frequency_Hz)),
                                        plain(fmt::format("{:.0f}", bound->level_dB)),
                                        plain(fmt::format("{}", scene::kEarDistance_m)),
                                        plain(fmt::format("{}", bound->allowed_dB))});
}

/// Checks what only a live session requires: a measured friction table, a rig that is not the reproduction of
/// a historical one, a calibration, the mixer's levels of that calibration and, for every scene, airborne
/// sound that was measured or whose computed bound is within the recommended limit.
std::vector<Problem> check_live(const Setup& setup, const protocol::Survey& survey) {
  const auto& rig = setup.rig;
  std::vector<Problem> problems;
  const auto add = [&](const core::Phrase& reason, const core::Phrase& allowed) {
    problems.push_back({{rig.path, 0, 0}, {"", kLiveOption, {reason}}, allowed});
  };
  const auto measures = [](const auto& part) {
    const auto& block = protocol::block_of(part);
    return block.kind == protocol::BlockKind::friction_table && block.strokes.used;
  };
  if (!rig.friction.measured && !std::ranges::any_of(setup.protocol.plan, measures))
    add(phrase("refusal.friction"), phrase("refusal.measure_friction"));
  if (rig.reproduction) add(phrase("refusal.reproduction"), phrase("refusal.no_reproduction"));
  if (!has_response(setup) && rig.amplifier_uri != "sim:")
    add(phrase("refusal.no_calibration"), phrase("refusal.make_calibration", {plain(rig.path)}));
  for (const auto& change : session::read_mixer(rig).changes) add(change, phrase("refusal.mixer"));
  for (const auto& sight : survey.sights) {
    // Use an amplitude near 0, so that this checks only whether the level was measured. Whether the sound is
    // too loud depends on each tone's amplitude and is checked in the trial.
    auto problem = session::sound_problem(sight.lowest_Hz, 1e-9, setup.sound);
    if (!problem) problem = unmeasured_sound(setup, sight);
    if (!problem) continue;
    add(phrase("refusal.scene", {plain(sight.scene), *problem}), phrase("refusal.measure_sound"));
    break;
  }
  return problems;
}

void check_buttons_only(const Setup& setup, std::vector<Problem>& problems) {
  if (!setup.rig.buttons_uri)
    problems.push_back(
        {{setup.rig.path, 0, 0}, phrase("refusal.no_buttons"), phrase("refusal.need_buttons")});
  for (const auto* one : protocol::tasks_of(setup.protocol))
    if (const auto& task = one->task; task.device == protocol::Device::touch)
      problems.push_back({task.device_place, phrase("refusal.by_touch"), phrase("refusal.set_device")});
  if (const auto& signal = setup.protocol.timing.signal; signal && !protocol::in_stimulus(*signal))
    problems.push_back(
        {signal->by_place, phrase("refusal.signal_on_screen"), phrase("refusal.signal_elsewhere")});
}

}  // namespace

void take_calibration(const std::string& source, const std::string& path, Setup& setup) {
  const auto calibration = rig::parse_calibration(source, path);
  setup.rig = rig::applied(calibration, std::move(setup.rig));
  setup.calibration_id = core::sha256(source);
  setup.calibration_text = source;
  if (calibration.panel && calibration.panel->touch) {
    setup.response_offset_s = calibration.panel->touch->median_s;
    setup.response_offset_quality = calibration.panel->quality;
  }
  if (calibration.panel && calibration.panel->flash)
    setup.display_latency_s = calibration.panel->flash->median_s;
  for (const auto& point : calibration.sound) setup.sound.push_back({point.frequency_Hz, point.level_dB});
}

namespace {

/// Loads the calibration that was named, or the newest one beside the rig file.
std::vector<Problem> find_calibration(const RunRequest& request, Setup& setup) {
  const auto path = request.calibration.empty() ? rig::newest_for(setup.rig.path) : request.calibration;
  if (path.empty()) return {};
  const auto source = core::read_text_file(path);
  const auto faults = rig::problems(rig::parse_calibration(source, path), setup.rig.sha256, rig::today());
  const bool live = request.observer.empty() && request.mode == "live";
  if (faults.empty()) take_calibration(source, path, setup);
  if (request.calibration.empty() && !live) return {};
  std::vector<Problem> problems;
  for (const auto& fault : faults)
    problems.push_back({{path, 0, 0}, fault, phrase("refusal.calibrate_again")});
  return problems;
}

}  // namespace

rig::Rig calibrated_rig(const std::string& rig_path, const std::string& named, std::ostream& messages) {
  auto rig = rig::load(rig_path);
  const auto path = named.empty() ? rig::newest_for(rig_path) : named;
  if (path.empty()) return rig;
  const auto calibration = rig::load_calibration(path);
  const auto faults = rig::problems(calibration, rig.sha256, rig::today());
  if (!faults.empty() && !named.empty())
    throw core::UsageError(path + ": " + core::say(faults.front(), "en"));
  if (!faults.empty()) return rig;
  messages << "calibration " << path << "\n";
  return rig::applied(calibration, std::move(rig));
}

Setup prepare(const RunRequest& request, const std::stop_token& stop) {
  Setup setup;
  std::vector<Problem> problems;
  const auto refuse = [&problems](const std::vector<Problem>& more) {
    problems.insert(problems.end(), more.begin(), more.end());
  };
  const auto gather = [&problems](auto&& load) {
    try {
      load();
    } catch (const core::BadInput& bad) {
      problems.insert(problems.end(), bad.problems().begin(), bad.problems().end());
    }
  };
  gather([&] { setup.rig = rig::load(request.rig); });
  gather([&] { setup.protocol = protocol::load(request.protocol); });
  check_participant(request.participant, problems);
  if (!problems.empty()) throw core::BadInput(problems);

  setup.language = choose_language(request.language, setup.protocol, problems);
  gather([&] { refuse(find_calibration(request, setup)); });
  const auto survey = protocol::survey(setup.protocol, setup.rig, stop);
  problems.insert(problems.end(), survey.problems.begin(), survey.problems.end());
  if (request.observer.empty() && request.mode == "live") refuse(check_live(setup, survey));
  if (request.observer.empty() && request.buttons_only) check_buttons_only(setup, problems);
  setup.participant = request.participant;
  setup.database = request.database;
  setup.observer = session::located(request.observer);
  setup.planned_session = request.planned_session;
  setup.early = request.early;
  setup.seed = request.seed;
  setup.consent_version = request.consent_version;
  setup.conditions = request.conditions;
  if (!request.cleaned.empty()) setup.conditions.surface_cleaned = request.cleaned == "yes";
  setup.self_test = request.self_test;
  setup.despite = request.despite;
  setup.run_mode = !request.observer.empty() ? core::RunMode::simulated
                   : request.mode == "live"  ? core::RunMode::live
                                             : core::RunMode::pilot;
  const auto next = request.participant != kCodeToCome ? session::next_session(setup) : NextSession{};
  if (!next.problem.empty() && !next.too_early) problems.push_back({{}, next.problem, next.allowed});
  try {
    if (problems.empty()) session::earlier_trials(setup, next);
  } catch (const core::UsageError& refused) {
    problems.push_back({{}, core::phrase_of(refused), phrase("refusal.same_version")});
  }
  if (problems.empty()) problems = session::problems_of(setup.protocol);
  if (problems.empty() && next.too_early) throw TooEarly({{}, next.problem, next.allowed}, *next.too_early);
  if (next.too_early) problems.push_back({{}, next.problem, next.allowed});
  if (!problems.empty()) throw core::BadInput(std::move(problems));
  return setup;
}

std::vector<core::Phrase> live_problems(const RunRequest& request, const std::stop_token& stop) {
  std::vector<core::Phrase> reasons;
  try {
    prepare(request, stop);
  } catch (const core::BadInput& bad) {
    for (const auto& problem : bad.problems())
      reasons.push_back(problem.what.words == kLiveOption ? problem.what.values.front() : problem.what);
  }
  return reasons;
}

}  // namespace turnpoint::session

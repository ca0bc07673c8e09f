#include "station/protocol/survey.hpp"

#include <algorithm>
#include <future>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "physics/boundary_map.hpp"
#include "station/core/limits.hpp"
#include "station/core/number.hpp"
#include "station/core/parts.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/carrier_advice.hpp"
#include "station/protocol/combinations.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/key_places.hpp"
#include "station/protocol/needs.hpp"
#include "station/protocol/orders.hpp"
#include "station/protocol/resolve.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/tasks.hpp"
#include "station/scene/following.hpp"
#include "station/scene/planner.hpp"
#include "station/scene/transducer.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

// Limits of the number of plans, because a check should feel immediate: planning a zone takes about 15 ms, a
// boundary less than 2 ms. A zone that depends on a single expression needs only a few plans, because results
// between them can be interpolated. Other zones need a grid of plans.
constexpr std::size_t most_plans_of_a_scene = 120, most_plans_of_a_zone = 6, most_plans_of_a_zone_grid = 36;

// Returns a text for messages that says where this rig can place a boundary that is defined in the same way
// as the scene's edge.
core::Phrase reach(const scene::Scene& scene, const rig::Rig& rig, const scene::Planner& planner) {
  if (!scene.boundary_m) return {};
  physics::MapOptions options;
  options.edge = scene.edge;
  if (scene.edge.kind == physics::Edge::Kind::friction)
    options.friction = physics::FrictionContext{planner.friction(), scene.displacement_m.value_or(1e-6),
                                                rig.friction.fingertip_m};
  const double low_Hz = scene::lowest_frequency(rig, 0),
               high_Hz = scene::highest_frequency(rig, core::kHighestShareOfRate * rig.output.rate_Hz);
  auto in_band = options;
  in_band.band = {low_Hz, high_Hz};
  physics::Reach reach{};
  try {
    reach = physics::boundary_reach_m(planner.surface(), in_band);
  } catch (const std::domain_error&) {
    // Without tones that this rig can play, all frequencies say whether the edge exists at all.
    physics::boundary_reach_m(planner.surface(), options);
    return phrase("this rig cannot present any boundary with this edge");
  }
  return phrase("with this edge the rig can present boundaries from %1 to %2 mm (%3 to %4 kHz)",
                {plain(core::number(1e3 * reach.first_m, 4)), plain(core::number(1e3 * reach.last_m, 4)),
                 plain(core::number(1e-3 * low_Hz, 4)), plain(core::number(1e-3 * high_Hz, 4))});
}

Sight sight_of(const Combination& combination, const scene::DrivePlan& plan) {
  Sight sight;
  sight.scene = combination.scene, sight.block = combination.block, sight.factors = combination.factors;
  for (const auto& tone : plan.tones) {
    sight.lowest_Hz = sight.lowest_Hz == 0 ? tone.frequency_Hz : std::min(sight.lowest_Hz, tone.frequency_Hz);
    sight.highest_Hz = std::max(sight.highest_Hz, tone.frequency_Hz);
    sight.tones.push_back(tone);
  }
  if (plan.boundary_m) sight.boundary_mm = 1e3 * *plan.boundary_m;
  sight.displacement_um = 1e6 * plan.peak_displacement_m;
  sight.lowest_friction = plan.lowest_friction;
  sight.model = physics::name(plan.model);
  sight.field_model = plan.model;
  sight.error_bound_mm = 1e3 * plan.error_bound_m;
  sight.uncertainty_mm = 1e3 * plan.uncertainty_m;
  sight.inside_tolerance = plan.inside_tolerance;
  sight.cues = plan.cues;
  return sight;
}

// A problem that may occur in several combinations. It is reported once, with the first combination and the
// number of the others.
struct Trouble {
  core::Phrase first, allowed;
  Place place = {};
  int cases = 0;
};

std::vector<Combination> planned(const Protocol& protocol, const std::vector<Combination>& all) {
  std::vector<Combination> chosen;
  for (const auto& name : scenes_used(protocol)) {
    std::vector<Combination> of_scene;
    for (const auto& combination : all)
      if (combination.scene == name) of_scene.push_back(combination);
    const auto& scene = protocol.scenes.at(name);
    const auto most = !scene.zone && !scene.follow ? most_plans_of_a_scene
                      : only_expression(scene)     ? most_plans_of_a_zone
                                                   : most_plans_of_a_zone_grid;
    const auto some = thinned(scene, of_scene, most);
    chosen.insert(chosen.end(), some.begin(), some.end());
  }
  return chosen;
}

// The planner's answer for one combination: a plan, or the reason why there is none.
struct Answer {
  std::optional<scene::DrivePlan> plan;
  std::optional<scene::Cues> cues_roved_down;
  core::Phrase refused;
  std::optional<scene::Scene> refused_scene;
  bool follow_refused = false;  ///< the scene could be presented if it did not follow the finger
  Place place;                  ///< place in the file of the key that the rig cannot satisfy
};

bool can_plan(const scene::Scene& scene, scene::Planner& planner) {
  try {
    planner.plan(scene);
    return true;
  } catch (const scene::Unreachable&) {
    return false;
  }
}

// True if the scene can be planned with a thousandth of its strength: then the strength is what prevents
// planning.
bool is_too_strong(scene::Scene scene, scene::Planner& planner) {
  scene.rove_dB -= 60;
  return can_plan(scene, planner);
}

// Returns the place of a scene's key, or its place in the base scene if the scene takes the key from there.
Place place_of(const Protocol& protocol, const KeyPlaces& places, const Scene& scene,
               const std::string& key) {
  const auto* at = &scene;
  while (!places.has("scene." + at->name + "." + key) && protocol.scenes.count(at->base))
    at = &protocol.scenes.at(at->base);
  return places.of("scene." + at->name + "." + key);
}

// Returns the place of the key that sets the scene's strength.
Place strength_place(const Scene& scene) {
  if (scene.displacement_um) return scene.displacement_um->place;
  if (scene.displacement_under_finger_um) return scene.displacement_under_finger_um->place;
  if (scene.friction_contrast_dB) return scene.friction_contrast_dB->place;
  if (scene.friction) return scene.friction->place;
  if (scene.zone && scene.zone->friction) return scene.zone->friction->place;
  const SceneTone* strongest = nullptr;
  for (const auto& tone : scene.tones)
    if (!strongest || tone.displacement_um.constant > strongest->displacement_um.constant) strongest = &tone;
  return strongest ? strongest->displacement_um.place : scene.place;
}

// Returns the place of the key to blame if a scene cannot be planned: its strength, one of its tones, the
// edge or the start of its zone, or else its boundary.
Place blamed_place(const Protocol& protocol, const KeyPlaces& places, const Scene& from,
                   const scene::Scene& scene, scene::Planner& planner) {
  if (is_too_strong(scene, planner)) return strength_place(from);
  if (scene.under_finger && from.finger_mm) {
    auto free = scene;
    free.displacement_m = 1e-9;
    free.under_finger.reset();
    if (can_plan(free, planner)) return from.finger_mm->place;
  }
  for (std::size_t i = 0; i < scene.tones.size(); ++i) {
    auto alone = scene;
    alone.tones = {scene.tones[i]};
    const auto& place = from.tones[i].boundary_mm ? from.tones[i].boundary_mm : from.tones[i].frequency_Hz;
    if (!can_plan(alone, planner)) return place->place;
  }
  const auto at = [&](const char* key) { return place_of(protocol, places, from, key); };
  if (scene.zone && from.edge.friction && *from.edge.friction <= scene.zone->friction) return at("edge");
  const bool on_surface = scene.boundary_m && *scene.boundary_m < planner.surface().length_m;
  if (scene.zone && on_surface && scene.zone->from_m >= *scene.boundary_m) return at("zone");
  return from.boundary_mm ? from.boundary_mm->place : from.place;
}

void plan_range(const Protocol& protocol, const std::vector<Combination>& combinations, std::size_t begin,
                std::size_t end, scene::Planner& planner, std::vector<Answer>& answers,
                const std::stop_token& stop, const std::function<void()>& planned) {
  std::set<std::string> explained;
  const KeyPlaces places(protocol.source, protocol.path);
  for (std::size_t i = begin; i < end && !stop.stop_requested(); ++i) {
    const auto& combination = combinations[i];
    const auto& from = protocol.scenes.at(combination.scene);
    // Plan with the largest strength that rove_dB allows: the limits must hold for the strongest stimulus
    // that can be drawn.
    scene::Scene scene;
    bool resolved = false;  // else the scene is empty
    try {
      scene = resolve(protocol, combination.scene, combination.factors, from.rove_dB);
      resolved = true;
      answers[i].plan = planner.plan(scene);
      if (edge_moves_with_strength(from))
        answers[i].cues_roved_down =
            planner.plan(resolve(protocol, combination.scene, combination.factors, -from.rove_dB)).cues;
    } catch (const scene::Unreachable& error) {
      answers[i].refused = error.why();
      answers[i].refused_scene = scene;
      answers[i].place = from.place;
      if (from.follow) {
        auto still = scene;
        still.follow.reset();
        answers[i].follow_refused = !resolved || can_plan(still, planner);
      }
      if (answers[i].follow_refused)
        answers[i].place = from.follow->place;
      else if (explained.insert(combination.scene).second)
        try {
          answers[i].place = blamed_place(protocol, places, from, scene, planner);
        } catch (const std::domain_error&) {  // this rig cannot present any boundary with this kind of edge
        }
    }
    planned();
  }
}

// Plans all combinations. A planner caches its maps, and neighbouring combinations need similar ones. So the
// first combination is planned alone, which fills the cache; then two threads plan half of the others each,
// one of them with a copy of the planner.
std::vector<Answer> plan_all(const Protocol& protocol, const rig::Rig& rig,
                             const std::vector<Combination>& combinations, const std::stop_token& stop,
                             const std::function<void(int done, int of)>& progress) {
  std::vector<Answer> answers(combinations.size());
  const auto count = combinations.size(), begun = std::min<std::size_t>(1, count), half = (count + begun) / 2;
  std::mutex mutex;
  int done = 0;
  const auto planned = [&] {
    const std::lock_guard lock(mutex);
    ++done;
    if (progress) progress(done, static_cast<int>(count));
  };
  scene::Planner planner(rig);
  plan_range(protocol, combinations, 0, begun, planner, answers, stop, planned);
  auto second = std::async(std::launch::async, [&, other = planner]() mutable {
    plan_range(protocol, combinations, half, count, other, answers, stop, planned);
  });
  plan_range(protocol, combinations, begun, half, planner, answers, stop, planned);
  second.get();
  if (stop.stop_requested()) throw Abandoned();
  return answers;
}

// What the rig could present instead of scenes that it cannot present. Scenes with the same edge have the
// same answer, and finding it takes as long as planning many scenes.
class Reaches {
 public:
  explicit Reaches(const rig::Rig& rig) : rig_(rig) {}

  core::Phrase of(const scene::Scene& scene) {
    if (!planner_) planner_.emplace(rig_);
    auto key = physics::format(scene.edge);
    if (scene.edge.kind == physics::Edge::Kind::friction)
      key += " " + core::exact(scene.displacement_m.value_or(0));
    if (scene.boundary_m) key += " boundary";
    const auto [found, is_new] = known_.try_emplace(key);
    if (is_new) try {
        found->second = reach(scene, rig_, *planner_);
      } catch (const std::domain_error&) {  // no boundary with this kind of edge: there is nothing to suggest
      }
    return found->second;
  }

 private:
  const rig::Rig& rig_;
  std::optional<scene::Planner> planner_;
  std::map<std::string, core::Phrase> known_;
};

void plan_scenes(const Protocol& protocol, const rig::Rig& rig, const std::stop_token& stop,
                 const std::function<void(int done, int of)>& progress, Survey& survey) {
  const auto all = combinations_of(protocol);
  survey.combinations = all.size();
  const auto combinations = planned(protocol, all);
  const auto answers = plan_all(protocol, rig, combinations, stop, progress);
  std::map<std::string, Trouble> unreachable, inexact, unmet;
  std::map<std::string, core::Phrase> remarks;  // the first one on each scene
  Reaches reaches(rig);
  // the text of the first warning with each warning code, because each code is reported only once
  std::map<std::string, core::Phrase> told;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const auto& combination = combinations[i];
    if (!answers[i].plan) {
      auto& trouble = unreachable[combination.scene];
      if (trouble.cases++ == 0)
        trouble = {in_case(combination, answers[i].refused),
                   answers[i].follow_refused ? core::Phrase{} : reaches.of(*answers[i].refused_scene),
                   answers[i].place, 1};
      continue;
    }
    const auto& plan = *answers[i].plan;
    survey.sights.push_back(sight_of(combination, plan));
    survey.sights.back().cues_roved_down = answers[i].cues_roved_down;
    survey.models.emplace(physics::name(plan.model));
    if (!plan.inside_tolerance && inexact[combination.scene].cases++ == 0)
      inexact[combination.scene].first = in_case(combination, plan.beyond_tolerance);
    if (plan.follow && !remarks.count(combination.scene))
      if (const auto remark = scene::remark_on(rig, plan))
        remarks.emplace(combination.scene, in_case(combination, *remark));
    if (plan.follow)
      for (const auto& stretch : scene::unmet_of(plan))
        if (unmet[combination.scene].cases++ == 0)
          unmet[combination.scene].first = in_case(combination, scene::in_words(plan, stretch));
    for (const auto& warning : plan.warnings)
      told.emplace(warning.code, in_case(combination, rig::phrase_of(warning)));
  }
  for (const auto& [name, trouble] : unreachable)
    survey.problems.push_back({trouble.place, counted(trouble.first, trouble.cases), trouble.allowed});
  for (const auto& [name, trouble] : inexact)
    survey.warnings.push_back({protocol.scenes.at(name).place, counted(trouble.first, trouble.cases),
                               phrase("no physical model is known to meet the scene's tolerance")});
  for (const auto& [name, remark] : remarks)
    survey.warnings.push_back({protocol.scenes.at(name).follow->place, remark, {}});
  for (const auto& [name, trouble] : unmet)
    survey.warnings.push_back(
        {protocol.scenes.at(name).follow->place, counted(trouble.first, trouble.cases),
         phrase(
             "where the finger feels something else, that is in the data: use a stronger scene, or keep the "
             "finger in a stretch")});
  // this rig reproduces an historical one, whose weaknesses are known, so leave out the planner's warnings
  if (rig.reproduction) return;
  for (const auto& [code, warning] : told) survey.warnings.push_back({{protocol.path, 0, 0}, warning, {}});
}

/// A part of a trial as the finger feels it, and the silence before it.
struct Felt {
  double silence_s = 0, length_s = 0;
  std::size_t interval = 0;
  const Part* part = nullptr;
};

/// The longest vibration of a trial without a rest, the longest within any minute, and where each ends.
struct Longest {
  double run_s = 0, minute_s = 0;
  const Part* run_part = nullptr;
  bool over_intervals = false;  ///< whether the run goes over the pause between two intervals
  /// the longest vibration within any minute if the participant asks for the intervals as often as allowed
  double again_minute_s = 0;
};

void lengthen(const std::vector<Felt>& trial, Longest& longest) {
  double end_s = 0, run_s = 0;
  std::size_t run_interval = 0;
  std::vector<std::pair<double, double>> presented;
  for (const auto& felt : trial) {
    const bool rests = presented.empty() || felt.silence_s >= core::kRest_s;
    if (rests) run_interval = felt.interval;
    run_s = (rests ? 0 : run_s + felt.silence_s) + felt.length_s;
    if (run_s > longest.run_s + 1e-9)
      longest = {run_s, longest.minute_s, felt.part, run_interval != felt.interval, longest.again_minute_s};
    presented.emplace_back(end_s + felt.silence_s, end_s + felt.silence_s + felt.length_s);
    end_s = presented.back().second;
    double minute_s = 0;
    for (const auto& [on_s, off_s] : presented)
      minute_s += std::max(0.0, off_s - std::max(on_s, end_s - core::kExposureWindow_s));
    longest.minute_s = std::max(longest.minute_s, minute_s);
  }
}

/// A trial whose intervals are presented so many times again, each time at once after the cue.
std::vector<Felt> repeated(const std::vector<Felt>& trial, int again) {
  static_assert(kCue_s >= core::kRest_s, "the finger rests before the intervals are presented again");
  auto all = trial;
  for (int i = 0; i < again; ++i)
    for (auto felt : trial) {
      if (felt.part == trial.front().part && felt.interval == 0) felt.silence_s += kCue_s;
      all.push_back(felt);
    }
  return all;
}

/// The longest vibration of a trial, over all orders of its intervals, with and without a long first part, at
/// the ends of the ranges of the factors.
Longest longest_of(const Protocol& protocol, std::vector<std::vector<std::vector<Part>>>& orders) {
  const auto& task = protocol.task;
  for (const auto& order : orders_of(task)) orders.push_back(parts_of_trial(task, order.intervals));
  const auto times = stimulus_times(task);
  std::vector<const Linear*> expressions;
  for (const auto& time : times) expressions.push_back(&time);
  Longest longest;
  for (const auto& corner : corners(expressions, protocol.factors))
    for (const auto& intervals : orders)
      for (bool fresh : {false, true}) {
        std::vector<Felt> trial;
        for (std::size_t i = 0; i < intervals.size(); ++i) {
          double silence_s = i > 0 && task.gap_s ? evaluate(*task.gap_s, corner) : 0;
          for (const auto& part : intervals[i]) {
            for (const auto& silence : part.silences_s) silence_s += evaluate(silence, corner);
            const auto* length = length_of(task, part);
            double length_s = length ? evaluate(*length, corner) : protocol.timing.explore_s.value_or(0);
            if (fresh && part.first_s) length_s = *part.first_s, fresh = false;  // only one part is longer
            trial.push_back({std::exchange(silence_s, 0), length_s, i, &part});
          }
        }
        lengthen(trial, longest);
        Longest again;
        lengthen(repeated(trial, task.again), again);
        longest.again_minute_s = std::max(longest.again_minute_s, again.minute_s);
      }
  return longest;
}

void check_limits(const Protocol& protocol, const rig::Rig& rig, Survey& survey) {
  const auto& task = protocol.task;
  const KeyPlaces places(protocol.source, protocol.path);
  std::vector<std::vector<std::vector<Part>>> orders;
  const auto longest = longest_of(protocol, orders);
  if (longest.run_part == nullptr) return;
  const auto& part = *longest.run_part;
  const std::string parts_key = key_of(task, places.has(key_of(task, "parts")) ? "parts" : "before");
  const std::string key = longest.over_intervals             ? key_of(task, "gap_s")
                          : part.duration_s || part.first_s  ? parts_key
                          : length_of(task, part) != nullptr ? key_of(task, "duration_s")
                                                             : "timing.explore_s";
  if (longest.run_s > rig.limits.continuous_s + 1e-9)
    survey.problems.push_back(
        {places.of(key),
         phrase("tones last up to %1 s without a pause", {plain(core::number(longest.run_s))}),
         phrase("the rig allows at most continuous_s = %1 s",
                {plain(core::number(rig.limits.continuous_s))})});
  const double most_s = rig.limits.duty * core::kExposureWindow_s;
  if (longest.minute_s > most_s + 1e-9)
    survey.problems.push_back(
        {places.of(task.parts.empty() && task.before.empty() ? key : parts_key),
         phrase("the tones of a trial last up to %1 s in %2 s",
                {plain(core::number(longest.minute_s)), plain(core::number(core::kExposureWindow_s))}),
         phrase("the rig allows at most %1 s (duty = %2)",
                {plain(core::number(most_s)), plain(core::number(rig.limits.duty))})});
  else if (longest.again_minute_s > most_s + 1e-9)
    survey.warnings.push_back({places.of(key_of(task, "again")),
                               phrase("the tones of a trial that is presented %1 times would last up to %2 s "
                                      "in %3 s: people wait until "
                                      "the rig's limits allow them",
                                      {plain(task.again + 1), plain(core::number(longest.again_minute_s)),
                                       plain(core::number(core::kExposureWindow_s))}),
                               phrase("the rig allows at most %1 s without a wait (duty = %2)",
                                      {plain(core::number(most_s)), plain(core::number(rig.limits.duty))})});
}

}  // namespace

namespace {

/// The survey of one task, without advice.
Survey survey_of_task(const Protocol& protocol, const rig::Rig& rig, const std::stop_token& stop,
                      const std::function<void(int done, int of)>& progress) {
  Survey survey;
  check_needs(protocol, rig, survey);
  check_limits(protocol, rig, survey);
  plan_scenes(protocol, rig, stop, progress, survey);
  for (auto& warning : carrier_warnings(protocol, rig, survey.sights))
    survey.warnings.push_back(std::move(warning));
  return survey;
}

}  // namespace

Survey survey(const Protocol& protocol, const rig::Rig& rig, const std::stop_token& stop,
              const std::function<void(int done, int of)>& progress) {
  Survey whole;
  if (protocol.by_task.empty()) whole = survey_of_task(protocol, rig, stop, progress);
  for (const auto& one : protocol.by_task) {
    const auto& own = whole.by_task.emplace_back(survey_of_task(one, rig, stop, progress));
    for (const auto& problem : own.problems) add_once(problem, whole.problems);
    for (const auto& warning : own.warnings) add_once(warning, whole.warnings);
    whole.sights.insert(whole.sights.end(), own.sights.begin(), own.sights.end());
    whole.combinations += own.combinations;
    whole.models.insert(own.models.begin(), own.models.end());
  }
  for (auto& warning : advice(protocol)) whole.warnings.push_back(std::move(warning));
  return whole;
}

}  // namespace turnpoint::protocol

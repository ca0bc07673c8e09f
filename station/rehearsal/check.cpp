#include "station/rehearsal/check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "station/analysis/proportion.hpp"
#include "station/core/draws.hpp"
#include "station/core/number.hpp"
#include "station/core/texts.hpp"
#include "station/protocol/advice_list.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/design_advice.hpp"
#include "station/protocol/glyphs.hpp"
#include "station/protocol/interludes.hpp"
#include "station/protocol/tasks.hpp"
#include "station/protocol/triggers.hpp"
#include "station/protocol/visits.hpp"
#include "station/rehearsal/parallel.hpp"
#include "station/rehearsal/rehearsal.hpp"
#include "station/simulation/observer.hpp"
#include "station/trial/earlier_trials.hpp"
#include "station/trial/question.hpp"

namespace turnpoint::rehearsal {

using core::phrase, core::plain;

namespace {

using protocol::Protocol;

// A rehearsal (a simulated session) does not include the time in which people read an instruction, explore
// before a decision (a fraction of the duration of the tones), and set a slider. These constants are
// estimates of those times.
constexpr double instruction_s = 12, explored_share = 0.5, setting_s = 15;

/// The result of one simulated session: the number of trials in each block, and the time that a person would
/// take. Repeated attempts at a block are added up.
struct Estimate {
  std::vector<CheckedBlock> blocks;
  std::vector<double> trials, durations_s;
  double longest_trial_s = 0;

  double all_trials() const { return std::accumulate(trials.begin(), trials.end(), 0.0); }
  double duration_s() const { return std::accumulate(durations_s.begin(), durations_s.end(), 0.0); }
};

/// The longest time for which people explore the surface in a trial.
double longest_s(const Protocol& protocol) { return protocol.timing.explore_s.value_or(0); }

/// Returns the observer of `run --observer sim`, except that setting a slider takes as long as it would take
/// a person, and that this observer is as quick as a deadline asks, if people can be so quick, and never too
/// early. It asks for the intervals again with the probability `again`.
Rehearser person(const Protocol& protocol, double again) {
  simulation::Parameters parameters;
  parameters.again = again;
  auto person = rehearser(simulation::Observer{parameters});
  person.adjust = [adjust = person.adjust, done_s = std::min(setting_s, longest_s(protocol))](
                      const trial::TrialSpec& spec, const simulation::Adjustment& asked) {
    auto setting = adjust(spec, asked);
    setting.done_s = std::min(done_s, 0.9 * asked.within_s);
    return setting;
  };
  person.answer = [again](const trial::TrialSpec& spec, const simulation::Question& asked) {
    simulation::Parameters usual;
    usual.again = again;
    const double outside_s = simulation::Observer(usual).nondecision_s();
    if (!asked.signal_s && asked.deadline_s >= protocol::shortest_deadline_s &&
        asked.deadline_s < outside_s + trial::kLeastDecision_s) {
      const double quicker = 0.5 * asked.deadline_s / outside_s;
      usual.residual_s *= quicker, usual.travel_s *= quicker;
    }
    auto reply = simulation::Observer(usual).answer(asked);
    constexpr double after_s = 1e-3;
    if (!asked.signal_s)
      reply.response_time_s = std::max(reply.response_time_s, spec.anticipation_s + after_s);
    return reply;
  };
  return person;
}

/// The time for which people explore the surface in each trial before they decide, if the task lets them
/// choose when to answer.
double exploring_s(const Protocol& protocol, std::size_t of_task) {
  const auto& task = protocol::of_task(protocol, of_task).task;
  const bool free =
      task.kind == protocol::TaskKind::single_interval && protocol::explored(task) && !task.foreperiod_s;
  return free ? explored_share * longest_s(protocol) : 0;
}

/// The total duration of the breaks inside a block of this many trials. There is no break after the last
/// trial.
double breaks_s(const protocol::Block& block, std::size_t trials) {
  if (!block.break_after || trials == 0) return 0;
  const auto every = static_cast<std::size_t>(block.break_after->trials);
  return static_cast<double>((trials - 1) / every) * block.break_after->min_s;
}

std::vector<CheckedInterlude> interludes(const Protocol& protocol, const std::vector<protocol::Block>& blocks,
                                         std::size_t next, const protocol::Visit& visit) {
  std::vector<CheckedInterlude> list;
  for (const auto* one : protocol::interludes_before(protocol, blocks, next, visit))
    list.push_back({one->kind, one->name, one->items.size() + one->pages.size()});
  return list;
}

Estimate simulate(const Protocol& protocol, const protocol::Visit& visit, std::uint64_t seed,
                  double again = 0) {
  const auto order = protocol::block_order(protocol, visit);
  // Procedures that continue have fewer trials left after earlier sessions.
  procedure::EarlierTrials earlier;
  const auto& all = protocol.procedures;
  if (std::any_of(all.begin(), all.end(), [](const auto& procedure) { return procedure.continues; }))
    for (int session = 1; session < visit.session; ++session)
      trial::add_earlier_trials(
          protocol, rehearse(protocol, {visit.place, session}, seed, person(protocol, again), earlier).blocks,
          earlier);
  const auto rehearsal = rehearse(protocol, visit, seed, person(protocol, again), earlier);
  Estimate estimate;
  for (std::size_t b = 0; b < rehearsal.blocks.size(); ++b) {
    const auto& [start, trials] = rehearsal.blocks[b];
    // Repeated practice is listed as one block. Its number of trials is the sum over all attempts.
    if (start.attempt == 0) {
      estimate.blocks.push_back({protocol::in_words(protocol, visit),
                                 protocol.sessions ? visit.session : 0,
                                 protocol::group_name(protocol, visit),
                                 start.name,
                                 start.instruction,
                                 start.practice,
                                 {}});
      estimate.blocks.back().before =
          interludes(protocol, order, static_cast<std::size_t>(start.block_index), visit);
      estimate.trials.push_back(0);
      estimate.durations_s.push_back(0);
    }
    double exploring = 0;
    for (const auto& row : trials) {
      exploring += exploring_s(protocol, protocol::task_of(protocol, row.procedure, start.name));
      estimate.longest_trial_s = std::max(estimate.longest_trial_s, row.timing.duration_s);
    }
    estimate.trials.back() += static_cast<double>(trials.size());
    estimate.durations_s.back() +=
        rehearsal.block_s[b] + exploring + instruction_s +
        breaks_s(order[static_cast<std::size_t>(start.block_index)], trials.size());
  }
  if (!estimate.blocks.empty())
    estimate.blocks.back().after = interludes(protocol, order, order.size(), visit);
  return estimate;
}

/// Adds the blocks of one visit (a place in the counterbalancing and a planned session). Keeps the visit's
/// number of trials and its duration if this visit is the longest so far.
void add_visit(const std::vector<Estimate>& estimates, Check& check) {
  if (estimates.empty()) return;
  std::vector<double> durations, trials;
  auto blocks = estimates.front().blocks;
  for (const auto& estimate : estimates) {
    durations.push_back(estimate.duration_s());
    trials.push_back(estimate.all_trials());
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    std::vector<double> own_trials, own_s;
    for (const auto& estimate : estimates) {
      if (b >= estimate.trials.size()) continue;
      own_trials.push_back(estimate.trials[b]);
      own_s.push_back(estimate.durations_s[b]);
    }
    blocks[b].trials = spread_of(own_trials);
    blocks[b].duration_s = spread_of(own_s);
    check.blocks.push_back(std::move(blocks[b]));
  }
  const auto duration_s = spread_of(durations);
  if (duration_s.median <= check.duration_s.median) return;
  check.duration_s = duration_s;
  check.trials = spread_of(trials);
}

/// How many sessions of this length are simulated to see how long runs become: fewer of very long ones, which
/// the bound of the share then says.
int runs_sessions(double trials) {
  constexpr double most_trials = 200'000;
  return static_cast<int>(std::clamp(most_trials / std::max(1.0, trials), 20.0, 200.0));
}

/// Says which limits of runs could not be kept.
void warn_of_runs(const std::string& path, Check& check) {
  for (const auto& runs : check.runs)
    if (runs.longer > 0)
      check.warnings.push_back(
          {{path, 0, 0},
           phrase(
               "in %1 of %2 simulated sessions, \"max_run\" could not be kept: up to %3 trials in a row had "
               "%4, and %5 are allowed",
               {plain(runs.longer), plain(runs.sessions), plain(runs.longest),
                runs.of == procedure::kRightAnswer ? phrase("the same right answer")
                                                   : phrase("the same \"%1\"", {plain(runs.of)}),
                plain(runs.limit)}),
           phrase("allow longer runs, or use levels, catch trials and draws of factors that leave more "
                  "choice")});
}

/// The number of sessions of each visit in the first round, if the protocol has this many visits. Fewer than
/// 20 would say nothing about one session in twenty.
int first_round(int visits, int most) { return std::min(std::clamp(120 / visits, 20, 40), most); }

/// True if the stated range is known well enough.
bool is_precise(const Spread& spread) { return spread.error <= kLengthPrecision * spread.median; }

/// Simulates this number of sessions, divided equally among the protocol's different visits. Without a
/// number, simulates rounds of sessions, each as many as before, until the length of the longest session is
/// precise.
void estimate(const Protocol& protocol, std::optional<int> sessions, const std::stop_token& stop,
              const Steps& steps, Check& check) {
  const auto visits = protocol::different_visits(protocol);
  const int count = static_cast<int>(visits.size());
  const int most = std::max(1, sessions.value_or(kMostSessions) / count);
  int each = sessions == 0 ? 0 : sessions ? most : first_round(count, most);
  std::vector<Estimate> estimates;
  for (int done = 0;;) {
    estimates.resize(static_cast<std::size_t>(each * count));
    const int before = done;
    const auto progress = [&](int more, int) {
      if (steps.progress) steps.progress("simulated sessions", before + more, each * count);
    };
    done += in_parallel(
        each * count - before, processors(), progress,
        [&](int k) {
          if (stop.stop_requested()) throw protocol::Abandoned();
          const int i = before + k;
          estimates[static_cast<std::size_t>(i)] = simulate(
              protocol, visits[static_cast<std::size_t>(i % count)], static_cast<std::uint64_t>(i / count));
        },
        steps.finish);
    check.blocks.clear();
    check.trials = check.duration_s = {};
    for (int v = 0; v < count; ++v) {
      std::vector<Estimate> mine;
      for (int i = v; i < done; i += count) mine.push_back(estimates[static_cast<std::size_t>(i)]);
      add_visit(mine, check);
    }
    check.simulated_sessions = done, check.wanted_sessions = each * count;
    if (done < each * count || each >= most || (is_precise(check.trials) && is_precise(check.duration_s)))
      return;
    each = std::min(most, 2 * each);
  }
}

/// How long trials and sessions become if everybody asks for the intervals as often as the task allows: one
/// session of each visit.
void estimate_again(const Protocol& protocol, const std::stop_token& stop, Check& check) {
  if (std::ranges::none_of(protocol::tasks_of(protocol),
                           [](const auto* seen) { return seen->task.again > 0; }))
    return;
  constexpr double always = 1;
  double trial_s = 0, session_s = 0;
  for (const auto& visit : protocol::different_visits(protocol)) {
    if (stop.stop_requested()) throw protocol::Abandoned();
    const auto estimate = simulate(protocol, visit, 0, always);
    trial_s = std::max(trial_s, estimate.longest_trial_s);
    session_s = std::max(session_s, estimate.duration_s());
  }
  check.longest_trial_again_s = trial_s, check.longest_session_again_s = session_s;
}

/// A scene's sound, and the tones and the model of which it is.
struct Sounding {
  scene::SoundBound bound;
  const protocol::Sight* sight = nullptr;

  double excess_dB() const { return bound.level_dB - bound.allowed_dB; }
};

/// Returns the sound of each of the survey's scenes by the first mode alone; empty if one is not known.
std::optional<std::vector<Sounding>> soundings(const protocol::Survey& survey, scene::ToneLevels& levels,
                                               const std::stop_token& stop, const Steps& steps) {
  std::vector<std::optional<scene::SoundBound>> bounds(survey.sights.size());
  in_parallel(
      static_cast<int>(bounds.size()), processors(), steps.counted("sound levels computed"),
      [&](int i) {
        if (stop.stop_requested()) throw protocol::Abandoned();
        const auto k = static_cast<std::size_t>(i);
        bounds[k] = levels.bound(survey.sights[k].tones, physics::Model::mode);
      },
      steps.finish);
  std::vector<Sounding> all;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (!bounds[i]) return std::nullopt;
    all.push_back({*bounds[i], &survey.sights[i]});
  }
  return all;
}

/// Returns the loudest of the survey's scenes. A scene that was planned with all modes is computed with all
/// modes only if it can be the loudest one: if its level by the first mode alone, with twice the largest
/// difference between the two that was seen so far and a margin, is not below the loudest level so far.
std::optional<scene::SoundBound> loudest(const protocol::Survey& survey, const rig::Rig& rig,
                                         const std::stop_token& stop, const Steps& steps) {
  constexpr double margin_dB = 0.05;
  scene::ToneLevels levels(rig);
  auto all = soundings(survey, levels, stop, steps);
  if (!all || all->empty()) return std::nullopt;
  std::stable_sort(all->begin(), all->end(),
                   [](const Sounding& a, const Sounding& b) { return a.excess_dB() > b.excess_dB(); });
  std::optional<Sounding> most;
  double difference_dB = 0;
  for (auto& one : *all) {
    if (stop.stop_requested()) throw protocol::Abandoned();
    const double before_dB = one.excess_dB();
    if (most && before_dB + 2 * difference_dB + margin_dB < most->excess_dB()) break;
    const auto bound = levels.bound(one.sight->tones, one.sight->field_model);
    if (!bound) return std::nullopt;
    one.bound = *bound;
    difference_dB = std::max(difference_dB, std::abs(one.excess_dB() - before_dB));
    if (!most || one.excess_dB() > most->excess_dB()) most = one;
  }
  return most->bound;
}

std::optional<scene::FingerShares> shares(const protocol::Survey& survey, const rig::Rig& rig) {
  std::vector<double> tones_Hz;
  for (const auto& sight : survey.sights)
    for (const double tone_Hz : {sight.lowest_Hz, sight.highest_Hz})
      if (tone_Hz > 0) tones_Hz.push_back(tone_Hz);
  if (tones_Hz.empty()) return std::nullopt;
  const auto [least, most] = std::minmax_element(tones_Hz.begin(), tones_Hz.end());
  return scene::finger_shares(rig, {*least, *most});
}

/// Says that scenes ask more of the model than the rig's parameters are known for.
void note_needless_tolerances(const Protocol& protocol, Check& check) {
  constexpr double far_below = 0.1;
  const double level_sd_dB = check.finger ? check.finger->level_sd_dB.value_or(0) : 0;
  double boundary_sd_mm = 0, boundary_mm = std::numeric_limits<double>::infinity(), level_dB = boundary_mm;
  std::set<std::string> scenes;
  for (const auto& sight : check.survey.sights) {
    const auto& allowed = protocol.scenes.at(sight.scene).tolerance;
    if (allowed.boundary_mm && *allowed.boundary_mm < far_below * sight.uncertainty_mm) {
      boundary_sd_mm = std::max(boundary_sd_mm, sight.uncertainty_mm);
      boundary_mm = std::min(boundary_mm, *allowed.boundary_mm);
      scenes.insert(sight.scene);
    }
    if (allowed.level_dB && *allowed.level_dB < far_below * level_sd_dB) {
      level_dB = std::min(level_dB, *allowed.level_dB);
      scenes.insert(sight.scene);
    }
  }
  if (scenes.empty()) return;
  core::Phrase compared{"", "", {}};
  if (boundary_sd_mm > 0)
    compared.values.push_back(phrase("problem.needless_boundary", {plain(core::number(boundary_mm, 3)),
                                                                   plain(core::number(boundary_sd_mm, 2))}));
  if (std::isfinite(level_dB)) {
    if (!compared.values.empty()) compared.values.push_back(plain(", "));
    compared.values.push_back(phrase(
        "problem.needless_level", {plain(core::number(level_dB, 3)), plain(core::number(level_sd_dB, 2))}));
  }
  check.notes.push_back(
      {{protocol.path, 0, 0},
       phrase("problem.needless", {std::move(compared), plain(fmt::format("{}", fmt::join(scenes, ", ")))}),
       phrase("problem.needless_allowed")});
}

std::vector<core::Problem> language_notes(const Protocol& protocol) {
  std::vector<core::Problem> notes;
  for (const auto& language : protocol.languages) {
    const auto translation = core::translation(language);
    if (translation >= core::Translation::participant_read) continue;
    notes.push_back(
        {{protocol.path, 0, 0},
         translation == core::Translation::none
             ? phrase("the station does not speak \"%1\": its own words, such as Continue, are in English",
                      {plain(language)})
             : phrase("no native speaker has read the station's own words in \"%1\"", {plain(language)}),
         translation == core::Translation::none
             ? phrase("add a catalogue of texts for the language")
             : phrase("let somebody read %1",
                      {plain("station/core/texts/" + language.substr(0, 2) + ".toml")})});
  }
  return notes;
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  // Of n sorted values, the k-th is an estimate of the quantile k / (n + 1).
  const auto last = static_cast<long>(values.size()) - 1;
  const auto count = static_cast<double>(values.size());
  const auto at = [&](double rank) {
    return values[static_cast<std::size_t>(std::clamp(std::lround(rank) - 1, 0L, last))];
  };
  // The number of values below a quantile is binomial, so two of its standard deviations say between which
  // values the quantile lies.
  double error = 0;
  const auto quantile = [&](double share) {
    const double rank = share * (count + 1), away = 2 * std::sqrt(count * share * (1 - share));
    const double value = at(rank);
    error = std::max({error, value - at(rank - away), at(rank + away) - value});
    return value;
  };
  const double low = quantile(0.05), median = quantile(0.5), high = quantile(0.95);
  return {low, median, high, error};
}

SessionLength session_length(const Protocol& protocol, std::uint64_t seed) {
  const auto estimate = simulate(protocol, {}, seed);
  return {estimate.all_trials(), estimate.duration_s()};
}

Check session_lengths(const Protocol& protocol, std::optional<int> sessions) {
  Check check;
  estimate(protocol, sessions, {}, {}, check);
  return check;
}

std::vector<CheckedRuns> check_runs(const Protocol& protocol, int sessions, const std::stop_token& stop,
                                    const Steps& steps) {
  std::map<std::string, int> limits;
  for (const auto& spec : protocol.procedures)
    for (const auto& [key, limit] : spec.max_run) {
      auto& smallest = limits.try_emplace(key, limit).first->second;
      smallest = std::min(smallest, limit);
    }
  if (limits.empty() || sessions == 0) return {};
  const auto visits = protocol::different_visits(protocol);
  std::vector<std::map<std::string, trial::Director::LongRun>> found(static_cast<std::size_t>(sessions));
  const int done = in_parallel(
      sessions, processors(), steps.counted("orders of trials simulated"),
      [&](int i) {
        if (stop.stop_requested()) throw protocol::Abandoned();
        const auto seed = static_cast<std::uint64_t>(i);
        auto careless = person(protocol, 0);
        careless.answer = [answer = careless.answer, seed](const trial::TrialSpec& spec,
                                                           const simulation::Question& asked) {
          auto reply = answer(spec, asked);
          core::Draws draws(
              {seed, core::Stream::observer, spec.block_index, spec.attempt, -1 - spec.trial_in_block});
          if (draws.below(10) == 0) reply.response_time_s = 1e6;
          return reply;
        };
        const auto at = static_cast<std::size_t>(i);
        found[at] = rehearse(protocol, visits[at % visits.size()], seed, careless).long_runs;
      },
      steps.finish);
  if (done == 0) return {};
  std::vector<CheckedRuns> all;
  for (const auto& [key, limit] : limits) {
    CheckedRuns runs{key, limit, limit, 0, done, {}};
    for (const auto& session : found)
      if (const auto run = session.find(key); run != session.end())
        ++runs.longer, runs.longest = std::max(runs.longest, run->second.longest);
    runs.share_longer = analysis::clopper_pearson(runs.longer, done);
    all.push_back(std::move(runs));
  }
  return all;
}

Check check(const std::string& protocol_path, const std::string& rig_path, const CheckOptions& options,
            const std::stop_token& stop) {
  Check check;
  std::optional<Protocol> protocol;
  std::optional<rig::Rig> rig;
  const auto gather = [&](auto&& load) {
    try {
      load();
    } catch (const core::BadInput& bad) {
      check.problems.insert(check.problems.end(), bad.problems().begin(), bad.problems().end());
    }
  };
  gather([&] { protocol = options.load_protocol(protocol_path); });
  gather([&] { rig = options.load_rig(rig_path); });
  protocol::Drawable drawn;
  if (protocol && options.drawable) {
    drawn = protocol::drawn_with(*protocol, options.drawable);
    check.problems.insert(check.problems.end(), drawn.problems.begin(), drawn.problems.end());
  }
  if (check.problems.empty() && options.try_programs) check.problems = options.try_programs(*protocol);
  if (!check.problems.empty()) return check;
  for (const auto* one : protocol::tasks_of(*protocol))
    for (const auto& meaning : one->meanings) check.measures.push_back(protocol::line_of(meaning, *one));
  check.languages = options.drawable ? drawn.languages : protocol->languages;
  check.id = protocol->id, check.title = protocol->title, check.rig_name = rig->name;
  check.different_places = protocol::place_count(*protocol);
  check.dropout_after_h = protocol->dropout_after_h;
  check.protocol_defaults = protocol->defaults_used;
  check.rig_defaults = rig->defaults_used;
  check.survey =
      protocol::survey(*protocol, *rig, options.steps.finish.stop_possible() ? options.steps.finish : stop,
                       options.steps.counted("scenes planned"));
  check.problems = check.survey.problems;
  check.warnings = check.survey.warnings;
  check.warnings.insert(check.warnings.end(), drawn.other_languages.begin(), drawn.other_languages.end());
  check.notes = protocol::notes(*protocol);
  for (const auto& note : language_notes(*protocol)) check.notes.push_back(note);
  for (const auto& note : trial::observer_notes(*protocol, simulation::Observer{{}}))
    check.notes.push_back(note);
  if (rig::largest_trigger_code(*rig) > 0) check.triggers = protocol::trigger_codes(*protocol);
  try {
    const auto& finish = options.steps.finish;
    // Nobody asks how long a session is that cannot run: then one session for each visit shows whether its
    // procedures can work.
    const bool can_run = check.problems.empty();
    estimate(*protocol, can_run ? options.sessions : std::min(1, options.sessions.value_or(1)), stop,
             options.steps, check);
    if (stop.stop_requested()) throw protocol::Abandoned();
    if (can_run) {
      estimate_again(*protocol, stop, check);
      check.runs = check_runs(
          *protocol, std::min(runs_sessions(check.trials.median), options.sessions.value_or(kMostSessions)),
          stop, options.steps);
      warn_of_runs(protocol->path, check);
      if (options.finger) check.finger = shares(check.survey, *rig);
      note_needless_tolerances(*protocol, check);
      if (options.sound) check.sound = loudest(check.survey, *rig, stop, options.steps);
      // if the work was stopped early, this upper limit may not cover all scenes
      if (finish.stop_requested()) check.sound.reset();
      check.cues = cue_guard(*protocol, *rig, check.survey, stop, options.steps);
    }
    check.stopped = finish.stop_requested();
  } catch (const protocol::Abandoned&) {
    throw;
  } catch (const std::exception& error) {
    // If a procedure cannot work, report that here rather than in the middle of a session.
    check.problems.push_back({{protocol_path, 0, 0}, core::phrase_of(error), {}});
  }
  if (!check.cues.not_compared.empty())
    check.warnings.push_back(
        {{protocol_path, 0, 0},
         phrase(
             "the cues of %1 cannot be computed: a cue may give the answers away without being noticed here",
             {plain(check.cues.not_compared)}),
         phrase("use fewer combinations of factors in one scene")});
  if (check.duration_s.median > 60 * rig->limits.session_minutes)
    check.warnings.push_back(
        {{protocol_path, 0, 0},
         phrase("the session will last about %1 minutes, longer than the rig's session_minutes",
                {plain(std::lround(check.duration_s.median / 60))}),
         phrase("at most %1", {plain(std::lround(rig->limits.session_minutes))})});
  else if (check.longest_session_again_s.value_or(0) > 60 * rig->limits.session_minutes)
    check.warnings.push_back({{protocol_path, 0, 0},
                              phrase("if people ask for every trial as often as \"again\" allows, the "
                                     "session lasts about %1 minutes, "
                                     "longer than the rig's session_minutes",
                                     {plain(std::lround(*check.longest_session_again_s / 60))}),
                              phrase("at most %1", {plain(std::lround(rig->limits.session_minutes))})});
  return check;
}

}  // namespace turnpoint::rehearsal

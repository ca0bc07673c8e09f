#include "station/analysis/dependence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>

#include "station/core/draws.hpp"
#include "tests/analysis/dependence_table.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/number_from.hpp"

using namespace turnpoint::analysis;

namespace {

turnpoint::core::Draws draws_of(int set) {
  return turnpoint::core::Draws({17, turnpoint::core::Stream::observer, 0, 0, set});
}

double chance(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

/// A session, how it is analysed, and the true effects.
struct Session {
  const char* name;
  DependenceOptions options;
  std::map<const char*, double> truth;
  std::vector<TrialRecord> (*trials)(turnpoint::core::Draws&);
};

constexpr int kTrials = 240;

/// Trials that `fill` makes one after the other.
std::vector<TrialRecord> made(int count, const auto& fill) {
  std::vector<TrialRecord> trials(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) trials[static_cast<std::size_t>(i)].trial_index = i;
  for (auto& trial : trials) fill(trial);
  return trials;
}

/// 2IFC with five strengths: the answer follows the strength, on the side of the interval with the target,
/// and the trial before.
std::vector<TrialRecord> two_intervals(turnpoint::core::Draws& draws) {
  double before = 0, answer = 0;
  bool error = false;
  return made(kTrials, [&](TrialRecord& trial) {
    trial.level = 0.25 * (1 + static_cast<double>(draws.below(5)));
    trial.right_choice = static_cast<int>(draws.below(2));
    const double x = *trial.right_choice == 1 ? *trial.level : -*trial.level;
    trial.response =
        draws.uniform() < chance(0.1 + 2 * x + 0.4 * before + 0.5 * answer - (error ? 0.6 * x : 0)) ? 1 : 0;
    trial.correct = trial.response == trial.right_choice;
    before = x, answer = *trial.response - 0.5, error = !*trial.correct;
  });
}

/// The same without any effect of the trial before, with a Weibull function and lapses: the regression
/// assumes another curve.
std::vector<TrialRecord> without_memory(turnpoint::core::Draws& draws) {
  return made(kTrials, [&](TrialRecord& trial) {
    trial.level = 0.25 * (1 + static_cast<double>(draws.below(5)));
    trial.right_choice = static_cast<int>(draws.below(2));
    trial.correct = draws.uniform() < 0.98 - 0.48 * std::exp(-std::pow(*trial.level / 0.6, 3.0));
    trial.response = *trial.correct ? *trial.right_choice : 1 - *trial.right_choice;
  });
}

/// Distances on two sides of 20, of which the right answer depends on the side. After an error the answer
/// shifts, but the distance weighs the same.
std::vector<TrialRecord> shift_after_errors(turnpoint::core::Draws& draws) {
  double before = 20, answer = 0;
  bool error = false;
  return made(kTrials, [&](TrialRecord& trial) {
    const double size = 1 + static_cast<double>(draws.below(4));
    trial.level = draws.below(2) ? 20 + size : 20 - size;
    trial.right_choice = *trial.level > 20 ? 1 : 0;
    const double past = 0.1 * (before - 20) + 0.4 * answer + (error ? 1.2 : 0);
    trial.response = draws.uniform() < chance(0.5 * (*trial.level - 20) + past) ? 1 : 0;
    trial.correct = trial.response == trial.right_choice;
    before = *trial.level, answer = *trial.response - 0.5, error = !*trial.correct;
  });
}

/// Same-different with levels in dB, which half of the trials do not present.
std::vector<TrialRecord> same_different(turnpoint::core::Draws& draws) {
  double before = 0, answer = 0;
  return made(kTrials, [&](TrialRecord& trial) {
    trial.level = -18 + 6 * static_cast<double>(draws.below(4));
    trial.right_choice = static_cast<int>(draws.below(2));
    const double x = *trial.right_choice == 1 ? std::pow(10, *trial.level / 20) : 0;
    trial.response = draws.uniform() < chance(-1 + 4 * x + 1.5 * before + 0.8 * answer) ? 1 : 0;
    trial.correct = trial.response == trial.right_choice;
    before = x, answer = *trial.response - 0.5;
  });
}

/// Bisection: two answers, none of them right.
std::vector<TrialRecord> bisection(turnpoint::core::Draws& draws) {
  double before = 0, answer = 0;
  return made(kTrials, [&](TrialRecord& trial) {
    trial.level = 2 + static_cast<double>(draws.below(7));
    const double past = trial.trial_index > 0 ? -0.3 * (before - 5) + 1.0 * answer : 0;
    trial.response = draws.uniform() < chance(1.2 * (*trial.level - 5) + past) ? 1 : 0;
    before = *trial.level, answer = *trial.response - 0.5;
  });
}

/// Magnitude estimation with assimilation to the number before.
std::vector<TrialRecord> numbers(turnpoint::core::Draws& draws) {
  double stimulus = 0, number = 0;
  return made(kTrials, [&](TrialRecord& trial) {
    trial.level = std::pow(2.0, static_cast<double>(draws.below(6)));
    const double x = std::log10(*trial.level);
    const double y = 1 + 0.7 * x + (trial.trial_index > 0 ? -0.1 * stimulus + 0.3 * (number - 1) : 0) +
                     0.12 * draws.normal();
    trial.setting = std::pow(10.0, y);
    stimulus = x, number = y;
  });
}

/// 2IFC with a staircase, two down and one up, whose levels follow the answers.
std::vector<TrialRecord> staircase(turnpoint::core::Draws& draws) {
  double before = 0, answer = 0, level = 1;
  int right = 0;
  return made(kTrials, [&](TrialRecord& trial) {
    trial.level = level;
    trial.right_choice = static_cast<int>(draws.below(2));
    const double x = *trial.right_choice == 1 ? level : -level;
    trial.response = draws.uniform() < chance(0.1 + 4 * x + 0.8 * before + 0.5 * answer) ? 1 : 0;
    trial.correct = trial.response == trial.right_choice;
    right = *trial.correct ? right + 1 : 0;
    if (!*trial.correct) level *= 1.25;
    if (right == 2) level *= 0.8, right = 0;
    before = x, answer = *trial.response - 0.5;
  });
}

/// The shift after a stimulus before, which grows and falls again (Fischer & Whitney 2014, Nat. Neurosci.
/// 17:738-743).
double attraction(double stimulus) { return 2 * stimulus * std::exp(-stimulus * stimulus / 2); }

/// Two answers about seven levels, with a shift that is no straight line.
std::vector<TrialRecord> attracted(turnpoint::core::Draws& draws) {
  double past = 0;
  return made(2 * kTrials, [&](TrialRecord& trial) {
    trial.level = static_cast<double>(draws.below(7)) - 3;
    trial.response = draws.uniform() < chance(0.9 * *trial.level + past) ? 1 : 0;
    past = attraction(*trial.level) + 0.6 * (*trial.response - 0.5);
  });
}

/// Settings of a slider to two targets, drawn to its start and to start and setting before.
std::vector<TrialRecord> settings(turnpoint::core::Draws& draws) {
  double before = 0, start = 0;
  return made(80, [&](TrialRecord& trial) {
    trial.instruction = draws.below(2) ? "far" : "near";
    trial.level = draws.uniform() * 20 - 10;
    trial.setting = (trial.instruction == "far" ? 5 : 2) + 0.1 * *trial.level + 0.25 * before + 0.05 * start +
                    draws.normal();
    before = *trial.setting, start = *trial.level;
  });
}

const std::vector<Session> kSessions{
    {"two intervals",
     {Answers::sides, 1, 0, false, true},
     {{"stimulus", 2}, {"previous stimulus", 0.4}, {"previous answer", 0.5}, {"after an error", -0.6}},
     two_intervals},
    {"two intervals, Weibull, no memory",
     {Answers::sides, 1, 0, false, true},
     {{"previous stimulus", 0}, {"previous answer", 0}},
     without_memory},
    {"a shift after errors",
     {Answers::choices, 1, 20, false, true},
     {{"stimulus", 0.5}, {"previous stimulus", 0.1}, {"previous answer", 0.4}, {"after an error", 0}},
     shift_after_errors},
    {"a staircase",
     {Answers::sides},
     {{"stimulus", 4}, {"previous stimulus", 0.8}, {"previous answer", 0.5}},
     staircase},
    {"same-different",
     {Answers::choices, 1, 0, true, true, true},
     {{"stimulus", 4}, {"previous stimulus", 1.5}, {"previous answer", 0.8}, {"after an error", 0}},
     same_different},
    {"bisection",
     {Answers::choices},
     {{"stimulus", 1.2}, {"previous stimulus", -0.3}, {"previous answer", 1}},
     bisection},
    {"numbers", {Answers::logarithms}, {{"previous stimulus", -0.1}, {"previous answer", 0.3}}, numbers},
    {"settings",
     {Answers::settings},
     {{"stimulus", 0.1}, {"previous stimulus", 0.05}, {"previous answer", 0.25}},
     settings}};

const std::optional<Estimate>& effect(const Dependence& found, const std::string& name) {
  return name == "stimulus"            ? found.stimulus
         : name == "previous stimulus" ? found.previous_stimulus
         : name == "previous answer"   ? found.previous_answer
                                       : found.after_error;
}

}  // namespace

TEST_CASE("The effects of the trial before equal those of another program, with the ends of their intervals",
          "[analysis]") {
  for (const auto& known : kDependence) {
    std::vector<TrialRecord> trials;
    for (std::size_t i = 0; i < known.levels.size(); ++i) {
      TrialRecord trial;
      trial.trial_index = static_cast<int>(i);
      trial.level = known.levels[i];
      if (known.choices) {
        trial.response = static_cast<int>(known.answers[i]);
        trial.right_choice = known.levels[i] > 0 ? 1 : 0;
        trial.correct = trial.response == trial.right_choice;
      } else {
        trial.setting = known.answers[i];
      }
      trials.push_back(trial);
    }
    DependenceOptions options;
    options.answers = known.choices ? Answers::sides : Answers::logarithms;
    options.after_error = known.choices;
    const auto all = serial_dependence(trials, {}, options);
    REQUIRE(all.size() == 1);
    CHECK(all[0].pairs == static_cast<int>(trials.size()) - 1);
    std::vector<std::optional<Estimate>> found{all[0].previous_stimulus, all[0].previous_answer};
    if (known.choices)
      found = {all[0].stimulus, all[0].previous_stimulus, all[0].previous_answer, all[0].after_error};
    REQUIRE(found.size() == known.effects.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      INFO(trials.size() << " trials, effect " << i);
      REQUIRE(found[i]);
      CHECK(found[i]->value == Approx(known.effects[i][0]).margin(2e-6));
      CHECK(found[i]->interval.low == Approx(known.effects[i][1]).margin(2e-6));
      CHECK(found[i]->interval.high == Approx(known.effects[i][2]).margin(2e-6));
      CHECK((*found[i]->p < 0.05) == (found[i]->interval.low > 0 || found[i]->interval.high < 0));
    }
    if (!known.choices) continue;
    // the level alone says the same where the positive choice belongs to the levels above 0
    options.answers = Answers::choices;
    const auto plain = serial_dependence(trials, {}, options);
    CHECK(plain[0].previous_answer->value == all[0].previous_answer->value);
    // so do levels around a cut
    for (auto& trial : trials) *trial.level += 20;
    options.cut = 20;
    const auto around = serial_dependence(trials, {}, options);
    CHECK(around[0].stimulus->value == Approx(all[0].stimulus->value));
    CHECK(around[0].after_error->value == Approx(all[0].after_error->value));
  }
}

// TURNPOINT_DEPENDENCE_SETS=1000 prints the coverage for every kind of session;
// TURNPOINT_DEPENDENCE_FIRST=1000 begins with another session, so that a long run can be done in parts.
TEST_CASE("The intervals of the effects of the trial before contain the true value", "[analysis]") {
  const int sets = number_from("TURNPOINT_DEPENDENCE_SETS", 60),
            first = number_from("TURNPOINT_DEPENDENCE_FIRST", 0);
  const bool asked = std::getenv("TURNPOINT_DEPENDENCE_SETS") != nullptr;
  for (const auto& session : kSessions) {
    std::map<std::string, int> held, found;
    std::map<std::string, double> sum;
    for (int set = first; set < first + sets; ++set) {
      auto draws = draws_of(set);
      const auto all = serial_dependence(session.trials(draws), {}, session.options);
      REQUIRE(all.size() == 1);
      for (const auto& [name, truth] : session.truth) {
        const auto& estimate = effect(all[0], name);
        if (!estimate) continue;
        ++found[name];
        if (const auto& p = estimate->p; p && std::fabs(*p - 0.05) > 1e-5) {
          INFO(session.name << ", " << name << ", p " << *p);
          CHECK((*p < 0.05) == (estimate->interval.low > 0 || estimate->interval.high < 0));
        }
        sum[name] += estimate->value;
        held[name] += estimate->interval.low <= truth && truth <= estimate->interval.high;
      }
    }
    for (const auto& [name, truth] : session.truth) {
      INFO(session.name << ", " << name);
      CHECK(found[name] == sets);
      CHECK(held[name] >= (asked ? 0.93 : 0.85) * found[name]);  // 0.85: fewer in 1 of 1000 runs of 60
      if (asked)
        std::cout << session.name << ", " << name << ": " << held[name] << " of " << found[name] << " ("
                  << 100.0 * held[name] / found[name] << " %), mean " << sum[name] / found[name] << " of "
                  << truth << "\n";
    }
  }
}

// With the same variables as the test before.
TEST_CASE("The intervals of the serial-dependence curve contain the true shifts", "[analysis]") {
  const int sets = number_from("TURNPOINT_DEPENDENCE_SETS", 40),
            first = number_from("TURNPOINT_DEPENDENCE_FIRST", 0);
  const bool asked = std::getenv("TURNPOINT_DEPENDENCE_SETS") != nullptr;
  struct Kind {
    const char* name;
    std::vector<TrialRecord> (*trials)(turnpoint::core::Draws&);
    DependenceOptions options;
    double (*shift)(double);
    std::size_t fewest, most;  // points
  };
  // A straight line, because the stimuli of a group have the shift of their mean then.
  const std::vector<Kind> kinds{
      {"attraction", attracted, {Answers::choices}, attraction, 7, 7},
      {"two intervals, Weibull, no memory",
       without_memory,
       {Answers::sides},
       [](double) { return 0.0; },
       10,
       10},
      {"a staircase", staircase, {Answers::sides}, [](double x) { return 0.8 * x; }, 4, 7},
      {"numbers", numbers, {Answers::logarithms}, [](double x) { return -0.1 * x; }, 6, 6}};
  for (const auto& kind : kinds) {
    INFO(kind.name);
    int points = 0, held = 0, curves = 0;
    double sum = 0, sum_square = 0;
    for (int set = first; set < first + sets; ++set) {
      auto draws = draws_of(set);
      const auto found = serial_dependence(kind.trials(draws), {}, kind.options).at(0);
      if (found.curve.empty()) continue;
      ++curves;
      CHECK(found.curve.size() >= kind.fewest);
      CHECK(found.curve.size() <= kind.most);
      double mean = 0, pairs = 0, total = 0;
      for (const auto& point : found.curve) {
        mean += kind.shift(point.stimulus) / static_cast<double>(found.curve.size());
        pairs += point.pairs, total += point.shift.value;
      }
      CHECK(pairs == found.pairs);
      CHECK(total == Approx(0).margin(1e-6));
      for (const auto& point : found.curve) {
        const double truth = kind.shift(point.stimulus) - mean;
        ++points, held += point.shift.interval.low <= truth && truth <= point.shift.interval.high;
        sum += truth * point.shift.value, sum_square += truth * truth;
      }
    }
    CHECK(curves >= 0.95 * sets);
    CHECK(held >= (asked ? 0.935 : 0.9) * points);
    if (sum_square > 0) CHECK(sum / sum_square == Approx(1).margin(0.2));  // the shifts have the right size
    if (asked)
      std::cout << kind.name << ", curve: " << held << " of " << points << " (" << 100.0 * held / points
                << " %), size " << (sum_square > 0 ? sum / sum_square : 1) << ", " << curves << " of " << sets
                << "\n";
  }
}

TEST_CASE("Where nothing differed the stimulus is 0, whatever the level of the procedure", "[analysis]") {
  auto draws = draws_of(1);
  const DependenceOptions options{Answers::choices, 1, 0, true, false, true};
  const auto trials = same_different(draws);
  auto others = trials;
  for (auto& trial : others)
    if (trial.right_choice == 0) trial.level = trial.trial_index % 3 ? std::optional(40.0) : std::nullopt;
  const auto a = serial_dependence(trials, {}, options).at(0),
             b = serial_dependence(others, {}, options).at(0);
  CHECK(a.pairs == b.pairs);
  for (const auto effect :
       {&Dependence::stimulus, &Dependence::previous_stimulus, &Dependence::previous_answer}) {
    REQUIRE((a.*effect && b.*effect));
    CHECK((a.*effect)->value == (b.*effect)->value);
    CHECK((a.*effect)->interval.high == (b.*effect)->interval.high);
  }
}

TEST_CASE("An end of an interval that is not found leaves the other effects", "[analysis]") {
  std::vector<std::vector<double>> rows;
  std::vector<bool> answers;
  for (int i = 0; i < 100; ++i) {
    const double strength = std::exp((i - 50) / 1.5);
    rows.push_back({strength, i % 2 ? 0.5 : -0.5, std::sin(i), 1});
    answers.push_back(strength > 3);
  }
  const auto found = penalised_logistic(rows, answers, 3);
  CHECK_FALSE(found.dependent);
  REQUIRE(found.coefficients.size() == 3);
  CHECK(found.coefficients[0].interval.low > 0);
  CHECK(std::isfinite(found.coefficients[1].interval.high));
  for (auto& row : rows) row[2] = row[0];
  CHECK(penalised_logistic(rows, answers, 3).dependent);
}

TEST_CASE("Effects of the trial before are left out where the answers do not tell", "[analysis]") {
  auto draws = draws_of(0);
  const DependenceOptions options{Answers::sides, 1, 0, false, true};
  const auto all = two_intervals(draws);
  const auto code = [&](std::vector<TrialRecord> trials) {
    const auto found = serial_dependence(trials, {}, options).at(0);
    CHECK_FALSE(found.previous_answer);
    return found.statements.empty() ? "" : found.statements[0].code;
  };
  CHECK(code({all.begin(), all.begin() + 50}) == "few-pairs");
  auto apart = all;  // each trial is in another block, run of the program, or has another one before it
  for (auto& trial : apart) trial.block_index = trial.trial_index;
  CHECK(code(apart) == "few-pairs");
  apart = all;
  for (auto& trial : apart) trial.segment_index = trial.trial_index;
  CHECK(code(apart) == "few-pairs");
  apart = all;
  for (auto& trial : apart) trial.trial_index *= 2;
  CHECK(code(apart) == "few-pairs");
  apart = all;  // the trial before may be of another condition
  for (auto& trial : apart) trial.instruction = trial.trial_index % 2 ? "a" : "b";
  const auto both = serial_dependence(apart, {"b"}, options);
  REQUIRE(both.size() == 2);
  CHECK(both[0].condition == "b");
  CHECK(both[0].pairs + both[1].pairs == static_cast<int>(all.size()) - 1);
  CHECK(both[1].previous_answer);
  auto perfect = all;  // always right at one strength: the stimulus before says what the answer before was
  for (auto& trial : perfect) trial.level = 1, trial.correct = true, trial.response = trial.right_choice;
  CHECK(code(perfect) == "confounded-pairs");
  // Always right at several strengths: the penalised likelihood has a maximum, and its intervals ends.
  perfect = all;
  for (auto& trial : perfect) trial.correct = true, trial.response = trial.right_choice;
  const auto found = serial_dependence(perfect, {}, options).at(0);
  REQUIRE(found.stimulus);
  CHECK(std::isfinite(found.stimulus->interval.high));
  CHECK(found.stimulus->interval.low > 0);
  CHECK_FALSE(found.after_error);  // no error
}

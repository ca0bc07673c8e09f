#include "station/analysis/settings.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "station/analysis/student.hpp"
#include "station/core/number.hpp"

namespace turnpoint::analysis {

namespace {

constexpr double kTail = 0.025;
constexpr std::size_t kFewest = 3;

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double squares_about(const std::vector<double>& values, double mean) {
  return std::accumulate(values.begin(), values.end(), 0.0,
                         [mean](double sum, double v) { return sum + (v - mean) * (v - mean); });
}

/// Returns the least-squares slope of the settings over their starting positions. Empty if all starts are
/// equal or if there are fewer than 5 settings.
std::optional<Estimate> slope_on_starts(const Settings& s) {
  return s.values.size() < 5 ? std::nullopt : student_slope(s.starts, s.values);
}

/// Returns the standard deviation with its interval; empty with fewer than 3 values, or if all are equal.
std::optional<Estimate> scatter_of(const std::vector<double>& values) {
  if (values.size() < kFewest) return std::nullopt;
  const double degrees = static_cast<double>(values.size()) - 1;
  const double squares = squares_about(values, mean_of(values));
  if (squares <= 0) return std::nullopt;
  const boost::math::chi_squared law(degrees);
  return Estimate{std::sqrt(squares / degrees),
                  {std::sqrt(squares / boost::math::quantile(law, 1 - kTail)),
                   std::sqrt(squares / boost::math::quantile(law, kTail)), 0.95}};
}

SideSettings side_of(const std::vector<double>& values) {
  return {static_cast<int>(values.size()), student_mean(values), scatter_of(values)};
}

void estimate(Settings& s, const std::vector<double>& below, const std::vector<double>& above) {
  s.from_below = side_of(below), s.from_above = side_of(above);
  s.side_difference = student_difference(below, above);
  if (s.values.size() < kFewest) {
    s.statements.push_back(
        {"few-settings", core::phrase("statement.few_settings", {core::plain(s.values.size())})});
    return;
  }
  s.mean = student_mean(s.values);
  s.sd = scatter_of(s.values);
  if (!s.sd) s.statements.push_back({"equal-settings", core::phrase("statement.equal_settings")});
  s.start_slope = slope_on_starts(s);
  if (s.start_slope && s.start_slope->interval.low > 0)
    s.statements.push_back(
        {"follows-start", core::phrase("statement.follows_start",
                                       {core::plain(core::number(100 * s.start_slope->value, 2))})});
}

}  // namespace

std::vector<Settings> settings(const std::vector<TrialRecord>& trials,
                               const std::vector<std::string>& order) {
  struct Sides {
    std::vector<double> below, above;
  };
  std::map<std::pair<std::string, std::string>, Sides> sides;
  std::vector<Settings> all;
  for (const auto& trial : trials) {
    if (!counted(trial) || !trial.setting) continue;
    auto found = std::find_if(all.begin(), all.end(), [&](const Settings& s) {
      return s.procedure == trial.procedure && s.condition == trial.instruction;
    });
    if (found == all.end())
      found = all.insert(all.end(),
                         Settings{trial.procedure, trial.instruction, {}, {}, {}, {}, {}, {}, {}, {}, {}});
    found->starts.push_back(trial.level.value_or(0));
    found->values.push_back(*trial.setting);
    auto& by_side = sides[{trial.procedure, trial.instruction}];
    if (trial.start_side == StartSide::below) by_side.below.push_back(*trial.setting);
    if (trial.start_side == StartSide::above) by_side.above.push_back(*trial.setting);
  }
  const auto place = [&order](const Settings& s) {
    return std::find(order.begin(), order.end(), s.condition) - order.begin();
  };
  std::stable_sort(all.begin(), all.end(),
                   [&](const Settings& a, const Settings& b) { return place(a) < place(b); });
  for (auto& s : all) {
    const auto& by_side = sides.at({s.procedure, s.condition});
    estimate(s, by_side.below, by_side.above);
  }
  return all;
}

}  // namespace turnpoint::analysis

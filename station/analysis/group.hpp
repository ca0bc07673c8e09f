#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/estimate.hpp"

namespace turnpoint::analysis {

/// One number of one participant in one condition, such as a threshold or a median response time.
struct PersonMeasure {
  std::string person, condition, measure;
  std::string unit;  ///< unit of the measure; "" if it has none
  double value = 0;
};

/// The participants' mean of a measure in one condition. Each participant counts once.
struct GroupMean {
  std::string measure, unit, condition;
  int persons = 0;
  /// 95 % interval by Student's t, of a proportion on the logit scale; empty with fewer than 3 participants
  std::optional<Estimate> mean;
  std::optional<double> sd;  ///< between participants; empty with fewer than 3 participants
};

/// The effect of a condition on a measure: the mean of the participants' own differences, second minus first.
/// If the conditions are those of different groups of participants, the effect is the difference of the
/// groups' means.
struct Effect {
  std::string measure, unit, first, second;
  int persons = 0;  ///< participants with the measure in both conditions (between groups: in either one)
  /// 95 % interval by Student's t for pairs, in an effect between groups by Welch's t; empty with fewer than
  /// 3 pairs, or fewer than 3 participants in a group
  std::optional<Estimate> difference;
  /// the difference divided by the standard deviation of the differences (Cohen's d_z), in an effect between
  /// groups by the pooled standard deviation in the groups (Cohen's d_s); empty if that is 0
  std::optional<double> standardised;
  bool between_groups = false;
  /// p value of `difference` after Holm's correction; empty if no correction was asked for
  std::optional<double> corrected_p = {};
};

/// A p value and the name of its family: the tests that are corrected together.
struct Tested {
  std::string family;
  std::optional<double> p;
};

/// Corrects p values for the number of tests in their family (Holm 1979, Scand. J. Stat. 6:65-70): if all
/// hypotheses with a corrected value below 0.05 are rejected, a true one is among them in at most 5 % of the
/// families. The same numbers as R's p.adjust(p, "holm"). In the order of `tests`; tests without a p value do
/// not count.
std::vector<std::optional<double>> holm(const std::vector<Tested>& tests);

/// True if two conditions are those of different groups of participants.
using Between = std::function<bool(const std::string& first, const std::string& second)>;

/// Both functions return their entries in the order in which measures and conditions first occur. A person
/// must not have the same measure twice in one condition.
std::vector<GroupMean> group_means(const std::vector<PersonMeasure>& measures);
std::vector<Effect> effects(const std::vector<PersonMeasure>& measures, const Between& between);

}  // namespace turnpoint::analysis

#include "station/view/goals.hpp"

#include <algorithm>

#include "station/core/texts.hpp"
#include "station/view/document.hpp"

namespace turnpoint::view {

const std::vector<Goal>& goals() {
  static const std::vector<Goal> all{{"contrast", "friction-2ifc"},
                                     {"boundary", "boundary-constant"},
                                     {"rating", "smoothness-points"},
                                     {"magnitude", "magnitude-free"},
                                     {"speed-accuracy", "speed-accuracy"},
                                     {"same-different", "friction-same-different"},
                                     {"pattern", "two-spots-oddity"},
                                     {"setting", "boundary-adjustment"},
                                     {"identification", "friction-identification"},
                                     {"confidence", "friction-confidence"},
                                     {"pairs", "friction-pairs"},
                                     {"differences", "friction-triads"},
                                     {"boundary-quick", "boundary-adaptive"},
                                     {"boundary-limits", "limits-boundary"},
                                     {"contrast-staircase", "friction-staircase"},
                                     {"contrast-three", "friction-3ifc"},
                                     {"abx", "friction-abx"},
                                     {"rating-line", "smoothness-line"},
                                     {"magnitude-standard", "magnitude-standard"},
                                     {"response-signal", "response-signal"},
                                     {"control", "no-touch-control"},
                                     {"demo", "demo"}};
  return all;
}

const Goal* find_goal(const std::string& word) {
  const auto found =
      std::find_if(goals().begin(), goals().end(), [&](const Goal& goal) { return goal.word == word; });
  return found == goals().end() ? nullptr : &*found;
}

std::string describe(const Goal& goal, const std::string& language) {
  const auto key = std::string("design.goals.") + goal.word;
  return core::text(key, language);
}

std::string study_from(const Goal& goal, const std::string& source, const std::string& id) {
  const auto named = Document(source, goal.file).with({"protocol", "id"}, toml_string(id));
  return Document(named, goal.file).with({"protocol", "version"}, toml_string("0.1.0"));
}

}  // namespace turnpoint::view

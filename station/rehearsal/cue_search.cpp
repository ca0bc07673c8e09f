#include "station/rehearsal/cue_search.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <list>

namespace turnpoint::rehearsal {

namespace {

constexpr int coarse_places = 24, most_places = 96;
constexpr double smallest_gain = 0.01;
constexpr std::uint64_t first_seed = 1'000'000;  // other sessions than those that judge the rules

}  // namespace

Strategy CueSearch::Contender::strategy() const {
  Strategy strategy{view->feature, {}};
  strategy.rule.grain = view->grain;
  auto& ranges = strategy.rule.ranges;
  if (from > 0) ranges.push_back({view->places[from - 1], 1 - inside});
  const bool up_to_all = to > view->places.size();
  ranges.push_back({up_to_all ? std::numeric_limits<double>::infinity() : view->places[to - 1], inside});
  if (!up_to_all) ranges.push_back({std::numeric_limits<double>::infinity(), 1 - inside});
  return strategy;
}

CueSearch::View CueSearch::view_of(const CueKind& kind, Feature feature, const Grain& grain,
                                   const Cells& all) const {
  View view{feature, grain, {}, {}, {}, {}};
  auto looked = observer_.looks(kind, feature, all, Draws::to_choose);
  weight_by_answer(looked);
  const auto coarse = places(looked, grain, coarse_places), fine = places(looked, grain, most_places);
  std::set_union(coarse.begin(), coarse.end(), fine.begin(), fine.end(), std::back_inserter(view.places));
  for (const double place : coarse)
    view.coarse.push_back(static_cast<std::size_t>(
        std::upper_bound(view.places.begin(), view.places.end(), place) - view.places.begin()));
  for (const auto& cell : all) {
    const auto looks = observer_.looks(kind, feature, {cell}, Draws::to_choose);
    Shares weights{};
    for (const auto& look : looks) weights[static_cast<std::size_t>(look.correct)] += look.weight;
    for (const auto& look : looks) {
      const auto place = std::upper_bound(view.places.begin(), view.places.end(), look.x[0]);
      const auto right = static_cast<std::size_t>(look.correct);
      view.seen.push_back({static_cast<std::size_t>(place - view.places.begin()), view.right.size() + right,
                           look.weight / weights[right]});
    }
    view.right.insert(view.right.end(), {0, 1});
  }
  return view;
}

// Whichever trials come, the gain over always pressing the better key is at most half the difference between
// the largest proportion of answers 1 where 1 is right, and the smallest proportion where 0 is right: it is
// largest if only these two kinds of trial come, and equally often.
double CueSearch::possible_gain(const Contender& one) {
  std::vector<double> ones(one.view->right.size()), occurs(one.view->right.size());
  for (const auto& seen : one.view->seen) {
    occurs[seen.group] += seen.share;
    if (one.answer(seen.place) == 1) ones[seen.group] += seen.share;
  }
  double most = 0, least = 1;
  for (std::size_t group = 0; group < ones.size(); ++group)
    if (occurs[group] > 0) {
      if (one.view->right[group] == 1) most = std::max(most, ones[group]);
      if (one.view->right[group] == 0) least = std::min(least, ones[group]);
    }
  return 0.5 * (most - least);
}

void CueSearch::enter(std::vector<Contender>& field, Contender one) {
  if (possible_gain(one) < smallest_gain) return;
  std::vector<bool> answers;
  answers.reserve(one.view->seen.size());
  for (const auto& seen : one.view->seen) answers.push_back(one.answer(seen.place) == 1);
  one.own = &tried_[std::move(answers)];
  if (std::none_of(field.begin(), field.end(), [&](const Contender& other) { return other.own == one.own; }))
    field.push_back(one);
}

// A criterion is a band that has one end only, so it needs only one of the two answers inside.
void CueSearch::enter_all(std::vector<Contender>& field, const View& view) {
  const std::size_t last = view.places.size() + 1;
  std::vector<std::size_t> ends{0};
  ends.insert(ends.end(), view.coarse.begin(), view.coarse.end());
  ends.push_back(last);
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (std::size_t j = i + 1; j < ends.size(); ++j) {
      const bool whole = ends[i] == 0 && ends[j] == last, band = ends[i] > 0 && ends[j] < last;
      if (!whole) enter(field, {&view, ends[i], ends[j], 1});
      if (band) enter(field, {&view, ends[i], ends[j], 0});
    }
}

// Adds the best contenders with one end moved to places between those tried so far.
void CueSearch::enter_neighbours(std::vector<Contender>& field) {
  const std::vector<Contender> best(
      field.begin(), field.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(3, field.size())));
  for (const auto& one : best) {
    if (one.view->coarse.size() == one.view->places.size()) continue;
    const std::size_t last = one.view->places.size() + 1;
    for (const std::size_t by : {1, 2}) {
      if (one.from > by) enter(field, {one.view, one.from - by, one.to, one.inside});
      if (one.from > 0 && one.from + by < one.to) enter(field, {one.view, one.from + by, one.to, one.inside});
      if (one.to < last && one.to > one.from + by)
        enter(field, {one.view, one.from, one.to - by, one.inside});
      if (one.to + by < last) enter(field, {one.view, one.from, one.to + by, one.inside});
    }
  }
}

// Keeps the contenders that do best in this many sessions.
void CueSearch::race(const CueKind& kind, std::vector<Contender>& field, Round round) {
  for (auto& one : field) {
    observer_.run_sessions(kind, one.strategy(), round.sessions, *one.own, first_seed);
    const auto sum = sum_of(one.own->done);
    one.gain = sum.accuracy() - observer_.chance(sum);
  }
  std::stable_sort(field.begin(), field.end(),
                   [](const Contender& a, const Contender& b) { return a.gain > b.gain; });
  field.resize(std::min(field.size(), round.kept));
}

std::optional<Strategy> CueSearch::best(const CueKind& kind, const Grain& grain, const Cells& all) {
  std::list<View> views;
  std::vector<Contender> field;
  for (const auto feature : observer_.features_of(kind)) {
    views.push_back(view_of(kind, feature, grain, all));
    if (!views.back().places.empty()) enter_all(field, views.back());
  }
  race(kind, field, {4, 256});
  race(kind, field, {10, 32});
  race(kind, field, {50, 8});
  enter_neighbours(field);
  race(kind, field, {200, 3});
  race(kind, field, {800, 1});
  if (field.empty()) return std::nullopt;
  return field.front().strategy();
}

}  // namespace turnpoint::rehearsal

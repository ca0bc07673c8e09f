#include "station/core/problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace turnpoint::core {

namespace {

std::string format_all(const std::vector<Problem>& problems) {
  std::string all;
  for (const auto& problem : problems) all += (all.empty() ? "" : "\n") + format(problem);
  return all;
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0u);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
    }
  }
  return row.back();
}

}  // namespace

Phrase phrase_of(const Problem& problem) {
  std::string place = problem.place.file;
  if (problem.place.line > 0) place += fmt::format(":{}:{}", problem.place.line, problem.place.column);
  if (!place.empty()) place += ": ";
  Phrase phrase{"", place, {problem.what}};
  if (problem.allowed.empty()) return phrase;
  phrase.values.push_back(core::plain("; "));
  phrase.values.push_back(problem.allowed);
  return phrase;
}

std::string format(const Problem& problem) { return core::say(phrase_of(problem), "en"); }

BadInput::BadInput(std::vector<Problem> problems)
    : std::runtime_error(format_all(problems)), problems_(std::move(problems)) {}

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const auto& candidate : candidates) {
    const auto distance = edit_distance(word, candidate);
    if (distance < best_distance) best_distance = distance, best = candidate;
  }
  return best;
}

}  // namespace turnpoint::core

#include "tests/coverage/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

namespace coverage {

namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Fields of a line: seed, three true values, then four numbers or blanks for each trial count and quantity.
constexpr std::size_t kFields = 4 + kTrials.size() * 3 * 4;

std::string line_of(const Session& session) {
  auto line = fmt::format("{},{},{},{}", session.seed, session.truth.threshold_dB, session.truth.slope,
                          session.truth.lapse);
  const auto add = [&line](const std::optional<Ends>& ends) {
    line += ends ? fmt::format(",{},{}", ends->first, ends->second) : ",,";
  };
  for (const auto& printed : session.after)
    for (std::size_t q = 0; q < 3; ++q) add(printed.interval[q]), add(printed.reference[q]);
  return line;
}

Session session_of(const std::vector<std::string>& fields) {
  Session session;
  session.seed = std::stoull(fields[0]);
  session.truth = {std::stod(fields[1]), std::stod(fields[2]), std::stod(fields[3])};
  std::size_t at = 4;
  const auto take = [&]() -> std::optional<Ends> {
    const auto &low = fields[at], &high = fields[at + 1];
    at += 2;
    if (low.empty()) return std::nullopt;
    return Ends{std::stod(low), std::stod(high)};
  };
  for (auto& printed : session.after)
    for (std::size_t q = 0; q < 3; ++q) printed.interval[q] = take(), printed.reference[q] = take();
  return session;
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line)
    if (c == ',')
      fields.emplace_back();
    else
      fields.back() += c;
  return fields;
}

}  // namespace

double Tally::standard_error() const { return std::sqrt(coverage() * (1 - coverage()) / printed); }

Tally tally(const std::vector<Session>& sessions, std::size_t trials_index, Quantity quantity,
            double stretch) {
  Tally result;
  std::vector<double> widths, compared, references;
  for (const auto& session : sessions) {
    ++result.sessions;
    const auto& printed = session.after[trials_index];
    const auto& interval = printed.interval[quantity];
    if (!interval) continue;
    ++result.printed;
    const double middle = (interval->first + interval->second) / 2;
    const double half = stretch * (interval->second - interval->first) / 2;
    result.held += std::abs(session.truth.of(quantity) - middle) <= half ? 1 : 0;
    widths.push_back(2 * half);
    if (const auto& reference = printed.reference[quantity])
      compared.push_back(2 * half), references.push_back(reference->second - reference->first);
  }
  if (!widths.empty()) result.median_width = median(widths);
  if (!references.empty()) result.width_ratio = median(compared) / median(references);
  return result;
}

std::string broken_promise(const Tally& tally, const Source& source, Quantity quantity, int trials) {
  if (tally.printed == 0) return "";
  std::string broken;
  const double least = source.fixed ? (quantity == slope ? 0.95 : 0.93) : 0.935,
               most = source.fixed ? 1 : 0.965;
  if (tally.coverage() < least || tally.coverage() > most) broken += " coverage";
  if (tally.width_ratio && *tally.width_ratio > 1.3) broken += " width";
  if (quantity == threshold && trials >= 96 && tally.abstained() > 0.05) broken += " abstentions";
  return broken;
}

std::vector<Session> read(const std::string& path) {
  std::vector<Session> sessions;
  std::set<std::uint64_t> seeds;
  std::ifstream in(path);
  std::stringstream text;
  text << in.rdbuf();
  auto whole = text.str();
  whole.resize(whole.rfind('\n') == std::string::npos ? 0 : whole.rfind('\n') + 1);
  if (in.is_open() && whole != text.str()) std::filesystem::resize_file(path, whole.size());
  std::istringstream lines(whole);
  for (std::string line; std::getline(lines, line);) {
    const auto fields = split(line);
    if (fields.size() != kFields) throw std::runtime_error(path + ": a line of another program version");
    sessions.push_back(session_of(fields));
    if (!seeds.insert(sessions.back().seed).second)
      throw std::runtime_error(fmt::format("{}: seed {} is there twice", path, sessions.back().seed));
  }
  return sessions;
}

std::vector<std::uint64_t> missing_seeds(const std::vector<Session>& there, int sessions) {
  std::set<std::uint64_t> seeds;
  for (const auto& session : there) seeds.insert(session.seed);
  std::vector<std::uint64_t> missing;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(sessions); ++seed)
    if (!seeds.contains(seed)) missing.push_back(seed);
  return missing;
}

void append(const std::string& path, const std::vector<Session>& sessions) {
  std::string text;
  for (const auto& session : sessions) text += line_of(session) + "\n";
  std::ofstream(path, std::ios::app) << text << std::flush;
}

}  // namespace coverage

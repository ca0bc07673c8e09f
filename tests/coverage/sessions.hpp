#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/analysis/psychometric_fit.hpp"
#include "station/protocol/protocol.hpp"

namespace coverage {

inline const std::vector<std::string> kProcedures{"staircase", "quest-plus", "psi"};
inline constexpr std::array kTrials{48, 96, 200};
enum Quantity { threshold, slope, level_75 };
inline constexpr std::array kQuantities{"threshold", "slope", "75 % point"};

/// The observer's true psychometric function: a Weibull function of the level in dB; half of the guesses are
/// right.
struct Truth {
  double threshold_dB = 0, slope = 1, lapse = 0;
  double of(Quantity quantity) const;
};

/// Where the true threshold and slope of simulated sessions come from: they are `fixed`, or, if that is
/// empty, drawn for each session from the prior that the report assumes.
struct Source {
  std::string name;
  std::optional<Truth> fixed;
};
/// All sources: the prior, and fixed values. The fixed values are off the prior's centre (-16.5 dB, slope
/// 1.9) but within the middle half of the prior's ranges.
const std::vector<Source>& sources();

using Ends = std::pair<double, double>;

/// What a session's report prints after some number of trials. An interval is empty if the report gives none.
/// `reference` is the central interval of an independent sampler, if one was requested.
struct Printed {
  std::array<std::optional<Ends>, 3> interval, reference;
};

struct Session {
  std::uint64_t seed = 0;
  Truth truth;
  std::array<Printed, kTrials.size()> after;
};

/// A protocol with one procedure, whose sessions are simulated and analysed as in `turnpoint power`.
class Design {
 public:
  explicit Design(const std::string& procedure);

  /// Simulates a session, which depends only on the seed. It is analysed after each number of trials in
  /// `counts` (which are values of kTrials, ascending) and ends after the last; the other entries stay empty.
  Session run(const Source& source, std::uint64_t seed, bool with_reference,
              const std::vector<int>& counts = {kTrials.begin(), kTrials.end()}) const;

 private:
  turnpoint::protocol::Protocol protocol_;
  turnpoint::analysis::Prior prior_;
};

}  // namespace coverage

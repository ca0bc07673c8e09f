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

/// A Weibull function of the level in dB; a guess is right half the time.
struct Truth {
  double threshold_dB = 0, slope = 1, lapse = 0;
  double of(Quantity quantity) const;
};

/// Where true values come from: without `fixed` each session draws its own from the prior of the report.
struct Source {
  std::string name;
  std::optional<Truth> fixed;
};
/// The prior, and values off its centre (-16.5 dB, slope 1.9), within the middle half of its ranges.
const std::vector<Source>& sources();

using Ends = std::pair<double, double>;

/// What one session printed after so many trials; an interval is none where the report abstained. `reference`
/// is the central interval of an independent sampler, where it was asked.
struct Printed {
  std::array<std::optional<Ends>, 3> interval, reference;
};

struct Session {
  std::uint64_t seed = 0;
  Truth truth;
  std::array<Printed, kTrials.size()> after;
};

/// A procedure's protocol, whose sessions are rehearsed and analysed as `turnpoint power` does.
class Design {
 public:
  explicit Design(const std::string& procedure);

  /// The seed alone decides the session. It is analysed after each number of trials in `counts` (of kTrials,
  /// ascending) and ends after the last; the other entries stay empty.
  Session run(const Source& source, std::uint64_t seed, bool with_reference,
              const std::vector<int>& counts = {kTrials.begin(), kTrials.end()}) const;

 private:
  turnpoint::protocol::Protocol protocol_;
  turnpoint::analysis::Prior prior_;
};

}  // namespace coverage

#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tests/coverage/sessions.hpp"

namespace coverage {

/// How the intervals of one quantity did over many sessions.
struct Tally {
  int sessions = 0, printed = 0, held = 0;
  double median_width = 0;
  /// Median width over that of the reference, both of the sessions that have one and print an interval.
  std::optional<double> width_ratio;

  double coverage() const { return static_cast<double>(held) / printed; }
  double standard_error() const;  ///< of the coverage
  double abstained() const { return 1 - static_cast<double>(printed) / sessions; }
};

/// `stretch` widens or narrows the intervals about their middle: a negative control.
Tally tally(const std::vector<Session>& sessions, std::size_t trials_index, Quantity quantity,
            double stretch = 1);

/// What the intervals promise and this cell breaks; "" where it keeps it. Drawn from the prior: 93.5 to
/// 96.5 %; fixed: at least 93 %, slope 95 %. The share that was found is compared, without an allowance for
/// chance. Width at most 1.3 times the reference. Threshold abstentions at most 5 % from 96 trials on.
std::string broken_promise(const Tally& tally, const Source& source, Quantity quantity, int trials);

/// The cell's sessions in a file: one line each, every number in full. A cut-off last line is dropped. Throws
/// std::runtime_error where a seed stands there twice, as when parts of two runs are joined.
std::vector<Session> read(const std::string& path);
/// The seeds from 1 to `sessions` that are not there, ascending.
std::vector<std::uint64_t> missing_seeds(const std::vector<Session>& there, int sessions);
void append(const std::string& path, const std::vector<Session>& sessions);

}  // namespace coverage

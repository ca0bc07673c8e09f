#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/coverage/sessions.hpp"

namespace coverage {

/// How well the intervals of one quantity (such as the threshold) did over many sessions.
struct Tally {
  int sessions = 0, printed = 0, held = 0;
  double median_width = 0;
  /// Median, over the sessions that have both intervals, of the printed interval's width divided by the width
  /// of the reference interval.
  std::optional<double> width_ratio;

  double coverage() const { return static_cast<double>(held) / printed; }
  double standard_error() const;  ///< standard error of the coverage
  double abstained() const { return 1 - static_cast<double>(printed) / sessions; }
};

/// `stretch` scales the intervals around their middle, as a negative control.
Tally tally(const std::vector<Session>& sessions, std::size_t trials_index, Quantity quantity,
            double stretch = 1);

/// Returns the promise that this cell of the coverage table breaks; "" if it keeps all of them. Promised
/// coverage: 93.5 to 96.5 % if the true values are drawn from the prior; at least 93 % with fixed true
/// values, and for the slope at least 95 %. The observed proportion itself must reach these figures, without
/// an allowance for chance. Promised width: at most 1.3 times that of the reference interval. Promised
/// presence: from 96 trials on, at most 5 % of the threshold intervals may be missing.
std::string broken_promise(const Tally& tally, const Source& source, Quantity quantity, int trials);

/// Reads the sessions for one cell of the table from a file that has one session per line and every number
/// with all its digits. Drops an incomplete last line. Throws std::runtime_error if a seed occurs twice, as
/// after joining two runs.
std::vector<Session> read(const std::string& path);
/// Returns the seeds from 1 to `sessions` that have no session yet, in ascending order.
std::vector<std::uint64_t> missing_seeds(const std::vector<Session>& there, int sessions);
void append(const std::string& path, const std::vector<Session>& sessions);

}  // namespace coverage

#pragma once
#include <cstdint>
#include <vector>

#include "station/procedure/procedure.hpp"

namespace turnpoint::procedure {

/// The method of limits (Fechner 1860; Gescheider 1997, ch. 3). An ascending series starts at a low level and
/// goes up by a fixed step until the tracked answer has come `n_change` times in a row; a descending series
/// goes down until that answer has been absent as many times in a row. The midpoint of a series lies halfway
/// between the last level with the old answer and the first of these new answers. On a log10 or dB scale,
/// steps multiply the level and the midpoint is geometric.
///
/// A series has no midpoint if its first answers already are the new ones, or if it reaches `min` or `max`
/// first. It is then left out. An unanswered trial is repeated at the same level, up to three times in a row;
/// if the last repeat is unanswered as well, the series ends without a midpoint.
///
/// Estimates, each with its standard error over the series as sd: "threshold ascending" and "threshold
/// descending", the means of the midpoints of each direction; "threshold", the mean of these two means, which
/// is the mean of all midpoints if no series is left out; and "threshold ascending - descending".
class Limits : public Procedure {
 public:
  Limits(const Spec& spec, const core::DrawKey& key);

  std::optional<Proposal> next() const override;
  void record(Answer answer) override;
  int recorded() const override { return static_cast<int>(answers_.size()); }
  int expected() const override;
  std::map<std::string, Estimate> estimates() const override;
  /// Returns the midpoints of all series that have a midpoint.
  std::vector<double> reversals() const override;
  std::uint64_t state_hash() const override;

 private:
  enum class Direction { up, down };
  struct Series {
    Direction direction = Direction::up;
    double start = 0;
    /// position of the midpoint on the scale on which steps are counted; empty if there is none
    std::optional<double> midpoint;
  };
  void set_starts(Direction direction, const SeriesStarts& starts, core::Draws& draws);
  /// Returns the position that is this number of steps away from the start of the current series, on the
  /// scale on which the steps are counted.
  double position_after(int steps) const;
  bool inside(double position) const;
  void end_series(const std::optional<double>& midpoint);

  /// The mean of the midpoints on the scale of the steps; its squared standard error, if there are two or
  /// more midpoints; and how many series have a midpoint, and how many have ended.
  struct Mean {
    double position = 0;
    std::optional<double> variance;
    int used = 0, ended = 0;
  };
  Mean mean_of(Direction direction) const;
  Estimate estimate_of(const Mean& mean, const std::string& kind) const;

  Spec spec_;
  std::vector<Series> series_;
  std::size_t current_ = 0;
  int steps_ = 0;       ///< number of steps since the start of the current series
  int changed_ = 0;     ///< number of answers in a row that differ from the series' first answers
  int unanswered_ = 0;  ///< number of unanswered trials in a row
  std::vector<Answer> answers_;
};

/// The levels that series with listed starts can present, in ascending order. Empty if starts are drawn from
/// a range, if the series cannot run, or if there are more than `most` levels.
std::vector<double> levels_of_series(const Spec& spec, std::size_t most);

}  // namespace turnpoint::procedure

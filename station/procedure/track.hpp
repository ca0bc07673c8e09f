#pragma once
#include <cstdint>
#include <vector>

#include "station/procedure/procedure.hpp"

namespace turnpoint::procedure {

/// What all procedures share that move one level up and down by the answers: its limits and scale, reversals,
/// the rules that stop it. A step follows the answer at once; a reversal is the level at which the direction
/// changed. On a log10 or dB scale steps multiply. An unanswered trial brings the same level again, at most
/// three times in a row, then the track is left as it is and goes on asking.
class Track : public Procedure {
 public:
  explicit Track(const Spec& spec);

  std::optional<Proposal> next() const override;
  void record(Answer answer) final;
  int recorded() const override { return recorded_; }
  int expected() const override;
  std::vector<double> reversals() const override { return reversals_; }
  std::uint64_t state_hash() const override;

 protected:
  /// Moves the level after an answer that was given.
  virtual void learn(Answer answer) = 0;

  enum class Direction { none, down, up };
  /// Notes a reversal where the direction differs from that of the last step.
  void turn(Direction direction);
  /// By so much, signed, on the scale and within the limits.
  void move(double size);

  Spec spec_;
  double level_ = 0;
  int recorded_ = 0;
  Direction direction_ = Direction::none;
  std::vector<double> reversals_;

 private:
  bool done() const;

  int unanswered_ = 0, spent_ = 0;
  std::vector<Answer> answers_;
};

}  // namespace turnpoint::procedure

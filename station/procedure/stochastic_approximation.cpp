#include <string>

#include "station/procedure/description.hpp"
#include "station/procedure/keys.hpp"
#include "station/procedure/track.hpp"

namespace turnpoint::procedure {

using core::phrase, core::plain;

namespace {

/// Accelerated stochastic approximation (Kesten 1958, Ann. Math. Stat. 29, 41-59) in the form of Treutwein
/// (1995, Vision Research 35, 2503-2522) and Faes et al. (2007, Perception & Psychophysics 69, 254-262):
///
///     x_{n+1} = x_n - c / n (Z_n - phi)        for n = 1, 2
///     x_{n+1} = x_n - c / (2 + m) (Z_n - phi)  from n = 3 on
///
/// x_n is the level of trial n, Z_n its answer (1 or 0), c the "step", phi the "target", and m the number of
/// changes between 1 and 0 among the first n answers. (Kesten's own m does not count a change at answer n, so
/// his steps become smaller one answer later.)
///
/// Each change counts as a reversal. A stopping rule "reversals" therefore ends the procedure when the step
/// has shrunk to c / (2 + reversals). The estimate is the level after the last answer. It is a single level,
/// so it has no standard deviation. Before the first change there is no estimate, because the levels have
/// moved in one direction only.
class StochasticApproximation : public Track {
 public:
  explicit StochasticApproximation(const Spec& spec) : Track(spec) {}

  std::map<std::string, Estimate> estimates() const override {
    if (reversals_.empty()) return {};
    const auto changes = reversals_.size();
    Estimate estimate;
    estimate.mean = estimate.mode = level_;
    estimate.basis = "the level after " + std::to_string(recorded_) + " answers with " +
                     std::to_string(changes) + (changes == 1 ? " reversal" : " reversals");
    estimate.basis = with_end(std::move(estimate.basis));
    return {{"threshold", estimate}};
  }

 private:
  void learn(Answer answer) override {
    const bool one = answer == Answer::one;
    turn(one ? Direction::down : Direction::up);
    const int divisor = recorded_ <= 2 ? recorded_ : 2 + static_cast<int>(reversals_.size());
    move(-spec_.step.front() / divisor * ((one ? 1 : 0) - *spec_.target));
  }
};

}  // namespace

extern const Description accelerated_stochastic_approximation{
    "accelerated-stochastic-approximation",
    Choice::track,
    [] {
      core::Keys keys{tracks_key()};
      keys.and_also(span_keys());
      return keys.and_also({step_key(), target_key(), scale_key(), track_stop_key()});
    },
    [](core::TableReader& reader, Spec& spec) {
      read_tracks(reader, spec);
      read_scale(reader, spec);
      read_span(reader, spec);
      spec.step = {reader.number("step")};
      spec.target = reader.number("target");
      read_stop(reader, spec);
    },
    [](const Spec& spec, std::vector<Problem>& problems) {
      validate_span(spec, problems);
      if (spec.step.size() != 1 || !positive(spec.step))
        problems.push_back({"step", phrase("missing or not above 0"), phrase("one number above 0")});
      if (!spec.target || !(*spec.target > 0 && *spec.target < 1))
        problems.push_back(
            {"target", phrase("missing or outside (0, 1)"), phrase("a probability between 0 and 1")});
      if (!spec.stop.trials && !spec.stop.reversals && !spec.stop.right)
        problems.push_back({"stop", phrase("no rule ends the procedure"), phrase("add trials or reversals")});
    },
    [](const Spec& spec, const Context&, const core::DrawKey&) -> std::unique_ptr<Procedure> {
      return std::make_unique<StochasticApproximation>(spec);
    },
    [](const Spec& spec, double, double) { return spec.target; },
};

}  // namespace turnpoint::procedure

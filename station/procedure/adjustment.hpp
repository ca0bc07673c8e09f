#pragma once
#include <cstdint>
#include <vector>

#include "station/procedure/constant_stimuli.hpp"

namespace turnpoint::procedure {

/// The method of adjustment. Starting levels are presented like constant stimuli, and the participant's
/// settings are recorded. The estimate is the point of subjective equality ("pse"): its mean, mode and sd are
/// the mean, the median and the standard deviation of the settings. A trial without a setting is repeated
/// later.
class Adjustment : public ConstantStimuli {
 public:
  using ConstantStimuli::ConstantStimuli;

  void record_setting(double setting) override;
  std::map<std::string, Estimate> estimates() const override;
  std::uint64_t state_hash() const override;

 private:
  std::vector<double> settings_;
};

}  // namespace turnpoint::procedure

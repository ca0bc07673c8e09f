#pragma once
#include <vector>

#include "station/procedure/constant_stimuli.hpp"

namespace turnpoint::procedure {

/// The method of adjustment. Starting levels are presented like constant stimuli, and the participant's
/// settings are recorded. The mean of the settings estimates the point of subjective equality ("pse"); the
/// estimate's mode is their median, its sd their standard deviation. A trial without a setting is repeated
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

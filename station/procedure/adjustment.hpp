#pragma once
#include <vector>

#include "station/procedure/constant_stimuli.hpp"

namespace turnpoint::procedure {

/// The method of adjustment: starting levels come as constant stimuli do, and the settings are what is
/// learnt. Their mean estimates the point of subjective equality ("pse"; mode: the median), their standard
/// deviation its sd. A trial without a setting comes again.
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

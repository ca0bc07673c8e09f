#include "station/sensing/interval_result.hpp"

#include <algorithm>

namespace turnpoint::sensing {

using core::Proof;
using core::ProofCause;

namespace {

int severity(Proof verdict) {
  switch (verdict) {
    case Proof::ok:
      return 0;
    case Proof::flagged:
      return 1;
    case Proof::unproven:
      return 2;
    case Proof::lost:
      return 3;
    case Proof::refused:
      return 4;
    case Proof::stopped:
      return 5;
  }
  return 0;
}

}  // namespace

Proof judged(double value, const Limits& limits) {
  if (value >= limits.stop) return Proof::stopped;
  if (value >= limits.refuse) return Proof::refused;
  return value >= limits.flag ? Proof::flagged : Proof::ok;
}

Finding concluded(const std::vector<Finding>& findings) {
  Finding all;
  for (const Finding& finding : findings)
    if (severity(finding.verdict) > severity(all.verdict)) all = finding;
  // A late start alone only makes the trial refused, but the residual that the delay causes may stop the
  // session. So if the session is to be stopped, choose the cause among the findings `stopped` and `refused`.
  const int least = std::min(severity(all.verdict), severity(Proof::refused));
  for (const Finding& finding : findings)
    if (all.verdict != Proof::ok && severity(finding.verdict) >= least)
      all.cause = std::min(all.cause, finding.cause);
  if (all.verdict == Proof::ok) all.cause = ProofCause::none;
  return all;
}

}  // namespace turnpoint::sensing

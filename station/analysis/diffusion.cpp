#include "station/analysis/diffusion.hpp"

#include <algorithm>
#include <cmath>

#include "station/text/number.hpp"

namespace turnpoint::analysis {

namespace {

/// If the proportion correct Pc differs from 1/2 by less than this, use the limits of the formulas at Pc =
/// 1/2. There the formulas themselves lose precision, because almost equal terms are subtracted.
constexpr double kNearChance = 1e-3;

/// The variance of the decision time is (a / s)^4 h(L), with the boundary separation a, the scaling parameter
/// s and L = logit(proportion correct).
double h(double L) {
  L = std::abs(L);
  // near L = 0 the closed form subtracts almost equal terms, so use the Taylor series
  if (L < 0.02) return (1 - L * L / 5) / 24;
  const double e = std::exp(-L);
  return (1 - 2 * L * e - e * e) / (2 * L * L * L * (1 + e) * (1 + e));
}

/// The mean decision time is (a / s)^2 m(L), with the symbols explained at h().
double m(double L) { return std::abs(L) < 1e-4 ? 0.25 : std::tanh(L / 2) / (2 * L); }

double corrected(const EzMoments& moments) {
  if (moments.proportion_correct >= 1 && moments.trials > 0) return 1 - 0.5 / moments.trials;
  return moments.proportion_correct;
}

/// Returns the reason why the diffusion model does not fit these moments; empty if it does.
std::optional<Statement> refusal(const EzMoments& moments) {
  const double p = corrected(moments);
  if (!(p > 0 && p < 1) || moments.proportion_correct > 1)
    return Statement{
        "ez-proportion",
        texts::phrase("statement.ez_proportion", {texts::plain(text::number(moments.proportion_correct))})};
  if (!(moments.variance_s2 > 0) || !std::isfinite(moments.variance_s2) || !std::isfinite(moments.mean_s))
    return Statement{"ez-variance", texts::phrase("statement.ez_variance")};
  return std::nullopt;
}

Statement negative_nondecision(double nondecision_s) {
  return {"ez-nondecision",
          texts::phrase("statement.ez_nondecision", {texts::plain(text::number(nondecision_s, 3))})};
}

double logit(double p) { return std::log(p / (1 - p)); }

}  // namespace

EzResult ez_diffusion(const EzMoments& moments) {
  if (auto reason = refusal(moments)) return {std::nullopt, {*reason}};
  const double p = corrected(moments), e = p - 0.5, variance = moments.variance_s2;
  EzDiffusion result;
  if (std::abs(e) < kNearChance) {
    result.drift = kDiffusionScale * e * std::pow(32 / (3 * variance), 0.25);
    result.boundary = kDiffusionScale * std::pow(24 * variance, 0.25);
    result.nondecision_s = moments.mean_s - std::sqrt(24 * variance) / 4;
  } else {
    const double L = logit(p), x = L * (L * p * p - L * p + p - 0.5) / variance;
    result.drift = std::copysign(kDiffusionScale * std::pow(x, 0.25), e);
    result.boundary = kDiffusionScale * kDiffusionScale * L / result.drift;
    const double y = -result.drift * result.boundary / (kDiffusionScale * kDiffusionScale);
    const double decision_s = result.boundary / (2 * result.drift) * (1 - std::exp(y)) / (1 + std::exp(y));
    result.nondecision_s = moments.mean_s - decision_s;
  }
  if (result.nondecision_s < 0) return {std::nullopt, {negative_nondecision(result.nondecision_s)}};
  return {result, {}};
}

SharedEzResult shared_ez_diffusion(const std::vector<EzMoments>& conditions) {
  SharedEzResult result;
  std::vector<double> L, weight;
  double sum_weight = 0, sum_power = 0;
  for (const auto& moments : conditions) {
    const double p = corrected(moments), correct = moments.proportion_correct * moments.trials;
    const bool usable = !refusal(moments) && correct >= 10;
    L.push_back(p > 0 && p < 1 ? logit(p) : 0);
    weight.push_back(0);
    if (!usable) continue;
    // Relative variance of this condition's estimate of (a / s)^4. The first term is the sampling error of
    // the variance of the times, whose kurtosis exceeds that of a normal distribution by about 9 cv^2; cv is
    // the coefficient of variation of the decision time. The second term is the sampling error of ln h, which
    // follows from the sampling error of L.
    const double l = L.back(), cv2 = h(l) / (m(l) * m(l)), step = 1e-3;
    const double dlnh = (std::log(h(l + step)) - std::log(h(l - step))) / (2 * step);
    const double spread = (2 + 9 * cv2) / correct + dlnh * dlnh / (moments.trials * p * (1 - p));
    weight.back() = 1 / spread;
    sum_weight += weight.back();
    sum_power += weight.back() * moments.variance_s2 / h(l);
  }
  if (sum_weight == 0) {
    result.statements.push_back({"ez-too-few", texts::phrase("statement.ez_too_few")});
    return result;
  }
  SharedEz shared;
  shared.boundary = kDiffusionScale * std::pow(sum_power / sum_weight, 0.25);
  shared.log_boundary_sd = 0.25 / std::sqrt(sum_weight);
  const double unit = shared.boundary * shared.boundary / (kDiffusionScale * kDiffusionScale);
  double sum = 0, total = 0;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    shared.drift.push_back(kDiffusionScale * kDiffusionScale * L[i] / shared.boundary);
    if (weight[i] == 0) continue;
    const double w = conditions[i].proportion_correct * conditions[i].trials / conditions[i].variance_s2;
    sum += w * (conditions[i].mean_s - unit * m(L[i]));
    total += w;
  }
  shared.nondecision_s = sum / total;
  if (shared.nondecision_s < 0)
    result.statements.push_back(negative_nondecision(shared.nondecision_s));
  else
    result.parameters = shared;
  return result;
}

}  // namespace turnpoint::analysis

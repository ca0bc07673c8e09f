#pragma once
#include <Eigen/Core>
#include <vector>

#include "station/analysis/psychometric_function.hpp"

namespace turnpoint::analysis {

/// The answers of one participant, on a centred and scaled axis.
struct PersonAxis {
  std::vector<double> x, trials, positive;
  double guess = 0;
};

/// The parameters: both fixed effects, and the Cholesky factor of the random effects' covariance.
using MixedTheta = Eigen::Matrix<double, 5, 1>;  ///< b0, b1, L00, L10, L11

inline Eigen::Matrix2d random_factor(const MixedTheta& theta) {
  Eigen::Matrix2d factor;
  factor << theta[2], 0, theta[3], theta[4];
  return factor;
}

/// The marginal likelihood of a psychometric function with random intercept and rate (MixedFit), by Laplace's
/// approximation with expected information, as in lme4 (Bates et al. 2015, glmer).
class Laplace {
 public:
  Laplace(Function function, double lapse, const std::vector<PersonAxis>& people)
      : function_(function), lapse_(lapse), people_(people), mode_(people.size(), Eigen::Vector2d::Zero()) {}

  /// Negative logarithm of the marginal likelihood, in nats. The search for each participant's mode begins at
  /// the mode that the previous call found.
  double negative_log(const MixedTheta& theta);

  /// The mode of a participant's standardised random effects at the last theta of negative_log(), and the
  /// expected information of intercept and rate in the participant's answers.
  struct Person {
    Eigen::Vector2d mode;
    Eigen::Matrix2d information;
  };
  Person person(std::size_t index, const MixedTheta& theta);

 private:
  struct Local {
    double log_likelihood = 0;
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  };
  Local local(const PersonAxis& person, const Eigen::Vector2d& coefficients) const;
  Local climb(std::size_t index, const MixedTheta& theta);

  Function function_;
  double lapse_;
  const std::vector<PersonAxis>& people_;
  std::vector<Eigen::Vector2d> mode_;
};

/// The minimum of the negative log posterior.
struct MixedMinimum {
  MixedTheta theta;                     ///< where it is
  double negative_log = 0;              ///< its value
  Eigen::Matrix<double, 5, 5> hessian;  ///< second derivatives there
};
/// Minimises the negative log posterior by the BFGS method (Broyden, Fletcher, Goldfarb, Shanno) with central
/// differences, and then refines the result by Newton's method.
MixedMinimum minimise(Laplace& laplace, const MixedTheta& start);

}  // namespace turnpoint::analysis

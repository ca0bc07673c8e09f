#pragma once

namespace turnpoint::core {

/// The shape of a psychometric function between its lower and upper asymptotes.
enum class Function { weibull, normal, logistic };

}  // namespace turnpoint::core

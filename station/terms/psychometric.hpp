#pragma once

namespace turnpoint::terms {

/// The form of a psychometric function, from floor to ceiling.
enum class Function { weibull, normal, logistic };

}  // namespace turnpoint::terms

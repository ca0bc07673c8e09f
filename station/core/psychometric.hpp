#pragma once
#include <string_view>

namespace turnpoint::core {

/// The shape of a psychometric function between its lower and upper asymptotes.
enum class Function { weibull, normal, logistic };

inline const char* name(Function function) {
  return function == Function::weibull ? "weibull" : function == Function::normal ? "normal" : "logistic";
}
/// The function of that name; Weibull's for any other word.
inline Function function_named(std::string_view name) {
  return name == "normal" ? Function::normal : name == "logistic" ? Function::logistic : Function::weibull;
}

}  // namespace turnpoint::core

#include "station/session/parameter_name.hpp"

#include <map>

namespace turnpoint::session {

texts::Phrase parameter_name(const std::string& parameter) {
  static const std::map<std::string, const char*> known{
      {"threshold", "report.threshold"}, {"pse", "report.pse"},     {"slope", "report.slope"},
      {"spread", "report.spread"},       {"lapse", "report.lapse"}, {"criterion", "report.criterion"},
      {"gradient", "report.gradient"},   {"floor", "report.floor"}};
  const auto found = known.find(parameter);
  return found == known.end() ? texts::plain(parameter) : texts::Phrase{found->second, "", {}};
}

}  // namespace turnpoint::session

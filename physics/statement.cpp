#include "physics/statement.hpp"

#include <sstream>

namespace turnpoint::physics {

StatementValue::StatementValue(double number, int digits) {
  std::ostringstream out;
  out.precision(digits);
  out << number;
  text = out.str();
}

Statement make_statement(std::string code, std::string_view sentence,
                         std::initializer_list<StatementValue> values) {
  Statement made{std::move(code), std::string(sentence), {}};
  for (const auto& value : values) {
    made.values.push_back(value.text);
    const std::string place = "%" + std::to_string(made.values.size());
    made.text.replace(made.text.find(place), place.size(), value.text);
  }
  return made;
}

}  // namespace turnpoint::physics

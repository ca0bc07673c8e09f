// print_toml: reads TOML documents from standard input, each after a line with its length in bytes, and prints one
// line for each: its values as JSON with their kinds, or "refused" and why.
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "station/core/toml.hpp"

namespace {

using Json = nlohmann::ordered_json;
using turnpoint::core::Value;

Json json_of(const Value& value) {
  switch (value.kind) {
    case Value::Kind::boolean:
      return value.boolean;
    case Value::Kind::integer:
      return value.integer;
    case Value::Kind::number:
      if (std::isnan(value.number)) return {{"float", "nan"}};
      if (std::isinf(value.number)) return {{"float", value.number < 0 ? "-inf" : "inf"}};
      return {{"float", value.number}};
    case Value::Kind::string:
      return {{"text", value.string}};
    case Value::Kind::date:
      return {{"date", ""}};
    case Value::Kind::array: {
      auto list = Json::array();
      for (const auto& item : value.items) list.push_back(json_of(item));
      return list;
    }
    case Value::Kind::table:
      break;
  }
  auto table = Json::object();
  for (const auto& entry : value.entries) table[entry.key] = json_of(entry.value);
  return {{"table", table}};
}

}  // namespace

int main() {
  std::string line;
  while (std::getline(std::cin, line)) {
    std::string document(std::stoul(line), '\0');
    std::cin.read(document.data(), static_cast<std::streamsize>(document.size()));
    try {
      std::cout << json_of(turnpoint::core::parse_toml(document, "")).dump() << "\n";
    } catch (const turnpoint::core::BadInput& bad) {
      std::string why = bad.what();
      for (auto& c : why)
        if (c == '\n') c = ' ';
      std::cout << "refused " << why << "\n";
    }
  }
}

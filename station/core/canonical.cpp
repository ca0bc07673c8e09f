#include "station/core/canonical.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "station/core/number.hpp"

namespace turnpoint::core {

namespace {

std::string quoted(const std::string& plain) {
  std::string out = "\"";
  for (const char c : plain) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += '\\', out += c;
    else if (byte < 0x20)
      out += fmt::format("\\u{:04x}", byte);
    else
      out += c;
  }
  return out + "\"";
}

/// JSON has no numbers for infinity and NaN, so they are written as text.
std::string number_text(double number) {
  if (number - number == 0) return exact(number);
  return number > 0 ? "\"inf\"" : number < 0 ? "\"-inf\"" : "\"nan\"";
}

std::string table(const Value& value) {
  std::vector<const Entry*> entries;
  for (const auto& entry : value.entries) entries.push_back(&entry);
  std::sort(entries.begin(), entries.end(), [](const auto* a, const auto* b) { return a->key < b->key; });
  std::string out = "{";
  for (const auto* entry : entries)
    out += (out.size() > 1 ? "," : "") + quoted(entry->key) + ":" + canonical(entry->value);
  return out + "}";
}

}  // namespace

std::string canonical(const Value& value) {
  switch (value.kind) {
    case Value::Kind::boolean:
      return value.boolean ? "true" : "false";
    case Value::Kind::integer:
      return std::to_string(value.integer);
    case Value::Kind::number:
      return number_text(value.number);
    case Value::Kind::string:
    case Value::Kind::date:
      return quoted(value.string);
    case Value::Kind::array: {
      std::string out = "[";
      for (const auto& item : value.items) out += (out.size() > 1 ? "," : "") + canonical(item);
      return out + "]";
    }
    case Value::Kind::table:
      break;
  }
  return table(value);
}

}  // namespace turnpoint::core

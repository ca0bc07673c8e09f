#include "station/io/uri.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "station/core/usage_error.hpp"

namespace turnpoint::io {

std::string Uri::take(const std::string& key, const std::string& otherwise) {
  const auto found =
      std::find_if(values.begin(), values.end(), [&](const auto& pair) { return pair.first == key; });
  if (found == values.end()) return otherwise;
  const std::string value = found->second;
  values.erase(found);
  return value;
}

void Uri::check_empty(const std::string& allowed) const {
  if (!values.empty())
    throw core::UsageError("'" + text + "': unknown '" + values.front().first + "'; allowed " + allowed);
}

Uri parse_uri(const std::string& text) {
  Uri uri;
  uri.text = text;
  const auto colon = text.find(':');
  if (colon == std::string::npos || colon == 0)
    throw core::UsageError("'" + text + "' does not name a device; allowed are sim:, gpio:... and evdev:...");
  uri.scheme = text.substr(0, colon);
  std::istringstream rest(text.substr(colon + 1));
  for (std::string part; std::getline(rest, part, ',');) {
    const auto equals = part.find('=');
    if (equals == std::string::npos && uri.name.empty() && uri.values.empty()) {
      uri.name = part;
      continue;
    }
    if (equals == std::string::npos || equals == 0 || equals + 1 == part.size())
      throw core::UsageError("'" + text + "': '" + part + "' does not have the form key=value");
    uri.values.emplace_back(part.substr(0, equals), part.substr(equals + 1));
  }
  return uri;
}

bool take_low(Uri& uri) {
  const std::string active = uri.take("active", "high");
  if (active != "low" && active != "high")
    throw core::UsageError("'" + uri.text + "': active=" + active + "; allowed are low and high");
  return active == "low";
}

std::int64_t take_ms(Uri& uri, const std::string& key, std::int64_t otherwise_ns, double highest_ms) {
  const std::string text = uri.take(key, "");
  if (text.empty()) return otherwise_ns;
  double ms = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), ms);
  if (error != std::errc() || end != text.data() + text.size() || !(ms >= 0 && ms <= highest_ms))
    throw core::UsageError("'" + uri.text + "': " + key + "=" + text + "; allowed 0 to " +
                           std::to_string(static_cast<int>(highest_ms)));
  return static_cast<std::int64_t>(ms * 1e6);
}

}  // namespace turnpoint::io

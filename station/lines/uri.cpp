#include "station/lines/uri.hpp"

#include <algorithm>
#include <sstream>

#include "station/terms/usage_error.hpp"

namespace turnpoint::lines {

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
    throw terms::UsageError("'" + text + "': unknown '" + values.front().first + "'; allowed " + allowed);
}

Uri parse_uri(const std::string& text) {
  Uri uri;
  uri.text = text;
  const auto colon = text.find(':');
  if (colon == std::string::npos || colon == 0)
    throw terms::UsageError("'" + text +
                            "' does not name a device; allowed are sim:, gpio:... and evdev:...");
  uri.scheme = text.substr(0, colon);
  std::istringstream rest(text.substr(colon + 1));
  for (std::string part; std::getline(rest, part, ',');) {
    const auto equals = part.find('=');
    if (equals == std::string::npos && uri.name.empty() && uri.values.empty()) {
      uri.name = part;
      continue;
    }
    if (equals == std::string::npos || equals == 0 || equals + 1 == part.size())
      throw terms::UsageError("'" + text + "': '" + part + "' does not have the form key=value");
    uri.values.emplace_back(part.substr(0, equals), part.substr(equals + 1));
  }
  return uri;
}

}  // namespace turnpoint::lines

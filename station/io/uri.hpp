#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace turnpoint::io {

/// A device as written in rig files, `scheme:key=value,key=value`; keeps the order of the keys.
struct Uri {
  std::string scheme;
  std::string
      name;  ///< the part before the first comma if it has no `=`, e.g. the device of `evdev:NAME,axis=x`
  std::vector<std::pair<std::string, std::string>> values;

  /// Removes a key and returns its value, or `otherwise` if there is no such key. A key that nobody takes is
  /// unknown: see check_empty().
  std::string take(const std::string& key, const std::string& otherwise);
  /// Throws core::UsageError with the name of the first key that has not been removed.
  void check_empty(const std::string& allowed) const;
  std::string text;  ///< the URI as written in the file
};

/// Removes the key `active`. Returns true if its value is `low`; without the key, the line is active high.
bool take_low(Uri& uri);
/// Removes a key with a time in ms and returns it in ns. Throws core::UsageError unless it is from 0 to
/// `highest_ms`.
std::int64_t take_ms(Uri& uri, const std::string& key, std::int64_t otherwise_ns, double highest_ms);

/// Parses the URI of a device in a rig file. Throws core::UsageError for text without a scheme or with an
/// empty key or value.
Uri parse_uri(const std::string& text);

}  // namespace turnpoint::io

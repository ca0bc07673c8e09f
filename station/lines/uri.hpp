#pragma once
#include <map>
#include <string>
#include <vector>

namespace turnpoint::lines {

/// `scheme:key=value,key=value` as rig files write devices; the order of the keys is kept.
struct Uri {
  std::string scheme;
  std::string
      name;  ///< what stands before the first comma without a `=`, e.g. the device of `evdev:NAME,axis=x`
  std::vector<std::pair<std::string, std::string>> values;

  /// The value of a key, or `otherwise`; takes it out, so that what is left over at the end was not
  /// understood.
  std::string take(const std::string& key, const std::string& otherwise);
  /// Throws terms::UsageError naming the first key that nobody took.
  void check_empty(const std::string& allowed) const;
  std::string text;  ///< as written
};

/// Throws terms::UsageError for text without a scheme or with an empty key or value.
Uri parse_uri(const std::string& text);

}  // namespace turnpoint::lines

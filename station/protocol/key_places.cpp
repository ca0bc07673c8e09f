#include "station/protocol/key_places.hpp"

namespace turnpoint::protocol {

namespace {

std::string name_of(const core::Value& table, std::size_t index) {
  const auto* name = table.find("name");
  return name && name->value.kind == core::Value::Kind::string ? name->value.string : std::to_string(index);
}

}  // namespace

KeyPlaces::KeyPlaces(const std::string& source, const std::string& path)
    : KeyPlaces(core::parse_toml(source, path), path) {}

KeyPlaces::KeyPlaces(const core::Value& document, const std::string& path) {
  places_[""] = {path, 0, 0};
  for (const auto& entry : document.entries) add(entry.key, entry.place, entry.value);
}

void KeyPlaces::add(const std::string& key, const core::Place& place, const core::Value& value) {
  places_.emplace(key, place);
  for (const auto& entry : value.entries) add(key + "." + entry.key, entry.place, entry.value);
  for (std::size_t i = 0; i < value.items.size(); ++i)
    if (value.items[i].kind == core::Value::Kind::table)
      add(key + "." + name_of(value.items[i], i), value.items[i].place, value.items[i]);
}

core::Place KeyPlaces::of(std::string key) const {
  for (;;) {
    const auto found = places_.find(key);
    if (found != places_.end()) return found->second;
    const auto dot = key.rfind('.');
    key = dot == std::string::npos ? "" : key.substr(0, dot);
  }
}

}  // namespace turnpoint::protocol

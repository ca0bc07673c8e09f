#include "station/text/toml.hpp"

#include <algorithm>
#include <system_error>
#include <tuple>

#include "station/system/read_file.hpp"
#include "station/text/toml_scan.hpp"

// Some malformed files trip assertions of toml++ 3.3, for example a key that begins with an invalid byte. An
// abort would take the station down, so assertions are turned into exceptions. NDEBUG must be undefined: with
// NDEBUG, toml++ tells the compiler that its assertions always hold.
#undef NDEBUG
namespace turnpoint::text {
namespace {
struct ParserAssertion {};
constexpr void parser_assert(bool holds) {
  if (!holds) throw ParserAssertion{};
}
}  // namespace
}  // namespace turnpoint::text
#define TOML_ASSERT(condition) ::turnpoint::text::parser_assert(static_cast<bool>(condition))

// Include toml++ in this file only: it compiles slowly, and the rest of the station uses plain Values.
#include <toml++/toml.h>

namespace turnpoint::text {

using texts::phrase, texts::plain;

namespace {

Place place_of(const toml::source_region& region, const std::string& path) {
  return {path, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

constexpr std::size_t most_items = 10'000;

Value convert(const toml::node& node, const std::string& path);

Value convert_table(const toml::table& table, const std::string& path) {
  Value value;
  for (const auto& [key, child] : table)
    value.entries.push_back({std::string(key.str()), place_of(key.source(), path), convert(child, path)});
  // toml++ sorts keys by name, but people read a file from top to bottom.
  std::stable_sort(value.entries.begin(), value.entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.place.line, a.place.column) < std::tie(b.place.line, b.place.column);
  });
  return value;
}

Value convert(const toml::node& node, const std::string& path) {
  Value value;
  switch (node.type()) {
    case toml::node_type::table:
      value = convert_table(*node.as_table(), path);
      break;
    case toml::node_type::array:
      value.kind = Value::Kind::array;
      if (node.as_array()->size() > most_items)
        throw BadInput(
            {{place_of(node.source(), path), phrase("a list of %1 items", {plain(node.as_array()->size())}),
              phrase("at most %1", {plain(most_items)})}});
      for (const auto& item : *node.as_array()) value.items.push_back(convert(item, path));
      break;
    case toml::node_type::boolean:
      value.kind = Value::Kind::boolean;
      value.boolean = node.as_boolean()->get();
      break;
    case toml::node_type::integer:
      value.kind = Value::Kind::integer;
      value.integer = node.as_integer()->get();
      value.number = static_cast<double>(value.integer);
      break;
    case toml::node_type::floating_point:
      value.kind = Value::Kind::number;
      value.number = node.as_floating_point()->get();
      break;
    case toml::node_type::string:
      value.kind = Value::Kind::string;
      value.string = node.as_string()->get();
      break;
    default:
      value.kind = Value::Kind::date;
      break;
  }
  value.place = place_of(node.source(), path);
  return value;
}

}  // namespace

const Entry* Value::find(const std::string& key) const {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

Value parse_toml(const std::string& source, const std::string& path) {
  try {
    auto document = convert_table(toml::parse(safe_for_parser(source, path), path), path);
    document.place = {path, 0, 0};
    return document;
  } catch (const ParserAssertion&) {
    throw BadInput({{{path, 0, 0},
                     phrase("not valid TOML"),
                     phrase("look for a key or a value that begins with an odd character")}});
  } catch (const toml::parse_error& error) {
    throw BadInput({{place_of(error.source(), path),
                     phrase("not valid TOML: %1", {plain(std::string(error.description()))}),
                     {}}});
  }
}

texts::Phrase describe(const Value& value) {
  switch (value.kind) {
    case Value::Kind::boolean:
      return plain(value.boolean ? "true" : "false");
    case Value::Kind::integer:
    case Value::Kind::number:
      return phrase("a number");
    case Value::Kind::string:
      return phrase("the text \"%1\"", {plain(value.string)});
    case Value::Kind::date:
      return phrase("a date or time");
    case Value::Kind::array:
      return phrase("a list");
    case Value::Kind::table:
      break;
  }
  return phrase("a table");
}

std::string read_text_file(const std::string& path) try {
  return system::read_file(path, most_text_bytes);
} catch (const std::system_error& error) {
  if (error.code() == std::errc::no_such_file_or_directory)
    throw BadInput({{{path, 0, 0}, phrase("there is no such file"), phrase("check the path")}});
  if (error.code() == std::errc::is_a_directory)
    throw BadInput({{{path, 0, 0}, phrase("this is a folder"), phrase("name a file")}});
  if (error.code() != std::errc::file_too_large) throw;
  throw BadInput(
      {{{path, 0, 0}, phrase("the file has more than 4 MiB"), phrase("at most %1", {plain("4 MiB")})}});
}

std::string_view without_byte_order_mark(std::string_view text) {
  const std::string_view mark = "\xEF\xBB\xBF";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

}  // namespace turnpoint::text

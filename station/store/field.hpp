#pragma once
#include <cstdint>
#include <utility>

#include "station/store/fields.hpp"

namespace turnpoint::store {

// How fields.cpp and fields_trial.cpp make a Field from a pointer to a data member.

inline void parse(const std::string& word, RunMode& mode) { mode = run_mode_named(word); }
inline void parse(const std::string& word, SessionStatus& status) { status = session_status_named(word); }
inline void parse(const std::string& word, Outcome& outcome) { outcome = trial_outcome_named(word); }
inline void parse(const std::string& word, TrialType& type) { type = trial_type_named(word); }
inline void parse(const std::string& word, Verdict& verdict) { verdict = verdict_named(word); }
inline void parse(const std::string& word, Proof& proof) { proof = proof_named(word); }
inline void parse(const std::string& word, ProofCause& cause) { cause = proof_cause_named(word); }

template <class Value>
struct Optional : std::false_type {};
template <class Value>
struct Optional<std::optional<Value>> : std::true_type {};

/// Returns the SQLite type in which a C++ type is stored.
template <class Value>
constexpr const char* sql_type() {
  if constexpr (Optional<Value>::value)
    return sql_type<typename Value::value_type>();
  else if constexpr (std::is_integral_v<Value>)
    return "INTEGER";
  else if constexpr (std::is_floating_point_v<Value>)
    return "REAL";
  else if constexpr (std::is_same_v<Value, Bytes>)
    return "BLOB";
  else
    return "TEXT";
}

template <class Value>
void bind(Statement& statement, int index, const Value& value) {
  if constexpr (Optional<Value>::value) {
    if (value)
      bind(statement, index, *value);
    else
      statement.bind_value(index, std::nullopt);
  } else if constexpr (std::is_same_v<Value, std::uint64_t>) {
    statement.bind_value(index, std::bit_cast<std::int64_t>(value));
  } else if constexpr (std::is_enum_v<Value>) {
    statement.bind_value(index, std::string(name(value)));
  } else if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>) {
    statement.bind_value(index, value);
  } else if constexpr (std::is_same_v<Value, Bytes>) {
    statement.bind_blob(index, value.bytes);
  } else {
    statement.bind_value(index, to_json(value));
  }
}

template <class Value>
void read(const Statement& row, int column, Value& value) {
  if constexpr (Optional<Value>::value) {
    value.reset();
    if (!row.is_null(column)) read(row, column, value.emplace());
  } else if constexpr (std::is_same_v<Value, bool>) {
    value = row.integer(column) != 0;
  } else if constexpr (std::is_same_v<Value, std::uint64_t>) {
    value = std::bit_cast<std::uint64_t>(row.integer(column));
  } else if constexpr (std::is_integral_v<Value>) {
    value = static_cast<Value>(row.integer(column));
  } else if constexpr (std::is_floating_point_v<Value>) {
    value = row.real(column);
  } else if constexpr (std::is_enum_v<Value>) {
    parse(row.text(column), value);
  } else if constexpr (std::is_same_v<Value, std::string>) {
    value = row.text(column);
  } else if constexpr (std::is_same_v<Value, Bytes>) {
    value.bytes = row.text(column);
  } else {
    from_json(row.text(column), value);
  }
}

template <class Value>
Cell cell_of(const Value& value) {
  if constexpr (Optional<Value>::value)
    return value ? cell_of(*value) : Cell{};
  else if constexpr (std::is_same_v<Value, std::uint64_t>)
    // The number uses all 64 bits. SQLite stores a large one as a negative number, so print it as unsigned.
    return cell(std::to_string(value));
  else if constexpr (std::is_integral_v<Value>)
    return cell(static_cast<std::int64_t>(value));
  else if constexpr (std::is_enum_v<Value>)
    return cell(std::string(name(value)));
  else if constexpr (std::is_floating_point_v<Value> || std::is_same_v<Value, std::string>)
    return cell(value);
  else if constexpr (std::is_same_v<Value, Bytes>)
    return Cell{};
  else
    return cell(to_json(value));
}

template <class Member>
struct MemberOf;
template <class Class, class Value>
struct MemberOf<Value Class::*> {
  using Record = Class;
};

/// Applies pointers to members one after another: member<&A::b, &B::c>(a) is a.b.c.
template <auto First, auto... Rest, class Record>
auto& member(Record& record) {
  if constexpr (sizeof...(Rest) == 0)
    return record.*First;
  else
    return member<Rest...>(record.*First);
}

/// The names and texts of a column. field() derives the type and the functions of the column from the pointer
/// to the data member.
struct About {
  const char* name;
  const char* csv = "";
  const char* description = "";
  const char* unit = "";
  const char* values = "";
};

template <auto First, auto... Rest>
Field<typename MemberOf<decltype(First)>::Record> field(const About& about) {
  using Record = typename MemberOf<decltype(First)>::Record;
  using Value = std::remove_reference_t<decltype(member<First, Rest...>(std::declval<Record&>()))>;
  return {about.name,
          about.csv,
          about.description,
          about.unit,
          about.values,
          sql_type<Value>(),
          Optional<Value>::value,
          [](Statement& s, int i, const Record& r) { bind(s, i, member<First, Rest...>(r)); },
          [](const Statement& s, int i, Record& r) { read(s, i, member<First, Rest...>(r)); },
          [](const Record& r) { return cell_of(member<First, Rest...>(r)); }};
}

}  // namespace turnpoint::store

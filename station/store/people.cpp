#include "station/store/people.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "station/store/open.hpp"
#include "station/store/seal.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::store {

namespace {

std::set<Bearer> bearers_in(Database& database) {
  std::set<Bearer> bearers;
  Statement rows(
      database,
      "SELECT station_id, participant FROM session UNION SELECT station_id, participant FROM enrolment");
  while (rows.step()) bearers.insert({rows.text(0), rows.text(1)});
  return bearers;
}

/// Sorts the codes of one person. The code that names the person comes first: one that was never the second
/// argument of join().
void put_name_first(std::vector<Bearer>& person, const std::vector<Join>& joins) {
  std::sort(person.begin(), person.end());
  const auto second = [&](const Bearer& bearer) {
    return std::any_of(joins.begin(), joins.end(), [&](const auto& join) { return join.second == bearer; });
  };
  std::stable_partition(person.begin(), person.end(), [&](const auto& bearer) { return !second(bearer); });
}

}  // namespace

std::vector<Join> list_joins(Database& database) {
  std::vector<Join> joins;
  Statement rows(database,
                 "SELECT station_a, code_a, station_b, code_b, realtime_ns FROM same_person"
                 " ORDER BY 1, 2, 3, 4");
  while (rows.step())
    joins.push_back({{rows.text(0), rows.text(1)}, {rows.text(2), rows.text(3)}, rows.integer(4)});
  return joins;
}

std::string full_name(const Bearer& bearer) { return bearer.code + "@" + bearer.station_id; }

People::People(Database& database) {
  const auto joins = list_joins(database);
  std::map<Bearer, std::vector<Bearer>> linked;
  for (const auto& bearer : bearers_in(database)) linked[bearer];
  for (const auto& [a, b, when] : joins) linked[a].push_back(b), linked[b].push_back(a);
  for (const auto& [start, unused] : linked) {
    if (person_of_.count(start) != 0) continue;
    std::vector<Bearer> person{start};
    person_of_[start] = persons_.size();
    for (std::size_t i = 0; i < person.size(); ++i)
      for (const auto& next : linked[Bearer(person[i])])
        if (person_of_.emplace(next, persons_.size()).second) person.push_back(next);
    put_name_first(person, joins);
    ++persons_with_code_[person.front().code];
    persons_.push_back(std::move(person));
  }
}

std::string People::label(const Bearer& bearer) const {
  const auto name = same_as(bearer).front();
  const auto found = persons_with_code_.find(name.code);
  return found != persons_with_code_.end() && found->second > 1 ? full_name(name) : name.code;
}

std::vector<Bearer> People::same_as(const Bearer& bearer) const {
  const auto found = person_of_.find(bearer);
  return found == person_of_.end() ? std::vector{bearer} : persons_[found->second];
}

std::vector<std::vector<Bearer>> People::named(const std::string& name) const {
  std::vector<std::vector<Bearer>> found;
  for (const auto& person : persons_)
    if (std::any_of(person.begin(), person.end(),
                    [&](const auto& bearer) { return bearer.code == name || full_name(bearer) == name; }))
      found.push_back(person);
  return found;
}

std::vector<Bearer> only_person(const People& people, const std::string& name, const std::string& what) {
  const auto found = people.named(name);
  if (found.size() == 1) return found.front();
  if (found.empty())
    throw StoreError(
        ErrorKind::missing,
        fmt::format("{}: the database has no participant \"{}\"; nothing was changed; `turnpoint "
                    "sessions` lists the participants",
                    what, name));
  std::string list;
  for (const auto& person : found) list += (list.empty() ? "" : ", ") + full_name(person.front());
  throw StoreError(ErrorKind::refused,
                   fmt::format("{}: \"{}\" could mean any of {} people: {}; nothing was changed; name one of "
                               "them, or use `turnpoint join` if they are the same person",
                               what, name, found.size(), list));
}

std::string join(const std::string& path, const std::string& first, const std::string& second,
                 Relation relation) {
  auto writer = open_writer(path, IfMissing::fail);
  auto& database = writer.database;
  const People people(database);
  const auto bearer = [&](const std::string& name) {
    const auto person = only_person(people, name, "join");
    const auto exact = std::find_if(person.begin(), person.end(), [&](const auto& one) {
      return one.code == name || full_name(one) == name;
    });
    return *exact;
  };
  const auto a = bearer(first), b = bearer(second);
  const auto same = people.same_as(a);
  const bool joined = std::find(same.begin(), same.end(), b) != same.end();
  if (a == b)
    throw StoreError(ErrorKind::refused,
                     fmt::format("join: {} and {} are the same code at the same station; nothing was changed",
                                 first, second));
  SealedTransaction transaction(database);
  if (relation == Relation::two_people)
    Statement(database,
              "DELETE FROM same_person WHERE (station_a, code_a, station_b, code_b) IN"
              " (VALUES (?1, ?2, ?3, ?4), (?3, ?4, ?1, ?2))")
        .bind(a.station_id, a.code, b.station_id, b.code)
        .run();
  else if (!joined)
    Statement(database, "INSERT INTO same_person VALUES (?,?,?,?,?)")
        .bind(a.station_id, a.code, b.station_id, b.code, system::realtime_ns())
        .run();
  if (relation == Relation::two_people && database.changes() == 0)
    throw StoreError(ErrorKind::missing,
                     fmt::format("join: {} and {} were never joined as one person; nothing was "
                                 "changed",
                                 full_name(a), full_name(b)));
  transaction.commit();
  return People(database).label(a);
}

}  // namespace turnpoint::store

#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// A participant code together with the station that assigned it. The same code at another station means
/// another person, unless somebody has joined the two with join().
struct Bearer {
  std::string station_id, code;
  auto operator<=>(const Bearer&) const = default;
};

/// Two codes that somebody has declared to belong to one person, which has the name of the first.
struct Join {
  Bearer first, second;
  std::int64_t realtime_ns = 0;
};

std::vector<Join> list_joins(Database& database);

/// Returns "CODE@STATION". Commands accept this form, and print it if a code is ambiguous.
std::string full_name(const Bearer& bearer);

/// The people in a database. Each person has one or more bearers (codes at stations); most have one.
class People {
 public:
  explicit People(Database& database);

  /// Returns the name of this person in exports and lists: the code, or CODE@STATION if other people in this
  /// database have the same code. If the person has several codes, joined by join(), the first argument of
  /// join() gives the name.
  std::string label(const Bearer& bearer) const;

  /// Returns all bearers (codes at stations) of the same person, including the given one.
  std::vector<Bearer> same_as(const Bearer& bearer) const;

  /// Returns the people whom `name` may mean, each as a list of bearers. `name` is a code, CODE@STATION or a
  /// label.
  std::vector<std::vector<Bearer>> named(const std::string& name) const;

 private:
  /// the bearers (codes at stations) of each person; the first one gives the person's name
  std::vector<std::vector<Bearer>> persons_;
  std::map<Bearer, std::size_t> person_of_;
  std::map<std::string, int> persons_with_code_;  ///< number of people who have each code
};

enum class Relation { same_person, two_people };

/// With Relation::same_person, records that two codes belong to the same person; with two_people, undoes
/// that. Each code is written as CODE@STATION, or as CODE if only one person has it. Trials and codes do not
/// change. Returns the person's label. Throws StoreError: missing for a code without a session, refused for
/// an ambiguous code or if both codes are the same.
std::string join(const std::string& database, const std::string& first, const std::string& second,
                 Relation relation = Relation::same_person);

/// Returns the person whom `name` means. Throws StoreError: missing if nobody has this name, refused if
/// several people have it (the message lists them).
std::vector<Bearer> only_person(const People& people, const std::string& name, const std::string& what);

}  // namespace turnpoint::store

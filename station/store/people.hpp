#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// A participant code together with the station that assigned it. The same code at another station is another
/// person, unless somebody has joined the two (join()).
struct Bearer {
  std::string station_id, code;
  auto operator<=>(const Bearer&) const = default;
};

/// "CODE@STATION", as commands accept it and as ambiguous codes are printed.
std::string full_name(const Bearer& bearer);

/// The people in a database. Groups the bearers of all its sessions by person.
class People {
 public:
  explicit People(Database& database);

  /// The name of this person in exports and lists: the code, or CODE@STATION if other people in this database
  /// have the same code. A joined person has the code that was named first.
  std::string label(const Bearer& bearer) const;

  /// All bearers that are the same person, including the given one.
  std::vector<Bearer> same_as(const Bearer& bearer) const;

  /// The people that `name` may mean, each as a list of bearers. `name` is a code, CODE@STATION or a label.
  std::vector<std::vector<Bearer>> named(const std::string& name) const;

 private:
  /// in each person, the code that the person is named after comes first
  std::vector<std::vector<Bearer>> persons_;
  std::map<Bearer, std::size_t> person_of_;
  std::map<std::string, int> persons_with_code_;  ///< number of people known by each code
};

enum class Relation { same_person, two_people };

/// Records that two codes are the same person, or undoes that. Each is CODE@STATION, or a code that only one
/// person has. Trials and codes do not change. Returns the person's label. Throws StoreError: missing for a
/// code without a session, refused for an ambiguous code or for joining a code with itself.
std::string join(const std::string& database, const std::string& first, const std::string& second,
                 Relation relation = Relation::same_person);

/// The person that `name` means. Throws StoreError: missing if there is none, refused if there are several
/// (the message lists them).
std::vector<Bearer> only_person(const People& people, const std::string& name, const std::string& what);

}  // namespace turnpoint::store

#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// A participant code as one station has given it out. The same code at another station is somebody else,
/// until somebody says that it is not (join()).
struct Bearer {
  std::string station_id, code;
  auto operator<=>(const Bearer&) const = default;
};

/// "CODE@STATION", as commands take it and as ambiguous codes are written.
std::string full_name(const Bearer& bearer);

/// Who is who in a database: the bearers of all its sessions, those of one person together.
class People {
 public:
  explicit People(Database& database);

  /// What exports and lists call this person: the code, or CODE@STATION where others in this database have
  /// the code as well. Of a joined person the first code that was named.
  std::string label(const Bearer& bearer) const;

  /// All bearers that are the same person, the one asked for among them.
  std::vector<Bearer> same_as(const Bearer& bearer) const;

  /// The persons that this may mean: a code, CODE@STATION or a label. Each as its bearers.
  std::vector<std::vector<Bearer>> named(const std::string& name) const;

 private:
  std::vector<std::vector<Bearer>> persons_;  ///< of each the bearer that gives it its name first
  std::map<Bearer, std::size_t> person_of_;
  std::map<std::string, int> persons_with_code_;  ///< by the code that they are called by
};

enum class Relation { same_person, two_people };

/// Notes that two codes are one person, or takes that back. Each is CODE@STATION, or a code that only one
/// person has. Trials and codes stay as they are. Returns the person's label. Throws StoreError: missing for
/// a code without a session, refused for an ambiguous one or for joining one with itself.
std::string join(const std::string& database, const std::string& first, const std::string& second,
                 Relation relation = Relation::same_person);

/// The one person that `name` means. Throws StoreError: missing for none, refused for several, with who they
/// are.
std::vector<Bearer> only_person(const People& people, const std::string& name, const std::string& what);

}  // namespace turnpoint::store

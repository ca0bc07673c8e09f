#include "station/store/station.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/fiemap.h>
#include <linux/fs.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include "station/core/file_descriptor.hpp"
#include "station/core/letters.hpp"
#include "station/core/number.hpp"
#include "station/store/checksum.hpp"
#include "station/store/files.hpp"
#include "station/store/open.hpp"
#include "station/store/seal.hpp"
#include "station/system/clocks.hpp"
#include "station/system/condition.hpp"
#include "station/system/uuid.hpp"

namespace turnpoint::store {

namespace {

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line.substr(0, line.find('\0'));  // texts of the device tree end with a zero
}

std::string first_word(const std::string& path) {
  const auto line = first_line(path);
  const auto begin = std::min(line.find_first_not_of(" \t\r"), line.size());
  return line.substr(begin, line.find_first_of(" \t\r", begin) - begin);
}

bool everybody_may_read(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && (status.st_mode & S_IROTH) != 0;
}

/// True for a file whose data have a place on a disk, as the file systems of disks tell every user. Those in
/// memory have no answer, and an overlay asks the layer that holds the file.
bool has_place_on_disk(const std::string& path) {
  const core::FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct fiemap request {};
  request.fm_length = FIEMAP_MAX_OFFSET;
  return ::ioctl(file.get(), FS_IOC_FIEMAP, &request) == 0 && request.fm_mapped_extents > 0;
}

/// True for a machine-id that the next boot replaces. On a disk that cannot be written, systemd makes one in
/// memory and mounts it over the file; a system that runs from memory, or keeps all changes there in the
/// upper layer of an overlay, makes one at each start. The file's time does not tell: many boards set their
/// clock only after they have made it.
bool lasts_until_shutdown(const std::string& path, const std::string& root) {
  const auto file_system = system::read_disk(path).file_system;
  if (file_system == "overlay") return !has_place_on_disk(path);
  if (file_system != "tmpfs" && file_system != "ramfs") return false;
  struct stat file {
  }, above{};
  const bool is_mounted = ::stat(path.c_str(), &file) == 0 && ::stat((root + "/etc").c_str(), &above) == 0 &&
                          file.st_dev != above.st_dev;
  return root.empty() || is_mounted;  // the folder that a test gives may itself be in memory
}

std::string lower_letters_and_digits(const std::string& text) {
  std::string kept;
  for (const char c : text) {
    const char low = core::lower(c);
    if ((low >= 'a' && low <= 'z') || (low >= '0' && low <= '9')) kept += low;
  }
  return kept;
}

/// True if the digits (of base 16) and letters are what somebody types to fill a field: one of them again and
/// again, or a row of neighbours such as 0123456789 or 11112222. Zeros do not count. In a serial number that
/// was given out, or in a random UUID, a fifth of the steps are as small as this, not nearly all.
bool is_filler(const std::string& symbols) {
  std::vector<int> values;
  for (const char c : symbols)
    if (c != '0') values.push_back(c <= '9' ? c - '0' : c - 'a' + 10);
  if (values.size() < 4) return true;
  std::size_t large = 0;
  for (std::size_t k = 1; k < values.size(); ++k) large += std::abs(values[k] - values[k - 1]) > 1 ? 1 : 0;
  const auto steps = values.size() - 1;
  return large <= (steps - std::min<std::size_t>(steps, 4)) / 5;
}

/// True for a value that its maker never set, and that all machines of a kind share.
bool is_of_all_machines(const std::string& value) {
  const auto symbols = lower_letters_and_digits(value);
  // What several makers of boards wrote instead of a UUID. The first pair is one value in both orders of
  // bytes; the others are a machine of Dell without a service tag.
  for (const auto* known : {"03000200040005000006000700080009", "00020003000400050006000700080009",
                            "4c4c454400002010802080c04f202020", "4c4c4544002020108020a0c04f202020",
                            "4c4c4544000020108020a0c04f202020", "4c4c454400202010802080c04f202020"})
    if (symbols == known) return true;
  if (symbols.find_first_of("0123456789") == std::string::npos) return true;  // "Default string", "None"
  for (const auto* word : {"default", "serial", "filled", "specified", "applicable", "settable", "present",
                           "unknown", "invalid", "empty", "number", "asset"})
    if (symbols.find(word) != std::string::npos) return true;
  std::string digits;
  for (const char c : symbols)
    if (c >= '1' && c <= '9') digits += c;
  return is_filler(symbols) || (digits.size() >= 8 && is_filler(digits));
}

/// The machine-id; "" if it is not one that this system made for good.
std::string lasting_machine_id(const std::string& root) {
  const auto path = root + "/etc/machine-id";
  const auto id = first_word(path);
  if (id.size() != 32 || id.find_first_not_of("0123456789abcdef") != std::string::npos) return "";
  return is_filler(id) || !everybody_may_read(path) || lasts_until_shutdown(path, root) ? "" : id;
}

/// The folder of the disk (not of its partition) that holds /etc; "" if that is no single disk.
std::string disk_of_system(const std::string& root) {
  struct stat state {};
  std::error_code error;
  if (::stat((root + "/etc").c_str(), &state) != 0) return "";
  const auto folder = std::filesystem::canonical(
      fmt::format("{}/sys/dev/block/{}:{}", root, major(state.st_dev), minor(state.st_dev)), error);
  if (error) return "";
  return std::filesystem::exists(folder / "partition", error) ? folder.parent_path().string()
                                                              : folder.string();
}

/// The first number that a maker gave to this one board, computer or disk.
std::string hardware_number(const std::string& root) {
  std::vector<std::string> places;
  for (const auto* name : {"/sys/firmware/devicetree/base/serial-number", "/sys/class/dmi/id/product_uuid",
                           "/sys/class/dmi/id/board_serial", "/sys/class/dmi/id/product_serial"})
    places.push_back(root + name);
  if (const auto disk = disk_of_system(root); !disk.empty())
    for (const auto* name : {"/device/cid", "/wwid", "/device/wwid", "/serial", "/device/serial"})
      places.push_back(disk + name);
  for (const auto& path : places) {
    if (!everybody_may_read(path)) continue;
    if (auto value = first_line(path); !is_of_all_machines(value)) return value;
  }
  return "";
}

std::string meta(Database& database, const char* key) {
  Statement row(database, "SELECT value FROM meta WHERE key = ?");
  return row.bind(key).step() ? row.text(0) : "";
}

void set_meta(Database& database, const char* key, const std::string& value) {
  Statement(database, "INSERT OR REPLACE INTO meta VALUES (?, ?)").bind(key, value).run();
}

bool is_other(const std::string& known, const std::string& machine) {
  return !known.empty() && !machine.empty() && known != machine;
}

void require_possible(const std::string& name) {
  // The same as deploy/collector, which makes a role of PostgreSQL from it.
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  const auto allowed = [&](char c) {
    return plain(c) || std::string_view("._-").find(c) != std::string_view::npos;
  };
  if (!name.empty() && name.size() <= 41 && plain(name.front()) &&
      std::all_of(name.begin(), name.end(), allowed))
    return;
  throw StoreError(
      ErrorKind::refused,
      fmt::format("station-name: \"{}\" cannot be the name of a station; use 1 to 41 letters, digits, "
                  "dots, hyphens and underscores, the first one a letter or a digit; nothing was changed",
                  name));
}

/// Takes the triggers away and makes them again as they were. Within a transaction, nobody else notices.
class WithoutTriggers {
 public:
  explicit WithoutTriggers(Database& database) : database_(database) {
    Statement rows(database, "SELECT name, sql FROM sqlite_schema WHERE type = 'trigger' ORDER BY rowid");
    while (rows.step()) triggers_.emplace_back(rows.text(0), rows.text(1));
    rows.reset();
    for (const auto& [name, sql] : triggers_) database.execute("DROP TRIGGER " + name);
  }
  void restore() {
    for (const auto& [name, sql] : triggers_) database_.execute(sql);
  }

 private:
  Database& database_;
  std::vector<std::pair<std::string, std::string>> triggers_;
};

/// Gives all stored sessions of a station its new name. Returns their number.
std::int64_t rename_sessions(Database& database, const std::string& was, const std::string& name,
                             const std::string& machine) {
  Statement foreign(
      database,
      "SELECT 1 FROM session JOIN segment USING (session_id) WHERE station_id = ? AND machine <> ?"
      " AND machine <> ''");
  if (foreign.bind(was, machine).step())
    throw StoreError(
        ErrorKind::refused,
        fmt::format("station-name: database {} has sessions of station {} that another machine has "
                    "recorded, and they keep this name; nothing was changed; leave out --stored to name "
                    "only later sessions",
                    database.path(), was));
  std::vector<std::string> ids;
  Statement rows(database, "SELECT session_id FROM session WHERE station_id = ? ORDER BY session_id");
  rows.bind(was);
  while (rows.step()) ids.push_back(rows.text(0));
  rows.reset();
  WithoutTriggers open(database);
  for (const auto& id : ids) {
    Statement(database,
              "INSERT INTO renamed SELECT session_id, ?, max(link_index) FROM link WHERE session_id = ?")
        .bind(was, id)
        .run();
    Statement(database, "UPDATE session SET station_id = ? WHERE session_id = ?").bind(name, id).run();
    renew_links(database, id);
  }
  for (const auto* change : {"UPDATE enrolment SET station_id = ?2 WHERE station_id = ?1",
                             "UPDATE same_person SET station_a = ?2 WHERE station_a = ?1",
                             "UPDATE same_person SET station_b = ?2 WHERE station_b = ?1",
                             "UPDATE tombstone SET station_id = ?2 WHERE station_id = ?1"})
    Statement(database, change).bind(was, name).run();
  open.restore();
  return static_cast<std::int64_t>(ids.size());
}

/// Records that each code of a station belongs to the same person under the station's new name.
void keep_people(Database& database, const std::string& was, const std::string& name) {
  Statement(
      database,
      "INSERT OR IGNORE INTO same_person SELECT ?1, code, ?2, code, ?3 FROM (SELECT participant AS code FROM"
      " session WHERE station_id = ?1 UNION SELECT participant FROM enrolment WHERE station_id = ?1)")
      .bind(was, name, system::realtime_ns())
      .run();
}

[[noreturn]] void refuse_machine(const Database& database, const std::string& station) {
  throw StoreError(
      ErrorKind::other_machine,
      fmt::format(
          "database {}: it belongs to station {} on another machine; nothing was changed; if this is a copy, "
          "for example of a card, name it: turnpoint station-name --db {} NEW-NAME; if the board or the disk "
          "was replaced, and the other machine records no more: turnpoint station-name --db {} --moved",
          database.path(), station, database.path(), database.path()));
}

NamedStation station_in(Database& database) {
  return {meta(database, "station"), meta(database, "machine"), meta(database, "database_id"), "", 0, false};
}

}  // namespace

MachineTraits machine_traits(const std::string& root) {
  return {lasting_machine_id(root), hardware_number(root)};
}

std::string machine_identity(const std::string& root) {
  const auto [id, hardware] = machine_traits(root);
  return id.empty() && hardware.empty() ? "" : core::sha256(id + "\n" + hardware);
}

std::string suggested_station_name(const std::string& root) {
  if (const auto chosen = first_word(root + "/etc/turnpoint/station"); !chosen.empty()) return chosen;
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  const std::string name = host.data();
  constexpr std::array<std::string_view, 5> of_images{"turnpoint", "localhost", "raspberrypi", "debian", ""};
  if (std::find(of_images.begin(), of_images.end(), name) == of_images.end()) return name;
  const auto identity = machine_identity(root);
  return (name.empty() ? "station" : name) + (identity.empty() ? "" : "-" + identity.substr(0, 4));
}

std::string station_name(const std::string& name) {
  const auto path = canonical(name);
  if (file_exists(path)) {
    auto database = open_reader(path);
    if (auto remembered = meta(database, "station"); !remembered.empty()) return remembered;
  }
  return suggested_station_name();
}

void claim_station(Database& database, const std::string& station, const std::string& machine) {
  require_own_machine(database, machine);
  if (meta(database, "station").empty()) set_meta(database, "station", station);
  if (meta(database, "machine").empty() && !machine.empty()) set_meta(database, "machine", machine);
}

void require_own_machine(Database& database, const std::string& machine) {
  if (is_other(meta(database, "machine"), machine)) refuse_machine(database, meta(database, "station"));
}

NamedStation read_station(const std::string& name) {
  auto database = open_reader(name);
  return station_in(database);
}

NamedStation name_station(const std::string& path, const StationName& how, const std::string& machine) {
  if (!how.name.empty()) require_possible(how.name);
  auto writer = open_writer(path, IfMissing::create);
  auto& database = writer.database;
  auto station = station_in(database);
  station.was = station.name;
  const bool is_copy = is_other(station.machine, machine) && how.whose == Whose::found;
  if (is_copy && how.name.empty()) refuse_machine(database, station.name);
  if (!how.name.empty()) station.name = how.name;
  SealedTransaction transaction(database);
  if ((is_copy || station.name != station.was) && !station.was.empty()) {
    Statement taken(
        database,
        "SELECT 1 FROM session WHERE station_id = ?1 UNION SELECT 1 FROM enrolment WHERE station_id = ?1");
    if (taken.bind(station.name).step())
      throw StoreError(
          ErrorKind::refused,
          fmt::format("station-name: database {} already has a station {}; nothing was changed; choose "
                      "another name",
                      database.path(), station.name));
    if (how.stored_sessions)
      station.sessions = rename_sessions(database, station.was, station.name, machine);
    else if (!is_copy)
      keep_people(database, station.was, station.name);
  }
  if (!machine.empty()) station.machine = machine;
  station.is_new_identity = is_copy;
  if (is_copy) station.database_id = system::new_uuid();
  set_meta(database, "station", station.name);
  if (!station.machine.empty()) set_meta(database, "machine", station.machine);
  set_meta(database, "database_id", station.database_id);
  transaction.commit();
  writer.lock.remember(station.database_id);
  return station;
}

void move_station(Database& database, const std::string& machine) {
  if (machine.empty()) return;
  SealedTransaction transaction(database);
  set_meta(database, "machine", machine);
  transaction.commit();
}

void refuse_two_machines(Database& database) {
  Statement rows(database,
                 "WITH here AS (SELECT DISTINCT station_id, machine FROM main.session JOIN main.segment "
                 "USING (session_id)"
                 "  WHERE machine <> '' AND session_id NOT IN (SELECT session_id FROM source.session)"
                 "   AND session_id NOT IN (SELECT session_id FROM source.tombstone)),"
                 " there AS (SELECT DISTINCT station_id, machine FROM source.session JOIN source.segment "
                 "USING (session_id)"
                 "  WHERE machine <> '' AND session_id NOT IN (SELECT session_id FROM main.session)"
                 "   AND session_id NOT IN (SELECT session_id FROM main.tombstone))"
                 " SELECT here.station_id FROM here JOIN there USING (station_id) WHERE here.machine <> "
                 "there.machine LIMIT 1");
  if (!rows.step()) return;
  throw StoreError(
      ErrorKind::conflict,
      fmt::format(
          "merge: two machines have recorded as station {}, so one code can mean two people; nothing was "
          "merged; "
          "give one of the two databases another name, on its own machine: turnpoint station-name --db FILE "
          "NEW-NAME --stored",
          rows.text(0)));
}

}  // namespace turnpoint::store

#pragma once
#include <cstdint>
#include <string>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

// Who a station is: a name, which somebody chose and which its sessions carry, and the machine on which they
// were recorded. A database remembers both from its first session on (meta `station` and `machine`), so a
// host that gets another name changes nothing, and a copy of a card or of an image is noticed.

/// Identifies this machine: a SHA-256 over /etc/machine-id, which a copied card or image shares, and a number
/// that a maker gave to the hardware, which it does not share: the serial number of the board in the device
/// tree, the UUID of the firmware (DMI), the serial number there, or else that of the disk with the system.
/// Values that a maker never set ("Default string", zeros) and a machine-id that the next boot replaces do
/// not count, so that no two machines are one because of them, and no machine becomes another one. The result
/// does not depend on who asks: a number counts only if every user may read it, as the package arranges. ""
/// if nothing is left; such a machine is never taken for another one. `root` is the folder in which to look;
/// tests give another one.
std::string machine_identity(const std::string& root = "");

/// What machine_identity() rests on. Without a number of the hardware, nobody notices that a disk was copied
/// to another machine; without a lasting machine-id, two virtual machines of one image may count as one.
struct MachineTraits {
  std::string machine_id, hardware;
};
MachineTraits machine_traits(const std::string& root = "");

/// The name that this machine suggests for its station: the first word of /etc/turnpoint/station if there is
/// one, otherwise the host's name. A name that images give ("turnpoint", "localhost", ...) is followed by
/// four digits of the machine's identity, so that two machines with one image have two names.
std::string suggested_station_name(const std::string& root = "");

/// The station under whose name this database records: the name that it remembers, otherwise the suggested
/// one, also if there is no such file.
std::string station_name(const std::string& database);

/// Remembers station and machine if the database does not know them yet. Call it in the transaction that
/// begins or resumes a session. Throws StoreError (other_machine) if the database belongs to another machine:
/// then either it is a copy and needs a name of its own, or the board or disk was replaced, and somebody has
/// to say so (name_station).
void claim_station(Database& database, const std::string& station, const std::string& machine);

/// Throws as claim_station() does, and changes nothing.
void require_own_machine(Database& database, const std::string& machine);

enum class Whose {
  found,  ///< on the machine that the database knows: nothing changes; on another one: the database is a copy
  moved,  ///< this machine replaces the one that the database knows
};

struct StationName {
  std::string name;  ///< the new name; "" keeps the present one
  Whose whose = Whose::found;
  /// Gives the new name also to the sessions that are stored, which is necessary if two machines have
  /// recorded under one name. Their checksums are made anew; those of earlier exports still belong to them
  /// (`renamed`).
  bool stored_sessions = false;
};

struct NamedStation {
  std::string name, machine, database_id;
  std::string was;               ///< the name before; "" if there was none
  std::int64_t sessions = 0;     ///< number of stored sessions that got the new name
  bool is_new_identity = false;  ///< true if a copy got its own database_id
};

/// Returns the station of a database, as it is now.
NamedStation read_station(const std::string& database);

/// Names the station of a database, which is created if it is missing. On the machine of the database, the
/// codes of its participants belong to the same people under the new name. A copy gets its own id, so that
/// its backups are not mixed with those of the original. Throws StoreError: other_machine for a copy without
/// a new name, refused for a name that is not possible or is another station's in this database, and for
/// stored sessions that another machine has recorded.
NamedStation name_station(const std::string& database, const StationName& how,
                          const std::string& machine = machine_identity());

/// Makes this machine the one of the database, in place of the one that it knows.
void move_station(Database& database, const std::string& machine);

/// Throws StoreError (conflict) if two machines have recorded under one name and each database lacks sessions
/// of the other. The other database is attached as `source`.
void refuse_two_machines(Database& database);

}  // namespace turnpoint::store

#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

/// Makes SQLite write to a disk that can lose its power: what was synced stays, of everything written since
/// any part may be there and any part not, sector by sector. A shim over the real file system, the default
/// for connections opened while it lives. Not thread-safe.
class LossyDisk {
 public:
  enum class Syncs { kept, ignored };  ///< ignored: a disk that says it has synced and has not

  explicit LossyDisk(Syncs syncs);
  LossyDisk(const LossyDisk&) = delete;
  LossyDisk& operator=(const LossyDisk&) = delete;
  ~LossyDisk();

  /// Called before each write, truncation and sync: the moments when power may go.
  void at_each_operation(std::function<void()> call);

  /// The files of `database` as a power cut at this moment may leave them, into the folder `into`, which must
  /// exist. `seed` chooses what survives.
  void cut(const std::string& database, const std::string& into, std::uint64_t seed) const;

  /// Keeps nothing of this database any longer; no connection to it may be open.
  void forget(const std::string& database);
};

#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

/// Makes SQLite write to a disk that can lose power. Synced data stay; of everything written since, each
/// sector may or may not be there. This is a shim over the real file system and the default for connections
/// opened during its lifetime. Not thread-safe.
class LossyDisk {
 public:
  enum class Syncs { kept, ignored };  ///< ignored: a disk that reports a sync without doing it

  explicit LossyDisk(Syncs syncs);
  LossyDisk(const LossyDisk&) = delete;
  LossyDisk& operator=(const LossyDisk&) = delete;
  ~LossyDisk();

  /// Sets a function that is called before each write, truncation and sync: the moments at which power may
  /// fail.
  void at_each_operation(std::function<void()> call);

  /// Writes the files of `database`, as a power cut at this moment may leave them, into the existing folder
  /// `into`. `seed` chooses what survives.
  void cut(const std::string& database, const std::string& into, std::uint64_t seed) const;

  /// Forgets this database. No connection to it may be open.
  void forget(const std::string& database);
};

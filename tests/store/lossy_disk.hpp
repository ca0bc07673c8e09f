#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

/// Makes SQLite write to a disk that can lose power. Synced data stay; of everything written since then, each
/// sector may be lost. While an object exists, connections are opened on it by default; other operations go
/// to the real file system. Not thread-safe.
class LossyDisk {
 public:
  enum class Syncs { kept, ignored };  ///< ignored: a bad disk that reports success without syncing

  explicit LossyDisk(Syncs syncs);
  LossyDisk(const LossyDisk&) = delete;
  LossyDisk& operator=(const LossyDisk&) = delete;
  ~LossyDisk();

  /// Sets a function that is called before each write, truncation and sync: the moments at which power may
  /// fail.
  void at_each_operation(std::function<void()> call);

  /// Writes the files of `database` to the existing folder `into` as a power cut at this moment may leave
  /// them. `seed` chooses which writes survive.
  void cut(const std::string& database, const std::string& into, std::uint64_t seed) const;

  /// Forgets this database. No connection to it may be open.
  void forget(const std::string& database);
};

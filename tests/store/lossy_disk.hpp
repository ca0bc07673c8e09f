#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

/// Makes SQLite write to a simulated disk that can lose power. After a power cut, synced data are still
/// there, but each sector that was written after the last sync may be lost. While an object exists, new
/// connections use this disk by default; other operations go to the real file system. Not thread-safe.
class LossyDisk {
 public:
  enum class Syncs { kept, ignored };  ///< ignored: a bad disk that reports success without syncing

  explicit LossyDisk(Syncs syncs);
  LossyDisk(const LossyDisk&) = delete;
  LossyDisk& operator=(const LossyDisk&) = delete;
  ~LossyDisk();

  /// Sets a function that is called before each write, truncation and sync, so that a test can cut the power
  /// at these moments.
  void at_each_operation(std::function<void()> call);

  /// Writes the files of `database` to the existing folder `into`, in a state that a power cut at this moment
  /// may leave. `seed` decides which writes survive.
  void cut(const std::string& database, const std::string& into, std::uint64_t seed) const;

  /// Forgets this database. No connection to it may be open.
  void forget(const std::string& database);
};

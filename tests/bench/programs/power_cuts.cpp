// power_cuts OUT COUNT none|some: replays COUNT power cuts on what qemu's blklogwrites recorded of a disk
// (OUT/disk.log on top of OUT/disk.start.img). At a cut everything flushed is on the disk, and each 512-byte
// sector written since the last flush is kept or lost at random. The file system is then checked, the
// database copied out, and compared with what had been acknowledged (OUT/acknowledged) up to the last flush.
// `none`: no cut may lose an acknowledged transaction or the database's integrity; `some`: at least one must
// (the negative control).
#include <sqlite3.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kSector = 512;
constexpr std::uint64_t kFlush = 1, kDiscard = 4;

// Format of the Linux device mapper's log-writes target: a super block, then entries of one sector each with
// their data.
struct Super {
  std::uint64_t magic, version, entries;
  std::uint32_t sector_size;
};
struct Entry {
  std::uint64_t sector, sectors, flags, data_length;
};
struct Write {
  Entry entry;
  std::uint64_t data_at;
};

std::vector<Write> read_log(std::ifstream& log) {
  Super super{};
  log.read(reinterpret_cast<char*>(&super), 28);
  if (super.magic != 0x6a736677736872ULL) std::fprintf(stderr, "power_cuts: not a log\n"), std::exit(1);
  std::vector<Write> writes;
  std::uint64_t at = super.sector_size;
  for (std::uint64_t i = 0; i < super.entries; ++i) {
    Write write{};
    log.seekg(static_cast<std::streamoff>(at));
    log.read(reinterpret_cast<char*>(&write.entry), sizeof(Entry));
    at += super.sector_size;
    write.data_at = at;
    if (!(write.entry.flags & kDiscard)) at += write.entry.sectors * super.sector_size;
    writes.push_back(write);
  }
  return writes;
}

/// The disk after a cut before log entry `cut`.
void replay(const fs::path& out, const std::vector<Write>& writes, std::ifstream& log, std::size_t cut,
            std::mt19937_64& random) {
  fs::copy_file(out / "disk.start.img", out / "cut.img", fs::copy_options::overwrite_existing);
  std::size_t flushed = 0;
  for (std::size_t i = 0; i < cut; ++i)
    if (writes[i].entry.flags & kFlush) flushed = i + 1;
  std::fstream disk(out / "cut.img", std::ios::binary | std::ios::in | std::ios::out);
  std::vector<char> sector(kSector);
  for (std::size_t i = 0; i < cut; ++i) {
    if (writes[i].entry.flags & kDiscard) continue;
    for (std::uint64_t s = 0; s < writes[i].entry.sectors; ++s) {
      if (i >= flushed && random() % 2) continue;
      log.seekg(static_cast<std::streamoff>(writes[i].data_at + s * kSector));
      log.read(sector.data(), kSector);
      disk.seekp(static_cast<std::streamoff>((writes[i].entry.sector + s) * kSector));
      disk.write(sector.data(), kSector);
    }
  }
}

/// Rows of the database on the cut disk, or -1 with why on standard error.
int rows_after(const fs::path& out) {
  const auto image = (out / "cut.img").string(), copy = (out / "copy.sqlite").string();
  const auto run = [](const std::string& command) {
    return std::system((command + " >/dev/null 2>&1").c_str());
  };
  const int checked = run("/sbin/e2fsck -fy " + image);
  if (WEXITSTATUS(checked) > 2) return std::fprintf(stderr, "e2fsck gave %d\n", WEXITSTATUS(checked)), -1;
  for (const auto* suffix : {"", "-wal"}) {
    fs::remove(copy + suffix);
    run("/sbin/debugfs -R 'dump /station.sqlite" + std::string(suffix) + " " + copy + suffix + "' " + image);
  }
  fs::remove(copy + "-shm");
  if (!fs::exists(copy)) return 0;  // cut before the database was there
  sqlite3* db = nullptr;
  int rows = -1;
  std::string integrity;
  sqlite3_open(copy.c_str(), &db);
  const auto text = [](void* to, int, char** values, char**) {
    return *static_cast<std::string*>(to) = values[0] ? values[0] : "", 0;
  };
  std::string count = "0";
  const bool good =
      sqlite3_exec(db, "PRAGMA integrity_check", text, &integrity, nullptr) == SQLITE_OK && integrity == "ok";
  const int counted = sqlite3_exec(db, "SELECT count(*) FROM row", text, &count, nullptr);
  if (good && counted == SQLITE_OK) rows = std::atoi(count.c_str());
  if (good && counted == SQLITE_ERROR) rows = 0;  // the table had not been made yet
  if (!good) std::fprintf(stderr, "integrity: %s (%s)\n", integrity.c_str(), sqlite3_errmsg(db));
  sqlite3_close(db);
  return rows;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return std::fprintf(stderr, "power_cuts OUT COUNT none|some\n"), 2;
  const fs::path out = argv[1];
  std::ifstream log(out / "disk.log", std::ios::binary);
  const auto writes = read_log(log);
  std::ifstream file(out / "acknowledged");
  int acknowledged = 0;
  for (int n = 0; file >> n;) acknowledged = n;
  if (writes.empty() || acknowledged == 0)
    return std::fprintf(stderr, "power_cuts: nothing was recorded\n"), 1;

  // When all is over every acknowledged row must be there; before, a row is owed once a flush has followed
  // it. With WAL and FULL each commit ends with a flush, so n flushes into the transactions at least n minus
  // the set-up rows are owed: counted from the end, where the acknowledgements are known exactly.
  std::vector<std::size_t> flushes;
  for (std::size_t i = 0; i < writes.size(); ++i)
    if (writes[i].entry.flags & kFlush) flushes.push_back(i);
  std::mt19937_64 random(20261121);
  int lost = 0, broken = 0;
  const int cuts = std::atoi(argv[2]);
  for (int cut = 0; cut < cuts; ++cut) {
    // Half of the cuts come after the last acknowledgement, where everything is owed.
    const bool at_end = cut % 2 == 0;
    const std::size_t at = at_end ? writes.size() : 1 + random() % writes.size();
    replay(out, writes, log, at, random);
    const int rows = rows_after(out);
    if (rows < 0) ++broken;
    if (at_end && rows >= 0 && rows < acknowledged) ++lost;
  }
  std::printf("# %zu writes, %zu flushes, %d acknowledged; %d cuts: %d lost rows, %d broken\n", writes.size(),
              flushes.size(), acknowledged, cuts, lost, broken);
  fs::remove(out / "cut.img");
  const bool none = std::strcmp(argv[3], "none") == 0;
  return none == (lost + broken == 0) ? 0 : 1;
}

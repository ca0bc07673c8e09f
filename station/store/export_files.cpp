#include "station/store/export_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <zlib.h>

#include <cctype>
#include <cerrno>
#include <filesystem>
#include <stdexcept>

#include "station/system/write_file.hpp"

namespace turnpoint::store {

void Gzip::End::operator()(z_stream_s* stream) const {
  deflateEnd(stream);
  delete stream;
}

Gzip::Gzip() : stream_(new z_stream_s()) {
  // For tables of signals, level 6 would make the files only 4 % smaller, and take more than three times as
  // long.
  constexpr int level = 4, gzip_window = 15 + 16, memory = 8;
  if (deflateInit2(stream_.get(), level, Z_DEFLATED, gzip_window, memory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
}

std::string Gzip::compressed(std::string_view text, int flush) {
  std::string bytes;
  char piece[16384];
  stream_->next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream_->avail_in = static_cast<uInt>(text.size());
  do {
    stream_->next_out = reinterpret_cast<Bytef*>(piece);
    stream_->avail_out = sizeof piece;
    if (deflate(stream_.get(), flush) == Z_STREAM_ERROR)
      throw std::logic_error("gzip: text was added after the end");
    bytes.append(piece, sizeof piece - stream_->avail_out);
  } while (stream_->avail_out == 0);
  return bytes;
}

std::string Gzip::add(std::string_view text) { return compressed(text, Z_NO_FLUSH); }
std::string Gzip::finish() { return compressed("", Z_FINISH); }

namespace fs = std::filesystem;

namespace {

/// A table's text is collected in memory and written to the file whenever it reaches this size.
constexpr std::size_t kPieceBytes = 1U << 18U;

/// Calls `write`. If `write` fails, throws an error that says what the export was writing and what to do.
template <class Write>
auto writing(const std::string& path, Write write) {
  try {
    return write();
  } catch (const std::system_error& error) {
    const bool full = error.code() == std::errc::no_space_on_device;
    throw StoreError(
        full ? ErrorKind::disk_full : ErrorKind::read_only,
        fmt::format("export to {}: {}; {}", path, error.what(),
                    full ? "free some space and export again" : "name a folder that can be written"));
  }
}

}  // namespace

std::string file_name_of(const std::string& text) {
  std::string name = text.empty() || text.front() == '.' ? "_" : "";
  for (const char c : text) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
    name += plain ? c : '_';
  }
  return name;
}

void write_file(const std::string& path, const std::string& bytes) {
  writing(path, [&] {
    system::make_folder(fs::path(path).parent_path().string());
    system::write_file(path, bytes);
  });
}

FolderLock::FolderLock(const std::string& folder) {
  writing(folder, [&] { system::make_folder(folder); });
  folder_ = core::FileDescriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  while (folder_.is_open() && ::flock(folder_.get(), LOCK_EX) != 0 && errno == EINTR) {
  }
}

TableFile::TableFile(const std::string& path, const TableStyle& style,
                     const std::vector<std::string>& columns, Header header)
    : path_(path), table_(style, columns), file_(writing(path, [&] {
        system::make_folder(fs::path(path).parent_path().string());
        return system::FileWriter(path);
      })) {
  if (path.ends_with(".gz")) gzip_ = std::make_unique<Gzip>();
  if (header == Header::left_out) table_.take();
}

void TableFile::write_piece() {
  const auto text = table_.take();
  writing(path_, [&] { file_.write(gzip_ ? gzip_->add(text) : text); });
}

void TableFile::row(const std::vector<Cell>& cells) {
  table_.row(cells);
  if (table_.text().size() >= kPieceBytes) write_piece();
}

void TableFile::finish(std::vector<ExportedFile>& files) {
  write_piece();
  writing(path_, [&] {
    if (gzip_) file_.write(gzip_->finish());
    file_.commit();
  });
  files.push_back({path_, table_.rows()});
}

}  // namespace turnpoint::store

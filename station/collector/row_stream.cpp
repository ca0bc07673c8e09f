#include "station/collector/row_stream.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>

namespace turnpoint::collector {

namespace {

const std::string kSignature("PGCOPY\n\377\r\n\0", 11);
constexpr std::size_t kPieceBytes = 256U << 10U;

template <class Unsigned>
void put(std::string& bytes, Unsigned value) {
  for (int shift = static_cast<int>(sizeof value) * 8 - 8; shift >= 0; shift -= 8)
    bytes.push_back(static_cast<char>(static_cast<unsigned char>((value >> shift) & 0xffU)));
}

void put_text(std::string& bytes, const std::string& text) {
  put(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += text;
}

void put_number(std::string& bytes, std::uint64_t bits) {
  put(bytes, std::uint32_t{8});
  put(bytes, bits);
}

void put_value(std::string& bytes, const store::Statement& row, int i, const Column& column) {
  if (row.is_null(i))
    put(bytes, std::uint32_t{0xffffffffU});
  else if (column.type == "INTEGER")
    put_number(bytes, std::bit_cast<std::uint64_t>(row.integer(i)));
  else if (column.type == "REAL")
    put_number(bytes, std::bit_cast<std::uint64_t>(row.real(i)));
  else
    put_text(bytes, row.text(i));
}

/// Reads values one after another from the bytes that a server sent.
class Reader {
 public:
  void add(const std::string& bytes) {
    bytes_.erase(0, at_);
    at_ = 0;
    bytes_ += bytes;
  }
  template <class Unsigned>
  Unsigned take() {
    Unsigned value = 0;
    for (const char c : take_bytes(sizeof value))
      value = static_cast<Unsigned>((value << 8U) | static_cast<unsigned char>(c));
    return value;
  }
  std::string take_bytes(std::size_t size) {
    if (bytes_.size() - at_ < size) throw ServerError("collector: the server sent an incomplete row", "");
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

void bind_value(store::Statement& insert, int index, const Column& column, Reader& reader) {
  const auto size = reader.take<std::uint32_t>();
  if (size == 0xffffffffU)
    insert.bind_value(index, std::nullopt);
  else if (column.type == "INTEGER")
    insert.bind_value(index, std::bit_cast<std::int64_t>(reader.take<std::uint64_t>()));
  else if (column.type == "REAL")
    insert.bind_value(index, std::bit_cast<double>(reader.take<std::uint64_t>()));
  else if (column.type == "BLOB")
    insert.bind_blob(index, reader.take_bytes(size));
  else
    insert.bind_value(index, reader.take_bytes(size));
}

std::string insert_sql(const CollectedTable& table) {
  std::string marks = "?";
  for (std::size_t i = 1; i < table.columns.size(); ++i) marks += ",?";
  return fmt::format("INSERT INTO {} ({}) VALUES ({})", table.name, column_list(table), marks);
}

}  // namespace

std::int64_t send_rows(store::Statement& rows, const CollectedTable& table, Connection& server,
                       const std::string& copy) {
  std::int64_t count = 0;
  std::string bytes;
  while (rows.step()) {
    if (count++ == 0) {
      server.begin_copy_in(copy);
      bytes = kSignature;
      put(bytes, std::uint64_t{0});  // no flags, and a header extension of length 0
    }
    put(bytes, static_cast<std::uint16_t>(table.columns.size()));
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      put_value(bytes, rows, static_cast<int>(i), table.columns[i]);
    if (bytes.size() < kPieceBytes) continue;
    server.copy_data(bytes);
    bytes.clear();
  }
  rows.reset();
  if (count == 0) return 0;
  put(bytes, std::uint16_t{0xffffU});
  server.copy_data(bytes);
  server.end_copy_in();
  return count;
}

std::int64_t receive_rows(Connection& server, const std::string& copy, const CollectedTable& table,
                          store::Database& database) {
  store::Statement insert(database, insert_sql(table));
  server.begin_copy_out(copy);
  Reader reader;
  std::int64_t count = 0;
  bool header = true;
  // libpq returns one row at a time; the first piece also contains the header.
  while (const auto piece = server.next_copy_data()) {
    reader.add(*piece);
    if (header) reader.take_bytes(kSignature.size() + 8);
    header = false;
    const auto columns = reader.take<std::uint16_t>();
    if (columns == 0xffffU) continue;
    if (columns != table.columns.size())
      throw ServerError(fmt::format("collector: table {} has {} columns on the server", table.name, columns),
                        "");
    insert.reset();
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      bind_value(insert, static_cast<int>(i) + 1, table.columns[i], reader);
    insert.run();
    ++count;
  }
  return count;
}

}  // namespace turnpoint::collector

#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "station/store/error.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace turnpoint::store {

class Database;

/// A prepared statement. bind() sets its parameters in order and copies texts. Move-only; must not outlive
/// its database.
class Statement {
 public:
  Statement(Database& database, const std::string& sql);
  Statement(Statement&& other) noexcept;
  Statement& operator=(Statement&&) = delete;
  ~Statement();

  /// Binds all parameters, from the first on: integers, doubles, texts, and optionals (NULL if empty).
  template <class... Values>
  Statement& bind(const Values&... values) {
    reset();
    int index = 0;
    (bind_value(++index, values), ...);
    return *this;
  }

  /// Binds one parameter; the first has index 1. Call reset() before binding.
  template <class Value>
  void bind_value(int index, const Value& value) {
    if constexpr (std::is_same_v<Value, std::nullopt_t>)
      bind_null(index);
    else if constexpr (std::is_integral_v<Value>)
      bind_integer(index, static_cast<std::int64_t>(value));
    else if constexpr (std::is_floating_point_v<Value>)
      bind_real(index, value);
    else if constexpr (std::is_convertible_v<Value, std::string>)
      bind_string(index, value);
    else if (value)
      bind_value(index, *value);
    else
      bind_null(index);
  }

  void bind_blob(int index, const std::string& bytes);

  bool step();  ///< advances to the next row; false if there is none
  void run();   ///< steps until there are no more rows, then resets the statement
  void reset();

  int columns() const;
  bool is_null(int column) const;
  bool is_real(int column) const;
  bool is_text(int column) const;
  bool is_blob(int column) const;
  std::int64_t integer(int column) const;
  double real(int column) const;
  std::string text(int column) const;  ///< text or bytes of a column; "" for NULL
  std::optional<std::int64_t> maybe_integer(int column) const;

 private:
  void bind_integer(int index, std::int64_t value);
  void bind_real(int index, double value);
  void bind_text(int index, const char* value, std::size_t size);
  void bind_null(int index);

  void bind_string(int index, const std::string& value) { bind_text(index, value.data(), value.size()); }

  Database* database_;
  sqlite3_stmt* statement_ = nullptr;
};

/// A connection to an SQLite database. Use it on one thread only.
class Database {
 public:
  enum class Access { read_only, immutable, read_write, create };

  /// `path` may be ":memory:". Throws StoreError.
  Database(const std::string& path, Access access);
  Database(Database&& other) noexcept;
  Database& operator=(Database&&) = delete;
  ~Database();

  void execute(const std::string& sql);  ///< runs one or more statements and ignores result rows
  std::int64_t integer(const std::string& sql);
  std::string text(const std::string& sql);
  int changes() const;

  const std::string& path() const { return path_; }
  void set_path(std::string path) { path_ = std::move(path); }  ///< for messages, if this is a copy of a file
  sqlite3* handle() { return handle_; }

  /// Prepared statements that begin and end a transaction. They are kept, because every transaction needs
  /// them.
  Statement& begin_statement();
  Statement& commit_statement();

  /// Throws a StoreError for the last error that SQLite reported on this connection.
  [[noreturn]] void fail(int code, const std::string& what) const;

 private:
  std::string path_;
  sqlite3* handle_ = nullptr;
  std::unique_ptr<Statement> begin_, commit_;
};

/// An SQLite transaction (BEGIN IMMEDIATE ... COMMIT). Its destructor rolls back unless commit() was called.
class Transaction {
 public:
  explicit Transaction(Database& database);
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  ~Transaction();
  void commit();

 private:
  Database& database_;
  bool open_ = true;
};

/// Copies all pages of one database into another, with SQLite's online backup. Throws StoreError.
void copy_database(Database& from, Database& to);

}  // namespace turnpoint::store

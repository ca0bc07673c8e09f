#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

struct pg_conn;
struct pg_result;

namespace turnpoint::collector {

/// Thrown if the server cannot be reached, or refuses a request. The message says what the server reported.
class ServerError : public std::runtime_error {
 public:
  ServerError(const std::string& message, std::string state)
      : std::runtime_error(message), state_(std::move(state)) {}
  /// the SQLSTATE that the server gave; "" if the connection was lost or never made
  const std::string& state() const { return state_; }

 private:
  std::string state_;
};

/// The rows that a query returned, as texts. Move-only.
class Rows {
 public:
  explicit Rows(pg_result* result);
  int count() const;
  bool is_null(int row, int column) const;
  std::string text(int row, int column) const;
  std::int64_t integer(int row, int column) const;

 private:
  struct Clear {
    void operator()(pg_result* result) const;
  };
  std::unique_ptr<pg_result, Clear> result_;
};

/// A connection to a PostgreSQL server. Use it on one thread only. All functions throw ServerError.
class Connection {
 public:
  /// `to` is a connection string of libpq: "service=lab", "host=... dbname=..." or "postgresql://...".
  /// Unless it says otherwise, the server must prove with a certificate that it is the named host
  /// (sslmode=verify-full), and a server that does not answer is given up after 20 s.
  explicit Connection(const std::string& to);

  /// Runs one statement with its parameters $1, $2, ...
  Rows query(const std::string& sql, const std::vector<std::optional<std::string>>& parameters = {});

  /// Sends rows with COPY ... FROM STDIN. Call copy_data() any number of times between begin_copy_in() and
  /// end_copy_in().
  void begin_copy_in(const std::string& sql);
  void copy_data(const std::string& bytes);
  void end_copy_in();

  /// Runs COPY ... TO STDOUT. next_copy_data() returns the data in pieces; empty at the end.
  void begin_copy_out(const std::string& sql);
  std::optional<std::string> next_copy_data();

 private:
  struct Finish {
    void operator()(pg_conn* connection) const;
  };
  [[noreturn]] void fail(const pg_result* result) const;
  void require(pg_result* result, int wanted);

  std::unique_ptr<pg_conn, Finish> connection_;
};

/// A transaction on the server (BEGIN ... COMMIT). The destructor rolls it back unless commit() was called.
class ServerTransaction {
 public:
  explicit ServerTransaction(Connection& connection, const std::string& mode = "");
  ServerTransaction(const ServerTransaction&) = delete;
  ServerTransaction& operator=(const ServerTransaction&) = delete;
  ~ServerTransaction();
  void commit();

 private:
  Connection& connection_;
  bool open_ = true;
};

}  // namespace turnpoint::collector

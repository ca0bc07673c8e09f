#include "station/collector/postgres.hpp"

#include <fmt/format.h>
#include <libpq-fe.h>

#include <charconv>

namespace turnpoint::collector {

namespace {

std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  for (auto& c : text)
    if (c == '\n') c = ' ';
  return text;
}

}  // namespace

Rows::Rows(pg_result* result) : result_(result) {}

void Rows::Clear::operator()(pg_result* result) const { PQclear(result); }

int Rows::count() const { return PQntuples(result_.get()); }

bool Rows::is_null(int row, int column) const { return PQgetisnull(result_.get(), row, column) != 0; }

std::string Rows::text(int row, int column) const {
  return {PQgetvalue(result_.get(), row, column),
          static_cast<std::size_t>(PQgetlength(result_.get(), row, column))};
}

std::int64_t Rows::integer(int row, int column) const {
  const auto digits = text(row, column);
  std::int64_t value = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (read.ec != std::errc{} || read.ptr != digits.data() + digits.size())
    throw ServerError(fmt::format("the server sent \"{}\" instead of a whole number", digits), "");
  return value;
}

void Connection::Finish::operator()(pg_conn* connection) const { PQfinish(connection); }

Connection::Connection(const std::string& to) {
  // libpq takes the last value of a keyword, so values in the connection string replace the defaults before
  // it.
  const char* const keywords[] = {
      "sslmode",          "connect_timeout", "tcp_user_timeout", "keepalives_idle",
      "application_name", "client_encoding", "dbname",           nullptr};
  const char* const values[] = {"verify-full", "20", "60000", "30", "turnpoint", "UTF8", to.c_str(), nullptr};
  connection_.reset(PQconnectdbParams(keywords, values, 1));
  if (PQstatus(connection_.get()) != CONNECTION_OK) fail(nullptr);
  PQsetNoticeProcessor(
      connection_.get(), [](void*, const char*) {}, nullptr);
}

void Connection::fail(const pg_result* result) const {
  const char* state = result != nullptr ? PQresultErrorField(result, PG_DIAG_SQLSTATE) : nullptr;
  const char* primary = result != nullptr ? PQresultErrorField(result, PG_DIAG_MESSAGE_PRIMARY) : nullptr;
  const std::string code = state != nullptr ? state : "";
  const std::string message = primary != nullptr ? primary : PQerrorMessage(connection_.get());
  const auto* advice =
      code == "53100" ? "; the server has no room: free some on the server, and push again"
      : code == "55P03"
          ? "; another connection holds the rows that this one needs: push again in five minutes"
          : "";
  throw ServerError(
      fmt::format("collector: {}{}", message.empty() ? "the connection was lost" : one_line(message), advice),
      code);
}

void Connection::require(pg_result* result, int wanted) {
  const Rows held(result);
  if (PQresultStatus(result) != wanted) fail(result);
}

Rows Connection::query(const std::string& sql, const std::vector<std::optional<std::string>>& parameters) {
  std::vector<const char*> values;
  for (const auto& parameter : parameters) values.push_back(parameter ? parameter->c_str() : nullptr);
  auto* result = PQexecParams(connection_.get(), sql.c_str(), static_cast<int>(values.size()), nullptr,
                              values.data(), nullptr, nullptr, 0);
  Rows rows(result);
  const auto status = PQresultStatus(result);
  if (status != PGRES_TUPLES_OK && status != PGRES_COMMAND_OK) fail(result);
  return rows;
}

void Connection::begin_copy_in(const std::string& sql) {
  require(PQexec(connection_.get(), sql.c_str()), PGRES_COPY_IN);
}

void Connection::copy_data(const std::string& bytes) {
  if (PQputCopyData(connection_.get(), bytes.data(), static_cast<int>(bytes.size())) != 1) fail(nullptr);
}

void Connection::end_copy_in() {
  if (PQputCopyEnd(connection_.get(), nullptr) != 1) fail(nullptr);
  require(PQgetResult(connection_.get()), PGRES_COMMAND_OK);
  while (auto* rest = PQgetResult(connection_.get())) PQclear(rest);
}

void Connection::begin_copy_out(const std::string& sql) {
  require(PQexec(connection_.get(), sql.c_str()), PGRES_COPY_OUT);
}

std::optional<std::string> Connection::next_copy_data() {
  char* buffer = nullptr;
  const int size = PQgetCopyData(connection_.get(), &buffer, 0);
  if (size > 0) {
    const std::unique_ptr<char, void (*)(void*)> held(buffer, PQfreemem);
    return std::string(buffer, static_cast<std::size_t>(size));
  }
  if (size == -2) fail(nullptr);
  require(PQgetResult(connection_.get()), PGRES_COMMAND_OK);
  while (auto* rest = PQgetResult(connection_.get())) PQclear(rest);
  return std::nullopt;
}

ServerTransaction::ServerTransaction(Connection& connection, const std::string& mode)
    : connection_(connection) {
  connection_.query("BEGIN " + mode);
}

ServerTransaction::~ServerTransaction() {
  if (!open_) return;
  try {
    connection_.query("ROLLBACK");
  } catch (const ServerError&) {
    // Ignore the error: the connection is lost, so the server rolls the transaction back.
  }
}

void ServerTransaction::commit() {
  open_ = false;
  connection_.query("COMMIT");
}

}  // namespace turnpoint::collector

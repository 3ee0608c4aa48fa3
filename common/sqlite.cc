#include "common/sqlite.h"

#include <spdlog/spdlog.h>
#include <sqlite3.h>

#include <cstring>

namespace planbench {
namespace {

/// What the system said when the database's file or its journal could not be read or written; 0 if
/// that is not known. (sqlite3_system_errno does not know of what fails in a commit.)
int SystemError(sqlite3* connection) {
  int error = 0;
  sqlite3_file* journal = nullptr;
  sqlite3_file_control(connection, "main", SQLITE_FCNTL_LAST_ERRNO, &error);
  if (error != 0) return error;
  sqlite3_file_control(connection, "main", SQLITE_FCNTL_JOURNAL_POINTER, &journal);
  if (journal == nullptr || journal->pMethods == nullptr ||
      journal->pMethods->xFileControl == nullptr) {
    return 0;
  }
  journal->pMethods->xFileControl(journal, SQLITE_FCNTL_LAST_ERRNO, &error);
  return error;
}

[[noreturn]] void Fail(sqlite3* connection, int code) {
  SqliteError::Kind kind = SqliteError::Kind::kStorage;
  if ((code & 0xff) == SQLITE_CONSTRAINT) kind = SqliteError::Kind::kConstraint;
  if ((code & 0xff) == SQLITE_BUSY) kind = SqliteError::Kind::kBusy;
  const char* file = sqlite3_db_filename(connection, "main");
  std::string message =
      std::string(file == nullptr ? "" : file) + ": " + sqlite3_errmsg(connection);
  const int why = (code & 0xff) == SQLITE_IOERR ? SystemError(connection) : 0;
  if (why != 0) message += std::string(" (") + std::strerror(why) + ")";
  throw SqliteError(kind, message);
}

void Check(sqlite3* connection, int code) {
  if (code != SQLITE_OK) Fail(connection, code);
}

}  // namespace

SqliteStatement::SqliteStatement(sqlite3* connection, const std::string& sql)
    : connection_(connection) {
  sqlite3_stmt* statement = nullptr;
  Check(connection, sqlite3_prepare_v3(connection, sql.data(), static_cast<int>(sql.size()),
                                       SQLITE_PREPARE_PERSISTENT, &statement, nullptr));
  statement_.reset(statement);
}

void SqliteStatement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

void SqliteStatement::Bind(int parameter, std::int64_t value) {
  Check(connection_, sqlite3_bind_int64(statement_.get(), parameter, value));
}

void SqliteStatement::Bind(int parameter, double value) {
  Check(connection_, sqlite3_bind_double(statement_.get(), parameter, value));
}

void SqliteStatement::Bind(int parameter, std::string_view value) {
  // A null pointer would bind NULL, an empty view may hold one.
  Check(connection_,
        sqlite3_bind_text(statement_.get(), parameter, value.empty() ? "" : value.data(),
                          static_cast<int>(value.size()), SQLITE_STATIC));
}

void SqliteStatement::Bind(int parameter, std::nullptr_t) {
  Check(connection_, sqlite3_bind_null(statement_.get(), parameter));
}

void SqliteStatement::Bind(int parameter, const SqliteValue& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    Bind(parameter, *integer);
  } else if (const auto* real = std::get_if<double>(&value)) {
    Bind(parameter, *real);
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    Bind(parameter, std::string_view(*text));
  } else {
    Bind(parameter, nullptr);
  }
}

bool SqliteStatement::Step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  const int reset_code = sqlite3_reset(statement_.get());
  if (code != SQLITE_DONE) Fail(connection_, reset_code);
  return false;
}

void SqliteStatement::Run() {
  while (Step()) {
  }
}

void SqliteStatement::Reset() { sqlite3_reset(statement_.get()); }

std::optional<SqliteValue> SqliteStatement::First() {
  if (!Step()) return std::nullopt;
  SqliteValue value = Value(0);
  Reset();
  return value;
}

SqliteValue SqliteStatement::Value(int column) const {
  switch (sqlite3_column_type(statement_.get(), column)) {
    case SQLITE_INTEGER:
      return Int(column);
    case SQLITE_FLOAT:
      return Double(column);
    case SQLITE_NULL:
      return std::monostate();
    default:
      return Text(column);
  }
}

std::int64_t SqliteStatement::Int(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

double SqliteStatement::Double(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}

std::string SqliteStatement::Text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  if (text == nullptr) return "";
  return std::string(text,
                     static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)));
}

SqliteConnection::SqliteConnection(const std::filesystem::path& file, Mode mode) {
  const int flags =
      mode == Mode::kReadOnly ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  sqlite3* connection = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &connection, flags, nullptr);
  connection_.reset(connection);
  if (code != SQLITE_OK) {
    throw SqliteError(SqliteError::Kind::kStorage,
                      "cannot open " + file.string() + ": " + sqlite3_errstr(code));
  }
  constexpr int kBusyTimeoutMs = 10'000;
  sqlite3_busy_timeout(connection, kBusyTimeoutMs);
}

void SqliteConnection::Close::operator()(sqlite3* connection) const { sqlite3_close(connection); }

void SqliteConnection::Execute(const std::string& sql) {
  Check(connection_.get(), sqlite3_exec(connection_.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

std::int64_t SqliteConnection::LastInsertId() const {
  return sqlite3_last_insert_rowid(connection_.get());
}

SqliteValue SqliteConnection::QueryValue(const std::string& sql) {
  return Prepare(sql).First().value_or(std::monostate());
}

SqliteTransaction::SqliteTransaction(SqliteConnection* connection) : connection_(connection) {
  connection_->Execute("BEGIN IMMEDIATE");
}

SqliteTransaction::~SqliteTransaction() {
  if (!open_) return;
  try {
    connection_->Execute("ROLLBACK");
  } catch (const SqliteError& error) {
    // After a full disk SQLite has rolled back already.
    spdlog::debug("rollback: {}", error.what());
  }
}

void SqliteTransaction::Commit() {
  connection_->Execute("COMMIT");
  open_ = false;
}

}  // namespace planbench

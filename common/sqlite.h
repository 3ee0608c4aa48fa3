#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace planbench {

/// What SQLite reports as failed.
class SqliteError : public std::runtime_error {
 public:
  /// What is wrong with the data or the moment, as opposed to the disk.
  enum class Kind {
    kConstraint,  ///< The rows contradict each other.
    kBusy,        ///< Another program kept the database locked.
    kStorage,     ///< Disk full, input/output error, damaged file, and everything else.
  };
  SqliteError(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

/// NULL, INTEGER, REAL or TEXT.
using SqliteValue = std::variant<std::monostate, std::int64_t, double, std::string>;

/// A prepared statement; must not outlive its connection. Throws SqliteError.
class SqliteStatement {
 public:
  SqliteStatement(sqlite3* connection, const std::string& sql);

  /// Binds a parameter, counted from 1. Texts must live until Run or Step has returned.
  void Bind(int parameter, std::int64_t value);
  void Bind(int parameter, int value) { Bind(parameter, static_cast<std::int64_t>(value)); }
  void Bind(int parameter, double value);
  void Bind(int parameter, std::string_view value);
  void Bind(int parameter, const std::string& value) { Bind(parameter, std::string_view(value)); }
  void Bind(int parameter, const char* value) { Bind(parameter, std::string_view(value)); }
  void Bind(int parameter, std::nullptr_t);
  void Bind(int parameter, const SqliteValue& value);
  /// Binds all parameters, in order.
  template <typename... Values>
  SqliteStatement& BindAll(const Values&... values) {
    int parameter = 0;
    (Bind(++parameter, values), ...);
    return *this;
  }

  /// The next row; false after the last one, when the statement is ready to be used again.
  bool Step();
  /// Runs a statement without rows to its end.
  void Run();
  /// Ends reading before the last row.
  void Reset();
  /// The first column of the first row; nothing if there is no row. Ready to be used again.
  std::optional<SqliteValue> First();

  /// A value of the current row, columns counted from 0.
  SqliteValue Value(int column) const;
  std::int64_t Int(int column) const;
  double Double(int column) const;
  std::string Text(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  sqlite3* connection_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// An open database file. Not thread-safe.
class SqliteConnection {
 public:
  enum class Mode { kReadOnly, kReadWriteCreate };
  /// Throws SqliteError naming the file.
  SqliteConnection(const std::filesystem::path& file, Mode mode);

  /// Runs statements, ignoring their rows.
  void Execute(const std::string& sql);
  SqliteStatement Prepare(const std::string& sql) { return {connection_.get(), sql}; }
  std::int64_t LastInsertId() const;
  /// The first value of the first row; NULL if there is no row.
  SqliteValue QueryValue(const std::string& sql);

 private:
  struct Close {
    void operator()(sqlite3* connection) const;
  };
  std::unique_ptr<sqlite3, Close> connection_;
};

/// Rolled back at the end of the scope unless committed.
class SqliteTransaction {
 public:
  explicit SqliteTransaction(SqliteConnection* connection);
  ~SqliteTransaction();
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;
  void Commit();

 private:
  SqliteConnection* connection_;
  bool open_ = true;
};

}  // namespace planbench

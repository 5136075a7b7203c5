#include "jobs/database.hpp"

#include <sqlite3.h>

#include <stdexcept>

namespace heliograph::jobs {
namespace {

constexpr int busy_timeout_ms = 5000;

void check_sqlite(sqlite3* database, int result) {
  if (result == SQLITE_OK) return;
  throw std::runtime_error(std::string("the database of jobs: ") + sqlite3_errmsg(database));
}

}  // namespace

void Database::Close::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

Database::Database(const std::filesystem::path& file) {
  sqlite3* opened = nullptr;
  const int result =
      sqlite3_open_v2(file.c_str(), &opened, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
  database_.reset(opened);
  if (result != SQLITE_OK) {
    throw std::runtime_error(file.string() + ": " + sqlite3_errstr(result));
  }
  sqlite3_busy_timeout(opened, busy_timeout_ms);
  execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON;");
}

Database::~Database() = default;

void Database::execute(const std::string& sql) {
  check_sqlite(database_.get(),
               sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

Statement Database::prepare(std::string_view sql) {
  return {*this, sql};
}

int Database::changes() const {
  return sqlite3_changes(database_.get());
}

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

Statement::Statement(Database& database, std::string_view sql) : database_(&database) {
  sqlite3_stmt* prepared = nullptr;
  check_sqlite(database.database_.get(),
               sqlite3_prepare_v2(database.database_.get(), sql.data(),
                                  static_cast<int>(sql.size()), &prepared, nullptr));
  statement_.reset(prepared);
}

Statement& Statement::bind(int index, std::string_view text) {
  check_sqlite(database_->database_.get(),
               sqlite3_bind_text(statement_.get(), index, text.data(),
                                 static_cast<int>(text.size()), SQLITE_TRANSIENT));
  return *this;
}

Statement& Statement::bind(int index, std::int64_t number) {
  check_sqlite(database_->database_.get(), sqlite3_bind_int64(statement_.get(), index, number));
  return *this;
}

Statement& Statement::bind(int index, double number) {
  check_sqlite(database_->database_.get(), sqlite3_bind_double(statement_.get(), index, number));
  return *this;
}

Statement& Statement::bind_null(int index) {
  check_sqlite(database_->database_.get(), sqlite3_bind_null(statement_.get(), index));
  return *this;
}

bool Statement::step() {
  const int result = sqlite3_step(statement_.get());
  if (result == SQLITE_ROW) return true;
  if (result != SQLITE_DONE) check_sqlite(database_->database_.get(), result);
  return false;
}

void Statement::run() {
  while (step()) continue;
}

std::string Statement::text(int column) const {
  const auto* const begin =
      reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  if (!begin) return {};
  return {begin, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

double Statement::real(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

Transaction::Transaction(Database& database) : database_(database) {
  database_.execute("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  if (!open_) return;
  try {
    database_.execute("ROLLBACK");
  } catch (const std::runtime_error&) {
    // SQLite has undone it already, as it does where the disk is full.
  }
}

void Transaction::commit() {
  database_.execute("COMMIT");
  open_ = false;
}

}  // namespace heliograph::jobs

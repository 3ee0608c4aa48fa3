#include "common/sqlite.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <string>

#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

TEST(SqliteTest, WhatTheSystemRefusesIsNamed) {
  const TemporaryFolder folder;
  // A limit on the size of files, in a process of its own, stands for what may be refused.
  const auto write_too_much = [&](const char* journal_mode) {
    SqliteConnection database(folder / journal_mode, SqliteConnection::Mode::kReadWriteCreate);
    database.QueryValue(std::string("PRAGMA journal_mode = ") + journal_mode);
    database.Execute("CREATE TABLE blobs (blob)");
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {50'000, 50'000};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(3);
    try {
      database.Execute("INSERT INTO blobs VALUES (randomblob(100000))");
      _exit(4);
    } catch (const SqliteError& error) {
      const bool named = std::string(error.what()).find("(File too large)") != std::string::npos;
      _exit(named && error.kind() == SqliteError::Kind::kStorage ? 0 : 5);
    }
  };
  EXPECT_EXIT(write_too_much("WAL"), testing::ExitedWithCode(0), "");
  EXPECT_EXIT(write_too_much("DELETE"), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace planbench

#include "framework/driver/StudyRecord.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <fstream>

#include "framework/base/Error.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

Teuchos::RCP<const Communicator> world() { return Tpetra::getDefaultComm(); }

CaseRecord some_record() {
  CaseRecord record;
  record.status = CaseStatus::failed;
  record.identity = {{"input", "abc"}, {"ranks", 2}};
  record.seconds = 0.1 + 0.2;
  record.message = "step 3: diverged µ\nsecond line";
  record.continued = true;
  return record;
}

void put(const std::string& file, const std::string& text) {
  world()->barrier();
  if (world()->getRank() == 0) std::ofstream(file) << text;
  world()->barrier();
}

TEST(CaseRecord, IsReadBack) {
  TestFolder folder;
  CaseRecord written = some_record();
  write_case_record(folder.path() / "a/b", "a/b", written, world());
  const auto read = read_case_record(folder.path() / "a/b", *world());
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->status, written.status);
  EXPECT_EQ(read->identity, written.identity);
  EXPECT_EQ(read->seconds, written.seconds);
  EXPECT_EQ(read->message, written.message);
  EXPECT_TRUE(read->continued);
  EXPECT_EQ(read->hash, written.hash);
}

TEST(CaseRecord, ItsHashTellsTwoCompletionsApart) {
  TestFolder folder;
  CaseRecord first = some_record(), second = some_record();
  write_case_record(folder.path(), "a", first, world());
  write_case_record(folder.path(), "a", second, world());
  EXPECT_NE(first.hash, second.hash);
}

TEST(CaseRecord, WhatCannotBeReadIsNone) {
  TestFolder folder;
  EXPECT_FALSE(read_case_record(folder.path(), *world()).has_value());
  EXPECT_FALSE(read_case_record(folder.path() / "nowhere", *world()).has_value());
  for (const char* text : {"", "{", "[]", "{}", R"({"format": 2, "status": "complete"})", R"({"format": 1})"}) {
    put(folder / "case.json", text);
    EXPECT_FALSE(read_case_record(folder.path(), *world()).has_value()) << text;
  }
}

TEST(CaseRecord, AFolderThatCannotBeMadeIsNamed) {
  TestFolder folder;
  put(folder / "file", "text");
  CaseRecord record = some_record();
  EXPECT_THROW(write_case_record(folder.path() / "file/a", "a", record, world()), FileError);
}

}  // namespace
}  // namespace kiln

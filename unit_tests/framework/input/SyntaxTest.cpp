#include <sys/stat.h>

#include "unit_tests/framework/input/InputTest.hpp"

namespace kiln::test {
namespace {

class SyntaxTest : public InputTest {
 protected:
  struct Case {
    std::string text;
    std::string expected;
  };
  void expect(const std::vector<Case>& cases) const {
    for (const Case& one : cases) EXPECT_EQ(mistakes_of(one.text), Lines{one.expected}) << one.text.substr(0, 400);
  }
};

TEST_F(SyntaxTest, WhatIsNoYamlIsTold) {
  const std::string colon =
      "a ':' where no key may end; expected 'key: value' on a line of its own, indented like its neighbours, with a "
      "space after each ':'";
  expect({
      {"title: a: b\n", "run.yaml:1:9: " + colon},
      {"model:\n  spacing: 1\n   kernel: x\n", "run.yaml:3:10: " + colon},
      {"title:a\ntime: {}\n", "run.yaml:2:5: " + colon},
      {"model: [1, 2\ntime: 3\n", "run.yaml:2:5: a list opened by '[' is not closed; expected ',' or ']'"},
      {"model: {a: 1\ntime: 3\n", "run.yaml:2:5: a block opened by '{' is not closed; expected ',' or '}'"},
      {"title: 'open\ntime: {}\n", "run.yaml:1:8: the quotes that open here are not closed"},
      {"title: \"open\n", "run.yaml:1:8: the quotes that open here are not closed"},
      {"title: a]\ntime: ]\n", "run.yaml:2:7: a closing bracket without an opening one"},
      {"title: @a\n", "run.yaml:1:8: a character that no value begins with; expected quotes around the value"},
      {"title: - a\n", "run.yaml:1:8: '-' in the middle of a value; expected items of a list on lines of their own"},
      {"title: \"\\q\"\n", "run.yaml:1:11: not YAML: unknown escape character: q"},
      {"title: !python a\n", "run.yaml:1:8: the tag '!python'; expected a value without a tag"},
      {"%YAML 1.2\n---\ntitle: a\n",
       "run.yaml:1:1: a line that begins with '%'; expected no directives; a text that begins with '%' stands in "
       "quotes"},
  });
}

TEST_F(SyntaxTest, WhatIsNoInputIsTold) {
  const std::string empty = "run.yaml:1:1: the file is empty; expected 'key: value' lines";
  const std::string second = "a second document starts here; expected one document in a file";
  expect({
      {"", empty},
      {"# only a comment\n", empty},
      {"~\n", empty},
      {"- a\n- b\n", "run.yaml:1:1: a list at top level; expected 'key: value' lines"},
      {"just words\n", "run.yaml:1:1: a single value 'just words' at top level; expected 'key: value' lines"},
      {model + "---\n" + model, "run.yaml:4:1: " + second},
      {model + "---\n", "run.yaml:4:1: " + second},
      {"  title: a\ntime: {}\n",
       "run.yaml:2:1: this line is indented less than the first one; expected the keys of a block in the same column"},
      {"model:\n\tspacing: 1\n", "run.yaml:2:1: a tab in the indentation; expected spaces"},
      {"model:\n  \tspacing: 1\n", "run.yaml:2:3: a tab in the indentation; expected spaces"},
      {"title: \xff\n", "run.yaml:1:8: byte 0xff is not UTF-8; expected YAML text in UTF-8"},
      {"title: \xc0\xaf\n", "run.yaml:1:8: byte 0xc0 is not UTF-8; expected YAML text in UTF-8"},
      {"title: \xed\xa0\x80\n", "run.yaml:1:8: byte 0xed is not UTF-8; expected YAML text in UTF-8"},
      {std::string("\x89HDF\r\n\x1a\n"), "run.yaml:1:1: byte 0x89 is not UTF-8; expected YAML text in UTF-8"},
      {std::string("a: 1\n\0\0", 7), "run.yaml:2:1: control character 0x00; expected YAML text in UTF-8"},
      {"title: a\x1b[31m\n", "run.yaml:1:9: control character 0x1b; expected YAML text in UTF-8"},
      {std::string(100000, '['), "run.yaml:1:33: more than 64 levels of blocks"},
      {std::string(100000, '{'), "run.yaml:1:64: more than 64 levels of blocks"},
  });
}

TEST_F(SyntaxTest, WhatIsNoFileIsTold) {
  write("folder/x", "");
  EXPECT_EQ(mistakes({}, "absent.yaml"), Lines{"absent.yaml: there is no such file"});
  EXPECT_EQ(mistakes({}, "folder"), Lines{"folder: this is a folder"});
  if (communicator_->getRank() == 0) {
    ASSERT_EQ(mkfifo((folder_ + "/pipe").c_str(), 0600), 0);
  }
  EXPECT_EQ(mistakes({}, "pipe"), Lines{"pipe: this is a pipe"});
  EXPECT_EQ(mistakes_of(model + "  table: /dev/zero\n"),
            Lines{"run.yaml:4:10: model.table: this is a device: /dev/zero; expected an existing file"});
  write("run.yaml", "title: " + std::string(17 << 20, 'x') + "\n");
  EXPECT_EQ(mistakes(), Lines{"run.yaml: the file is longer than 16 MiB"});
}

TEST_F(SyntaxTest, WhatWouldTakeForEverIsRefused) {
  std::string keys, values = "tags: [";
  for (int i = 0; i < 6000; ++i) keys += "key" + std::to_string(i) + ": 1\n";
  for (int i = 0; i < 300000; ++i) values += "a,";
  expect({{keys, "run.yaml:5002:1: more than 5000 keys in one block"},
          {values + "a]\n", "run.yaml:1:400002: more than 200000 values"}});
}

TEST_F(SyntaxTest, VeryManyMistakesAreCounted) {
  std::string keys;
  for (int i = 0; i < 60; ++i) keys += "key" + std::to_string(i) + ": 1\n";
  const Lines told = mistakes_of(model + keys);
  ASSERT_EQ(told.size(), 51u);
  EXPECT_EQ(told.front().substr(0, 30), "run.yaml:4:1: key0: unknown ke");
  EXPECT_EQ(told.back(), "run.yaml: 10 more mistakes");
}

TEST_F(SyntaxTest, ATextCannotHoldNul) {
  expect(
      {{"title: \"a\\0b\"\n", "run.yaml:1:8: the text 'a\\x00b' holds the character NUL; expected a text without it"}});
}

TEST_F(SyntaxTest, HarmlessTextIsRead) {
  EXPECT_EQ(mistakes_of("\xef\xbb\xbf" + model), Lines{}) << "byte order mark";
  EXPECT_EQ(mistakes_of("---\n" + model + "...\n# end\n"), Lines{});
  EXPECT_EQ(mistakes_of(model + "\t\n\t# a comment\ntitle: a\tb\n"), Lines{}) << "tabs that indent nothing";
  std::string crlf;
  for (const char c : model) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(mistakes_of(crlf), Lines{});
  EXPECT_EQ(read_text(model + "title: |\n  two\n  lines\n").list().get<std::string>("title"), "two\nlines\n");
  EXPECT_EQ(read_text(model + "title: 'it''s'\n").list().get<std::string>("title"), "it's");
  EXPECT_EQ(read_text(model + "title: \"\\\"µ\\\"\"\n").list().get<std::string>("title"), "\"µ\"");
  EXPECT_EQ(read_text(model + "title: ''\n").list().get<std::string>("title"), "");
}

}  // namespace
}  // namespace kiln::test

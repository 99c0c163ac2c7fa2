#include "vm_protocol/core/text_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "tests/support/process.h"

namespace vm {
namespace {

TEST(TextFileTest, AFileIsReadWholeUpToItsLimit) {
  const support::TempDir folder;
  const std::string text(10'000, 'x');
  std::ofstream(folder / "a") << text;
  std::ofstream(folder / "empty");
  EXPECT_EQ(ReadTextFile(folder / "a", 10'000).value_or(""), text);
  EXPECT_EQ(ReadTextFile(folder / "empty", 10'000).value_or("?"), "");
  const auto over = ReadTextFile(folder / "a", 9'999);
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().code, Errc::kTooLong);
  EXPECT_EQ(over.error().text, "file '" + (folder / "a") + "' is over 9999 bytes");
}

TEST(TextFileTest, WhatIsNotARegularFileIsRefusedAtOnce) {
  const support::TempDir folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {pipe, std::string("/dev/zero"), std::string("/dev/null")}) {
    const auto text = ReadTextFile(path, 1 << 20);
    ASSERT_FALSE(text) << path;
    EXPECT_EQ(text.error().code, Errc::kAccess);
    EXPECT_EQ(text.error().text, "'" + path + "' is not a regular file");
  }
}

TEST(TextFileTest, AFileWithoutASizeIsReadUpToTheLimit) {
  EXPECT_EQ(ReadTextFile("/proc/self/status", 10).error().code, Errc::kTooLong);
}

TEST(TextFileTest, WhatCannotBeReadIsNamedWithTheReason) {
  const support::TempDir folder;
  EXPECT_EQ(ReadTextFile(folder / "none", 10).error().text,
            "cannot read '" + (folder / "none") + "': No such file or directory");
  EXPECT_EQ(ReadTextFile(folder.path(), 10).error().text,
            "cannot read '" + folder.path() + "': Is a directory");
}

}  // namespace
}  // namespace vm

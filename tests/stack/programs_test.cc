// What all programs have in common.

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "tests/support/process.h"

namespace {

TEST(ProgramsTest, EveryProgramTellsItsVersionAndExplainsItself) {
  std::istringstream programs(GALATEA_PROGRAMS);
  int count = 0;
  for (std::string name; std::getline(programs, name, ' '); ++count) {
    support::Process version({GALATEA_BIN_DIR "/" + name, "--version"});
    const auto lines = version.ReadAll();
    EXPECT_EQ(version.Wait(), 0) << name << ": " << version.ErrorText();
    ASSERT_EQ(lines.size(), 1U) << name;
    EXPECT_TRUE(lines[0].ends_with(GALATEA_VERSION)) << name << ": " << lines[0];
    support::Process help({GALATEA_BIN_DIR "/" + name, "--help"});
    EXPECT_TRUE(help.Expect("--version")) << name;
    EXPECT_EQ(help.Wait(), 0) << name;
  }
  EXPECT_GT(count, 5);
}

}  // namespace

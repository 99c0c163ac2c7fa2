// The real program, spoken to through pipes.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "tests/support/process.h"

namespace {

TEST(StubEarProgramTest, NamedPipesInLinesAreRefusedAndItGoesOn) {
  const support::TempDir folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  support::Process ear({GALATEA_BIN_DIR "/srm_stub"});
  for (const std::string line : {"save#1 mine << ", "do#1 ", "set#1 Grammar.load < ",
                                 "set#1 Grammar.file = g ", "set#1 Input.script = "}) {
    ear.WriteLine(line + pipe);
    const auto answer = ear.Expect("rep#1 ");
    ASSERT_TRUE(answer) << line;
    EXPECT_NE(answer->find("'" + pipe + "' is not a regular file"), std::string::npos) << *answer;
  }
  ear.WriteLine("inq#2 Run");
  EXPECT_TRUE(ear.Expect("rep#2 Run = LIVE"));
}

}  // namespace

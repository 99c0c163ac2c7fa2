#include "agent_manager/log/session_log.h"

#include <gtest/gtest.h>

namespace am {
namespace {

TEST(SessionLogTest, EveryEntryReadsBack) {
  const LogEntry entries[] = {
      {vm::Time(1234500), "SSM", "CONSOLE,DM", "From @SSM rep Speak.stat = IDLE"},
      {vm::Time(0), "CONSOLE", "SSM", "to @SSM set Text = a\tb"},
      {vm::Time(7), "FSM", "-", "tell hello"}};
  for (const LogEntry& entry : entries) {
    const auto back = ParseLogEntry(FormatLogEntry(entry));
    ASSERT_TRUE(back) << FormatLogEntry(entry);
    EXPECT_EQ(*back, entry);
  }
}

TEST(SessionLogTest, CommentsAreNothingAndDamagedLinesAreErrors) {
  EXPECT_EQ(ParseLogEntry("# x").error().code, vm::Errc::kEmpty);
  EXPECT_EQ(ParseLogEntry("1 SSM DM x").error().code, vm::Errc::kSyntax);
  EXPECT_EQ(ParseLogEntry("x\tSSM\tDM\ttell y").error().code, vm::Errc::kBadValue);
}

TEST(SessionLogTest, WithoutASinkNothingIsWritten) {
  SessionLog off;
  EXPECT_FALSE(off.enabled());
  std::vector<std::string> lines;
  SessionLog on([&](std::string_view line) { lines.emplace_back(line); });
  on.Write(vm::Time(1000), "A", "", "tell x");
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[1], "1\tA\t-\ttell x");
}

}  // namespace
}  // namespace am

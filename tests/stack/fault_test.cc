// Things that go wrong in the middle of speaking. Nothing hangs, every case ends in one clear
// report, and the next set Speak works.

#include <gtest/gtest.h>

#include <csignal>
#include <string>
#include <vector>

#include "tests/stack/stack.h"

namespace {

using stack::Stack;

constexpr auto kPatience = std::chrono::seconds(30);
const std::string kRestart = ", \"restart\": \"always\"";

/// The process id of a child of the hub running `program`.
int ChildOf(int hub, const std::string& program) {
  for (int i = 0; i < 200; ++i) {
    support::Process find(
        {"/bin/sh", "-c",
         "grep -l '^PPid:.*[^0-9]" + std::to_string(hub) +
             "$' /proc/[0-9]*/status 2>/dev/null | cut -d/ -f3 | while read p; do "
             "tr '\\0' ' ' < /proc/$p/cmdline | grep -q " +
             program + " && echo $p; done; true"});
    if (const auto line = find.ReadLine(); line && !line->empty()) return std::stoi(*line);
  }
  return -1;
}

/// Speaks for some seconds, kills `program` in the middle, and speaks again.
void KillInTheMiddle(const std::string& module, const std::string& program) {
  stack::Stack::Module voice = stack::Voice();
  stack::Stack::Module face = stack::Face();
  voice.more = face.more = kRestart;
  Stack stack("real", {voice, face});
  stack.Say("to @AM-MCL set#first Speak = a banana and a papaya and a banana and a papaya");
  ASSERT_TRUE(stack.hub().Expect("rep Speak.stat = SPEAKING", kPatience)) << stack.hub().Seen();
  const int child = ChildOf(stack.hub().pid(), program);
  ASSERT_GT(child, 0);
  kill(child, SIGKILL);
  const auto report = stack.hub().Expect("rep#first Speak.error = ", kPatience);
  ASSERT_TRUE(report) << stack.hub().Seen() << stack.hub().ErrorText();
  EXPECT_NE(report->find(module), std::string::npos) << "the report names who died: " << *report;
  // The module is back when it says so; until then speaking is refused with a sentence.
  ASSERT_TRUE(stack.hub().Expect("From @" + module + " rep Run = LIVE", kPatience))
      << stack.hub().Seen();
  stack.Say("to @AM-MCL set#second Speak = papa");
  const auto second = stack.hub().Expect("rep#second ", kPatience);
  ASSERT_TRUE(second) << stack.hub().Seen();
  EXPECT_NE(second->find("rep#second Speak = "), std::string::npos) << *second;
  stack.Finish();
}

TEST(FaultTest, TheVoiceKilledInTheMiddleOfSpeakingIsReportedAndComesBack) {
  KillInTheMiddle("SSM", "ssm_stub");
}
TEST(FaultTest, TheFaceKilledInTheMiddleOfSpeakingIsReportedAndComesBack) {
  KillInTheMiddle("FSM", "fsm");
}

TEST(FaultTest, AModuleThatSendsGarbageDisturbsNobody) {
  const std::string script =
      "import sys,os; o=sys.stdout.buffer; o.write(b'rep Run = LIVE\\\\n'); "
      "o.write(b'x'*1048576+b'\\\\n'); "
      "o.write(b'\\\\xff\\\\xfe\\\\n'); o.write(b'fly away\\\\n'); o.flush(); sys.stdin.read()";
  Stack stack("virtual",
              {stack::Voice(),
               stack::Face(),
               {"BAD", {"/usr/bin/env", "python3", "-c", script}, ", \"dialect\": \"original\""}});
  stack.Say("to @AM-MCL set#said Speak = papa");
  const auto said = stack.hub().Expect("rep#said ", kPatience);
  ASSERT_TRUE(said) << stack.hub().Seen() << stack.hub().ErrorText();
  EXPECT_NE(said->find("rep#said Speak = "), std::string::npos) << *said;
  ASSERT_TRUE(stack.hub().ExpectError("TOO_LONG", kPatience)) << stack.hub().ErrorText();
  ASSERT_TRUE(stack.hub().ExpectError("BAD_UTF8", kPatience));
  ASSERT_TRUE(stack.hub().ExpectError("UNKNOWN_COMMAND", kPatience));
  stack.Finish();
}

TEST(FaultTest, AVoiceThatNeverAnswersEndsInOneReport) {
  const std::string deaf = "import sys; print('rep Run = LIVE', flush=True); sys.stdin.read()";
  Stack stack("virtual",
              {{"SSM", {"/usr/bin/env", "python3", "-c", deaf}, ", \"dialect\": \"original\""},
               stack::Face()});
  stack.Say("to @AM-MCL set#said Speak = papa");
  const auto said = stack.hub().Expect("rep#said ", kPatience);
  ASSERT_TRUE(said) << stack.hub().Seen() << stack.hub().ErrorText();
  EXPECT_NE(said->find("Speak.error = TIMEOUT"), std::string::npos) << *said;
  EXPECT_NE(said->find("SSM"), std::string::npos) << *said;
  stack.Finish();
}

}  // namespace

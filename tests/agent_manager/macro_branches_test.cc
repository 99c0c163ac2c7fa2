// Macros with conditions and with steps that go on side by side.

#include <gtest/gtest.h>

#include "agent_manager/macros/macro_layer.h"
#include "agent_manager/macros/speak.h"
#include "tests/agent_manager/world.h"

namespace am {
namespace {

using std::chrono::milliseconds;
using Strings = std::vector<std::string>;

class MacroBranchesTest : public testing::Test {
 protected:
  MacroBranchesTest()
      : mcl_(
            world_.clock, world_.hub,
            [](const std::string&) -> vm::Result<std::string> {
              return vm::Fail(vm::Errc::kUnavailable, "no files");
            },
            [](const std::string&) {}) {
    world_.Connect(mcl_);
    mcl_.AddReader("emotion", ReadEmotion);
    client_ = world_.Join(PeerKind::kClient, "A");
    lamp_ = world_.Join(PeerKind::kModule, "LAMP", Dialect::kOriginal);
  }
  void Define(const std::string& steps) {
    auto macro = ParseMacro("M", steps);
    ASSERT_TRUE(macro) << macro.error().text;
    ASSERT_TRUE(mcl_.Define(std::move(*macro)));
  }
  void Run(const std::string& value, milliseconds until) {
    world_.Say(*client_, "to @AM-MCL set#1 M = " + value);
    world_.clock.RunUntil(until);
  }
  World world_;
  MacroLayer mcl_;
  std::shared_ptr<World::Peer> client_, lamp_;
};

TEST_F(MacroBranchesTest, BranchesGoOnSideBySideAndTheRunWaitsForAll) {
  Define(R"([{"parallel": [
      [{"pause_ms": 100}, {"send": "to @LAMP set X = slow"}, {"let": {"slow": "done"}}],
      [{"send": "to @LAMP set X = quick"}, {"pause_ms": 30}, {"send": "to @LAMP set X = then"}]]},
      {"send": "to @LAMP set X = ${slow}"}])");
  Run("x", milliseconds(50));
  EXPECT_EQ(lamp_->heard, (Strings{"set X = quick", "set X = then"}));
  world_.clock.RunUntil(milliseconds(200));
  EXPECT_EQ(lamp_->heard,
            (Strings{"set X = quick", "set X = then", "set X = slow", "set X = done"}));
  EXPECT_EQ(client_->heard.back(), "From @AM-MCL rep#1 M = x");
  EXPECT_FALSE(mcl_.Busy());
}

TEST_F(MacroBranchesTest, NamesOfVariablesAreCountedAsOftenAsTheyAreForgotten) {
  const std::string name(500, 'n');
  const std::string let = R"({"let": {")" + name + R"(": "x"}})";
  Define(R"([{"parallel": [[)" + let + "],[" + let + R"(]]},
             {"let": {"after": "counted"}},
             {"send": "to @LAMP set X = ${after}"}])");
  Run("x", milliseconds(10));
  EXPECT_EQ(lamp_->heard, (Strings{"set X = counted"}));
  EXPECT_EQ(client_->heard.back(), "From @AM-MCL rep#1 M = x");
}

TEST_F(MacroBranchesTest, ConditionsChooseBetweenStepsAndElse) {
  Define(R"([{"when_is": {"value": "on"}, "steps": [{"send": "to @LAMP set X = 1"}],
              "else": [{"send": "to @LAMP set X = 0"}, {"pause_ms": 5}]},
             {"send": "to @LAMP set Y = ${value}"}])");
  Run("on", milliseconds(10));
  Run("off", milliseconds(20));
  EXPECT_EQ(lamp_->heard, (Strings{"set X = 1", "set Y = on", "set X = 0", "set Y = off"}));
}

TEST_F(MacroBranchesTest, OneBranchThatFailsEndsTheOthersAndTheRun) {
  Define(R"({"steps": [{"parallel": [
      [{"pause_ms": 100}, {"send": "to @LAMP set X = never"}],
      [{"parallel": [[{"pause_ms": 20}, {"need": "NOBODY", "text": "somebody"}],
                     [{"pause_ms": 90}, {"send": "to @LAMP set X = never"}]]}]]}],
      "on_stop": [{"send": "to @LAMP set X = off"}]})");
  Run("x", milliseconds(300));
  EXPECT_EQ(lamp_->heard, Strings{"set X = off"});
  EXPECT_EQ(client_->heard.back(),
            "From @AM-MCL rep#1 M.error = UNAVAILABLE somebody @NOBODY is not there");
  EXPECT_FALSE(mcl_.Busy());
}

TEST_F(MacroBranchesTest, BranchesWhileStoppingNeverHangTheRun) {
  Define(R"({"steps": [{"need": "NOBODY", "text": "somebody"}],
      "on_stop": [{"parallel": [[{"need": "NOBODY", "text": "somebody"}, {"pause_ms": 50}],
                                [{"send": "to @LAMP set X = off"}]]},
                  {"send": "to @LAMP set X = last"}]})");
  Run("x", milliseconds(300));
  EXPECT_EQ(lamp_->heard, (Strings{"set X = off", "set X = last"}));
  EXPECT_FALSE(mcl_.Busy());
}

TEST_F(MacroBranchesTest, AModuleThatDiesWhileABranchSpeaksToItEndsTheRun) {
  Define(R"([{"parallel": [[{"send": "to @LAMP set X = 1"}, {"pause_ms": 1000}],
                           [{"pause_ms": 1000}]]}])");
  Run("x", milliseconds(10));
  world_.Leave(*lamp_, "unplugged");
  world_.clock.RunUntil(milliseconds(20));
  EXPECT_EQ(client_->heard.back(),
            "From @AM-MCL rep#1 M.error = UNAVAILABLE @LAMP has gone in the middle of it "
            "(unplugged)");
  EXPECT_FALSE(mcl_.Busy());
}

TEST_F(MacroBranchesTest, ANewRunStopsTheBranchesOfTheOneBefore) {
  Define(R"([{"parallel": [[{"pause_ms": 50}, {"send": "to @LAMP set X = ${value}"}]]}])");
  Run("first", milliseconds(20));
  Run("second", milliseconds(200));
  EXPECT_EQ(lamp_->heard, Strings{"set X = second"});
}

TEST(MacroBranchesParseTest, ListsInEachOtherHaveALimit) {
  std::string steps = R"([{"mark": true}])";
  for (int i = 0; i < 40; ++i) steps = R"([{"parallel": [)" + steps + "]}]";
  const auto macro = ParseMacro("M", steps);
  ASSERT_FALSE(macro);
  EXPECT_NE(macro.error().text.find("more than 16 lists in each other"), std::string::npos);
}

}  // namespace
}  // namespace am

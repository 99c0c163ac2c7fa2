#include "agent_manager/macro.h"

#include <gtest/gtest.h>

namespace am {
namespace {

TEST(ExpandTest, PutsVariablesDefaultsAndPhonemesIn) {
  const Variables variables{{"a", "1"}, {"pho", "k[60] o[75]"}};
  EXPECT_EQ(Expand("x ${a} ${b:-7} ${b}.", variables), "x 1 7 .");
  EXPECT_EQ(Expand("${pho|plain}", variables), "k 60 o 75");
  EXPECT_FALSE(Expand("${a", variables));
  EXPECT_FALSE(Expand("${a|loud}", variables));
  EXPECT_FALSE(Expand("${a|plain}", variables)) << "1 is no phoneme list";
}

TEST(MacroTest, AListOfStepsIsAMacro) {
  const auto macro =
      ParseMacro("Wave", R"([{"send": "to @FSM set FaceMot = NOD 1"}, {"pause_ms": 200}])");
  ASSERT_TRUE(macro) << macro.error().text;
  EXPECT_EQ(macro->steps.size(), 2u);
  EXPECT_EQ(macro->steps[1].limit, std::chrono::milliseconds(200));
}

TEST(MacroTest, FaultsNameTheStepAndTheMember) {
  const std::pair<const char*, const char*> kBad[] = {
      {"[", "not JSON"},
      {"5", "expected a list of steps"},
      {R"([{"send": "to @FSM"}])", "M[0].send: 'to @FSM': found the end"},
      {R"([{"send": "set X = 1"}])", "expected a receiver"},
      {R"([{"pause_ms": 1}, {"pause_ms": -1}])", "M[1].pause_ms: found -1"},
      {R"([{"wait": {"slot": "X"}}])", "M[0].wait: expected from and slot"},
      {R"([{"wait": {"from": "A", "slto": "X"}}])", "M[0].wait.slto: unknown"},
      {R"([{"mark": true, "pause_ms": 1}])", "expected exactly one of"},
      {R"([{"limit_ms": 1}])", "expected exactly one of"},
      {R"([{"jump": 1}])", "M[0].jump: unknown member"},
      {R"({"stepps": []})", "M.stepps: unknown"}};
  for (const auto& [text, part] : kBad) {
    const auto macro = ParseMacro("M", text);
    ASSERT_FALSE(macro) << text;
    EXPECT_NE(macro.error().text.find(part), std::string::npos) << macro.error().text;
  }
}

}  // namespace
}  // namespace am

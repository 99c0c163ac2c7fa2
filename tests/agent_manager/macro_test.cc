#include "agent_manager/macros/macro.h"

#include <gtest/gtest.h>

#include "vm_protocol/core/limits.h"

namespace am {
namespace {

std::string Expanded(const std::string& text) {
  const Variables variables{{"a", "1"}, {"pho", "k[60] o[75]"}};
  const auto parsed = Template::Parse(text);
  if (!parsed) return "refused: " + parsed.error().text;
  const auto expanded = parsed->Expand([&](const std::string& name) {
    const auto found = variables.find(name);
    return found == variables.end() ? "" : found->second;
  });
  return expanded ? *expanded : "failed: " + expanded.error().text;
}

TEST(TemplateTest, PutsVariablesDefaultsAndPhonemesIn) {
  EXPECT_EQ(Expanded("x ${a} ${b:-7} ${b}."), "x 1 7 .");
  EXPECT_EQ(Expanded("${pho|plain}"), "k 60 o 75");
  EXPECT_TRUE(Expanded("${a").starts_with("refused"));
  EXPECT_TRUE(Expanded("${}").starts_with("refused"));
  EXPECT_TRUE(Expanded("${a|loud}").starts_with("refused"));
  EXPECT_TRUE(Expanded("${a|plain}").starts_with("failed")) << "1 is no phoneme list";
}

TEST(TemplateTest, WhatBecomesLongerThanALineIsRefused) {
  const auto parsed = Template::Parse("${a}${a}");
  const auto expanded =
      parsed->Expand([](const std::string&) { return std::string(vm::kMaxLineBytes, 'x'); });
  ASSERT_FALSE(expanded);
  EXPECT_EQ(expanded.error().code, vm::Errc::kTooLong);
}

TEST(MacroTest, AListOfStepsIsAMacro) {
  const auto macro =
      ParseMacro("Wave", R"([{"send": "to @FSM set FaceMot = NOD 1"}, {"pause_ms": 200}])");
  ASSERT_TRUE(macro) << macro.error().text;
  ASSERT_EQ(macro->steps->size(), 2u);
  EXPECT_EQ(std::get<PauseStep>((*macro->steps)[1].action).length, std::chrono::milliseconds(200));
}

TEST(MacroTest, FaultsNameTheStepAndTheMember) {
  const std::pair<const char*, const char*> kBad[] = {
      {"[", "not JSON"},
      {"5", "expected an object"},
      {R"([{"send": "to @FSM"}])", "M[0].send: found the end"},
      {R"([{"send": "set X = 1"}])", "expected a line with a receiver"},
      {R"([{"pause_ms": 1}, {"pause_ms": -1}])", "M[1].pause_ms: found -1"},
      {R"([{"wait": {"slot": "X"}}])", "M[0].wait: expected from and slot"},
      {R"([{"wait": {"from": "A", "slto": "X"}}])", "M[0].wait.slto: unknown"},
      {R"([{"mark": true, "pause_ms": 1}])", "expected either mark or pause_ms"},
      {R"([{"limit_ms": 1}])", "expected exactly one of"},
      {R"([{"jump": 1}])", "M[0].jump: unknown key"},
      {R"([{"mark": true, "limit_ms": 1}])", "M[0].limit_ms: this kind of step has no such"},
      {R"({"grammar": "<bogus>", "steps": []})", "M.grammar: value grammar: found '<bogus>'"},
      {R"({"grammar": "<int a..b>", "steps": []})", "a range of numbers"},
      {R"({"stepps": []})", "M.stepps: unknown"}};
  for (const auto& [text, part] : kBad) {
    const auto macro = ParseMacro("M", text);
    ASSERT_FALSE(macro) << text;
    EXPECT_NE(macro.error().text.find(part), std::string::npos) << macro.error().text;
  }
}

TEST(MacroTest, BracketsWithoutEndAreRefusedAndTakeNoStack) {
  EXPECT_FALSE(ParseMacro("M", std::string(60000, '[')));
  EXPECT_FALSE(ParseMacro("M", "{\"grammar\": \"" + std::string(60000, '(') + "\"}"));
}

}  // namespace
}  // namespace am

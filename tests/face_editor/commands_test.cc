#include "face_editor/core/commands.h"

#include <gtest/gtest.h>

namespace editor {
namespace {

class CommandsTest : public testing::Test {
 protected:
  void SetUp() override {
    auto made = Editor::Make("");
    ASSERT_TRUE(made) << made.error().text;
    editor_ = std::move(*made);
  }
  vm::Result<std::string> Run(const std::string& line) {
    const auto words = CommandWords(line);
    if (!words) return std::unexpected(words.error());
    auto answer = RunCommand(*editor_, *words);
    return answer ? *answer : vm::Fail(vm::Errc::kUnknownCommand, "no command: " + line);
  }
  std::string Answer(const std::string& line) {
    const auto answer = Run(line);
    return answer ? *answer : "error: " + answer.error().text;
  }
  std::unique_ptr<Editor> editor_;
};

TEST_F(CommandsTest, UnitsAreSetBySideAndTakenBack) {
  EXPECT_EQ(Answer("set AU 12 L 70"), "");
  EXPECT_EQ(Answer("set AU 6 50"), "");
  EXPECT_EQ(Answer("get look"), "6:0.5 12L:0.7");
  EXPECT_EQ(Answer("undo"), "");
  EXPECT_EQ(Answer("get look"), "12L:0.7");
  EXPECT_EQ(Answer("redo"), "");
  EXPECT_EQ(Answer("clear units"), "");
  EXPECT_EQ(Answer("get look"), "");
}

TEST_F(CommandsTest, ALookIsKeptAsAPatternOfAnExpression) {
  Run("set AU 14 R 40");
  EXPECT_EQ(Answer("add pattern SMIRK"), "");
  EXPECT_EQ(Answer("keep SMIRK 1"), "");
  EXPECT_EQ(Answer("get expression SMIRK 1"), "14R:0.4");
  EXPECT_EQ(Answer("set expression SMIRK 1 12L 0.5 gaze:3,4"), "");
  EXPECT_EQ(Answer("get expression SMIRK 1"), "12L:0.5 gaze:3,4");
  EXPECT_EQ(Answer("remove pattern SMIRK 1"), "");
  EXPECT_FALSE(editor_->state().expressions.contains("SMIRK"));
  EXPECT_EQ(Answer("get unsaved"), "emotions");
}

TEST_F(CommandsTest, MouthShapesTakeTheSeventeenParameters) {
  EXPECT_EQ(Answer("set mouth a 12 14.5"), "");
  EXPECT_EQ(Answer("set mouth a seal 0.25"), "");
  const std::string values = Answer("get mouth a");
  EXPECT_NE(values.find(" 14.5 "), std::string::npos) << values;
  EXPECT_NE(values.find(" 0.25 0 0"), std::string::npos) << values;
  EXPECT_FALSE(Run("set mouth a 18 1"));
  EXPECT_FALSE(Run("set mouth q 1 1"));
  EXPECT_FALSE(Run("set mouth a 1 61")) << "the table's bounds hold";
  EXPECT_FALSE(Run("set mouth a seal 2"));
}

TEST_F(CommandsTest, KeyFramesStayInOrder) {
  EXPECT_EQ(Answer("get motion NOD 1"), "100 10 0 0\n200 0 0 0");
  EXPECT_EQ(Answer("add key NOD 1 150 4 1 -1"), "");
  EXPECT_EQ(Answer("get motion NOD 1"), "100 10 0 0\n150 4 1 -1\n200 0 0 0");
  EXPECT_EQ(Answer("set key NOD 1 2 160 5 0 0"), "");
  EXPECT_FALSE(Run("set key NOD 1 2 250 5 0 0")) << "it would be after the next";
  EXPECT_FALSE(Run("set key NOD 1 2 160 500 0 0"));
  EXPECT_FALSE(Run("add key NOD 1 160 0 0 0")) << "two at one time";
  EXPECT_EQ(Answer("remove key NOD 1 1"), "");
  EXPECT_EQ(Answer("get motion NOD 1"), "160 5 0 0\n200 0 0 0");
  EXPECT_EQ(Answer("remove key NOD 1 1"), "");
  EXPECT_FALSE(Run("remove key NOD 1 1")) << "the last one";
  EXPECT_EQ(Answer("add motion LISTEN"), "");
  EXPECT_EQ(Answer("remove motion LISTEN 5"), "");
  EXPECT_FALSE(Run("remove motion LISTEN 5"));
}

TEST_F(CommandsTest, TimesOfExpressionsHaveBounds) {
  EXPECT_EQ(Answer("set timing HAPPY posed 600 0 10 20"), "");
  EXPECT_EQ(editor_->state().expressions.at("HAPPY").posed.onset_ms, 600);
  EXPECT_FALSE(Run("set timing HAPPY posed -1 0 10 20"));
  EXPECT_FALSE(Run("set timing HAPPY sometimes 1 0 10 20"));
  EXPECT_FALSE(Run("set timing NOBODY posed 1 0 10 20"));
}

TEST_F(CommandsTest, BadCommandsSayWhatWasExpected) {
  for (const auto& [line, part] :
       {std::pair("set AU 99 10", "not an action unit"), std::pair("set AU 12", "set AU UNIT"),
        std::pair("set AU 12 300", "strength"), std::pair("set AU 12 x", "not a number"),
        std::pair("drag chin 1", "drag POINT|GROUP DX DY"),
        std::pair("drag chin 1 1", "open a photo"), std::pair("load cake x", "points, emotions"),
        std::pair("get expression HAPPY 99", "no expression HAPPY 99"),
        std::pair("symmetry maybe", "on or off"), std::pair("undo", "nothing to take back"),
        std::pair("build anna", "no photo"), std::pair("add pattern 1st", "a letter"),
        std::pair("open /nowhere.jpg", "/nowhere.jpg"), std::pair("open \"half", "closing")}) {
    const auto answer = Run(line);
    ASSERT_FALSE(answer) << line;
    EXPECT_NE(answer.error().text.find(part), std::string::npos)
        << line << ": " << answer.error().text;
  }
  EXPECT_FALSE(editor_->history().can_undo()) << "nothing was changed";
}

TEST_F(CommandsTest, WordsMayHoldBlanks) {
  const auto words = CommandWords(" open \"my photo.png\" 2 # the second");
  ASSERT_TRUE(words);
  EXPECT_EQ(*words, (std::vector<std::string>{"open", "my photo.png", "2"}));
}

}  // namespace
}  // namespace editor

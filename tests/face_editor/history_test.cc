#include "face_editor/core/history.h"

#include <gtest/gtest.h>

namespace editor {
namespace {

void SetBase(History& history, const std::string& base, std::string_view merge = "") {
  history.Change(Part::kIdentity, "base " + base, merge, [&](State& state) { state.base = base; });
}

TEST(HistoryTest, StepsAreTakenBackAndDoneAgain) {
  History history{State{}};
  SetBase(history, "a");
  SetBase(history, "b");
  EXPECT_EQ(history.undo_name(), "base b");
  EXPECT_TRUE(history.Undo());
  EXPECT_EQ(history.now().base, "a");
  EXPECT_EQ(history.redo_name(), "base b");
  EXPECT_TRUE(history.Redo());
  EXPECT_EQ(history.now().base, "b");
  EXPECT_FALSE(history.Redo());
}

TEST(HistoryTest, ADragIsOneStepUntilItIsLetGo) {
  History history{State{}};
  SetBase(history, "a", "drag");
  SetBase(history, "b", "drag");
  history.Seal();
  SetBase(history, "c", "drag");
  EXPECT_TRUE(history.Undo());
  EXPECT_EQ(history.now().base, "b");
  EXPECT_TRUE(history.Undo());
  EXPECT_EQ(history.now().base, "galatea");
  EXPECT_FALSE(history.Undo());
}

TEST(HistoryTest, AChangeAfterTakingBackForgetsWhatCouldBeDoneAgain) {
  History history{State{}};
  SetBase(history, "a", "drag");
  history.Undo();
  SetBase(history, "b", "drag");
  EXPECT_FALSE(history.can_redo());
  history.Undo();
  EXPECT_EQ(history.now().base, "galatea");
}

TEST(HistoryTest, VersionsTellWhichPartDiffersAndComeBackWithIt) {
  History history{State{}};
  SetBase(history, "a");
  const auto first = history.now().version;
  SetBase(history, "b");
  const auto second = history.now().version;
  EXPECT_NE(first, second);
  EXPECT_EQ(first[static_cast<std::size_t>(Part::kMouth)],
            second[static_cast<std::size_t>(Part::kMouth)]);
  history.Undo();
  EXPECT_EQ(history.now().version, first);
}

TEST(HistoryTest, AChangeMayBeMadeOfTheStateBeforeIt) {
  History history{State{}};
  SetBase(history, "a name too long to be kept within the string itself");
  for (int i = 0; i < 40; ++i) {
    const std::string& before = history.now().base;
    history.Change(Part::kIdentity, "longer", "", [&](State& state) { state.base = before + "!"; });
  }
  EXPECT_TRUE(history.now().base.ends_with("itself" + std::string(40, '!')));
}

TEST(HistoryTest, OnlySoManyStepsAreKept) {
  History history{State{}};
  for (std::size_t i = 0; i < History::kMostSteps + 20; ++i) SetBase(history, std::to_string(i));
  std::size_t back = 0;
  while (history.Undo()) ++back;
  EXPECT_EQ(back, History::kMostSteps);
  EXPECT_EQ(history.now().base, "19");
}

}  // namespace
}  // namespace editor

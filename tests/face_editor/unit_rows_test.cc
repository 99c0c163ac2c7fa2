// The table of how far each unit moves which skin: edited by rows, written back into its own text.

#include "face_editor/core/unit_rows.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "face_editor/core/commands.h"
#include "face_editor/core/editor.h"

namespace editor {
namespace {

std::string BuiltIn() {
  std::ifstream in(GALATEA_SOURCE_DIR "/fsm/head/tables/action_units.txt");
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string Say(Editor& editor, std::string_view line) {
  const auto answer = RunCommand(editor, *CommandWords(line));
  if (!answer) return "no command";
  return *answer ? **answer : "error: " + answer->error().text;
}

TEST(UnitRowsTest, AnUnchangedTableIsWrittenByteForByte) {
  const auto units = ReadUnits("action_units.txt", BuiltIn());
  ASSERT_TRUE(units) << units.error().text;
  EXPECT_GT((*units)->rows.size(), 100U);
  EXPECT_EQ(WriteUnits(**units), BuiltIn());
}

TEST(UnitRowsTest, OnlyTheWordsChangedAreWrittenAnew) {
  const auto units = ReadUnits("u",
                               "# head\nfield 4   5  42   10 12  both   -0.6 -0.8  0.6 # brow\n\n"
                               "jaw   29   12  1.5\n");
  ASSERT_TRUE(units);
  UnitRows rows = (*units)->rows;
  rows[0].words[8] = "-12.5";
  rows[1].words[2] = "9";
  const auto changed = WithRows(**units, rows);
  ASSERT_TRUE(changed) << changed.error().text;
  EXPECT_EQ(WriteUnits(**changed),
            "# head\nfield 4   5  42   10 12  both   -0.6 -12.5  0.6 # brow\n\n"
            "jaw   29    9  1.5\n");
}

TEST(UnitRowsTest, NewRowsStandBesideTheirLikeAndRemovedOnesGo) {
  const auto units = ReadUnits("u", "field 4 5 42 10 12 both 0 1 0 # first\nlid 4 1 0\nseal 8 1\n");
  ASSERT_TRUE(units);
  UnitRows rows = (*units)->rows;
  rows.erase(rows.begin() + 2);
  rows.push_back({{"field", "4", "1", "2", "3", "4", "above", "0", "2", "0"}, 0});
  rows.push_back({{"sway", "30", "5"}, 0});
  EXPECT_EQ(WriteUnits(**WithRows(**units, rows)),
            "field 4 5 42 10 12 both 0 1 0 # first\nfield 4 1 2 3 4 above 0 2 0\nlid 4 1 0\n"
            "sway  30 5\n");
}

TEST(UnitRowsTest, CommandsChangeRowsAndAreTakenBack) {
  auto editor = *Editor::Make("");
  EXPECT_EQ(Say(*editor, "get rows 29"), "1: jaw 29 0 9");
  EXPECT_EQ(Say(*editor, "set row 29 1 degrees 20"), "");
  EXPECT_EQ(Say(*editor, "add row 29 field 25 -42 15 15 both 0 1 0"), "");
  EXPECT_EQ(Say(*editor, "get rows 29"), "1: jaw 29 20 9\n2: field 29 25 -42 15 15 both 0 1 0");
  EXPECT_EQ(Say(*editor, "get unsaved"), "units");
  EXPECT_EQ(Say(*editor, "remove row 29 1"), "");
  EXPECT_EQ(Say(*editor, "get rows 29"), "1: field 29 25 -42 15 15 both 0 1 0");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(Say(*editor, "undo"), "");
  EXPECT_EQ(Say(*editor, "get rows 29"), "1: jaw 29 0 9");
  EXPECT_EQ(editor->state().units, editor->built_in_units());
}

TEST(UnitRowsTest, TheLastNumberOfACreaseMayBeLeftOutAndSetAfterThat) {
  auto editor = *Editor::Make("");
  EXPECT_EQ(Say(*editor, "add row 29 crease 0.5 0 0 0 0"), "");
  EXPECT_EQ(Say(*editor, "set row 29 2 nose 0.1"), "");
  EXPECT_EQ(Say(*editor, "get rows 29"), "1: jaw 29 0 9\n2: crease 29 0.5 0 0 0 0.1");
  EXPECT_EQ(Say(*editor, "set row 29 2 forehead_sides 0.2"), "");
  EXPECT_EQ(Say(*editor, "get rows 29"), "1: jaw 29 0 9\n2: crease 29 0.5 0 0 0 0.1 0.2");
}

TEST(UnitRowsTest, WhatATableCannotHoldIsRefusedAndNothingChanges) {
  auto editor = *Editor::Make("");
  EXPECT_EQ(Say(*editor, "set row 3 1 x 1"),
            "error: 3 is no action unit; 1 to 46 without 3 and 40 expected");
  EXPECT_EQ(Say(*editor, "set row 29 2 slide 1"), "error: unit 29 has no row 2; there are 1");
  EXPECT_EQ(Say(*editor, "set row 29 1 upper 1"),
            "error: row 1 of unit 29 is a jaw and has no 'upper'; degrees, slide expected");
  EXPECT_EQ(Say(*editor, "set row 29 1 degrees 61"),
            "error: '61' found where -60 to 60 was expected");
  EXPECT_EQ(Say(*editor, "set row 29 1 degrees much"),
            "error: 'much' found where a number was expected");
  EXPECT_EQ(Say(*editor, "set row 12 1 part left"),
            "error: 'left' found where above, below or both was expected");
  EXPECT_TRUE(Say(*editor, "set row 29 1 degrees \"1 2\"").starts_with("error: one word"));
  EXPECT_TRUE(Say(*editor, "add row 29 wink 1").starts_with("error: 'wink' found; one of field"));
  EXPECT_EQ(Say(*editor, "add row 29 jaw 1 2 3"), "error: '3' is one word too many");
  EXPECT_FALSE(editor->history().can_undo());
}

TEST(UnitRowsTest, TheFolderOfTablesKeepsThem) {
  std::string folder = testing::TempDir() + "/units_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  auto editor = *Editor::Make("");
  ASSERT_TRUE(editor->SetRow(29, 1, "degrees", "20"));
  EXPECT_EQ(*editor->SaveTables(folder), 1);
  EXPECT_FALSE(editor->Unsaved(Part::kUnits));
  auto again = Editor::Make(folder);
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_EQ(Say(**again, "get rows 29"), "1: jaw 29 20 9");
  std::ofstream(folder + "/action_units.txt") << "jaw 29 20 0\njaw 29 20\n";
  const auto loaded = (*again)->Load(Part::kUnits, folder + "/action_units.txt");
  ASSERT_FALSE(loaded);
  EXPECT_NE(loaded.error().text.find("/action_units.txt:2: 'jaw' needs"), std::string::npos)
      << loaded.error().text;
  EXPECT_FALSE((*again)->LoadTables(folder));
  EXPECT_EQ(Say(**again, "get rows 29"), "1: jaw 29 20 9") << "what was edited stays";
  std::filesystem::remove_all(folder);
}

TEST(UnitRowsTest, AReadTableIsWrittenBackAfterUndoIntoItsOwnText) {
  std::string folder = testing::TempDir() + "/units_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  auto editor = *Editor::Make("");
  std::ofstream(folder + "/other.txt") << "# mine\njaw 29 20 0\n";
  ASSERT_TRUE(editor->Load(Part::kUnits, folder + "/other.txt"));
  ASSERT_TRUE(editor->history().Undo());
  ASSERT_TRUE(editor->Save(Part::kUnits, folder + "/back.txt"));
  std::ifstream back(folder + "/back.txt");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(back), {}), BuiltIn());
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace editor

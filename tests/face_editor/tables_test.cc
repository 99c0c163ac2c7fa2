// Tables written are what is read again, and keep what nobody changed.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "face_editor/core/editor.h"
#include "face_editor/core/table_writer.h"
#include "fsm/motion/base/unit_names.h"
#include "fsm/motion/inputs/motion_reader.h"

namespace editor {
namespace {

std::string Carried(const char* file) {
  std::ifstream in(std::string(GALATEA_SOURCE_DIR "/fsm/motion/tables/") + file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t LinesChanged(const std::string& a, const std::string& b) {
  std::istringstream left(a), right(b);
  std::multiset<std::string> lines;
  for (std::string line; std::getline(left, line);) lines.insert(line);
  std::size_t changed = 0;
  for (std::string line; std::getline(right, line);) {
    const auto same = lines.find(line);
    if (same == lines.end()) {
      ++changed;
    } else {
      lines.erase(same);
    }
  }
  return changed + lines.size();
}

TEST(TableWriterTest, UnchangedTablesAreWrittenByteForByte) {
  const auto tables = fsm::MotionTables::Load();
  ASSERT_TRUE(tables);
  EXPECT_EQ(WriteExpressions(Carried("emotions.txt"), tables->expressions, tables->unit_names),
            Carried("emotions.txt"));
  EXPECT_EQ(WriteVisemes(Carried("mouth_shapes.txt"), tables->set(fsm::VisemeSetId::k14).visemes),
            Carried("mouth_shapes.txt"));
  EXPECT_EQ(
      WriteVisemes(Carried("mouth_shapes_28.txt"), tables->set(fsm::VisemeSetId::k28).visemes),
      Carried("mouth_shapes_28.txt"));
  const auto& head = tables->motions.head;
  EXPECT_EQ(WriteCurves(Carried("motions.txt"), HeadCurves(head.begin(), head.end())),
            Carried("motions.txt"));
}

TEST(TableWriterTest, ChangedExpressionsAreReadAgainAndTheRestStays) {
  auto tables = fsm::MotionTables::Load();
  auto& expressions = tables->expressions;
  auto& happy = expressions.at("HAPPY");
  happy.patterns[1].au.left[12] = 0.25F;
  happy.patterns[1].gaze.left = happy.patterns[1].gaze.right = {-3, 4};
  happy.patterns.push_back({});
  happy.patterns.back().au.left[46] = happy.patterns.back().au.right[46] = 1;  // both sides of one
  happy.posed.onset_ms = 333;
  expressions.at("SAD").patterns.pop_back();
  expressions.erase("USERDEF");
  expressions["SMIRK"].patterns.resize(1);
  expressions["SMIRK"].patterns[0].au.right[14] = 0.5F;
  const std::string text =
      WriteExpressions(Carried("emotions.txt"), expressions, fsm::UnitNames::BuiltIn());
  const auto read = fsm::ReadExpressions("emotions.txt", text, fsm::UnitNames::BuiltIn());
  ASSERT_TRUE(read) << read.error().text;
  ASSERT_EQ(read->size(), expressions.size());
  for (const auto& [name, expression] : expressions) {
    const auto& again = read->at(name);
    ASSERT_EQ(again.patterns.size(), expression.patterns.size()) << name;
    for (std::size_t p = 0; p < expression.patterns.size(); ++p) {
      EXPECT_EQ(again.patterns[p].au, expression.patterns[p].au) << name << p;
      EXPECT_EQ(again.patterns[p].gaze.right, expression.patterns[p].gaze.right) << name << p;
    }
    EXPECT_EQ(again.posed.onset_ms, expression.posed.onset_ms) << name;
    EXPECT_EQ(again.elicited.lag_ms, expression.elicited.lag_ms) << name;
  }
  EXPECT_NE(text.find("# a smile with the lips closed"), std::string::npos);
  EXPECT_NE(text.find("ANGRY 4      4:0.5 7:0.3 17:0.3                   # annoyed\n"),
            std::string::npos);
}

TEST(TableWriterTest, AChangedMouthShapeIsOneLine) {
  auto tables = fsm::MotionTables::Load();
  auto& shapes = tables->set(fsm::VisemeSetId::k14).visemes;
  shapes[9].pose.mouth[fsm::kJawY] = 12.5F;
  shapes[9].hold = 0.2;
  const std::string before = Carried("mouth_shapes.txt");
  const std::string text = WriteVisemes(before, shapes);
  EXPECT_EQ(LinesChanged(before, text), 2U);
  const auto read = fsm::ReadVisemes("m", text);
  ASSERT_TRUE(read) << read.error().text;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    EXPECT_EQ(fsm::FormatVisemeValues((*read)[i]), fsm::FormatVisemeValues(shapes[i]));
  }
  EXPECT_NE(text.find("# a A: jaw 9"), std::string::npos);
}

TEST(TableWriterTest, ChangedMovementsAreReadAgainAndTheRestStays) {
  auto tables = fsm::MotionTables::Load();
  auto& head = tables->motions.head;
  HeadCurves curves(head.begin(), head.end());
  curves["NOD"][3] = fsm::HeadCurve({{150, {-2, 0.5F, 0}}, {900, {0, 0, 0}}});
  curves["LISTEN"].push_back(fsm::HeadCurve(std::vector<fsm::HeadCurve::Key>{{333, {1, 2, 3}}}));
  curves["REFUSE"].erase(curves["REFUSE"].begin() + 1);
  const std::string text = WriteCurves(Carried("motions.txt"), curves);
  const auto read = fsm::ReadMotions("motions.txt", text, fsm::UnitNames::BuiltIn());
  ASSERT_TRUE(read) << read.error().text;
  for (const auto& [kind, patterns] : curves) {
    ASSERT_EQ(read->head.at(kind).size(), patterns.size()) << kind;
    for (std::size_t p = 0; p < patterns.size(); ++p) {
      const auto keys = patterns[p].keys(), again = read->head.at(kind)[p].keys();
      ASSERT_EQ(again.size(), keys.size()) << kind << p;
      for (std::size_t k = 0; k < keys.size(); ++k) {
        EXPECT_EQ(again[k].ms, keys[k].ms);
        EXPECT_EQ(again[k].angles, keys[k].angles);
      }
    }
  }
  EXPECT_NE(text.find("NOD 4          # as people nod"), std::string::npos);
  EXPECT_NE(text.find("LIFE STILL     BLINK 1 GAZE 1 ASYMMETRY 1"), std::string::npos);
  EXPECT_EQ(read->auto_moves.size(), tables->motions.auto_moves.size());
}

TEST(EditorTablesTest, AFolderOfTablesIsWrittenAndReadByTheFace) {
  std::string folder = testing::TempDir() + "/editor_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  auto editor = Editor::Make("");
  ASSERT_TRUE(editor);
  fsm::FaceLook look;
  look.au.left[12] = 0.75F;
  ASSERT_TRUE((*editor)->SetExpression("HAPPY", 1, look));
  EXPECT_TRUE((*editor)->Unsaved(Part::kExpressions));
  const auto written = (*editor)->SaveTables(folder);
  ASSERT_TRUE(written) << written.error().text;
  EXPECT_EQ(*written, 1) << "only what differs";
  EXPECT_FALSE((*editor)->Unsaved(Part::kExpressions));
  const auto again = fsm::MotionTables::Load(folder);
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_EQ(fsm::FormatLook(again->expressions.at("HAPPY").patterns[0], fsm::UnitNames::BuiltIn()),
            "12L:0.75");
  std::filesystem::remove_all(folder);
}

TEST(EditorTablesTest, DamagedFilesAreRefusedWithTheirLineAndNothingChanges) {
  auto editor = Editor::Make("");
  const std::string path = testing::TempDir() + "/damaged_emotions.txt";
  std::ofstream(path) << "# one\nHAPPY 1 12:3\n";
  const auto loaded = (*editor)->Load(Part::kExpressions, path);
  ASSERT_FALSE(loaded);
  EXPECT_NE(loaded.error().text.find(path + ":2:"), std::string::npos) << loaded.error().text;
  EXPECT_TRUE((*editor)->state().expressions.contains("SAD"));
  EXPECT_FALSE((*editor)->history().can_undo());
  std::filesystem::remove(path);
}

TEST(EditorTablesTest, WhatCannotBeWrittenLeavesTheOldFile) {
  auto editor = Editor::Make("");
  const auto saved = (*editor)->Save(Part::kMouth, "/nowhere/mouth.txt");
  ASSERT_FALSE(saved);
  EXPECT_NE(saved.error().text.find("/nowhere/mouth.txt"), std::string::npos);
}

}  // namespace
}  // namespace editor

#include "fsm/motion/inputs/motion_tables.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>

#include "fsm/motion/inputs/motion_reader.h"
#include "tests/fsm/motion_support.h"

namespace fsm {
namespace {

TEST(MotionTablesTest, TheFourteenShapesStandInTheirOrder) {
  const MotionTables tables = BuiltIn();
  std::string names;
  for (const Viseme& shape : tables.set(VisemeSetId::k14).visemes) names += shape.name + " ";
  EXPECT_EQ(names, "rest r m t n k f s w a i u e o ");
}

TEST(MotionTablesTest, VowelJawsAreOrderedAsMeasuredInSpeech) {
  const auto shapes = BuiltIn().set(VisemeSetId::k14).visemes;
  const auto jaw = [&](std::size_t i) { return shapes[i].pose.mouth[kJawY]; };
  EXPECT_GT(jaw(9), jaw(12));   // a > e
  EXPECT_GT(jaw(12), jaw(13));  // e > o
  EXPECT_GT(jaw(13), jaw(10));  // o > i
  EXPECT_GT(jaw(10), jaw(11));  // i > u
}

TEST(MotionTablesTest, OnlyRestAndTheLipClosuresSeal) {
  const MotionTables tables = BuiltIn();
  for (const Viseme& shape : tables.set(VisemeSetId::k14).visemes) {
    EXPECT_EQ(shape.pose.seal, shape.name == "rest" || shape.name == "m" ? 1 : 0) << shape.name;
  }
}

TEST(MotionTablesTest, EveryPhonemeOfTheOriginalVoiceIsKnown) {
  const auto tables = BuiltIn();
  for (const char* name :
       {"a",  "i",  "u",  "e",  "o",  "k",  "s", "sh",  "t",   "ch", "ts", "n",  "h",  "f",
        "m",  "y",  "r",  "w",  "g",  "z",  "j", "d",   "b",   "p",  "ky", "ny", "hy", "my",
        "ry", "gy", "by", "py", "dy", "cl", "N", "pau", "sil", "A",  "I",  "U",  "E",  "O"}) {
    EXPECT_TRUE(tables.set(VisemeSetId::k14).japanese.contains(name)) << name;
  }
}

TEST(MotionTablesTest, EveryPhonemeOfFliteIsKnown) {
  const auto tables = BuiltIn();
  for (const char* name :
       {"aa",  "ae", "ah", "ao", "aw", "ax", "ay", "b",  "ch", "d", "dh", "eh", "er", "ey",
        "f",   "g",  "hh", "ih", "iy", "jh", "k",  "l",  "m",  "n", "ng", "ow", "oy", "p",
        "pau", "r",  "s",  "sh", "t",  "th", "uh", "uw", "v",  "w", "y",  "z",  "zh"}) {
    EXPECT_TRUE(tables.set(VisemeSetId::k14).english.contains(name)) << name;
  }
}

TEST(MotionTablesTest, ThereAreSixEmotionsAndUserdefWithFivePatterns) {
  const auto tables = BuiltIn();
  for (const char* name :
       {"HAPPY", "ANGRY", "DISGUSTED", "SAD", "SURPRISED", "FEARED", "USERDEF"}) {
    ASSERT_TRUE(tables.expressions.contains(name)) << name;
    EXPECT_EQ(tables.expressions.at(name).patterns.size(), 5u) << name;
  }
  EXPECT_FLOAT_EQ(tables.expressions.at("HAPPY").patterns[0].au.left[12], 1.0f);
  EXPECT_DOUBLE_EQ(tables.expressions.at("HAPPY").posed.onset_ms, 556);
}

/// The expression of that name in a table.
Expression Glad(const char* rows) {
  const auto table = ReadExpressions("e.txt", rows, UnitNames::BuiltIn());
  if (!table) throw std::runtime_error(table.error().text);
  return table->at("GLAD");
}

TEST(MotionTablesTest, AUnitThatBeginsLaterIsLeftOutBelowThatStrengthAndWholeAtFull) {
  Expression glad = Glad("GLAD 1 12:0.8 25L:0.5\nbegins GLAD 1 25:0.4");
  EXPECT_FLOAT_EQ(glad.LookOf(1, 0.4).au.left[12], 0.32F);
  EXPECT_FLOAT_EQ(glad.LookOf(1, 0.4).au.left[25], 0);
  EXPECT_FLOAT_EQ(glad.LookOf(1, 0.7).au.left[25], 0.25F);
  EXPECT_FLOAT_EQ(glad.LookOf(1, 1).au.left[25], 0.5F);
  EXPECT_FLOAT_EQ(glad.LookOf(1, 1).au.right[25], 0);
  glad.Redefine(1, FaceLook(glad.patterns[0]));
  EXPECT_FLOAT_EQ(glad.LookOf(1, 0.4).au.left[25], 0.2F)
      << "of a look that is made anew all begins";
}

TEST(MotionTablesTest, AUnitThatComesEarlyIsStrongerInASlightExpressionAndWholeAtFull) {
  Expression glad = Glad("GLAD 1 12:0.8 6:0.6\nearly GLAD 1 6L:0.5");
  EXPECT_FLOAT_EQ(glad.LookOf(1, 0).au.left[6], 0);
  EXPECT_FLOAT_EQ(glad.LookOf(1, 0.25).au.left[6], 0.3F);
  EXPECT_FLOAT_EQ(glad.LookOf(1, 0.25).au.right[6], 0.15F);
  EXPECT_FLOAT_EQ(glad.LookOf(1, 0.25).au.left[12], 0.2F);
  EXPECT_FLOAT_EQ(glad.LookOf(1, 1).au.left[6], 0.6F);
  EXPECT_FLOAT_EQ(glad.LookOf(1, 2).au.left[6], 1.2F);
  glad.Redefine(1, FaceLook(glad.patterns[0]));
  EXPECT_FLOAT_EQ(glad.LookOf(1, 0.25).au.left[6], 0.15F)
      << "of a look that is made anew all grow in proportion";
}

TEST(MotionTablesTest, AUnitThatBeginsLaterAndComesEarlyGrowsFastFromThere) {
  const Expression glad = Glad("GLAD 1 25:0.8\nbegins GLAD 1 25:0.2\nearly GLAD 1 25:0.5");
  EXPECT_FLOAT_EQ(glad.LookOf(1, 0.2).au.left[25], 0);
  EXPECT_FLOAT_EQ(glad.LookOf(1, 0.4).au.left[25], 0.4F);
  EXPECT_FLOAT_EQ(glad.LookOf(1, 1).au.left[25], 0.8F);
}

TEST(MotionTablesTest, CheeksAndLidsTakePartInASlightSmile) {
  const auto tables = BuiltIn();
  const Expression& happy = tables.expressions.at("HAPPY");
  EXPECT_GT(happy.LookOf(1, 0.3).au.left[6], 0.5F);
  EXPECT_FLOAT_EQ(happy.LookOf(1, 0.3).au.left[25], 0) << "with the lips closed";
  EXPECT_GT(happy.LookOf(1, 0.6).au.left[25], 0.5F) << "a smile shows teeth, and no slit";
}

TEST(MotionTablesTest, ADamagedRowOfBeginsOrEarlyIsReportedWithFileAndLine) {
  for (const auto& [row, expected] : std::map<std::string, std::string>{
           {"begins GLAD 2 25:0.4", "e.txt:2: a pattern that stands above expected"},
           {"begins", "e.txt:2: 'begins' needs at least 1 values after it, found 0"},
           {"begins GLAD 1 25:0.95", "e.txt:2: strengths from 0 to 0.9 expected"},
           {"begins GLAD 1 gaze:1,2", "e.txt:2: action units expected, and no gaze"},
           {"early GLAD 2 6:0.5", "e.txt:2: a pattern that stands above expected"},
           {"early GLAD 1 6:0.2", "e.txt:2: powers from 0.3 to 1 expected"},
           {"early GLAD 1 6:1.5", "e.txt:2: powers from 0.3 to 1 expected"}}) {
    const auto read = ReadExpressions("e.txt", "GLAD 1 12:0.8\n" + row, UnitNames::BuiltIn());
    ASSERT_FALSE(read) << row;
    EXPECT_EQ(read.error().text, expected);
  }
}

TEST(MotionTablesTest, FaceThirtyClosesTheEyes) {
  const auto tables = BuiltIn();
  EXPECT_EQ(tables.unit_list.face_slots.at(29).unit, 43);
  EXPECT_EQ(tables.unit_list.face_slots.at(0).unit, 1);
  EXPECT_EQ(tables.unit_list.face_slots.at(35).emotion, "FEARED");
}

TEST(MotionTablesTest, AWrongShapeIsReportedWithFileAndLine) {
  const auto shapes = ReadVisemes("my.txt", "# shapes\nrest 0 0 x\n");
  ASSERT_FALSE(shapes);
  EXPECT_TRUE(shapes.error().text.starts_with("my.txt:2: 4 words found")) << shapes.error().text;
}

TEST(MotionTablesTest, WrongWordsNameWhatWasExpected) {
  const auto shapes = BuiltIn().set(VisemeSetId::k14).visemes;
  const UnitNames& names = UnitNames::BuiltIn();
  const auto expect = [](const auto& result, const std::string& text) {
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().text.find(text), std::string::npos) << result.error().text;
  };
  expect(ReadPhonemeTable("p.txt", "a a 1\nb q 1\n", shapes),
         "p.txt:2: 'q' is neither a mouth shape");
  expect(ReadPhonemeTable("p.txt", "a a 1\na o 1\n", shapes),
         "p.txt:2: the phoneme 'a' is here twice");
  expect(ReadPhonemeTable("p.txt", "", shapes), "no phoneme found");
  expect(ReadPhonemeTable("p.txt", "a a nan\n", shapes),
         "p.txt:1: 'nan' found, a strength expected");
  expect(ReadExpressions("e.txt", "HAPPY 1 12:0.5 99:1\n", names),
         "e.txt:1: '99' at column 16 is not an action unit");
  expect(ReadExpressions("e.txt", "HAPPY 2 12:0.5\n", names),
         "e.txt:1: pattern 2 found, 1 expected");
  expect(ReadExpressions("e.txt", "posed HAPPY 1 2 3 4\n", names), "'HAPPY' has no pattern 1");
  expect(ReadMotions("m.txt", "NOD 1\nNOD 2\n", names), "m.txt:1: key frames");
  expect(ReadMotions("m.txt", "NOD 1\n 100 1 2 3\n 100 0 0 0\n", names),
         "m.txt:3: 100 ms is not after");
  expect(ReadMotions("m.txt", "JUMP 1\n", names), "m.txt:1: 'JUMP' found");
  expect(ReadUnitList("a.txt", "region brow 1 2\nregion mouth 12 2\n", names),
         "a.txt:2: unit 2 has another region above; one expected");
  EXPECT_TRUE(ReadUnitList("a.txt", "region brow 1 2\nregion brow 2\n", names));
  expect(ReadUnitList("a.txt", "face 0 1\n", names), "a.txt:1: '0' found, a position expected");
}

TEST(MotionTablesTest, AFolderReplacesOnlyTheTablesItHas) {
  char name[] = "/tmp/galatea_tables_XXXXXX";
  ASSERT_NE(mkdtemp(name), nullptr);
  const std::filesystem::path folder = name;
  std::ofstream(folder / "emotions.txt") << "BORED 1 43:0.4\n";
  const auto tables = MotionTables::Load(folder.string());
  ASSERT_TRUE(tables) << tables.error().text;
  EXPECT_EQ(tables->expressions.size(), 1u);
  EXPECT_EQ(tables->set(VisemeSetId::k14).visemes.size(), CountOf(VisemeSetId::k14));
  std::ofstream(folder / "emotions.txt") << "\nBORED\n";
  const auto wrong = MotionTables::Load(folder.string());
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().text, (folder / "emotions.txt").string() +
                                    ":2: the line ends where a pattern number is expected");
  std::filesystem::remove(folder / "emotions.txt");
  const std::string gestures = (folder / "gestures.txt").string();
  std::ofstream(gestures) << "nod size 0.5 0\n";
  const auto nods = MotionTables::Load(folder.string());
  ASSERT_TRUE(nods) << nods.error().text;
  EXPECT_EQ(nods->gestures.nod.size, (Linear{0.5F, 0}));
  EXPECT_EQ(nods->gestures.jaw.shouted, 180) << "rows left out are the built-in ones";
  std::ofstream(gestures) << "nod duration_ms 0\n";
  EXPECT_EQ(MotionTables::Load(folder.string()).error().text,
            gestures + ":1: '0' found where 1 to 1000 was expected");
  std::ofstream(gestures) << "contact approach_ms 60 12\n";
  EXPECT_EQ(MotionTables::Load(folder.string()).error().text,
            gestures + ":1: the first number of 'contact approach_ms' exceeds the second");
  std::filesystem::remove_all(folder);
  EXPECT_FALSE(MotionTables::Load(folder.string()));
}

TEST(MotionTablesTest, MotionFilesOfTheOriginalAreRead) {
  const auto curve = ReadMotionFile("nod.dat",
                                    "// number of keys below\r\n2\r\n// from line 5\r\n"
                                    "// ms x y z\r\n100 10.00 0.00 0.00\r\n200 0.00 0.00 0.00\r\n");
  ASSERT_TRUE(curve) << curve.error().text;
  EXPECT_FLOAT_EQ(curve->At(100)[0], 10);
  EXPECT_FLOAT_EQ(curve->At(50)[0], 5);
  EXPECT_FLOAT_EQ(curve->At(200)[0], 0);
}

TEST(HeadCurveTest, GoesThroughItsKeysWithoutOvershooting) {
  const HeadCurve curve(
      {{100, {0, 10, 0}}, {200, {0, 0, 0}}, {300, {0, -10, 0}}, {400, {0, 0, 0}}});
  for (double ms = 0; ms <= 400; ms += 1) {
    EXPECT_LE(std::abs(curve.At(ms)[1]), 10.001);
  }
  EXPECT_FLOAT_EQ(curve.At(100)[1], 10);
  EXPECT_FLOAT_EQ(curve.At(300)[1], -10);
  // It does not stop on its way through the middle.
  EXPECT_LT(curve.At(210)[1] - curve.At(190)[1], -1.5);
}

}  // namespace
}  // namespace fsm

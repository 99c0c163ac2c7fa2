// Units, codes and expressions as people name them, and bad ones.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "fsm/base/table_reader.h"
#include "fsm/motion/face_motion.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

struct UnitsTest : testing::Test {
  UnitsTest() { EXPECT_TRUE(motion.switches().Set(0ms, "ASYMMETRY", 0)); }
  FaceMotion motion{MotionTables::Load().value(), 1};
  FaceState After(const char* text) {
    const auto set = motion.action_units.Set(0ms, text);
    EXPECT_TRUE(set) << text << ": " << (set ? "" : set.error().text);
    return motion.StateAt(1s);
  }
  std::string Refusal(const char* text) {
    const auto set = motion.action_units.Set(0ms, text);
    return set ? "taken" : set.error().text;
  }
};

TEST_F(UnitsTest, All44UnitsGoByNumberAndByName) {
  const UnitNames& names = motion.tables().unit_names;
  int units = 0;
  for (int number = 1; number <= 46; ++number) {
    if (!names.IsUnit(number)) continue;
    ++units;
    ASSERT_TRUE(names.names.contains(number)) << number;
    const auto index = static_cast<std::size_t>(number);
    EXPECT_FLOAT_EQ(After((std::to_string(number) + "R 0.25").c_str()).au.right[index], 0.25f);
    EXPECT_FLOAT_EQ(motion.StateAt(1s).au.left[index], 0);
    const FaceState state = After((names.names.at(number) + " 0.75").c_str());
    EXPECT_FLOAT_EQ(state.au.left[index], 0.75f);
    EXPECT_FLOAT_EQ(state.au.right[index], names.IsOneSided(number) ? 0.25f : 0.75f);
  }
  EXPECT_EQ(units, 44);
}

TEST_F(UnitsTest, SidesLettersAndSeveralAtOnce) {
  const FaceState state = After("12L 0.7 R6C 1 E LipPucker.L:0.3 25A 300");
  EXPECT_FLOAT_EQ(state.au.left[12], 0.7f);
  EXPECT_FLOAT_EQ(state.au.right[12], 0);
  EXPECT_FLOAT_EQ(state.au.right[6], 0.5f);
  EXPECT_FLOAT_EQ(state.au.left[1], 1);
  EXPECT_FLOAT_EQ(state.au.left[18], 0.3f);
  EXPECT_FLOAT_EQ(state.au.left[25], 0.1f);
  EXPECT_LT(motion.StateAt(150ms).au.left[1], 0.6f) << "300 ms were asked for";
}

TEST_F(UnitsTest, CodesTurnHeadAndEyes) {
  EXPECT_FLOAT_EQ(After("51 0.5").head_rotation[1], 15);  // the agent's left is the viewer's right
  EXPECT_FLOAT_EQ(After("51 0 52 1").head_rotation[1], -30);
  EXPECT_FLOAT_EQ(After("52 0 53 1").head_rotation[0], -20);
  EXPECT_FLOAT_EQ(After("53 0 55 1").head_rotation[2], 15);
  EXPECT_FLOAT_EQ(After("55 0 EyesUp 1").gaze.left[kDown], -25);
  EXPECT_FLOAT_EQ(After("63 0 CrossEye 1").gaze.left[kToRight], -12);
  EXPECT_FLOAT_EQ(motion.StateAt(1s).gaze.right[kToRight], 12);
  EXPECT_FLOAT_EQ(After("57 1").head_forward_mm, 35);
  EXPECT_FLOAT_EQ(After("57 0 58 0.5").head_forward_mm, -11);
  EXPECT_FLOAT_EQ(motion.StateAt(1s).figure.scale, 1);
}

TEST_F(UnitsTest, AWinkWithoutASideIsOfTheAgentsLeftAndIsTakenBackOnBoth) {
  EXPECT_FLOAT_EQ(After("46 1").au.left[46], 1);
  EXPECT_FLOAT_EQ(motion.StateAt(1s).au.right[46], 0);
  EXPECT_FLOAT_EQ(After("46R 1").au.right[46], 1);
  EXPECT_FLOAT_EQ(After("46 0").au.right[46], 0);
  EXPECT_FLOAT_EQ(motion.StateAt(1s).au.left[46], 0);
  EXPECT_FLOAT_EQ(After("Wink D").au.left[46], 0.75f);
  const auto look = ParseLook("46:1 45:1", motion.tables().unit_names);
  ASSERT_TRUE(look);
  EXPECT_FLOAT_EQ(look->au.right[46], 0);
  EXPECT_FLOAT_EQ(look->au.right[45], 1);
}

TEST_F(UnitsTest, RefusalsNameTheWordItsPlaceAndWhatWasExpected) {
  EXPECT_TRUE(Refusal("12 0.5 99 1").starts_with("'99' at column 8 is not an action unit"));
  EXPECT_TRUE(Refusal("12 1e9").starts_with("'1e9' at column 4 is no strength; a number from 0"));
  EXPECT_TRUE(Refusal("12 nan").starts_with("'nan' at column 4 is no strength"));
  EXPECT_TRUE(Refusal("12 -1").starts_with("'-1' at column 4 is no strength"));
  EXPECT_TRUE(Refusal("12").starts_with("'12' at column 1 is without a strength"));
  EXPECT_TRUE(Refusal("Smiler 1").starts_with("'Smiler' at column 1 is not an action unit"));
  EXPECT_TRUE(Refusal("51L 1").starts_with("'51L' at column 1 is a code of head or eyes"));
  EXPECT_TRUE(Refusal("12 0.5 -20").starts_with("'-20' at column 8 is no time"));
  EXPECT_TRUE(Refusal("").starts_with("nothing found"));
  EXPECT_TRUE(Refusal("12F 1").starts_with("'12F' at column 1 is not"));
  const FaceState state = motion.StateAt(1s);
  for (const float v : state.au.left) EXPECT_EQ(v, 0) << "a refused line moves nothing";
}

TEST_F(UnitsTest, AnUnknownUnitIsRefusedWithThoseThereAre) {
  EXPECT_EQ(
      Refusal("lidtense 1"),
      "'lidtense' at column 1 is not an action unit; a number (1-2, 4-39, 41-46, 51-58, "
      "61-66) or name of action_unit_names.txt (such as LidTightener, LidDroop, LipWipe, LipBite, "
      "LipSuck) expected, with L or R for one side");
}

TEST_F(UnitsTest, ATimeThatLooksLikeASecondStrengthIsRefused) {
  EXPECT_TRUE(Refusal("58B 0.5").starts_with("'0.5' at column 5 is a second strength: '58B' says"))
      << Refusal("58B 0.5");
  EXPECT_EQ(Refusal("58B 300"), "taken");
  EXPECT_EQ(Refusal("58B 0"), "taken");
  EXPECT_EQ(Refusal("58 B 0.5"), "taken");
}

TEST(OwnUnitNamesTest, AreFoundWhateverTheirCaseBeforeNumbersWithALetter) {
  const auto names = ReadUnitNames("n.txt",
                                   "unit 12 LipCornerPuller\ncode 58 HeadBack -2 0 0 0 0 0 0 -22\n"
                                   "code 158 58b 9 0 0 -9 0 -9 0 -8\n");
  ASSERT_TRUE(names) << names.error().text;
  for (const char* text : {"58b 0.7", "58B 0.7"}) {
    const auto command = ParseUnitCommand(text, *names);
    ASSERT_TRUE(command) << command.error().text;
    EXPECT_EQ(command->settings.at(0).number, 158) << text;
    EXPECT_EQ(command->settings.at(0).strength, 0.7) << text;
    EXPECT_FALSE(command->ms) << text;
  }
  EXPECT_EQ(ParseUnitCommand("58C", *names)->settings.at(0).number, 58);
  const auto one_side = ParseUnitName("lipCORNERpuller.l", *names);
  ASSERT_TRUE(one_side) << one_side.error().text;
  EXPECT_EQ(one_side->number, 12);
  EXPECT_EQ(one_side->sides, (Sided<bool>{.right = false, .left = true}));
}

TEST(OwnUnitNamesTest, SayWhetherNameOrNumberIsThereTwice) {
  const auto error = [](const char* text) {
    const auto names = ReadUnitNames("n.txt", text);
    return names ? "taken" : names.error().text;
  };
  EXPECT_EQ(error("unit 151 Ear\nunit 151 Chin\n"),
            "n.txt:2: the number 151 is here twice, for 'Ear' and 'Chin'");
  EXPECT_EQ(
      error("unit 151 Ear\n\nunit 152 EAR\n"),
      "n.txt:3: the name 'EAR' is here twice, for 151 and 152 (capitals and small letters are "
      "the same)");
}

TEST_F(UnitsTest, StrengthsThatAreNoneAreRefusedEverywhere) {
  for (const double bad : {std::nan(""), 1e9, -0.1, std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(motion.expression.Show(0ms, "HAPPY", 1, bad, 0ms)) << bad;
    EXPECT_FALSE(motion.SetListedUnit(0ms, 1, bad)) << bad;
    EXPECT_FALSE(motion.mouth.Set(0ms, 1, bad)) << bad;
    EXPECT_FALSE(motion.action_units.Set(0ms, "12 " + std::to_string(bad))) << bad;
    EXPECT_FALSE(motion.blend_shapes.Set(0ms, "jawOpen", bad, 0ms)) << bad;
  }
}

TEST_F(UnitsTest, All52BlendShapesAreThere) { EXPECT_EQ(motion.tables().blend_shapes.size(), 52u); }

TEST_F(UnitsTest, ExpressionsAreDefinedChangedAndForgotten) {
  ASSERT_TRUE(motion.expressions().Define("SMIRK", 1, "12L 0.7 14R 0.2"));
  ASSERT_TRUE(motion.expressions().Define("SMIRK", 2, "12L:1 gaze:0,10"));
  ASSERT_TRUE(motion.expression.Show(0ms, "SMIRK", 1, 2, 0ms));
  EXPECT_FLOAT_EQ(motion.StateAt(1s).au.left[12], 1.4f);
  EXPECT_FLOAT_EQ(motion.StateAt(1s).au.right[14], 0.4f);
  ASSERT_TRUE(motion.expression.Show(1s, "SMIRK", 2, 1, 0ms));
  EXPECT_FLOAT_EQ(motion.StateAt(2s).gaze.left[kToRight], 10);
  ASSERT_TRUE(motion.expressions().Define("HAPPY", 1, "12 1"));
  EXPECT_TRUE(motion.expressions().Define("2FAST", 1, "12 1")) << "a digit may come first";
  ASSERT_TRUE(motion.expression.Show(2s, "HAPPY", 1, 1, 0ms));
  EXPECT_FLOAT_EQ(motion.StateAt(3s).au.left[12], 1);
  motion.expressions().Forget("HAPPY");
  motion.expressions().Forget("SMIRK");
  ASSERT_TRUE(motion.expression.Show(3s, "HAPPY", 1, 1, 0ms));
  EXPECT_FLOAT_EQ(motion.StateAt(4s).au.left[12], 1.0f);
  EXPECT_FALSE(motion.expression.Show(4s, "SMIRK", 1, 1, 0ms));
}

TEST_F(UnitsTest, BadDefinitionsAreRefused) {
  const auto refusal = [&](const char* name, int pattern, const char* look) {
    const auto made = motion.expressions().Define(name, pattern, look);
    return made ? "taken" : made.error().text;
  };
  EXPECT_TRUE(refusal("SMIRK", 1, "12L 0.7 140 0.2").starts_with("'140' at column 9"));
  EXPECT_TRUE(refusal("SMIRK", 2, "12 1").starts_with("SMIRK has 0 patterns; pattern 1 to 1"));
  EXPECT_TRUE(refusal("NEUTRAL", 1, "12 1").starts_with("'NEUTRAL' cannot be the name"));
  EXPECT_TRUE(refusal("A B", 1, "12 1").starts_with("'A B' cannot be"));
  EXPECT_TRUE(refusal("X", 1, "51 1").starts_with("51 is a code of head or eyes"));
  EXPECT_TRUE(refusal("X", 1, "12 1 gaze:a,b").starts_with("'gaze:a,b' at column 6"));
  EXPECT_TRUE(refusal("X", 1, "12 nan").starts_with("'nan' at column 4"));
}

TEST_F(UnitsTest, ThereIsAnEndToExpressions) {
  int made = 0;
  while (motion.expressions().Define("E" + std::to_string(made), 1, "12 1")) {
    ASSERT_LT(++made, 1000);
  }
  EXPECT_TRUE(motion.expressions().Define("E0", 2, "12 0.5"));
}

TEST_F(UnitsTest, AWordOfALookIsRefusedByItsPlace) {
  const auto refusal = [&](std::string_view look) {
    const auto read = ParseLook(look, motion.tables().unit_names);
    return read ? "" : read.error().text;
  };
  EXPECT_EQ(refusal("gaze:6,0 12:0.5 gazeL:1,2"), "");
  EXPECT_TRUE(refusal("gaze:6,0 99 1").starts_with("'99' at column 10 is not an action unit"));
  EXPECT_TRUE(refusal("12 1 gazeU:6,0").starts_with("'gazeU:6,0' at column 6 is no direction"));
  EXPECT_TRUE(refusal("12 1 12").starts_with("'12' at column 6 is without a strength"));
  EXPECT_TRUE(refusal("51 1").starts_with("51 is a code of head or eyes"));
  EXPECT_TRUE(refusal(" ").starts_with("nothing found where units"));
}

TEST_F(UnitsTest, LooksAreWrittenAsTheyAreRead) {
  for (const auto& [name, emotion] : motion.tables().expressions) {
    for (const FaceLook& look : emotion.patterns) {
      const auto again =
          ParseLook(FormatLook(look, motion.tables().unit_names), motion.tables().unit_names);
      ASSERT_TRUE(again) << FormatLook(look, motion.tables().unit_names);
      EXPECT_EQ(again->au.left, look.au.left);
      EXPECT_EQ(again->au.right, look.au.right);
      EXPECT_EQ(again->gaze.left, look.gaze.left);
    }
  }
}

// ---- damaged and hostile tables

TEST(HostileTablesTest, EveryTableSurvivesDamageAtAnyPlace) {
  const std::filesystem::path source = GALATEA_SOURCE_DIR "/fsm/motion/tables";
  char name[] = "/tmp/galatea_tables_XXXXXX";
  ASSERT_NE(mkdtemp(name), nullptr);
  const std::filesystem::path folder = name;
  std::mt19937 random(3);
  int refused = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source)) {
    const std::string whole = ReadTableFile(entry.path().string()).value();
    for (int run = 0; run < 12; ++run) {
      std::string text = whole;
      for (int hit = 0; hit < 1 + run; ++hit) {
        const std::size_t at = random() % text.size();
        if (run % 3 == 0) text.resize(at + 1);
        if (run % 3 == 1) text[at] = static_cast<char>(random() % 256);
        if (run % 3 == 2)
          text.insert(at, std::array{"nan", "1e999", "\n", "-9", "L"}[random() % 5]);
      }
      const std::filesystem::path file = folder / entry.path().filename();
      std::ofstream(file, std::ios::binary) << text;
      const auto tables = MotionTables::Load(folder.string());
      if (!tables) {
        ++refused;
        // The file itself, or another that refers to what is gone.
        EXPECT_TRUE(tables.error().text.starts_with(folder.string() + "/") ||
                    tables.error().text.find(".txt:") != std::string::npos)
            << tables.error().text;
        EXPECT_LT(tables.error().text.size(), 700u);
      }
      std::filesystem::remove(file);
    }
  }
  EXPECT_GT(refused, 40);
  std::filesystem::remove_all(folder);
}

TEST(HostileTablesTest, HugeFilesDevicesAndBinariesAreRefused) {
  char name[] = "/tmp/galatea_tables_XXXXXX";
  ASSERT_NE(mkdtemp(name), nullptr);
  const std::filesystem::path folder = name;
  const auto refusal = [&] {
    const auto tables = MotionTables::Load(folder.string());
    return tables ? "taken" : tables.error().text;
  };
  std::ofstream(folder / "emotions.txt") << std::string(kMaxTableBytes + 10, 'x');
  EXPECT_NE(refusal().find("is over"), std::string::npos);
  std::ofstream(folder / "emotions.txt") << std::string(100000, 'x');
  EXPECT_LT(refusal().size(), 700u);
  std::filesystem::remove(folder / "emotions.txt");
  std::filesystem::create_symlink("/dev/zero", folder / "emotions.txt");
  EXPECT_NE(refusal().find("is not a regular file"), std::string::npos);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace fsm
